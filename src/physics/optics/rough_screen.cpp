// The screen of Gaussian heights: its light leaves as a mixture of normal distributions of
// directions, one for each power of each scale's autocorrelation. Eq. optics.12
#include <algorithm>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "physics/optics/screen.h"
#include "physics/optics/sparkle.h"

namespace papilla::optics {
namespace {

// Scattered light: shares by the variance of each of the two sines of its direction.
struct Mixture {
  double straight = 1;                           // in the undeviated direction
  std::vector<std::pair<double, double>> parts;  // (variance, share)
};

struct Term {
  double variance, share;
};

// Of one scale: Poisson's shares of 0, 1, 2, ... events, each of which adds to the variance.
std::vector<Term> terms_of(double phase_variance, double step) {
  constexpr double kReach = 9, kLeast = 1e-12;  // standard deviations; left out beyond: 1e-18
  const double spread = std::sqrt(phase_variance);
  const int first = static_cast<int>(std::max(0.0, phase_variance - kReach * spread - 12));
  const int last = static_cast<int>(phase_variance + kReach * spread + 12);
  std::vector<Term> out;
  for (int k = first; k <= last; ++k) {
    const double log_share =
        phase_variance > 0 ? k * std::log(phase_variance) - phase_variance - std::lgamma(k + 1.0)
        : k == 0           ? 0
                           : -kInfinity;
    if (const double share = std::exp(log_share); share > kLeast) out.push_back({k * step, share});
  }
  return out;
}

// Terms of nearly the same variance are one: 4 % apart.
Mixture mixture(const std::vector<RoughScale>& scales, double phase, double wavelength) {
  std::vector<Term> all{{0, 1}};
  for (const RoughScale& s : scales) {
    if (s.rms <= 0) continue;
    const double step = 2 * square(wavelength / (2 * kPi * s.correlation_length));
    std::map<int, Term> merged;
    for (const Term& one : terms_of(square(phase * s.rms), step)) {
      for (const Term& other : all) {
        const double variance = one.variance + other.variance, share = one.share * other.share;
        constexpr double kBins = 25, kNone = -1000;
        const int bin =
            static_cast<int>(variance > 0 ? std::floor(kBins * std::log(variance)) : kNone);
        Term& in = merged[bin];
        in.variance += share * variance, in.share += share;
      }
    }
    all.clear();
    for (const auto& [bin, t] : merged) all.push_back({t.variance / t.share, t.share});
  }
  Mixture out{0, {}};
  for (const Term& t : all) {
    if (t.variance > 0) {
      out.parts.emplace_back(t.variance, t.share);
    } else {
      out.straight += t.share;
    }
  }
  return out;
}

class RoughScreen : public Screen {
 public:
  explicit RoughScreen(std::vector<RoughScale> scales) : scales_(std::move(scales)) {}

  Sent through(const Column& column, double wavelength, double sine, double cone) const override {
    const double power = mean_power([&](double h) { return column.through(h); }, column);
    const Mixture light = mixture(scales_, column.phase_through(), wavelength);
    double inside = light.straight;
    for (const auto& [variance, share] : light.parts)
      inside += share * inside_cone(variance, sine, cone);
    return {power * light.straight, power * inside, power};
  }

  double received(const Column& column, double wavelength,
                  const Receptor& receptor) const override {
    const double power = mean_power([&](double h) { return column.back(h); }, column);
    return power * taken(mixture(scales_, column.phase_back(), wavelength), receptor);
  }

  // Two passages far from each other: their phases are independent.
  double received_twice(const Column& column, double wavelength,
                        const Receptor& receptor) const override {
    const double power = mean_power([&](double h) { return column.through(h); }, column);
    return power * power *
           taken(mixture(scales_, std::sqrt(2.0) * column.phase_through(), wavelength), receptor);
  }

  double sparkle(double step, const Panel& panel) const override {
    return rough_sparkle(scales_, step, panel);
  }

 private:
  // Over the heights, which films of a thickness of their own make matter.
  template <class Amplitude>
  double mean_power(const Amplitude& amplitude, const Column& column) const {
    if (column.even()) return std::norm(amplitude(0));
    double variance = 0, sum = 0, weights = 0;
    for (const RoughScale& s : scales_) variance += square(s.rms);
    constexpr int kSteps = 16;
    for (int k = 0; k < kSteps; ++k) {
      const double u = -3 + 6 * (k + 0.5) / kSteps, weight = std::exp(-0.5 * u * u);
      sum += weight * std::norm(amplitude(u * std::sqrt(variance)));
      weights += weight;
    }
    return sum / weights;
  }

  // The cone around an oblique direction is an ellipse of sines.
  static double inside_cone(double variance, double sine, double cone) {
    const double across = std::sin(cone), along = across * std::sqrt(1 - sine * sine);
    if (sine == 0) return -std::expm1(-square(across) / (2 * variance));
    constexpr int kSteps = 16;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double turn = 0.5 * kPi * (k + 0.5) / kSteps;
      const double radius = 1 / std::hypot(std::cos(turn) / along, std::sin(turn) / across);
      sum += -std::expm1(-radius * radius / (2 * variance)) / kSteps;
    }
    return sum;
  }

  // The receptor takes what lies in both its slits, and a normal density parts likewise.
  static double taken(const Mixture& light, const Receptor& receptor) {
    double out = light.straight * receptor.accepts(0, 0);
    for (const auto& [variance, share] : light.parts) {
      const double spread = std::sqrt(variance);
      out += share *
             share_within(receptor.angle, spread, receptor.offset, receptor.reach_x(),
                          [&](double off) { return receptor.along(off); }) *
             share_within(0, spread, 0, receptor.reach_y(),
                          [&](double off) { return receptor.across(off); });
    }
    return out;
  }

  // Of a normal density of sines around that of `angle`, what a slit takes; midpoints over what
  // both have in common.
  template <class Slit>
  static double share_within(double angle, double spread, double offset, double reach,
                             const Slit& slit) {
    constexpr int kSteps = 48;
    constexpr double kTails = 6;  // standard deviations
    const double sine = std::sin(angle);
    const auto angle_of = [](double s) { return std::asin(std::clamp(s, -1.0, 1.0)); };
    const double low = std::max(offset - reach, angle_of(sine - kTails * spread) - angle);
    const double high = std::min(offset + reach, angle_of(sine + kTails * spread) - angle);
    double sum = 0;
    for (int k = 0; k < kSteps && high > low; ++k) {
      const double off = low + (high - low) * (k + 0.5) / kSteps;
      const double u = (std::sin(angle + off) - sine) / spread;
      sum += slit(off) * std::exp(-0.5 * u * u) * std::cos(angle + off);
    }
    return sum * (high - low) / kSteps / (std::sqrt(2 * kPi) * spread);
  }

  std::vector<RoughScale> scales_;
};

}  // namespace

std::unique_ptr<Screen> rough_screen(const std::vector<RoughScale>& scales) {
  return std::make_unique<RoughScreen>(scales);
}

}  // namespace papilla::optics
