// Films whose polarisation saturates: the voltage exponent of the pull. Eq. electrostatics.22
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/field.h"

namespace papilla::tests::saturation_test {
namespace {

constexpr double kFilm = 0.4e-6, kHeld = 100e6;  // d/eps [m], field in the air [V/m]

FieldProblem problem(double volts) {
  FieldProblem p;
  p.v_rms = p.v_peak = volts;
  p.steady = true;
  p.dielectric = kFilm;
  p.dielectric_thickness = 20e-6;
  p.film_holds = kHeld;
  return p;
}

// Gaps evenly from 0 to `widest`.
Gap ramp(double widest) {
  const Grid grid{256, 256, 100e-6, 100e-6};
  Gap gap{grid, std::vector<double>(grid.size())};
  for (std::size_t i = 0; i < gap.value.size(); ++i)
    gap.value[i] = widest * (static_cast<double>(i) + 0.5) / static_cast<double>(grid.size());
  return gap;
}

double pull(const Gap& gap, double volts) {
  const FieldSolution s = solve_local_field(gap, nullptr, {}, problem(volts));
  EXPECT_TRUE(s.ok);
  return s.mean_pressure;
}

double exponent(const Gap& gap, double volts) {
  return std::log(pull(gap, 1.01 * volts) / pull(gap, volts / 1.01)) / (2 * std::log(1.01));
}

TEST(Saturation, APlaneGapPullsWithTheSquareAndThenNoMore) {
  const Grid grid{8, 8, 10e-6, 10e-6};
  const Gap plane{grid, std::vector<double>(grid.size(), 0.6e-6)};
  const double saturates = kHeld * (0.6e-6 + kFilm);  // 100 V
  EXPECT_NEAR(exponent(plane, 0.5 * saturates), 2, 1e-9);
  EXPECT_NEAR(exponent(plane, 2 * saturates), 0, 1e-9);
  EXPECT_NEAR(pull(plane, 300), 0.5 * kVacuumPermittivity * square(kHeld), 1e-6);
}

// Even gaps up to G, those below V/E - d/eps saturated: p = eps0/2 (2 V E - E^2 d/eps -
// V^2/(G + d/eps))/G, whose exponent comes down from 2 to below 1.
TEST(Saturation, ARoughGapFollowsTheIntegralOverItsGaps) {
  const double widest = 4e-6;
  const Gap gap = ramp(widest);
  const auto exact = [&](double v) {
    return 0.5 * kVacuumPermittivity *
           (2 * v * kHeld - square(kHeld) * kFilm - square(v) / (widest + kFilm)) / widest;
  };
  for (const double volts : {60.0, 120.0, 250.0})
    EXPECT_NEAR(pull(gap, volts), exact(volts), 1e-4 * exact(volts)) << volts;
  EXPECT_NEAR(exponent(gap, 20), 2, 1e-9);
  const double v = 120, step = 1.01;
  EXPECT_NEAR(exponent(gap, v), std::log(exact(v * step) / exact(v / step)) / (2 * std::log(step)),
              1e-3);
  EXPECT_LT(exponent(gap, v), 1.2);
}

}  // namespace
}  // namespace papilla::tests::saturation_test
