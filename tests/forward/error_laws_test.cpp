// What is stated of grid, method and field, from planted runs by hand; and what the skips of a plan
// may cost, from the fields of its patches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "base/constants.h"
#include "forward/field_ratio.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "forward/skips.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::tests::error_laws_test {
namespace {

using Member = Measured PointQuantities::*;
using Points = std::vector<ResponsePoint>;

// A quantity of all skins and without each of them.
Resampled run(Member quantity, double all, const std::vector<double>& without) {
  const auto point = [&](double value) {
    ResponsePoint p;
    (p.*quantity).value = value;
    return Points{p};
  };
  Resampled out;
  out.points = point(all);
  for (const double w : without) out.without.push_back(point(w));
  return out;
}
Reading of(Member quantity) {
  return [quantity](const Points& points) { return std::optional((points[0].*quantity).value); };
}

// Without skins 0, 1, 2: relative steps of 0.1 and those without each. Samples of the jackknife:
// all - 2 (without - mean).
TEST(ErrorLaws, SamplesAreTheJackknifesOfTheRelativeStep) {
  const Member m = &ResponsePoint::electrostatic_force;
  ControlRuns runs;
  runs.own = run(m, 2, {2, 4, 5});
  runs.coarse = run(m, 2.2, {2.3, 4.2, 5.5});  // 0.1 and 0.15, 0.05, 0.1
  const ControlledChange change = controlled_change(runs, GridLaw::Pull, of(m));
  ASSERT_EQ(change.halving.size(), 3u);
  const double expected[] = {0.1 - 2 * 0.05, 0.1 + 2 * 0.05, 0.1};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(change.halving[k], expected[k], 1e-12) << k;
    EXPECT_NEAR(change.grid[k], 0.7 * expected[k], 1e-12) << k;  // order 1.3
  }
  EXPECT_TRUE(change.method.empty());
  // By itself the step of 0.2 counts, without each 0.3, 0.2, 0.5.
  const ControlledChange plain = controlled_change(runs, GridLaw::Other, of(m), Change::Absolute);
  const double mean = 1.0 / 3;
  EXPECT_NEAR(plain.halving[0], 0.2 - 2 * (0.3 - mean), 1e-12);
  EXPECT_NEAR(plain.halving[2], 0.2 - 2 * (0.5 - mean), 1e-12);
  EXPECT_NEAR(plain.grid[1], 0.55 * (0.2 - 2 * (0.2 - mean)), 1e-12);  // order 1.5
  // A quantity of nothing has no relative step; one that is not defined has no samples.
  runs.own = run(m, 0, {0, 0, 0});
  for (const double sample : controlled_change(runs, GridLaw::Pull, of(m)).halving)
    EXPECT_EQ(sample, 0);
  const Reading undefined = [](const Points&) { return std::optional<double>(); };
  EXPECT_TRUE(controlled_change(runs, GridLaw::Pull, undefined).halving.empty());
  EXPECT_TRUE(controlled_change(runs, GridLaw::Pull, undefined).grid.empty());
  EXPECT_TRUE(controlled_change({}, GridLaw::Pull, of(m)).grid.empty());
}

// A negative quantity is as far off as its size says.
TEST(ErrorLaws, StepsAreRelativeToTheSize) {
  const Member m = &ResponsePoint::capillary_force;
  ControlRuns runs;
  runs.own = run(m, -2, {-2, -2});
  runs.coarse = run(m, -2.2, {-2.2, -2.2});
  for (const double sample : controlled_change(runs, GridLaw::Other, of(m)).halving)
    EXPECT_NEAR(sample, -0.1, 1e-12);
}

// With the load law grids are compared by solved areas, and the law with them on the same grid; of
// the modulation its way to the limit as well, half of which is not known.
TEST(ErrorLaws, TheLoadLawIsSetAgainstSolvedAreas) {
  for (const Member m : {&ResponsePoint::friction_on, &ResponsePoint::modulation}) {
    const bool modulation = m == &ResponsePoint::modulation;
    ControlRuns runs;
    runs.own = run(m, 1, {1, 1});          // by the law
    runs.areas = run(m, 0.8, {0.8, 0.8});  // solved
    runs.coarse = run(m, 0.88, {0.88, 0.88});
    runs.octaves = 0;
    const GridLaw law = modulation ? GridLaw::Modulation : GridLaw::Other;
    const ControlledChange change = controlled_change(runs, law, of(m));
    for (const double step : change.halving) EXPECT_NEAR(step, 0.1, 1e-12);
    for (const double g : change.grid) EXPECT_NEAR(g, (modulation ? 0.5 : 1) * 0.55 * 0.1, 1e-12);
    // -20 %, and 55 % of the step of 8 % of the law's number.
    for (const double l : change.method)
      EXPECT_NEAR(l, modulation ? -0.2 - 0.55 * 0.08 : -0.2, 1e-12);
    // Without a coarse run the law's distance alone.
    runs.coarse = {};
    for (const double l : controlled_change(runs, law, of(m)).method) EXPECT_NEAR(l, -0.2, 1e-12);
  }
}

// Areas: taken off is what the octaves left out would take; what is not known of it is a seventh,
// and the scatter of the step between skins counts whole.
TEST(ErrorLaws, WhatIsTakenOffAreasIsKnownAsWellAsSkinsAgree) {
  const Member m = &ResponsePoint::area_fraction_off;
  ControlRuns runs;
  runs.own = run(m, 1, {1, 1, 1});
  runs.coarse = run(m, 1.1, {1.14, 1.06, 1.1});
  runs.octaves = 2;
  const ControlledChange change = controlled_change(runs, GridLaw::Area, of(m));
  const double step = grid_error(change.halving);  // 0.1 and its scatter
  const double mean = 0.1, deviations[] = {-0.08, 0.08, 0};
  EXPECT_NEAR(step, std::hypot(0.1, std::sqrt(2 * 0.08 * 0.08 / 2 / 3)), 1e-12);
  const double all = (1 - std::pow(1 + step, -2)) / step, missing = 0.14 * all;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(change.halving[k], mean + deviations[k], 1e-12) << k;
    EXPECT_NEAR(change.grid[k], missing * (mean + deviations[k]) + (all - missing) * deviations[k],
                1e-12);
  }
  EXPECT_NEAR(resolved_areas(runs), std::pow(1.1, -2), 1e-12);
  // A grid that shows less is not taken for more.
  runs.coarse = run(m, 0.9, {0.9, 0.9, 0.9});
  EXPECT_EQ(resolved_areas(runs), 1);
  runs.coarse = {};
  EXPECT_EQ(resolved_areas(runs), 1);
}

TEST(ErrorLaws, TheTotalHoldsEveryPartThatIsNotCommonToAllDesigns) {
  for (const ErrorOrigin& origin : kErrorOrigins) {
    ErrorParts parts;
    parts.sampling = 3;
    parts.*origin.part = 4;
    const std::string name = origin.name;
    EXPECT_NEAR(parts.total(), name == "water" || name == "model" ? 3 : 5, 1e-12) << name;
  }
  EXPECT_EQ(ErrorParts{}.total(), 0);
}

TEST(ErrorLaws, EveryQuantityHasItsLaw) {
  for (const Member area : {&ResponsePoint::friction_off, &ResponsePoint::friction_on,
                            &ResponsePoint::area_fraction_off, &ResponsePoint::area_fraction_on})
    EXPECT_EQ(grid_law(area), GridLaw::Area);
  EXPECT_EQ(grid_law(&ResponsePoint::modulation), GridLaw::Modulation);
  // Friction by a coefficient is of no area.
  EXPECT_EQ(grid_law(&ResponsePoint::friction_on, true), GridLaw::Other);
  EXPECT_EQ(grid_law(&ResponsePoint::area_fraction_on, true), GridLaw::Area);
  EXPECT_EQ(grid_law(&ResponsePoint::electrostatic_force), GridLaw::Pull);
  for (const Member other :
       {&ResponsePoint::capillary_force, &ResponsePoint::retention_force, &ResponsePoint::bridges,
        &ResponsePoint::wetted_fraction, &ResponsePoint::mean_gap, &ResponsePoint::indentation})
    EXPECT_EQ(grid_law(other), GridLaw::Other);
}

// A film that is not flat, so that the rule is off, at two humidities.
Scene holes_scene(FieldMethod method) {
  Scene scene;
  scene.surface.process = FilmProcess::Planar;
  scene.surface.dielectric[0].thickness = 1e-6;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.2, 0.6};
  scene.model.field = method;
  return scene;
}
Texture deep_holes() {
  HoleArray h;
  h.period = 3e-6, h.diameter = 2e-6, h.depth = 600e-9, h.wall_angle = 85 * kPi / 180;
  return Texture{h};
}
Fidelity coarse(int field_skins) {
  Fidelity f = fidelity_level("search");
  f.grid = 32, f.skins = 3, f.field_skins = field_skins;
  return f;
}

// Eq. electrostatics.17: the ratio of the sums over the skins; what pixels leave of it, and the
// larger of what one skin says of others, over the root of the skins, and their own scatter.
TEST(FieldRatioLaws, AreThoseOfTheSumsOfItsSkins) {
  for (const FieldMethod method : {FieldMethod::Spread, FieldMethod::Local}) {
    const Scene scene = holes_scene(method);
    for (const int skins : {1, 3}) {
      const Fidelity f = coarse(skins);
      const FieldRatios ratios = field_ratios(scene, deep_holes(), f);
      ASSERT_EQ(ratios.size(), 2u);
      for (std::size_t i = 0; i < 2; ++i) {
        const double rh = scene.environment.relative_humidity[i];
        std::vector<double> rule, full;
        for (int k = 0; k < skins; ++k) {
          const PatchPicture p = picture_patch(scene, deep_holes(), f, rh, k);
          const CoveredSurface surface(p.texture, film_of(scene));
          rule.push_back(p.fields.pull.mean());
          full.push_back(solve_full_field({p.texture.grid, p.fields.off.gap}, &surface,
                                          p.fields.wetting_on, field_problem(scene, rh))
                             .mean_pressure);
        }
        const double ratio = std::accumulate(full.begin(), full.end(), 0.0) /
                             std::accumulate(rule.begin(), rule.end(), 0.0);
        const FieldRatio& r = ratios[i];
        ASSERT_TRUE(r.error);
        // Contact starts from the humidity before: the gap is the same within its tolerance.
        if (method == FieldMethod::Local) {
          EXPECT_EQ(r.correction, 1);
          EXPECT_NEAR(*r.error, std::min(1.0, std::abs(1 / ratio - 1)), 0.01);
          continue;
        }
        EXPECT_NEAR(r.correction, ratio, 0.01 * ratio);
        const double scatter = skins > 1 ? ratio_estimate(full, rule).se / ratio : 0;
        const double others = std::hypot(0.03, 0.3 * square(std::max(0.0, 1 - ratio)) / ratio);
        const double of_skins = std::max(others / std::sqrt(skins), scatter);
        EXPECT_NEAR(*r.error, std::hypot(full_field_error(ratio), of_skins), 0.002);
      }
    }
  }
  for (const FieldRatio& r :
       field_ratios(holes_scene(FieldMethod::Full), deep_holes(), coarse(2))) {
    EXPECT_EQ(r.correction, 1);
    EXPECT_NEAR(*r.error, 0.02, 1e-7);  // and next to no lag at 5 kHz
  }
  EXPECT_FALSE(field_ratios(holes_scene(FieldMethod::Spread), deep_holes(), coarse(0))[1].error);
}

TEST(FieldRatioLaws, WhatIsCorrectedAndItsPrice) {
  Scene scene = holes_scene(FieldMethod::Spread);
  EXPECT_TRUE(field_corrected(scene, coarse(1)));
  EXPECT_FALSE(field_corrected(scene, coarse(0)));
  EXPECT_FALSE(field_corrected(holes_scene(FieldMethod::Local), coarse(1)));
  EXPECT_FALSE(field_corrected(holes_scene(FieldMethod::Full), coarse(1)));
  Scene paper = scene, still = scene;
  paper.model.preset = Preset::M3;
  still.drive.amplitude = 0;
  EXPECT_FALSE(field_corrected(paper, coarse(1)));
  EXPECT_FALSE(field_corrected(still, coarse(1)));
  // 3 us a pixel, of as many as a grid of 128 has, for every skin and humidity.
  Fidelity f = coarse(3);
  EXPECT_NEAR(field_ratio_seconds(scene, {32, 24, 12e-6, 9e-6}, f), 3 * 2 * 3e-6 * 32 * 24, 1e-12);
  f.grid = 512;
  EXPECT_NEAR(field_ratio_seconds(scene, {512, 256, 24e-6, 12e-6}, f), 3 * 2 * 3e-6 * 128 * 64,
              1e-12);
}

// By hand: loads 2 off and 5 on, beta 0.8, the pull 4 % off: 0.8 x 3/5 x 4 % of the friction.
TEST(FieldRatioLaws, APullThatIsOffMovesWhatStandsOnIt) {
  ResponsePoint p;
  p.samples.load_off = {0.5, 1.5};
  p.samples.load_on = {2, 3};
  p.electrostatic_force.value = 7;
  p.area_fraction_on.value = 0.3;
  p.friction_on.value = 10, p.retention_force.value = 1, p.retention_gain = 0.5;
  p.modulation.value = 0.6;
  add_field_error({1.1, 0.04}, {0.8, 0.8}, p);
  const double relative = 0.8 * 0.6 * 0.04;
  EXPECT_EQ(p.field_correction, 1.1);
  EXPECT_EQ(p.field_error, 0.04);
  EXPECT_NEAR(*p.electrostatic_force.parts.field, 0.28, 1e-12);
  EXPECT_NEAR(*p.area_fraction_on.parts.field, relative * 0.3, 1e-12);
  EXPECT_NEAR(*p.friction_on.parts.field, relative * 8.5, 1e-12);
  EXPECT_NEAR(*p.modulation.parts.field, relative * 1.6, 1e-12);
  EXPECT_FALSE(p.friction_off.parts.field || p.capillary_force.parts.field);
  // With a coefficient friction goes with the load itself, and the area as before.
  add_field_error({1.1, 0.04}, load_exponents(0.8, 0.3), p);
  EXPECT_NEAR(*p.area_fraction_on.parts.field, relative * 0.3, 1e-12);
  EXPECT_NEAR(*p.friction_on.parts.field, 0.6 * 0.04 * 8.5, 1e-12);
  EXPECT_NEAR(*p.modulation.parts.field, 0.6 * 0.04 * 1.6, 1e-12);
  // A finger that the drive lifts off, and one whose loads fall, have none of contact.
  ResponsePoint lifted;
  lifted.samples.load_off = {1}, lifted.samples.load_on = {0};
  lifted.friction_on.value = 2;
  add_field_error({1, 0.04}, {0.8, 0.8}, lifted);
  EXPECT_EQ(*lifted.friction_on.parts.field, 0);
  lifted.samples.load_on = {0.5};
  add_field_error({1, 0.04}, {0.8, 0.8}, lifted);
  EXPECT_EQ(*lifted.friction_on.parts.field, 0);
  ResponsePoint unmeasured;
  add_field_error({0.9, std::nullopt}, {0.8, 0.8}, unmeasured);
  EXPECT_EQ(unmeasured.field_correction, 0.9);
  EXPECT_FALSE(unmeasured.electrostatic_force.parts.field);
}

// Eqs. accuracy.7 to 10 over two skins at each of two humidities, the larger of both.
TEST(SkipLaws, BoundsAreThoseOfTheFieldsOfItsPatches) {
  Scene scene;
  scene.drive.amplitude = 150;
  scene.environment.relative_humidity = {0.3, 0.7};
  scene.model.coupling = Coupling::Equilibrium;  // the bound is of one pass
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  const SkipBounds bounds = skip_bounds(scene, Texture{}, f, 2);
  Scene once = scene;
  once.model.coupling = Coupling::OnePass;
  Fidelity areas = f;
  areas.estimator = Estimator::Area, areas.skins = 2, areas.control_skins = 0;
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  double waals = 0, kelvin = 0, coupling = 0, retention = 0;
  for (const double rh : scene.environment.relative_humidity) {
    double off = 0, on = 0, vdw = 0, suction = 0, pull = 0, next = 0;
    for (int k = 0; k < 2; ++k) {
      const PatchPicture p = picture_patch(once, Texture{}, areas, rh, k);
      const Grid& g = p.texture.grid;
      off += mean(p.fields.off.pressure), on += mean(p.fields.on.pressure);
      vdw += van_der_waals_traction({g, p.fields.off.gap}).mean();
      suction += kelvin_traction({g, p.fields.off.gap}, scene, rh).mean();
      pull += p.fields.pull.mean();
      const CoveredSurface surface(p.texture, film_of(scene));
      next += solve_field(scene, {g, p.fields.on.gap}, &surface, p.fields.wetting_on,
                          field_problem(scene, rh), f.field_tolerance)
                  .mean_pressure;
    }
    const double beta = f.load_exponent, r = next / pull - 1;
    ASSERT_TRUE(r > 0 && r < 1) << r;
    waals = std::max(waals, 2 * beta * vdw / off);
    kelvin = std::max(kelvin, 2 * beta * suction / off);
    coupling = std::max(coupling, 4 * beta * pull * r / (1 - r) / on);
  }
  EXPECT_GT(waals, 0);
  EXPECT_NEAR(bounds.van_der_waals, waals, 1e-9 * waals);
  EXPECT_NEAR(bounds.kelvin, kelvin, 1e-9 * kelvin);
  EXPECT_NEAR(bounds.self_consistency, coupling, 1e-9 * coupling);
  Scene rest = scene;
  rest.drive = {};
  for (const ResponsePoint& p : evaluate(rest, Texture{}, areas).points)
    retention = std::max(
        retention, p.retention_force.value / (p.friction_off.value - p.retention_force.value));
  EXPECT_GT(retention, 0);
  EXPECT_NEAR(bounds.retention, retention, 1e-9 * retention);
  // In saturated air menisci have no end; a drive at rest has no next pass.
  rest.environment.relative_humidity = {1};
  const SkipBounds wet = skip_bounds(rest, Texture{}, f, 1);
  EXPECT_EQ(wet.kelvin, kInfinity);
  EXPECT_EQ(wet.self_consistency, 0);
  // The plan carries them, and says of one that it is an estimate still.
  const Plan plan = measured_plan(once, Texture{}, f);
  int named = 0;
  for (const PlanSkip& s : plan.skipped) {
    const bool waals_skip = s.piece == Piece::VanDerWaals;
    if (waals_skip || s.piece == Piece::Kelvin || s.piece == Piece::Coupling) {
      EXPECT_NEAR(s.bound,
                  waals_skip                 ? waals
                  : s.piece == Piece::Kelvin ? kelvin
                                             : coupling,
                  1e-9 * s.bound);
      EXPECT_EQ(s.estimate, waals_skip);
      ++named;
    } else {
      EXPECT_TRUE(s.estimate) << s.name();
    }
  }
  EXPECT_EQ(named, 3);
}

// A pull that would double itself has no bound.
TEST(SkipLaws, PullInHasNoBound) {
  Scene scene;
  scene.drive.amplitude = 1500;
  scene.environment.relative_humidity = {0.3};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  EXPECT_EQ(skip_bounds(scene, Texture{}, f, 1).self_consistency, kInfinity);
}

}  // namespace
}  // namespace papilla::tests::error_laws_test
