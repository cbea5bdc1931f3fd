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

// Scattered light: shares by the variance of each of the two sines of its direction; of two waves
// that interfere shares may be negative.
struct Mixture {
  double straight = 1;                           // in the undeviated direction
  std::vector<std::pair<double, double>> parts;  // (variance, share)
};

constexpr double kBins = 25;  // of variances, a factor of e: 4 % apart

struct Term {
  double variance, share;
};

// Of one scale and two phases: shares of 0, 1, 2, ... events, each of which adds to the variance;
// Poisson's where both are one.
std::vector<Term> terms_of(double phase, double other, double step) {
  constexpr double kReach = 9, kLeast = 1e-12;  // standard deviations; left out beyond: 1e-18
  const double mean = std::abs(phase * other), spread = std::sqrt(mean);
  const double loss = 0.5 * (square(phase) + square(other));
  const int first = static_cast<int>(std::max(0.0, mean - kReach * spread - 12));
  const int last = static_cast<int>(mean + kReach * spread + 12);
  std::vector<Term> out;
  for (int k = first; k <= last; ++k) {
    const double log_share = mean > 0 ? k * std::log(mean) - loss - std::lgamma(k + 1.0)
                             : k == 0 ? -loss
                                      : -kInfinity;
    const double sign = phase * other < 0 && k % 2 != 0 ? -1 : 1;
    if (const double share = std::exp(log_share); share > kLeast)
      out.push_back({k * step, sign * share});
  }
  return out;
}

// Of one wave by another, of these phases a metre: their product, mean over places. Terms of nearly
// the same variance are one: 4 % apart. Eq. optics.12
Mixture mixture(const std::vector<RoughScale>& scales, double phase, double other_phase,
                double wavelength) {
  std::vector<Term> all{{0, 1}};
  for (const RoughScale& s : scales) {
    if (s.rms <= 0) continue;
    const double step = 2 * square(wavelength / (2 * kPi * s.correlation_length));
    struct Merged {
      double variance = 0, size = 0, share = 0;
    };
    std::map<int, Merged> merged;
    for (const Term& one : terms_of(phase * s.rms, other_phase * s.rms, step)) {
      for (const Term& other : all) {
        const double variance = one.variance + other.variance, share = one.share * other.share;
        constexpr double kNone = -1000;
        const int bin =
            static_cast<int>(variance > 0 ? std::floor(kBins * std::log(variance)) : kNone);
        Merged& in = merged[bin];
        in.variance += std::abs(share) * variance, in.size += std::abs(share);
        in.share += share;
      }
    }
    all.clear();
    for (const auto& [bin, t] : merged) all.push_back({t.variance / t.size, t.share});
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
Mixture mixture(const std::vector<RoughScale>& scales, double phase, double wavelength) {
  return mixture(scales, phase, phase, wavelength);
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

  using Screen::received;
  std::vector<double> received(const Column& column, double wavelength,
                               const std::vector<Receptor>& receptors) const override {
    std::vector<double> out(receptors.size(), 0.0);
    for (const Product& product : reflected(column)) {
      const std::vector<double>& share = taken(product.phase, product.other, wavelength, receptors);
      for (std::size_t k = 0; k < receptors.size(); ++k) out[k] += product.power * share[k];
    }
    return out;
  }

  double mirrored(const Column& column, double) const override {
    double out = 0;
    for (const Product& product : reflected(column)) {
      const double loss = 0.5 * (square(product.phase) + square(product.other));
      out += product.power * std::exp(-loss * height_variance());
    }
    return out;
  }

  double step() const override { return 0; }  // a normal distribution has no two levels

  // Two passages far from each other: their phases are independent.
  double received_twice(const Column& column, double wavelength,
                        const Receptor& receptor) const override {
    const double power = mean_power([&](double h) { return column.through(h); }, column);
    const double phase = std::sqrt(2.0) * column.phase_through();
    return power * power * taken(phase, phase, wavelength, {receptor}).front();
  }

  double sparkle(double step, const Panel& panel) const override {
    return rough_sparkle(scales_, step, panel);
  }

 private:
  // Mean product of two reflected waves, of these phases a metre; flat it has this power.
  struct Product {
    double power, phase, other;
  };
  static std::vector<Product> reflected(const Column& column) {
    const double top_phase = column.phase_back(), below_phase = column.phase_below();
    if (column.even()) return {{std::norm(column.back(0)), top_phase, top_phase}};
    // The top of the film and what lies below it scatter differently, and interfere.
    const Complex top = column.top(), below = column.back(0) - top;
    return {{std::norm(top), top_phase, top_phase},
            {std::norm(below), below_phase, below_phase},
            {2 * (top * std::conj(below)).real(), top_phase, below_phase}};
  }

  double height_variance() const {
    double out = 0;
    for (const RoughScale& s : scales_) out += square(s.rms);
    return out;
  }

  // Over the heights, which films of a thickness of their own make matter.
  template <class Amplitude>
  double mean_power(const Amplitude& amplitude, const Column& column) const {
    if (column.even()) return std::norm(amplitude(0));
    const double spread = std::sqrt(height_variance());
    double sum = 0, weights = 0;
    constexpr int kSteps = 16;
    for (int k = 0; k < kSteps; ++k) {
      const double u = -3 + 6 * (k + 0.5) / kSteps, weight = std::exp(-0.5 * u * u);
      sum += weight * std::norm(amplitude(u * spread));
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

  // Of one mixture, receptor by receptor; polarisations ask for the same.
  const std::vector<double>& taken(double phase, double other, double wavelength,
                                   const std::vector<Receptor>& receptors) const {
    const auto serves = [&](const Taken& t) {
      return t.phase == phase && t.other == other && t.wavelength == wavelength &&
             t.receptors == receptors;
    };
    if (const auto found = std::find_if(taken_.rbegin(), taken_.rend(), serves);
        found != taken_.rend())
      return found->shares;
    const Mixture light = mixture(scales_, phase, other, wavelength);
    std::vector<double> shares;
    for (const Receptor& receptor : receptors) {
      double sum = light.straight * receptor.accepts(0, 0);
      for (const auto& [variance, share] : light.parts) sum += share * within(receptor, variance);
      shares.push_back(sum);
    }
    taken_.push_back({phase, other, wavelength, receptors, shares});
    return taken_.back().shares;
  }

  // Of a normal density of this variance, what a receptor takes: straight lines between variances
  // that are 4 % apart, as those of a mixture are.
  double within(const Receptor& receptor, double variance) const {
    auto known = std::find_if(slits_.begin(), slits_.end(),
                              [&](const Slits& s) { return s.receptor == receptor; });
    if (known == slits_.end()) known = slits_.insert(slits_.end(), {receptor, {}});
    const auto at = [&](int bin) {
      const auto [place, missing] = known->shares.try_emplace(bin);
      if (missing) place->second = share_of(receptor, std::exp(0.5 * bin / kBins));
      return place->second;
    };
    const double place = kBins * std::log(variance);
    const int bin = static_cast<int>(std::floor(place));
    return at(bin) + (place - bin) * (at(bin + 1) - at(bin));
  }

  // The receptor takes what lies in both its slits, and a normal density parts likewise.
  static double share_of(const Receptor& receptor, double spread) {
    return share_within(receptor.angle, spread, receptor.offset, receptor.reach_x(),
                        [&](double off) { return receptor.along(off); }) *
           share_within(0, spread, 0, receptor.reach_y(),
                        [&](double off) { return receptor.across(off); });
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
  struct Taken {
    double phase, other, wavelength;
    std::vector<Receptor> receptors;
    std::vector<double> shares;
  };
  mutable std::vector<Taken> taken_;
  struct Slits {
    Receptor receptor;
    std::map<int, double> shares;  // by the bin of the variance
  };
  mutable std::vector<Slits> slits_;
};

}  // namespace

std::unique_ptr<Screen> rough_screen(const std::vector<RoughScale>& scales) {
  return std::make_unique<RoughScreen>(scales);
}

}  // namespace papilla::optics
