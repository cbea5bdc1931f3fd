// Scatter and steps of known size planted into the control runs: the errors that are stated of
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "forward/forward.h"

namespace papilla::tests::stated_errors_test {
namespace {

using Member = Measured PointQuantities::*;

// The same number in a run and in all of its parts without a skin.
Resampled steady(Member quantity, double value, int skins = 4) {
  ResponsePoint point;
  (point.*quantity).value = value;
  Resampled out;
  out.points = {point};
  out.without.assign(static_cast<std::size_t>(skins), {point});
  return out;
}

Reading of(Member quantity) {
  return [quantity](const std::vector<ResponsePoint>& points) {
    return std::optional((points[0].*quantity).value);
  };
}

double grid_part(const ControlRuns& runs, Member quantity) {
  return grid_error(controlled_change(runs, grid_law(quantity), of(quantity)).grid);
}

// Means 0.03 and scatter with a standard error of 0.04: five numbers whose deviations are known.
std::vector<double> planted(double mean, double se) {
  const double unit = se / std::sqrt(0.5);  // of -2 -1 0 1 2: variance 2.5, over five 0.5
  return {mean - 2 * unit, mean - unit, mean, mean + unit, mean + 2 * unit};
}

TEST(StatedErrors, TheScatterIsAddedToAStepOfTheGrid) {
  EXPECT_NEAR(grid_error(planted(0.03, 0.04)), 0.05, 1e-12);
  EXPECT_NEAR(grid_error(planted(-0.03, 0)), 0.03, 1e-12);
  EXPECT_NEAR(grid_error(planted(0, 0.04)), 0.04, 1e-12);
}

TEST(StatedErrors, TheScatterIsTakenOffTheMethod) {
  EXPECT_NEAR(method_error(planted(0.05, 0.03)), 0.04, 1e-12);
  EXPECT_NEAR(method_error(planted(-0.05, 0.03)), 0.04, 1e-12);
  EXPECT_EQ(method_error(planted(0.03, 0.05)), 0);  // nothing but scatter
}

std::vector<double> levelled(std::vector<double> size, const std::vector<double>& of) {
  level_out(size, of);
  return size;
}

// A difference that crosses zero at one humidity is as large there as at the others.
TEST(StatedErrors, OfAHumidityWhereADifferenceVanishesAreThoseOfTheOthers) {
  const std::vector<double> size = levelled({0, 0.05, 0.05}, {1, 0.35, 0.2});
  EXPECT_NEAR(size[0], 0.0406, 1e-4);
  EXPECT_EQ(size[2], 0.05);
  EXPECT_NEAR(levelled({0.03, 0, 0.03}, {1, 1, 1})[1], 0.03 * std::sqrt(2.0 / 3), 1e-12);
}

// A pull that water all but shuts off, by errors as large as itself.
TEST(StatedErrors, AsLargeAsTheQuantityItselfSayLittleWhereThereIsMoreOfIt) {
  const std::vector<double> size = levelled({0.02, 1.33, 1}, {627, 190, 2.4});
  EXPECT_NEAR(size[0], 0.302, 1e-3);
  EXPECT_EQ(size[1], 1.33);
  EXPECT_EQ(levelled({0.05, 0.3}, {1, 0})[0], 0.05);  // nothing is left
}

TEST(StatedErrors, PartsAddInSquaresAndTheWatersBandIsNone) {
  ErrorParts parts;
  parts.sampling = 0.03;
  parts.grid = 0.04;
  parts.method = 0.12;
  parts.water = 7;
  EXPECT_NEAR(parts.total(), 0.13, 1e-12);
}

TEST(StatedErrors, TheScatterBetweenSkinsIsTheSamplingPart) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.5};
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = 32;
  fidelity.skins = 5;
  fidelity.control_skins = 0;
  fidelity.threads = 1;
  PatchSet set = solve_patches(scene, Texture{}, fidelity);
  ASSERT_EQ(set.skins(), 5);
  // Two are the fewest that say how they scatter.
  for (const int skins : {1, 2, 5}) {
    PatchSet first = set;
    for (auto& results : first.results) results.resize(static_cast<std::size_t>(skins));
    EXPECT_EQ(respond(scene, fidelity, first).without.size(), skins > 1 ? skins : 0u) << skins;
  }
  const std::vector<double> scatter = planted(1, 0.03);
  for (std::size_t k = 0; k < 5; ++k) {
    set.results[0][k].pull = 2e-6 * scatter[k];
    set.results[0][k].mean_gap = 50e-9 * scatter[k];
  }
  const ResponsePoint p = respond(scene, fidelity, set).points.front();
  EXPECT_NEAR(p.mean_gap.value, 50e-9, 1e-18);
  EXPECT_NEAR(p.mean_gap.parts.sampling, 0.03 * 50e-9, 1e-18);
  EXPECT_NEAR(p.electrostatic_force.parts.sampling / p.electrostatic_force.value, 0.03, 1e-9);
}

// Half the pixels see 10 % more: what is left to the limit is a known share of that, by the order
// of convergence of each quantity (Eq. accuracy.2).
TEST(StatedErrors, AStepBetweenGridsGivesItsRestToTheLimit) {
  const double step = 0.1;
  for (const auto& [quantity, rest] :
       {std::pair<Member, double>{&ResponsePoint::electrostatic_force, 1 / (std::exp2(1.3) - 1)},
        {&ResponsePoint::capillary_force, 1 / (std::exp2(1.5) - 1)}}) {
    ControlRuns runs;
    runs.own = steady(quantity, 2.0);
    runs.coarse = steady(quantity, 2.0 * (1 + step));
    EXPECT_NEAR(grid_part(runs, quantity), rest * step, 0.02 * step);
    // A smaller number on half the pixels is as far off.
    runs.coarse = steady(quantity, 2.0 * (1 - step));
    EXPECT_NEAR(grid_part(runs, quantity), rest * step, 0.02 * step);
  }
}

// An octave of the skin that the grid leaves out moves the pull as far as the last one that it
// resolves did.
TEST(StatedErrors, OctavesThatTheGridLeavesOutMoveThePullAsTheLastOneDid) {
  const Member pull = &ResponsePoint::electrostatic_force;
  ControlRuns runs;
  runs.own = steady(pull, 2.0);
  runs.coarse = steady(pull, 2.2);
  for (double octaves : {1.0, 2.0, 3.5}) {
    runs.octaves = octaves;
    EXPECT_NEAR(grid_part(runs, pull), octaves * 0.1, 1e-9) << octaves;
  }
  runs.octaves = 0.5;
  EXPECT_NEAR(grid_part(runs, pull), 0.07, 1e-9);
}

// Areas fall by one factor an octave: n octaves that the grid leaves out take 1 - 1.1^-n. It is
// taken off, a seventh of it stays unknown.
TEST(StatedErrors, OctavesThatTheGridLeavesOutAreTakenOffTheAreas) {
  const Member area = &ResponsePoint::area_fraction_off;
  ControlRuns runs;
  runs.own = steady(area, 0.2);
  runs.coarse = steady(area, 0.22);
  for (double octaves : {1.0, 2.0, 3.5}) {
    runs.octaves = octaves;
    const double lacking = 1 - std::pow(1.1, -octaves);
    EXPECT_NEAR(resolved_areas(runs), 1 - lacking, 1e-9) << octaves;
    EXPECT_NEAR(grid_part(runs, area), 0.14 * lacking, 1e-9) << octaves;
  }
  // What coarse features leave of the step counts where it is more.
  runs.octaves = 1;
  runs.coarse_features = 0.2;
  EXPECT_NEAR(grid_part(runs, area), 0.2 * 0.1, 1e-9);
  runs.coarse_features = 0;
  // A grid that resolves the cut-off has coarse features alone, in a value as in a difference.
  runs.octaves = 0;
  EXPECT_EQ(resolved_areas(runs), 1);
  EXPECT_EQ(grid_part(runs, area), 0);
  runs.coarse_features = 0.2;
  EXPECT_NEAR(grid_part(runs, area), 0.2 * 0.1, 1e-9);
  runs.coarse_features = 0;
  // Of one that leaves next to nothing out next to nothing is taken off and not known: no cliff.
  for (double octaves : {0.3, 1e-6}) {
    runs.octaves = octaves;
    const double lacking = 1 - std::pow(1.1, -octaves);
    EXPECT_NEAR(resolved_areas(runs), 1 - lacking, 1e-12) << octaves;
    EXPECT_NEAR(grid_part(runs, area), 0.14 * lacking, 1e-12) << octaves;
  }
  // No control runs, nothing known.
  EXPECT_EQ(resolved_areas({}), 1);
}

// What is taken off is taken off friction as well, and off no modulation.
TEST(StatedErrors, AFrictionIsThatOfTheResolvedArea) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.5};
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = 32;
  fidelity.skins = 3;
  fidelity.threads = 1;
  PatchSet set = solve_patches(scene, Texture{}, fidelity);
  const ResponsePoint as_solved = respond(scene, fidelity, set).points.front();
  set.area_factor = 0.8;
  const ResponsePoint taken = respond(scene, fidelity, set).points.front();
  const double held = as_solved.retention_force.value;
  EXPECT_NEAR(taken.area_fraction_on.value, 0.8 * as_solved.area_fraction_on.value, 1e-12);
  EXPECT_NEAR(taken.friction_off.value - held, 0.8 * (as_solved.friction_off.value - held), 1e-12);
  EXPECT_NEAR(taken.friction_off.parts.sampling / taken.friction_off.value,
              as_solved.friction_off.parts.sampling / as_solved.friction_off.value, 1e-3);
  EXPECT_NEAR(taken.modulation.value, as_solved.modulation.value, 0.01);
}

// Where the texture's features are few pixels wide all of the step of areas and frictions counts;
// the modulation, where such an error cancels, keeps its own law.
TEST(StatedErrors, CoarseFeaturesLeaveTheWholeStepOfAreasOpen) {
  for (const PointQuantity& q : kPointQuantities) {
    if (q.grid != GridLaw::Area) continue;
    ControlRuns runs;
    runs.own = steady(q.value, 2.0);
    runs.coarse = steady(q.value, 2.4);
    runs.coarse_features = 1;
    EXPECT_NEAR(grid_part(runs, q.value), 0.2, 1e-12);
    runs.coarse_features = 2;
    EXPECT_NEAR(grid_part(runs, q.value), 0.4, 1e-12);
  }
}

// Pillars of 4 and of 2 pixels on a skin that every grid resolves: the part reaches to the number
// of eight times finer pixels, and is next to nothing where features are resolved.
TEST(StatedErrors, TheGridPartKnowsTheTexturesFeatures) {
  Scene scene;
  scene.finger.skin.cutoff = 1.5e-6;
  scene.environment.relative_humidity = {0};
  scene.drive.amplitude = 0;
  for (const double width : {0.75e-6, 0.375e-6}) {
    const Texture texture{PillarArray{.period = 2 * width, .diameter = width, .height = 200e-9}};
    Fidelity f = fidelity_level("search");
    f.skins = f.control_skins = 4;
    f.grid = 64;
    const Measured coarse = evaluate(scene, texture, f).points[0].area_fraction_off;
    f.grid = 512;
    const Measured fine = evaluate(scene, texture, f).points[0].area_fraction_off;
    const double off = std::abs(coarse.value / fine.value - 1);
    EXPECT_LT(off, 1.5 * coarse.parts.grid.value() / coarse.value) << width;
    EXPECT_LT(fine.parts.grid.value(), 0.05 * fine.value);
  }
}

TEST(StatedErrors, TheLoadLawIsJudgedBySolvedAreas) {
  const Member friction = &ResponsePoint::friction_off;
  ControlRuns runs;
  runs.own = steady(friction, 1.0);
  runs.areas = steady(friction, 0.8);
  const ControlledChange change = controlled_change(runs, grid_law(friction), of(friction));
  EXPECT_NEAR(method_error(change.method), 0.2, 1e-12);
  for (double sample : change.method) EXPECT_NEAR(sample, -0.2, 1e-12);
  EXPECT_TRUE(change.grid.empty());
}

// Its way to the limit belongs to the method of the modulation: solved areas on half the pixels
// have 10 % more, so they themselves are 5.5 % too high.
TEST(StatedErrors, TheLoadLawOfTheModulationIsJudgedInTheLimit) {
  const Member modulation = &ResponsePoint::modulation;
  ControlRuns runs;
  runs.own = steady(modulation, 1.0);
  runs.areas = steady(modulation, 1.0);
  runs.coarse = steady(modulation, 1.1);
  const ControlledChange change = controlled_change(runs, grid_law(modulation), of(modulation));
  EXPECT_NEAR(method_error(change.method), 0.055, 0.002);
  EXPECT_NEAR(grid_error(change.grid), 0.5 * 0.055, 0.002);  // half of that is not known
}

}  // namespace
}  // namespace papilla::tests::stated_errors_test
