// What a plan decides and what it says its pieces cost.
#include <gtest/gtest.h>

#include <cmath>

#include "forward/forward.h"

namespace papilla::tests {
namespace {

Scene driven() {
  Scene scene;
  scene.drive.amplitude = 200;
  return scene;
}

Plan plan_of(const Scene& scene, const Fidelity& f) { return make_plan(scene, Texture{}, f); }

const PlanStep* step(const Plan& plan, Piece piece) {
  for (const PlanStep& s : plan.steps) {
    if (s.piece == piece) return &s;
  }
  return nullptr;
}
const PlanSkip* skip(const Plan& plan, Piece piece) {
  for (const PlanSkip& s : plan.skipped) {
    if (s.piece == piece) return &s;
  }
  return nullptr;
}

TEST(PlanPrices, EveryPatchCostsTheSameAndNodesMultiplyThem) {
  Fidelity f = fidelity_level("search");
  f.skins = 10;
  Scene scene = driven();
  const Plan four = plan_of(scene, f);
  scene.environment.relative_humidity = {0.5};
  const Plan one = plan_of(scene, f);
  scene.model.closure = Closure::Persson;
  f.bridge_nodes = 5;
  const Plan nodes = plan_of(scene, f);
  for (const Piece piece : {Piece::Contact, Piece::Water, Piece::Field}) {
    ASSERT_TRUE(step(one, piece));
    EXPECT_NEAR(step(four, piece)->seconds, 4 * step(one, piece)->seconds, 1e-12);
    EXPECT_NEAR(step(nodes, piece)->seconds, 5 * step(one, piece)->seconds, 1e-12);
  }
  double sum = 0;
  for (const PlanStep& s : four.steps) sum += s.seconds;
  EXPECT_DOUBLE_EQ(four.seconds(), sum);
  EXPECT_TRUE(skip(four, Piece::PatchPressures));
  EXPECT_TRUE(step(nodes, Piece::PatchPressures));
}

TEST(PlanPrices, SolvedAreasTakeASolveForEachState) {
  Fidelity f = fidelity_level("search");
  f.estimator = Estimator::Area;
  Scene scene = driven();
  const Plan driven_plan = plan_of(scene, f);
  EXPECT_TRUE(driven_plan.traction_solves);
  EXPECT_NEAR(step(driven_plan, Piece::Tractions)->seconds,
              2 * step(driven_plan, Piece::Contact)->seconds, 1e-12);
  scene.drive.amplitude = 0;
  const Plan at_rest = plan_of(scene, f);
  EXPECT_NEAR(step(at_rest, Piece::Tractions)->seconds, step(at_rest, Piece::Contact)->seconds,
              1e-12);
  EXPECT_FALSE(at_rest.field);
  EXPECT_TRUE(skip(at_rest, Piece::Field));
  for (double& v : scene.finger.water.volume) v = 0;
  const Plan dry = plan_of(scene, f);
  EXPECT_FALSE(dry.water || dry.traction_solves || dry.retention);
  EXPECT_FALSE(step(dry, Piece::Tractions) || skip(dry, Piece::Tractions));
}

TEST(PlanPrices, RetentionNeedsWaterAndHysteresis) {
  const Fidelity f = fidelity_level("search");
  Scene scene = driven();
  EXPECT_TRUE(plan_of(scene, f).retention);
  scene.finger.water.hysteresis = 0;
  EXPECT_FALSE(plan_of(scene, f).retention);
  scene = driven();
  for (double& v : scene.finger.water.volume) v = 0;
  EXPECT_FALSE(plan_of(scene, f).retention);
}

TEST(PlanPrices, TheScatterFallsWithTheRootOfTheSkins) {
  Fidelity f = fidelity_level("search");
  f.skins = 9;
  EXPECT_NEAR(step(plan_of(driven(), f), Piece::Sampling)->error, 0.03, 1e-12);
  f.estimator = Estimator::Area;
  f.skins = 121;
  EXPECT_NEAR(step(plan_of(driven(), f), Piece::Sampling)->error, 0.01, 1e-12);
}

// Controls: half the pixels, and with the load law solved areas once more.
TEST(PlanPrices, ControlSkinsAreCountedFromTwo) {
  Fidelity f = fidelity_level("search");
  f.skins = 8;
  f.control_skins = 1;
  EXPECT_FALSE(step(plan_of(driven(), f), Piece::Errors));
  f.control_skins = 2;
  const double two = step(plan_of(driven(), f), Piece::Errors)->seconds;
  f.control_skins = 6;
  EXPECT_NEAR(step(plan_of(driven(), f), Piece::Errors)->seconds, 3 * two, 1e-12);
  f.control_skins = 80;  // no more than there are
  EXPECT_NEAR(step(plan_of(driven(), f), Piece::Errors)->seconds, 4 * two, 1e-12);
  f.skins = 80;
  EXPECT_NEAR(step(plan_of(driven(), f), Piece::Errors)->seconds, 40 * two, 1e-10);
}

TEST(PlanPrices, FeaturesAreCountedInTheCoarserPixel) {
  const Texture texture{PillarArray{.period = 5e-6, .diameter = 2e-6, .height = 100e-9}};
  const Plan plan = make_plan(driven(), texture, fidelity_level("search"));
  EXPECT_NEAR(plan.feature_pixels,
              facts(texture).margins.smallest() / std::max(plan.grid.dx(), plan.grid.dy()), 1e-9);
  EXPECT_GT(plan.feature_pixels, 10);
  EXPECT_LE(plan.feature_pixels, 2e-6 / plan.grid.dx());
}

// A patch of a millimetre has pixels for longer waves than the window of every other.
TEST(PlanPrices, ASkinWithoutItsWavesIsSaidInNanometres) {
  Fidelity f = fidelity_level("search");
  const Texture texture{PillarArray{.period = 1e-3, .diameter = 0.5e-3, .height = 100e-9}};
  const Plan plan = make_plan(driven(), texture, f);
  ASSERT_GT(plan.effective_cutoff, 1e-7);
  const std::string said =
      "no waves below " + std::to_string(std::lround(1e9 * plan.effective_cutoff)) +
      " nm (the finger's end at " + std::to_string(std::lround(1e9 * plan.skin_cutoff)) + " nm)";
  bool found = false;
  for (const std::string& warning : plan.warnings)
    found = found || warning.find(said) != std::string::npos;
  EXPECT_TRUE(found) << said << "\n" << (plan.warnings.empty() ? "" : plan.warnings[0]);
}

TEST(PlanPrices, ATimeIsSaidInItsUnit) {
  EXPECT_EQ(duration(0.123), "0.12 s");
  EXPECT_EQ(duration(9.94), "9.9 s");
  EXPECT_EQ(duration(12), "12 s");
  EXPECT_EQ(duration(120), "120 s");
  EXPECT_EQ(duration(150.1), "3 min");
  EXPECT_EQ(duration(7200), "120 min");
  EXPECT_EQ(duration(9000.1), "3 h");
}

TEST(TargetReport, SaysWhichPartIsLeftAndTheLimits) {
  TargetReport r;
  r.quantity = "mean(friction)";
  r.end = TargetEnd::LimitsReached;
  r.largest_part = "grid";
  r.largest_share = 0.034;
  r.largest_grid = 512;
  r.most_skins = 192;
  EXPECT_EQ(text(r), "not reached: grid 3.4 % is the largest part; at most 512 pixels, 192 skins");
  r.end = TargetEnd::NoRelativeError;
  EXPECT_EQ(text(r), "mean(friction) is zero: no relative error");
  r.end = TargetEnd::Reached;
  EXPECT_EQ(text(r), "reached");
}

}  // namespace
}  // namespace papilla::tests
