// Films whose polarisation saturates: the voltage exponent of the pull. Eq. electrostatics.22
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/field.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/pull.h"

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

// Bare contact, a gap that saturates and one that does not, at 100 V over a film of 0.4 um that
// holds 100 V/um in the air.
TEST(Saturation, WhatTheGapCannotTakeStandsOnTheFilm) {
  const Grid grid{8, 8, 10e-6, 10e-6};
  FieldProblem p = problem(100);
  p.skin_layer = 50e-9;
  for (const auto& [gap, film] : {std::pair{0.0, 95.0}, {0.25e-6, 70.0}, {0.75e-6, 100 / 3.0}}) {
    const Gap plane{grid, std::vector<double>(grid.size(), gap)};
    const double expected = film / 20e-6;  // [V/m]
    for (const FieldSolution& s :
         {solve_local_field(plane, nullptr, {}, p), solve_spread_field(plane, nullptr, {}, p, 1e-6),
          solve_full_field(plane, nullptr, {}, p)}) {
      ASSERT_TRUE(s.ok) << s.reason;
      EXPECT_NEAR(s.peak_oxide_field, expected, 2e-3 * expected) << gap;
      EXPECT_LE(s.peak_air_field, kHeld * (1 + 1e-9)) << gap;
    }
  }
}

// All of the patch: the skin's layer below it takes 100 V/um, 20 nm of it 2 V.
TEST(Saturation, UnderWaterWhatTheSkinCannotTakeStandsOnTheFilm) {
  const Grid grid{8, 8, 10e-6, 10e-6};
  FieldProblem p = problem(100);
  p.water_skin_layer = 20e-9;
  const Gap plane{grid, std::vector<double>(grid.size(), 100e-9)};
  const AirColumns columns{plane.value, {}};
  const std::vector<double> bridged(grid.size(), 0);
  const FieldSolution s = pull(plane, nullptr, p, columns, {.open = bridged, .potential = {}});
  EXPECT_NEAR(s.peak_oxide_field, 98 / 20e-6, 1e-6 * s.peak_oxide_field);
  // By the potential that the rule with spreading flux gives the water, of its own divider.
  const std::vector<double> potential(grid.size(), 20.0 / 420);
  const FieldSolution by_water =
      pull(plane, nullptr, p, columns, {.open = bridged, .potential = potential});
  EXPECT_NEAR(by_water.peak_oxide_field, 98 / 20e-6, 1e-6 * s.peak_oxide_field);
}

}  // namespace
}  // namespace papilla::tests::saturation_test
