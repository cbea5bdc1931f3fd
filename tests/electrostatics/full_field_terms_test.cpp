// The full field of a gap is the potential of the bodies that the gap, its water and its film are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/breakdown.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::tests::full_field_terms_test {
namespace {

constexpr Grid kGrid{18, 14, 1.8e-6, 1.6e-6};

// Of a film that is the same everywhere: its d/eps.
const std::vector<double> kFlat(kGrid.size(), 300e-9 / 4);

struct Case {
  Gap gap{kGrid, {}};
  Heightmap surface{kGrid, std::vector<double>(kGrid.size(), 0)};
  Wetting water;
  FieldProblem problem;

  Case() {
    RandomStream random(31, "full field", 0);
    water.grid = kGrid;
    water.bridged.assign(kGrid.size(), 0);
    for (int iy = 0; iy < kGrid.ny; ++iy) {
      for (int ix = 0; ix < kGrid.nx; ++ix) {
        const std::size_t i = kGrid.index(ix, iy);
        surface.z[i] = ix < 6 && iy < 6 ? -120e-9 : 0;
        gap.value.push_back(ix == 9 ? 0 : 50e-9 + 60e-9 * random.uniform() - surface.z[i]);
        water.bridged[i] = ix > 14 && iy > 10;
      }
    }
    const auto drop = [&](double x, double y, double radius, double height, DropletState state) {
      Droplet d;
      d.x = x, d.y = y, d.radius = radius, d.height = height, d.state = state;
      water.droplets.push_back(d);
    };
    // One above the other, more than the gap holds; one of each alone; a bridge is no dielectric.
    drop(1.2e-6, 0.5e-6, 0.3e-6, 60e-9, DropletState::OnSubstrate);
    drop(1.3e-6, 0.5e-6, 0.3e-6, 50e-9, DropletState::OnSkin);
    drop(0.3e-6, 1.2e-6, 0.25e-6, 20e-9, DropletState::OnSubstrate);
    drop(0.8e-6, 1.2e-6, 0.25e-6, 20e-9, DropletState::OnSkin);
    drop(1.6e-6, 1.4e-6, 0.2e-6, 40e-9, DropletState::Bridge);
    problem.v_rms = 70, problem.v_peak = 100;
    problem.dielectric_thickness = 300e-9;
    problem.dielectric = 300e-9 / 4;
    problem.skin_layer = {20e-9, 14e-9};
    problem.water_skin_layer = 17e-9;
  }
};

std::vector<double> caps(const Wetting& w, DropletState state) {
  Wetting some;
  some.grid = w.grid;
  for (const Droplet& d : w.droplets) {
    if (d.state == state) some.droplets.push_back(d);
  }
  return droplet_columns(kGrid, some);
}

// The bodies, by hand; film: a CoveredSurface or the flat one of the problem.
PotentialProblem bodies(const Case& c, const CoveredSurface* surface, bool water) {
  PotentialProblem p;
  p.grid = kGrid;
  p.skin_layer = 20e-9;
  p.water_skin_layer = 17e-9;
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    const double z = surface ? c.surface.z[i] : 0;
    p.surface.push_back(z);
    p.electrode.push_back(z - (surface ? surface->film[i] : 300e-9));
    p.skin.push_back(z + c.gap.value[i]);
    p.dielectric.push_back(surface ? surface->dielectric[i] : 75e-9);
  }
  p.bridged = c.water.bridged;
  if (!water) return p;
  p.water_below = caps(c.water, DropletState::OnSubstrate);
  p.water_above = caps(c.water, DropletState::OnSkin);
  int squeezed = 0;
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    const double both = p.water_below[i] + p.water_above[i], room = 0.9 * c.gap.value[i];
    if (both <= room) continue;
    p.water_below[i] *= room / both, p.water_above[i] *= room / both;
    squeezed += p.water_below[i] > 0 && p.water_above[i] > 0;
  }
  EXPECT_GT(squeezed, 3);
  return p;
}

// What a solution is per volt, as numbers of the drive.
void expect_of(const FieldSolution& is, const PotentialSolution& s, const Case& c,
               const std::vector<double>& effective, const std::vector<double>& hidden) {
  const FieldProblem& p = c.problem;
  const bool limited = p.air_limit == AirLimit::Emission;
  double sum = 0, over = 0, over_sum = 0;
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    // Eq. electrostatics.14 with a lossy layer.
    const double e2 = s.square_field[i] / (1 + std::max(s.square_field[i], 0.0) * square(14e-9));
    const bool none = c.water.bridged[i] || (!hidden.empty() && hidden[i] > 0);
    const double g = c.gap.value[i];
    // Of a voltage of one magnitude: 350 V/um, or 327 V over the gap.
    const double held = std::min(350e6, 327 / std::max(g, 1e-12));
    const double cap = limited ? 0.5 * kVacuumPermittivity * square(held) : kInfinity;
    const double pressure =
        none ? 0 : std::min(0.5 * kVacuumPermittivity * square(p.v_rms) * e2, cap);
    ASSERT_NEAR(is.traction.value[i], pressure, 1e-9 * is.mean_pressure) << i;
    sum += pressure;
    if (!none && g > 0 && e2 > 0 && p.v_peak * std::sqrt(e2) * g > air_breakdown_voltage(g))
      over += 1, over_sum += pressure;
  }
  EXPECT_GT(over, 5);
  EXPECT_LT(over, 250);
  EXPECT_NEAR(is.mean_pressure, sum / static_cast<double>(kGrid.size()), 1e-9 * is.mean_pressure);
  EXPECT_NEAR(is.over_limit_area, over / static_cast<double>(kGrid.size()), 1e-12);
  EXPECT_NEAR(is.over_limit_share, over_sum / sum, 1e-9);
  EXPECT_NEAR(is.peak_air_field, p.v_peak * s.peak_air, 1e-9 * is.peak_air_field);
  // What is over the film, with the lag of the layer as in Eq. electrostatics.1.
  double film = 0;
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    const double flux = (1 - s.surface_potential[i]) / effective[i];
    film = std::max(film, std::min(flux / std::hypot(1, 14e-9 * flux), 1 / effective[i]));
  }
  EXPECT_NEAR(is.peak_oxide_field, p.v_peak * film * 75e-9 / 300e-9, 1e-9 * is.peak_oxide_field);
  EXPECT_EQ(is.residual, s.residual);
  EXPECT_EQ(is.iterations, s.iterations);
  EXPECT_EQ(is.ok, s.ok);
}

TEST(FullFieldTerms, AreTheBodiesOfGapFilmAndWater) {
  Case c;
  const CoveredSurface covered(c.surface, {{FilmProcess::Planar, 0, 300e-9, 4}});
  for (const CoveredSurface* s : {static_cast<const CoveredSurface*>(nullptr), &covered}) {
    for (const bool water : {true, false}) {
      c.problem.droplet_enhancement = water;
      const PotentialSolution potential = solve_potential(bodies(c, s, water), {});
      ASSERT_TRUE(potential.ok) << potential.reason;
      expect_of(solve_full_field(c.gap, s, c.water, c.problem), potential, c,
                s ? s->effective : kFlat, {});
    }
  }
}

TEST(FullFieldTerms, ThePublishedRuleHidesWhatLiesUnderDroplets) {
  Case c;
  c.problem.zero_under_droplets = true;
  const PotentialSolution potential = solve_potential(bodies(c, nullptr, false), {});
  expect_of(solve_full_field(c.gap, nullptr, c.water, c.problem), potential, c, kFlat,
            droplet_columns(kGrid, c.water));
}

TEST(FullFieldTerms, TheCapHoldsEveryPixel) {
  Case c;
  c.problem.air_limit = AirLimit::Emission, c.problem.steady = true;
  const PotentialSolution potential = solve_potential(bodies(c, nullptr, true), {});
  expect_of(solve_full_field(c.gap, nullptr, c.water, c.problem), potential, c, kFlat, {});
}

// Water without screening is air to the potential: its pixels are not pulled, and no others change.
TEST(FullFieldTerms, WithoutScreeningABridgeIsAir) {
  Case c;
  c.problem.screening = false;
  PotentialProblem dry = bodies(c, nullptr, true);
  dry.bridged.clear();
  expect_of(solve_full_field(c.gap, nullptr, c.water, c.problem), solve_potential(dry, {}), c,
            kFlat, {});
}

TEST(FullFieldTerms, OptionsReachThePotential) {
  Case c;
  const PotentialOptions options{
      .dielectric_cells = 5, .air_cells = 6, .tolerance = 1e-5, .max_iterations = 30};
  const PotentialSolution potential = solve_potential(bodies(c, nullptr, true), options);
  expect_of(solve_full_field(c.gap, nullptr, c.water, c.problem, options), potential, c, kFlat, {});
}

TEST(FullFieldTerms, EachVoltageHasItsOwnNumbersAndNoneHasNone) {
  Case c;
  c.problem.v_rms = 0;
  const FieldSolution peaks = solve_full_field(c.gap, nullptr, c.water, c.problem);
  EXPECT_EQ(peaks.mean_pressure, 0);
  EXPECT_GT(peaks.peak_air_field, 0);
  c.problem.v_rms = 70, c.problem.v_peak = 0;
  const FieldSolution pull = solve_full_field(c.gap, nullptr, c.water, c.problem);
  EXPECT_GT(pull.mean_pressure, 0);
  EXPECT_EQ(pull.peak_oxide_field, 0);
  EXPECT_EQ(pull.over_limit_share, 0);
  c.problem.v_rms = 0;
  EXPECT_EQ(solve_full_field(c.gap, nullptr, c.water, c.problem).iterations, 0);
}

TEST(FullFieldTerms, CostThreeMicrosecondsAPixel) {
  EXPECT_NEAR(full_field_seconds(kGrid), 3e-6 * 18 * 14, 1e-12);
}

// Cells of the dielectric: two and one for every two of the finer pixels of its thickest place,
// four to eight.
TEST(FullFieldTerms, CellsOfTheDielectricAreFourToEight) {
  Case c;
  // 1 pixel: 2.5 cells by the rule; 3 pixels: 3.5, rounded up; 7: 5.5; 20: 12.
  for (const auto& [thickness, cells] :
       {std::pair{100e-9, 4}, {450e-9, 4}, {520e-9, 5}, {920e-9, 7}, {2e-6, 8}}) {
    PotentialProblem p = bodies(c, nullptr, false);
    for (std::size_t i = 0; i < kGrid.size(); ++i) {
      p.electrode[i] = p.surface[i] - (i == 77 ? thickness : 0.9 * thickness);
      p.dielectric[i] = (p.surface[i] - p.electrode[i]) / 4;
    }
    EXPECT_EQ(solve_potential(p, {}).square_field,
              solve_potential(p, {.dielectric_cells = cells}).square_field)
        << thickness;
  }
}

TEST(Potential, WhatIsNoBodyIsRefusedInWords) {
  Case c;
  const auto reason = [&](auto&& change) {
    PotentialProblem p = bodies(c, nullptr, false);
    change(p);
    const PotentialSolution s = solve_potential(p, {});
    EXPECT_EQ(s.iterations, 0);
    EXPECT_EQ(s.square_field, std::vector<double>(kGrid.size(), 0));
    return s.ok ? "" : s.reason;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string height = "a height is not finite",
                    bare = "no dielectric anywhere: contact would short the drive";
  EXPECT_EQ(reason([&](PotentialProblem& p) { p.surface[5] = nan; }), height);
  EXPECT_EQ(reason([&](PotentialProblem& p) { p.skin[251] = kInfinity; }), height);
  EXPECT_EQ(reason([&](PotentialProblem& p) { p.electrode[0] = nan; }), height);
  // In contact without film or layer; a layer alone is enough, but not below water.
  const auto touches = [](PotentialProblem& p, std::size_t i) {
    p.electrode[i] = p.surface[i] = p.skin[i];
  };
  EXPECT_EQ(reason([&](PotentialProblem& p) {
              touches(p, 40);
              p.skin_layer = 0;
            }),
            bare);
  PotentialProblem layer = bodies(c, nullptr, false);
  touches(layer, 40);
  EXPECT_TRUE(solve_potential(layer, {}).ok);
  const auto wet = static_cast<std::size_t>(
      std::find(c.water.bridged.begin(), c.water.bridged.end(), 1) - c.water.bridged.begin());
  EXPECT_EQ(reason([&](PotentialProblem& p) { p.electrode[wet] = p.surface[wet]; }), bare);
}

TEST(Potential, OneThatHasNotConvergedSaysHowFarItCame) {
  Case c;
  const PotentialProblem p = bodies(c, nullptr, true);
  const PotentialSolution s = solve_potential(p, {.tolerance = 0, .max_iterations = 2});
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.iterations, 2);
  EXPECT_EQ(s.reason.find("the potential has not converged: residual "), 0u);
  EXPECT_NE(s.reason.find(" after 2 cycles"), std::string::npos);
  // What it is so far is still told, by the field as well.
  EXPECT_GT(s.capacitance, 0);
  const FieldSolution field =
      solve_full_field(c.gap, nullptr, c.water, c.problem, {.tolerance = 0, .max_iterations = 2});
  EXPECT_FALSE(field.ok);
  EXPECT_EQ(field.reason, s.reason);
  EXPECT_GT(field.mean_pressure, 0);
}

// docs/theory states 3 to 5 cycles; one more digit takes as many again.
TEST(Potential, ConvergesInAFewCycles) {
  Case c;
  const PotentialProblem p = bodies(c, nullptr, true);
  const int three = solve_potential(p, {}).iterations;
  EXPECT_GE(three, 3);
  EXPECT_LE(three, 5);
  EXPECT_LE(solve_potential(p, {.tolerance = 1e-6}).iterations, 2 * three + 1);
}

// A layer that counts like micrometres of air would let flux spread above the skin, and pull it
// away: 100 um of it gave minus 24 mN.
TEST(FullFieldTerms, ALayerThickerThanATenthOfThePatchIsRefused) {
  Case c;
  c.problem.skin_layer = 0.15e-6;
  EXPECT_TRUE(solve_full_field(c.gap, nullptr, c.water, c.problem).ok);
  c.problem.skin_layer = 0.17e-6;
  const FieldSolution refused = solve_full_field(c.gap, nullptr, c.water, c.problem);
  EXPECT_FALSE(refused.ok);
  EXPECT_TRUE(refused.reason.find("too thick for the 3-D field") != std::string::npos);
  EXPECT_EQ(refused.mean_pressure, 0);
}

}  // namespace
}  // namespace papilla::tests::full_field_terms_test
