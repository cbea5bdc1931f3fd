#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "physics/persson/persson.h"
#include "physics/persson/power_law.h"

namespace papilla::persson {

namespace {

struct Bracket {  // pressures [Pa] and what load and pull give beyond them there: > 0 low, <= 0
                  // high
  double low, high, excess_low, excess_high;
};
struct Equilibrium {
  double pressure, pull;  // [Pa]
};

// The pressure without excess, by regula falsi (Illinois).
template <class PullAt>
Equilibrium between(Bracket b, double external_pressure, const PullAt& pull_at) {
  for (int i = 0; i < 60 && b.high - b.low > 1e-9 * b.high; ++i) {
    double p = b.low + (b.high - b.low) * b.excess_low / (b.excess_low - b.excess_high);
    p = std::clamp(p, b.low, b.high);
    const double pull = pull_at(p);
    const double excess = external_pressure + pull - p;
    if (std::abs(excess) < 1e-8 * p) return {p, pull};
    if (excess > 0) {
      b.low = p;
      b.excess_low = excess;
      b.excess_high *= 0.5;
    } else {
      b.high = p;
      b.excess_high = excess;
      b.excess_low *= 0.5;
    }
  }
  const double middle = 0.5 * (b.low + b.high);
  return {middle, middle - external_pressure};
}

}  // namespace

PullState solve_pull(const MeanField& field, double external_pressure, double v_rms,
                     std::complex<double> h0, double finite_size_pressure) {
  PullState state;
  const double factor = 0.5 * kVacuumPermittivity * v_rms * v_rms;
  const auto pull_at = [&](double p) {
    return factor * field.gaps(std::max(p, finite_size_pressure)).inverse_square(h0);
  };
  const auto finish = [&](double p, double pull) {
    state.pressure = p;
    state.pull = pull;
    state.area = field.area(p);
    state.mean_gap =
        p > 0 || finite_size_pressure > 0 ? field.mean_gap(std::max(p, finite_size_pressure)) : 0.0;
    return state;
  };
  PAPILLA_CHECK(
      external_pressure > 0 || finite_size_pressure > 0,
      "without load the gaps of an infinite body are infinite: give a finite-size pressure");
  if (v_rms == 0) return finish(external_pressure, 0);

  // The pull rises with p, so every fixed-point iterate is below the first equilibrium: march up
  // from there, aiming a little past the secant's guess, until the excess p0 + pull(p) - p changes
  // sign.
  double previous = external_pressure, previous_pull = pull_at(previous);
  double low = external_pressure + previous_pull;
  if (low <= finite_size_pressure) return finish(low, previous_pull);  // the gaps stay as they are
  double pull = pull_at(low), excess_low = external_pressure + pull - low;
  double high = low, excess_high = 0;
  for (;;) {
    if (std::abs(excess_low) <= 1e-9 * low) return finish(low, pull);
    const double slope = (pull - previous_pull) / (low - previous);
    high = low + (slope < 0.9 ? 1.02 * excess_low / (1 - slope) : 0.5 * (low - external_pressure));
    if (high > 1e9) {
      state.status = PullStatus::Collapsed;
      return finish(low, pull);
    }
    const double next = pull_at(high);
    excess_high = external_pressure + next - high;
    if (excess_high <= 0) break;
    previous = low;
    previous_pull = pull;
    low = high;
    pull = next;
    excess_low = excess_high;
  }
  const Equilibrium e = between({low, high, excess_low, excess_high}, external_pressure, pull_at);
  return finish(e.pressure, e.pull);
}

FrictionPoint friction_at(const MeanField& field, double normal_force, double nominal_area,
                          double shear_strength, double v_rms, std::complex<double> h0,
                          double finite_size_pressure) {
  FrictionPoint point{};
  point.normal_force = normal_force;
  point.pull = solve_pull(field, normal_force / nominal_area, v_rms, h0, finite_size_pressure);
  point.friction = shear_strength * nominal_area * point.pull.area;
  point.coefficient = normal_force > 0 ? point.friction / normal_force : 0.0;
  return point;
}

double SkinDielectric::permittivity_at(double f) const {
  return log_log(frequency, permittivity, f);
}
double SkinDielectric::resistivity_at(double f) const {
  return log_log(resistivity_frequency, resistivity, f);
}

std::complex<double> SkinDielectric::complex_permittivity(double f) const {
  return {permittivity_at(f), 1 / (2 * kPi * f * kVacuumPermittivity * resistivity_at(f))};
}

std::complex<double> gap_permittivity(double f, double resistivity) {
  if (resistivity == 0) return 1;
  return {1, 1 / (2 * kPi * f * kVacuumPermittivity * resistivity)};
}

std::complex<double> series_thickness(double dielectric_equivalent, double skin_thickness,
                                      const SkinDielectric& skin, double f,
                                      double gap_resistivity) {
  return (dielectric_equivalent + skin_thickness / skin.complex_permittivity(f)) *
         gap_permittivity(f, gap_resistivity);
}

}  // namespace papilla::persson
