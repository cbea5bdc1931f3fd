// The pull of a pixel by the local rule from its column alone, everything in it at once; and the
// rules as one table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "base/constants.h"
#include "physics/electrostatics/breakdown.h"
#include "physics/electrostatics/electrode.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/pull.h"
#include "physics/electrostatics/rules.h"
#include "physics/electrostatics/screening.h"
#include "tests/electrostatics/oxide.h"

namespace papilla::tests::column_pull_test {
namespace {

// 11 pixels: a whole register and three more.
constexpr Grid kGrid{11, 1, 1.1e-6, 0.1e-6};

Gap stairs() {
  Gap gap{kGrid, {}};
  for (int i = 0; i < 11; ++i) gap.value.push_back(20e-9 * i);
  return gap;
}

// A film of 300 nm and more, by steps in the surface that only the columns see.
CoveredSurface film() {
  Heightmap h{kGrid, std::vector<double>(11, 0)};
  for (std::size_t i = 0; i < 11; ++i) h.z[i] = i % 3 == 0 ? 0 : -100e-9;
  return {h, {{FilmProcess::Planar, 0, 400e-9, 4}}};
}

FieldProblem lossy(double v_peak) {
  FieldProblem p = oxide(v_peak, 400e-9);
  p.dielectric = 100e-9;
  p.skin_layer = {24e-9, 15e-9};
  p.film_phase = 1.2;
  return p;
}

TEST(ColumnPull, OfEveryPixelIsThatOfItsSeries) {
  const Gap gap = stairs();
  const CoveredSurface surface = film();
  const FieldProblem p = lossy(80);
  const FieldSolution s = solve_local_field(gap, &surface, {}, p);
  ASSERT_TRUE(s.ok);
  double sum = 0, over = 0, over_sum = 0, least = kInfinity, strongest = 0;
  for (std::size_t i = 0; i < 11; ++i) {
    const double dielectric = i % 3 == 0 ? 100e-9 : 75e-9;
    ASSERT_NEAR(surface.effective[i], dielectric, 1e-18);
    const double distance =
        std::hypot(gap.value[i] + dielectric + p.skin_layer.real(), p.skin_layer.imag());
    const double pressure = 0.5 * kVacuumPermittivity * square(p.v_rms / distance);
    EXPECT_NEAR(s.traction.value[i], pressure, 1e-9 * pressure) << i;
    sum += pressure;
    if (gap.value[i] > 0) {
      least = std::min(least, distance);
      // 350 V/um, all gaps being below the Paschen minimum.
      if (80 / distance > 350e6) over += 1, over_sum += pressure;
    }
    // Of a film that leaks, its share of the voltage is larger by its phase: 1 at most.
    strongest = std::max(strongest, std::min(1.2 * dielectric / distance, 1.0) / dielectric);
  }
  EXPECT_GT(over, 2);
  EXPECT_LT(over, 10);
  EXPECT_NEAR(s.mean_pressure, sum / 11, 1e-9 * sum);
  EXPECT_NEAR(s.over_limit_area, over / 11, 1e-12);
  EXPECT_NEAR(s.over_limit_share, over_sum / sum, 1e-9);
  EXPECT_NEAR(s.peak_air_field, 80 / least, 1e-9 * s.peak_air_field);
  EXPECT_NEAR(s.peak_oxide_field, 80 * strongest * 100e-9 / 400e-9, 1e-9 * s.peak_oxide_field);
  EXPECT_EQ(s.residual, 0);
  EXPECT_EQ(s.iterations, 0);
  // Of a phase so large that the thinner columns would have 106 % they have all, 80 V over 75 nm.
  FieldProblem leaky = p;
  leaky.film_phase = 1.7;
  EXPECT_NEAR(solve_local_field(gap, &surface, {}, leaky).peak_oxide_field,
              80 / 75e-9 * 100e-9 / 400e-9, 1);
}

// Beside walls the stated radius raises the film's field; on a flat electrode it says nothing.
TEST(ColumnPull, TheEdgeRadiusCountsWhereThereAreWalls) {
  FieldProblem p = lossy(200);
  const double flat = solve_local_field(stairs(), nullptr, {}, p).peak_oxide_field;
  const CoveredSurface planar = film();
  ASSERT_FALSE(planar.walls);
  const double columns = solve_local_field(stairs(), &planar, {}, p).peak_oxide_field;
  CoveredSurface walls = planar;
  walls.walls = true;
  p.edge_radius = 100e-9;
  EXPECT_EQ(solve_local_field(stairs(), nullptr, {}, p).peak_oxide_field, flat);
  EXPECT_EQ(solve_local_field(stairs(), &planar, {}, p).peak_oxide_field, columns);
  EXPECT_NEAR(solve_local_field(stairs(), &walls, {}, p).peak_oxide_field,
              columns * 4 / std::log(5), 1e-9 * columns);
}

// Under a bridge the film carries everything and nothing pulls; what fades pulls by its share and
// has the whole field.
TEST(ColumnPull, BridgesLeaveTheVoltageToTheFilmAndFadingTakesItsShareOfThePull) {
  const Gap gap{kGrid, std::vector<double>(11, 60e-9)};
  FieldProblem p = lossy(200);
  p.film_phase = 1;
  std::vector<double> open(11, 1);
  open[2] = 0, open[3] = 0.25, open[9] = 0.5;
  const AirColumns columns{gap.value, {}};
  const FieldSolution s = pull(gap, nullptr, p, columns, {.open = open, .potential = {}});
  const double distance = std::hypot(60e-9 + 100e-9 + 24e-9, 15e-9);
  const double whole = 0.5 * kVacuumPermittivity * square(p.v_rms / distance);
  for (std::size_t i = 0; i < 11; ++i)
    EXPECT_NEAR(s.traction.value[i], open[i] * whole, 1e-9 * whole) << i;
  EXPECT_NEAR(s.mean_pressure, 8.75 / 11 * whole, 1e-9 * whole);
  EXPECT_NEAR(s.peak_oxide_field, 200 / 400e-9, 1);
  EXPECT_NEAR(s.peak_air_field, 200 / distance, 1);
  EXPECT_NEAR(s.over_limit_area, 10.0 / 11, 1e-12);  // 1.08 GV/m, but for the bridge
  EXPECT_NEAR(s.over_limit_share, 1, 1e-9);
  // A potential on the film: 1.2 times the flux of the column, and the rest of the voltage in the
  // film, with what its flux meets in the skin's layer out of phase.
  const double phi = 1.2 * 84 / 184;
  const std::vector<double> potential(11, phi);
  const FieldSolution more = pull(gap, nullptr, p, columns, {.open = {}, .potential = potential});
  EXPECT_NEAR(more.mean_pressure, 1.44 * whole, 1e-9 * whole);
  EXPECT_NEAR(more.peak_air_field, 1.2 * 200 / distance, 1);
  EXPECT_NEAR(more.peak_oxide_field, (1 - phi) / std::hypot(1, (1 - phi) * 0.15) * 200 / 400e-9, 1);
  // The cap holds a pixel at the field of air before it fades.
  p.air_limit = AirLimit::Emission, p.steady = true;
  const FieldSolution held = pull(gap, nullptr, p, columns, {.open = open, .potential = {}});
  const double cap = 0.5 * kVacuumPermittivity * square(350e6);
  ASSERT_GT(whole, cap);
  for (std::size_t i = 0; i < 11; ++i)
    EXPECT_NEAR(held.traction.value[i], open[i] * cap, 1e-9 * cap) << i;
}

// Of a gap, the wider, the nearer to Paschen's curve: on either side of it by a volt.
TEST(ColumnPull, AirIsOverItsLimitFromItsBreakdownVoltageOn) {
  for (const double g : {50e-9, 500e-9, 1.2e-6, 6e-6, 50e-6}) {
    FieldProblem p = oxide(100, 400e-9);
    const double limit = air_breakdown_voltage(g) * (g + p.dielectric) / g;
    for (const double more : {-1e-3, 1e-3}) {
      p.v_peak = limit * (1 + more);
      const FieldSolution s = solve_local_field(uniform_gap(g, 4), nullptr, {}, p);
      EXPECT_EQ(s.over_limit_area, more > 0 ? 1 : 0) << g;
      EXPECT_EQ(s.over_limit_share, more > 0 ? 1 : 0) << g;
    }
  }
}

TEST(ColumnPull, EitherVoltageAloneIsADrive) {
  FieldProblem p = oxide(200);
  p.v_peak = 0;
  EXPECT_GT(solve_local_field(uniform_gap(1e-7, 4), nullptr, {}, p).mean_pressure, 0);
  p = oxide(200);
  p.v_rms = 0;
  const FieldSolution s = solve_local_field(uniform_gap(1e-7, 4), nullptr, {}, p);
  EXPECT_EQ(s.mean_pressure, 0);
  EXPECT_GT(s.peak_air_field, 0);
}

TEST(ColumnPull, WhatItCannotSayHasItsWords) {
  FieldProblem p;
  p.v_rms = p.v_peak = 10;
  const FieldSolution bare = solve_local_field(uniform_gap(1e-7, 4), nullptr, {}, p);
  EXPECT_FALSE(bare.ok);
  EXPECT_EQ(bare.reason, "no dielectric anywhere: contact would short the drive");
  // A layer on the skin is a dielectric, and one that only lags is.
  for (const std::complex<double> layer : {std::complex<double>{1e-9, 0}, {0, 1e-9}}) {
    p.skin_layer = layer;
    EXPECT_TRUE(solve_local_field(uniform_gap(1e-7, 4), nullptr, {}, p).ok);
  }
  Gap gap = uniform_gap(1e-7, 4);
  gap.value[15] = std::nan("");
  const FieldSolution none = solve_local_field(gap, nullptr, {}, oxide(10));
  EXPECT_FALSE(none.ok);
  EXPECT_EQ(none.reason, "the pull is not finite");
}

// On a tenth of a micrometre and more of dielectric of 1: 100 times its d/eps is what is better.
TEST(ColumnPull, AFilmHoldsAllTheVoltageAHundredTimesBeyondVacuum) {
  FieldProblem p = oxide(100, 100e-9);
  p.dielectric = 10.1e-6;
  EXPECT_TRUE(holds_all_voltage(p));
  p.dielectric = 9.9e-6;
  EXPECT_FALSE(holds_all_voltage(p));
}

// Eq. electrostatics.4 on a cap's own columns, on either side; no more water than nine tenths of
// the gap.
TEST(ColumnPull, DropletsAreSphericalCapsThatLeaveATenthOfTheGap) {
  const Grid grid{24, 20, 2.4e-6, 1.6e-6};
  Gap gap{grid, std::vector<double>(grid.size(), 200e-9)};
  Wetting w;
  w.grid = grid;
  Droplet flat;
  flat.x = 2.3e-6, flat.y = 0.1e-6, flat.radius = 0.5e-6, flat.height = 150e-9;
  Droplet bead = flat;  // overhangs its foot
  bead.x = 1.1e-6, bead.y = 0.9e-6, bead.radius = 0.2e-6, bead.height = 0.35e-6;
  bead.state = DropletState::OnSkin;
  Droplet bridge = flat;
  bridge.x = 0.8e-6, bridge.state = DropletState::Bridge;
  Droplet none = flat;
  none.x = 1.4e-6, none.height = 0;
  w.droplets = {flat, bead, bridge, none};
  const FieldProblem p = oxide(100, 300e-9);
  const std::vector<double> columns = droplet_columns(grid, w);
  const FieldSolution s = solve_local_field(gap, nullptr, w, p);
  int held = 0;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      double water = 0;
      for (const Droplet* d : {&flat, &bead}) {
        const double sphere = (square(d->radius) + square(d->height)) / (2 * d->height);
        const double r = std::hypot(std::remainder(grid.x(ix) - d->x, grid.lx),
                                    std::remainder(grid.y(iy) - d->y, grid.ly));
        if (r >= (d->height > d->radius ? sphere : d->radius)) continue;
        // Above the foot from it to the top; beside it from one side of the sphere to the other.
        const double half = std::sqrt(square(sphere) - r * r);
        water = std::max(water, r < d->radius ? d->height - sphere + half : 2 * half);
      }
      const std::size_t i = grid.index(ix, iy);
      ASSERT_NEAR(columns[i], water, 1e-15) << ix << ' ' << iy;
      const double b = std::min(water, 180e-9);
      held += b < water;
      const double pressure =
          0.5 * kVacuumPermittivity *
          square(p.v_rms / (200e-9 - b + b / kWaterPermittivity + p.dielectric));
      ASSERT_NEAR(s.traction.value[i], pressure, 1e-9 * pressure) << ix << ' ' << iy;
    }
  }
  EXPECT_GT(held, 3);
}

TEST(FieldRules, AreOneTable) {
  struct Row {
    FieldMethod method;
    std::string words, accuracy;
    double error, seconds;  // of 128 x 64 pixels at a residual of 1e-3
  };
  // 3.3e-10 s a pixel and halving is a transform forth and back; the spread rule takes 10.5 of them
  // a digit but for 12, six at least.
  const double pair = 3.3e-10 * 8192 * 13 * (1 + 8192 / 2.5e5);
  const Grid grid{128, 64, 12e-6, 6e-6};
  for (const Row& row : {Row{FieldMethod::Local, "columns, one by one",
                             "pull 20 to 45 % below the 3-D field", 0.3, 2e-8 * 8192},
                         Row{FieldMethod::Spread, "columns, the flux spreading in the dielectric",
                             "uncorrected: pull 0 to 30 % above the 3-D field, more on deep holes",
                             0.12, 19.5 * pair},
                         Row{FieldMethod::Full, "3-D potential", "asked for; pull stated to 2 %",
                             0.02, 3e-6 * 8192}}) {
    const FieldRule& rule = field_rule(row.method);
    EXPECT_EQ(rule.method, row.words);
    EXPECT_EQ(rule.accuracy, row.accuracy);
    EXPECT_EQ(rule.usual_error, row.error) << row.words;
    EXPECT_NEAR(rule.seconds(grid, 1e-3), row.seconds, 1e-9 * row.seconds) << row.words;
  }
  const FieldRule& spread = field_rule(FieldMethod::Spread);
  EXPECT_NEAR(spread.seconds(grid, 1e-5), 40.5 * pair, 1e-9 * pair);
  EXPECT_NEAR(spread.seconds(grid, 1e-1), 6 * pair, 1e-9 * pair);
  EXPECT_NEAR(spread.seconds(grid, 1), 6 * pair, 1e-9 * pair);
}

// Each rule is the solver of its name, with the tolerance handed on where it has one.
TEST(FieldRules, SolveByTheirMethod) {
  Gap gap{{12, 12, 1.2e-6, 1.2e-6}, {}};
  for (int i = 0; i < 144; ++i) gap.value.push_back(1e-9 * (i * 37 % 90));
  const FieldProblem p = oxide(100, 300e-9);
  const auto by = [&](FieldMethod method, double tolerance) {
    return field_rule(method).solve(gap, nullptr, {}, p, tolerance);
  };
  EXPECT_EQ(by(FieldMethod::Local, 1e-2).traction.value,
            solve_local_field(gap, nullptr, {}, p).traction.value);
  EXPECT_EQ(by(FieldMethod::Full, 1e-2).traction.value,
            solve_full_field(gap, nullptr, {}, p).traction.value);
  for (const double tolerance : {1e-2, 1e-8}) {
    const FieldSolution s = by(FieldMethod::Spread, tolerance);
    EXPECT_EQ(s.traction.value, solve_spread_field(gap, nullptr, {}, p, tolerance).traction.value);
    EXPECT_LE(s.residual, tolerance);
  }
}

TEST(Breakdown, OfAirBeyondTheMinimumIsPaschensCurve) {
  // B p d / (ln(A p d) - ln ln(1 + 1/gamma)): A 112.501 and B 2737.5 V per kPa cm, gamma 0.01.
  for (const double g : {30e-6, 100e-6, 1e-3}) {
    const double pd = 101.325 * 100 * g;  // kPa cm
    EXPECT_NEAR(air_breakdown_voltage(g),
                2737.5 * pd / (std::log(112.501 * pd) - std::log(std::log(101.0))), 1e-9);
  }
  // From 7.5 um on, never below the minimum of 327 V.
  EXPECT_EQ(air_breakdown_voltage(7.5e-6), 327);
  EXPECT_EQ(air_breakdown_voltage(8e-6), 327);
  EXPECT_EQ(air_breakdown_voltage(0), 0);
}

TEST(Breakdown, CornersHaveTheirLimits) {
  EXPECT_EQ(corner_factor(0, 1e-9), 1);
  EXPECT_EQ(corner_factor(1e-9, 0), HUGE_VAL);
  EXPECT_NEAR(corner_factor(3e-7, 1e-7), 3 / std::log(4), 1e-12);
  EXPECT_NEAR(corner_factor(1e-9, 1), 1, 1e-8);
}

// The weakest layer decides; one of no thickness carries nothing and is asked nothing.
TEST(Breakdown, TheMarginIsThatOfTheWeakestLayer) {
  std::vector<Dielectric> stack(3);
  stack[0].thickness = 200e-9, stack[0].permittivity = 4, stack[0].strength = 1e9;    // 50 nm
  stack[1].thickness = 100e-9, stack[1].permittivity = 2, stack[1].strength = 0.3e9;  // 50 nm
  stack[2].thickness = 0, stack[2].permittivity = 1, stack[2].strength = 1;
  // 150 V over 100 nm of d/eps: 375 and 750 V/um.
  EXPECT_NEAR(dielectric_margin(stack, 150, HUGE_VAL), 0.3 / 0.75, 1e-12);
  // At an edge of 100 nm the 300 nm of film have 3/ln 4 times the field.
  EXPECT_NEAR(dielectric_margin(stack, 150, 100e-9), 0.3 / 0.75 / (3 / std::log(4)), 1e-12);
  stack[1].strength = 2e9;
  EXPECT_NEAR(dielectric_margin(stack, 150, HUGE_VAL), 1 / 0.375, 1e-12);
  EXPECT_EQ(dielectric_margin({}, 150, HUGE_VAL), 0);
  EXPECT_EQ(dielectric_margin({}, 0, HUGE_VAL), HUGE_VAL);
}

// Fields are magnitudes: beside a capacitor of 50 nm a resistor as large leaves it 1/|1 - i|.
TEST(Breakdown, LayersDivideByWhatTheirSeriesCounts) {
  std::vector<Dielectric> stack(2);
  stack[0].thickness = 200e-9, stack[0].permittivity = 4, stack[0].strength = 1e9;
  stack[1].thickness = 100e-9, stack[1].permittivity = 2, stack[1].strength = 1e12;
  const std::vector<std::complex<double>> turned{1, {0, -1}}, short_cut{1, 1e-9};
  const double alone = 1 / 0.75;  // 150 V on 200 nm
  EXPECT_NEAR(dielectric_margin(stack, 150, HUGE_VAL, turned), alone * std::sqrt(2), 1e-12);
  EXPECT_NEAR(dielectric_margin(stack, 150, HUGE_VAL, short_cut), alone, 1e-8);
  stack[0].strength = 1e12, stack[1].strength = 1e9;
  EXPECT_NEAR(dielectric_margin(stack, 150, HUGE_VAL, turned), std::sqrt(2) / 1.5, 1e-12);
  // A share that all have in common says nothing.
  const std::vector<std::complex<double>> one{{0.3, -0.4}};
  EXPECT_NEAR(dielectric_margin({stack.data(), 1}, 150, HUGE_VAL, one), 1e12 / (150 / 200e-9),
              1e-6);
}

}  // namespace
}  // namespace papilla::tests::column_pull_test
