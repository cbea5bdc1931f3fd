// The search for a voltage by what it evaluates and where it ends: counts that follow from a
// modulation that goes with the square of small voltages, and what the same patches answer there.
#include <gtest/gtest.h>

#include <cmath>

#include "estimate/voltage.h"
#include "forward/undriven.h"
#include "numerics/statistics.h"
#include "tests/support/one_pass.h"

namespace papilla::tests::voltage_search_test {
namespace {

Fidelity tiny() {
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 2;
  f.threads = 1;
  return f;
}

Scene scene_at(double amplitude) {
  Scene scene;
  scene.drive.amplitude = amplitude;
  scene.environment.relative_humidity = {0.35};
  return scene;
}

std::vector<VoltageAnswer> voltages(const Scene& scene, const std::vector<double>& targets,
                                    const Fidelity& f = tiny()) {
  Response r = evaluate(scene, Texture{}, f);
  add_voltages(r, scene, Texture{}, f, targets);
  return r.points.at(0).voltages;
}

double modulation(const Scene& scene, double amplitude, Estimator estimator = Estimator::Load) {
  Fidelity f = tiny();
  f.estimator = estimator;
  const Resampled there = UndrivenPatches(scene, Texture{}, f).drive(amplitude, estimator);
  return there.points.front().modulation.value;
}

TEST(VoltageSearch, OfTheDesignsOwnModulationIsItsAmplitudeAtOnce) {
  const Scene scene = scene_at(40);
  const double m = modulation(scene, 40);
  const VoltageAnswer a = voltages(scene, {m}).at(0);
  EXPECT_EQ(a.end, VoltageEnd::Reached);
  EXPECT_EQ(a.amplitude.value, 40);
  EXPECT_EQ(a.modulation, m);
  EXPECT_EQ(a.target, m);
  EXPECT_EQ(a.evaluations, 1);
  EXPECT_EQ(a.limit, 500);
}

// Each target is begun at the voltage of the one before. Where the modulation is nearly a square
// the first proposal is within percents, the second, by the slope of the two, within a thousandth.
TEST(VoltageSearch, TakesThreeEvaluationsOfASquare) {
  Scene scene = scene_at(40);
  scene.finger = one_pass_finger();
  const double m = modulation(scene, 40);
  const std::vector<VoltageAnswer> all = voltages(scene, {m, 1.5 * m, 0.5 * m});
  EXPECT_EQ(all[0].evaluations, 1);
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_LE(all[k].evaluations, 3) << k;
    EXPECT_NEAR(modulation(scene, all[k].amplitude.value) / all[k].target, 1, 2e-3) << k;
    EXPECT_NEAR(all[k].modulation / all[k].target, 1, 2e-3) << k;
  }
}

// A decade down and five octaves up. Below a thousandth of the limit, half a volt, nobody asks.
TEST(VoltageSearch, FindsFarTargetsInFewEvaluations) {
  const Scene scene = scene_at(10);
  for (const double amplitude : {1.0, 320.0}) {
    const double m = modulation(scene, amplitude);
    const VoltageAnswer a = voltages(scene, {m}).at(0);
    ASSERT_TRUE(a.reached());
    EXPECT_NEAR(a.amplitude.value / amplitude, 1, 2e-3);
    EXPECT_LE(a.evaluations, 6) << amplitude;
  }
  const VoltageAnswer least = voltages(scene, {modulation(scene, 0.3)}).at(0);
  EXPECT_TRUE(least.reached());
  EXPECT_LE(least.amplitude.value, 0.5);
  EXPECT_GE(least.amplitude.value, 0.3 * 0.999);
}

// Nothing is known of a design without a drive: it is begun at 100 V.
TEST(VoltageSearch, OfAnUndrivenDesignBeginsAtAHundredVolts) {
  const double target = 0.7 * modulation(scene_at(100), 100);
  const VoltageAnswer undriven = voltages(scene_at(0), {target}).at(0),
                      driven = voltages(scene_at(100), {target}).at(0);
  EXPECT_EQ(undriven, driven);
  EXPECT_NE(voltages(scene_at(150), {target}).at(0), driven);
}

// One evaluation at the design's, one at the limit: what is reached there is the highest.
TEST(VoltageSearch, BelowTheTargetAtTheLimitItEndsThere) {
  Scene scene = scene_at(200);
  VoltageAnswer a = voltages(scene, {1e3}).at(0);
  EXPECT_EQ(a.end, VoltageEnd::Breakdown);
  EXPECT_EQ(a.limit, 500);
  EXPECT_EQ(a.evaluations, 2);
  EXPECT_EQ(a.modulation, modulation(scene, 500));
  EXPECT_EQ(a.amplitude.value, 0);
  scene.drive.source_compliance = 90;  // below the amplitude: begun there
  a = voltages(scene, {1e3}).at(0);
  EXPECT_EQ(a.end, VoltageEnd::SourceEnds);
  EXPECT_EQ(a.limit, 90);
  EXPECT_EQ(a.evaluations, 1);
  EXPECT_EQ(a.modulation, modulation(scene, 90));
  EXPECT_EQ(text(a), "the source ends at 90 V");
  scene.surface.dielectric.clear();
  scene.drive.amplitude = 0;
  a = voltages(scene, {0.1}).at(0);
  EXPECT_EQ(a.end, VoltageEnd::NoDielectric);
  EXPECT_EQ(a.evaluations, 0);
}

// A target that is reached a little below the limit, and one a little above it.
TEST(VoltageSearch, TheLimitItselfMayBeTheAnswer) {
  const Scene scene = scene_at(300);
  const double top = modulation(scene, 500);
  const std::vector<VoltageAnswer> all = voltages(scene, {0.98 * top, 1.02 * top});
  EXPECT_TRUE(all[0].reached());
  EXPECT_GT(all[0].amplitude.value, 480);
  EXPECT_LT(all[0].amplitude.value, 500);
  EXPECT_EQ(all[1].end, VoltageEnd::Breakdown);
  EXPECT_EQ(all[1].modulation, top);
}

// The ceiling that pull-in sets: the model has no answer there, and has one half a percent below.
TEST(VoltageSearch, EndsNextToWhereTheGapPullsIn) {
  Scene scene = scene_at(0);
  scene.environment.relative_humidity = {0.15};
  scene.model.coupling = Coupling::Equilibrium;
  scene.surface.dielectric[0].strength = 1e12;
  scene.surface.dielectric[0].thickness = 20e-9;
  const auto driven = [&](double v) {
    return UndrivenPatches(scene, Texture{}, tiny()).drive(v, Estimator::Load).points.front();
  };
  const VoltageAnswer a = voltages(scene, {1e3}).at(0);
  EXPECT_EQ(a.end, VoltageEnd::ModelEnds);
  EXPECT_EQ(a.model, driven(a.limit).status);
  EXPECT_FALSE(a.model.sound());
  const ResponsePoint below = driven(a.limit * (1 - 5.1e-3));
  EXPECT_FALSE(below.status.pull_in());
  EXPECT_GT(a.modulation, 0.99 * below.modulation.value);
  EXPECT_LT(a.evaluations, 25);
}

// First by the load law, then by areas begun where that ended.
TEST(VoltageSearch, ByAreasBeginsWhereTheLoadLawEnds) {
  const Scene scene = scene_at(60);
  Fidelity f = tiny();
  const double target = modulation(scene, 90);
  const VoltageAnswer load = voltages(scene, {target}, f).at(0);
  f.estimator = Estimator::Area;
  const VoltageAnswer area = voltages(scene, {target}, f).at(0);
  ASSERT_TRUE(load.reached() && area.reached());
  EXPECT_GT(area.evaluations, load.evaluations);
  EXPECT_LE(area.evaluations, load.evaluations + 5);
  EXPECT_NEAR(modulation(scene, area.amplitude.value, Estimator::Area) / target, 1, 5e-3);
  EXPECT_EQ(area.modulation, modulation(scene, area.amplitude.value, Estimator::Area));
}

// Ten seconds of touch make skin so soft that the law alone has more contact than the patch at some
// 200 V: areas are sought up to what the film holds all the same, and nothing below is called its
// breakdown.
TEST(VoltageSearch, ByAreasGoesOnWhereTheLoadLawIsFull) {
  Scene scene = scene_at(60);
  scene.environment.relative_humidity = {0.15};
  scene.finger.touch_time = 10;
  Fidelity f = tiny();
  const VoltageAnswer load = voltages(scene, {5}, f).at(0);
  ASSERT_EQ(load.end, VoltageEnd::ModelEnds);
  ASSERT_EQ(load.model.trouble, Trouble::FullContact);
  f.estimator = Estimator::Area;
  const VoltageAnswer area = voltages(scene, {5}, f).at(0);
  EXPECT_TRUE(area.end == VoltageEnd::ModelEnds || area.limit == 500) << text(area);
  EXPECT_GT(area.evaluations, load.evaluations);
}

// Driven at the amplitude that is stated without a skin, the other skins have the modulation that
// is asked for, but for what a slope leaves of what they are off by at the amplitude of all. The
// sampling error is the jackknife of these. Eq. metrics.6
TEST(VoltageSearch, SaysWhatTheAmplitudeIsWithoutEachSkin) {
  const Scene scene = scene_at(60);
  Fidelity f = tiny();
  f.skins = 4;
  for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
    f.estimator = estimator;
    const UndrivenPatches patches(scene, Texture{}, f);
    const double target = patches.drive(80, estimator).points.front().modulation.value;
    const VoltageAnswer a = voltages(scene, {target}, f).at(0);
    ASSERT_TRUE(a.reached());
    ASSERT_EQ(a.without.size(), 4u);
    const auto others = [&](std::size_t k, double amplitude) {
      return patches.drive(amplitude, estimator).without.at(k).front().modulation.value;
    };
    for (std::size_t k = 0; k < a.without.size(); ++k) {
      const double off = std::abs(others(k, a.amplitude.value) - target);
      EXPECT_NEAR(others(k, a.without[k]), target, 0.3 * off + 5e-3 * target) << k;
    }
    EXPECT_NEAR(a.amplitude.parts.sampling,
                mean_estimate(jackknife_samples(a.amplitude.value, a.without)).se,
                1e-9 * a.amplitude.value);
    EXPECT_GT(a.amplitude.parts.sampling, 0);
  }
  f.skins = 1;
  f.estimator = Estimator::Load;
  EXPECT_TRUE(voltages(scene, {0.1}, f).at(0).without.empty());
}

// A design without a drive has no field of its own; its amplitude has.
TEST(VoltageSearch, HasTheFieldOfItsAmplitude) {
  Fidelity f = tiny();
  f.field_skins = 1;
  Scene scene = scene_at(0);
  scene.environment.relative_humidity = {0.6};
  const double target = 0.5 * modulation(scene, 100);
  Response r = evaluate(scene, Texture{}, f);
  ASSERT_FALSE(r.points[0].field_error);
  add_voltages(r, scene, Texture{}, f, std::vector<double>{target});
  const VoltageAnswer& a = r.points[0].voltages.at(0);
  ASSERT_TRUE(a.reached());
  EXPECT_TRUE(a.field_error);
  EXPECT_NE(a.field_correction, 1);
}

// Nothing is solved of what no field reaches.
TEST(VoltageSearch, OfWhatDoesNotConductSaysThatNoFieldReachesIt) {
  Scene scene = scene_at(0);
  Response r = evaluate(scene, Texture{}, tiny());
  scene.touch.conducts = false;
  add_voltages(r, scene, Texture{}, tiny(), std::vector<double>{0.1, 0.5});
  ASSERT_EQ(r.points[0].voltages.size(), 2u);
  for (const VoltageAnswer& a : r.points[0].voltages) {
    EXPECT_EQ(text(a), "what touches does not conduct: no field reaches it");
    EXPECT_EQ(a.evaluations, 0);
  }
  EXPECT_EQ(r.points[0].voltages[1].target, 0.5);
}

}  // namespace
}  // namespace papilla::tests::voltage_search_test
