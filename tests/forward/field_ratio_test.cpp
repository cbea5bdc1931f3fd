// The field rule scaled to the 3-D field on skins of the scene.
#include "forward/field_ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::tests::field_ratio_test {
namespace {

// Deep square holes in a planar film, where the rule is a third and more above the 3-D field.
Texture deep_holes() {
  HoleArray holes;
  holes.period = 3e-6;
  holes.diameter = 2e-6;
  holes.depth = 700e-9;
  holes.wall_angle = 88 * kPi / 180;
  return Texture{holes};
}

Scene planar_glass() {
  Scene scene;
  scene.surface.process = FilmProcess::Planar;
  scene.surface.dielectric[0].thickness = 1e-6;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.15, 0.75};
  return scene;
}

Fidelity small(int field_skins) {
  Fidelity f = fidelity_level("draft");
  f.grid = 64;
  f.skins = 6;
  f.control_skins = 0;
  f.field_skins = field_skins;
  return f;
}

TEST(FieldRatio, TwoSkinsCorrectTheRuleOnOthersToTheThreeDimensionalField) {
  Scene full = planar_glass();
  full.model.field = FieldMethod::Full;
  const Response exact = evaluate(full, deep_holes(), small(0));
  const Response plain = evaluate(planar_glass(), deep_holes(), small(0));
  const Response scaled = evaluate(planar_glass(), deep_holes(), small(2));
  for (std::size_t i = 0; i < exact.points.size(); ++i) {
    const double pull = exact.points[i].electrostatic_force.value;
    EXPECT_GT(plain.points[i].electrostatic_force.value, 1.2 * pull);
    EXPECT_FALSE(plain.points[i].field_error);
    const ResponsePoint& point = scaled.points[i];
    ASSERT_TRUE(point.field_error);
    // Of R: pixels of the 3-D field, and two skins.
    const double r = point.field_correction, off = 1 - r;
    EXPECT_LT(*point.field_error,
              1.1 * std::hypot(0.02, off * off / r, 0.03 + 0.3 * off * off / r));
    EXPECT_NEAR(point.electrostatic_force.value, pull, 2 * *point.field_error * pull);
    EXPECT_NEAR(point.modulation.value, exact.points[i].modulation.value,
                2 * *point.modulation.parts.field);
  }
}

TEST(FieldRatio, IsThatOfThePullsOfTheFirstSkins) {
  const Fidelity fidelity = small(2);
  const FieldRatios ratios = field_ratios(planar_glass(), deep_holes(), fidelity);
  ASSERT_EQ(ratios.size(), 2u);
  double rule = 0, full = 0;
  for (int k = 0; k < 2; ++k) {
    const PatchPicture p = picture_patch(planar_glass(), deep_holes(), fidelity, 0.15, k);
    const CoveredSurface surface(p.texture, film_of(planar_glass()));
    rule += p.fields.pull.mean();
    full += solve_full_field({p.texture.grid, p.fields.off.gap}, &surface, p.fields.wetting_on,
                             field_problem(planar_glass(), 0.15))
                .mean_pressure;
  }
  EXPECT_NEAR(ratios[0].correction, full / rule, 1e-6);
}

TEST(FieldRatio, ASkinWithoutA3DFieldIsNoSkinWithoutAPull) {
  using Full = std::vector<std::optional<double>>;
  const std::vector<double> rule{1e3, 2e3, 4e3};
  const FieldRatio two = field_ratio(Full{800, std::nullopt, 3200}, rule, true);
  EXPECT_NEAR(two.correction, 0.8, 1e-12);
  // Of pixels, of what they leave of the fifth that is taken off, and of two skins.
  const double of_skins = std::hypot(0.03 * 0.8, 0.3 * 0.04) / std::sqrt(2) / 0.8;
  EXPECT_NEAR(*two.error, std::hypot(0.02, 0.04 / 0.8, of_skins), 1e-12);
  const FieldRatio none = field_ratio(Full(3), rule, true);
  EXPECT_EQ(none.correction, 1);
  EXPECT_EQ(*none.error, 1);
  // A flooded skin has a field and no pull.
  const std::vector<double> flooded{1e3, 0};
  EXPECT_NEAR(*field_ratio(Full{800, 0.0}, flooded, true).error,
              std::hypot(0.02, 0.04 / 0.8, of_skins), 1e-12);
}

// The wetter a patch, the less is left of the rule's pull, without a step where the 3-D field's own
// passes zero: a skin below it was left out, and without any the rule stood uncorrected.
TEST(FieldRatio, FallsToNextToNothingWhereThe3DPullPassesZero) {
  using Full = std::vector<std::optional<double>>;
  const std::vector<double> rule{1e3, 1e3};
  FieldRatio before = field_ratio(Full{1000.0, 1000.0}, rule, true);
  EXPECT_EQ(before.correction, 1);
  for (double pull = 990; pull > -1000; pull -= 10) {
    const FieldRatio ratio = field_ratio(Full{pull, pull}, rule, true);
    EXPECT_GT(ratio.correction, 0) << pull;
    EXPECT_LT(ratio.correction, before.correction + 1e-12) << pull;
    EXPECT_GT(ratio.correction, before.correction - 0.011) << pull;
    EXPECT_GE(*ratio.error, *before.error - 1e-3) << pull;
    before = ratio;
  }
  EXPECT_LT(before.correction, 0.1);
  EXPECT_GT(*before.error, 1);
  EXPECT_LT(*before.error, std::sqrt(2) + 1e-3);
  // Columns, which nothing corrects, are off by no more than all of their pull.
  EXPECT_EQ(*field_ratio(Full{-500.0, -500.0}, rule, false).error, 1);
  EXPECT_NEAR(*field_ratio(Full{800.0, 800.0}, rule, false).error, 0.25, 1e-6);
  // One skin above and one below zero: both count, a mean of 0.3 that is known to 0.6.
  EXPECT_NEAR(field_ratio(Full{900.0, -300.0}, rule, true).correction,
              not_below_zero({0.3, 0.6}).value, 1e-12);
}

// A relative error of the pull moves the friction of contact by beta times the share of the pull
// in the load.
TEST(FieldRatio, TheErrorOfThePullReachesModulationAndFriction) {
  Response r = evaluate(planar_glass(), deep_holes(), small(0));
  ResponsePoint point = r.points[0];
  const double before =
      std::accumulate(point.samples.load_off.begin(), point.samples.load_off.end(), 0.0);
  const double after =
      std::accumulate(point.samples.load_on.begin(), point.samples.load_on.end(), 0.0);
  add_field_error({0.8, 0.01}, {0.84, 0.84}, point);
  EXPECT_EQ(point.field_correction, 0.8);
  EXPECT_DOUBLE_EQ(*point.electrostatic_force.parts.field, 0.01 * point.electrostatic_force.value);
  const double relative = 0.84 * (after - before) / after * 0.01;
  EXPECT_NEAR(*point.modulation.parts.field, relative * (1 + point.modulation.value), 1e-12);
  EXPECT_NEAR(
      *point.friction_on.parts.field,
      relative * (point.friction_on.value - point.retention_force.value - point.retention_gain),
      1e-12);
  EXPECT_FALSE(point.friction_off.parts.field);
  EXPECT_GT(point.modulation.se(), r.points[0].modulation.se());
}

TEST(FieldRatio, ColumnsAreNotCorrectedAndThePaperIsLeftAlone) {
  Scene scene = planar_glass();
  scene.model.field = FieldMethod::Local;
  for (const FieldRatio& r : field_ratios(scene, deep_holes(), small(2))) {
    EXPECT_EQ(r.correction, 1);
    ASSERT_TRUE(r.error);
    EXPECT_GT(*r.error, 0.1);
  }
  scene.model.preset = Preset::M3;
  for (const FieldRatio& r : field_ratios(scene, deep_holes(), small(2))) {
    EXPECT_EQ(r.correction, 1);
    EXPECT_FALSE(r.error);
  }
  Scene still = planar_glass();
  still.drive.amplitude = 0;
  EXPECT_FALSE(field_ratios(still, deep_holes(), small(2))[0].error);
}

// Wet skin is saturated, and has another layer than clean skin at every humidity.
TEST(FieldRatio, HasTheLagOfTheFingerInItsState) {
  Scene scene = planar_glass();
  scene.drive.frequency = 30;
  scene.finger.electrical.thickness_15 = 10e-9;
  scene.finger.electrical.thickness_75 = 500e-9;
  for (const FieldMethod method : {FieldMethod::Full, FieldMethod::Spread}) {
    scene.model.field = method;
    scene.finger.state = FingerState::Clean;
    const FieldRatios clean = field_ratios(scene, deep_holes(), small(1));
    scene.finger.state = FingerState::Wet;
    const FieldRatios wet = field_ratios(scene, deep_holes(), small(1));
    const FieldRatios said = field_ratios(in_its_state(scene), deep_holes(), small(1));
    for (std::size_t i = 0; i < wet.size(); ++i) {
      ASSERT_TRUE(wet[i].error && said[i].error);
      EXPECT_NEAR(*wet[i].error, *said[i].error, 1e-6);
    }
    EXPECT_LT(*wet[0].error, *clean[0].error - 0.01);
  }
}

TEST(FieldRatio, IsTheSameForAnyNumberOfThreads) {
  Fidelity one = small(3), two = small(3);
  one.threads = 1;
  two.threads = 2;
  const FieldRatios a = field_ratios(planar_glass(), deep_holes(), one),
                    b = field_ratios(planar_glass(), deep_holes(), two);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].correction, b[i].correction);
    EXPECT_EQ(a[i].error, b[i].error);
  }
}

// A film of uniform thickness along z has no walls: the modulation has no step where the slope of
// the walls passes 45 degrees, for any process.
TEST(FieldRatio, TheModulationHasNoStepAtAnySlopeOfTheWalls) {
  for (const FilmProcess process :
       {FilmProcess::Conformal, FilmProcess::Directional, FilmProcess::Planar}) {
    Scene scene = planar_glass();
    scene.surface.process = process;
    scene.environment.relative_humidity = {0.15};
    scene.model.water = WaterModel::Threshold;  // droplets have noise of their own
    std::vector<double> modulation;
    for (double angle = 36; angle <= 54; angle += 2) {
      HoleArray holes;
      holes.period = 3e-6;
      holes.diameter = 2.6e-6;
      holes.depth = 350e-9;
      holes.wall_angle = angle * kPi / 180;
      modulation.push_back(evaluate(scene, Texture{holes}, small(0)).points[0].modulation.value);
    }
    // Every value lies near the mean of its neighbours.
    for (std::size_t i = 1; i + 1 < modulation.size(); ++i) {
      EXPECT_NEAR(modulation[i], 0.5 * (modulation[i - 1] + modulation[i + 1]),
                  0.004 * modulation[i])
          << static_cast<int>(process) << ' ' << 36 + 2 * i;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::field_ratio_test
