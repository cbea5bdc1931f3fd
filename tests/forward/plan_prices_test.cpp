// What a plan decides and what it says its pieces cost.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "forward/forward.h"

namespace papilla::tests::plan_prices_test {
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
  scene.finger.water.relative_humidity = {0.5};  // as many droplets at every humidity
  scene.finger.water.volume = {2e-18};
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
  // Two pixels to the shortest wave that every level keeps on the window of 12 um: the key that
  // does is the next whole number.
  const Texture shorter{PillarArray{.period = 30.1e-6, .diameter = 15e-6, .height = 100e-9}};
  f.most_pixels = 128;
  const Plan small = make_plan(driven(), shorter, f);
  const double usual = std::max(small.skin_cutoff, 2 * 12e-6 / 128);
  const double side = std::max(small.grid.lx, small.grid.ly);
  ASSERT_FALSE(small.warnings.empty());
  const std::string key =
      fmt::format("accuracy.grid = {:.0f}, or a period", std::ceil(2 * side / usual));
  EXPECT_NE(std::ceil(2 * side / usual), std::floor(2 * side / usual));
  EXPECT_NE(small.warnings[0].find(key), std::string::npos) << key << "\n" << small.warnings[0];
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

bool warns(const Plan& plan, const std::string& said) {
  for (const std::string& warning : plan.warnings) {
    if (warning.find(said) != std::string::npos) return true;
  }
  return false;
}

// Some two pixels wide: a grid of as many times more as double them to eight.
TEST(PlanWarnings, CoarseFeaturesNameTheGridThatResolvesThem) {
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  const Texture texture{PillarArray{.period = 0.9e-6, .diameter = 0.42e-6, .height = 200e-9}};
  const Plan plan = make_plan(driven(), texture, f);
  const double smallest = facts(texture).margins.smallest();
  const double pixels = smallest / std::max(plan.grid.dx(), plan.grid.dy());
  EXPECT_NEAR(plan.feature_pixels, pixels, 1e-9);
  ASSERT_TRUE(pixels > 2 && pixels < 4) << pixels;
  char said[200];
  std::snprintf(said, sizeof said, "feature of the texture, %.3g nm, is %.2g pixels wide",
                1e9 * smallest, pixels);
  EXPECT_TRUE(warns(plan, said)) << said << plan.warnings.front();
  std::snprintf(said, sizeof said, "accuracy.grid = 256 gives it %.2g", 4 * pixels);
  EXPECT_TRUE(warns(plan, said)) << said << plan.warnings.front();
  f.grid = 256;
  EXPECT_FALSE(warns(make_plan(driven(), texture, f), "pixels wide"));
  const Texture fine{PillarArray{.period = 20e-9, .diameter = 10e-9, .height = 5e-9}};
  EXPECT_TRUE(warns(make_plan(driven(), fine, f), "no grid up to 4096 resolves it"));
}

TEST(PlanWarnings, ADirectVoltageSaysWhenItsPullStays) {
  Scene scene = driven();
  EXPECT_FALSE(warns(plan_of(scene, fidelity_level("search")), "direct voltage"));
  scene.drive.waveform = Waveform::Dc;
  const double a = 1e3 * relaxation_time(scene, 0.5, 0.1e-6),
               b = 1e3 * relaxation_time(scene, 0.5, 1e-6);
  char said[100];
  std::snprintf(said, sizeof said, "%.2g to %.2g ms after the touch (gaps of 0.1 and 1 um)",
                std::min(a, b), std::max(a, b));
  EXPECT_TRUE(warns(plan_of(scene, fidelity_level("search")), said)) << said;
  scene.finger.electrical.gap_resistivity = 0;
  scene.finger.electrical.corner_frequency = 0;
  for (FilmDielectric& layer : scene.surface.dielectric) layer.resistivity = 0;
  EXPECT_TRUE(warns(plan_of(scene, fidelity_level("search")), "nothing leaks"));
}

TEST(PlanWarnings, ACurrentBeyondTheSourceIsNamedByItsHumidities) {
  Scene scene;
  scene.environment.relative_humidity = {0.15, 0.75};
  scene.drive.control = DriveControl::Current;
  scene.drive.current = 0.25e-3;
  scene.drive.source_compliance = 0;
  const double dry = source_voltage(scene, 0.15).peak, moist = source_voltage(scene, 0.75).peak;
  ASSERT_LT(moist, dry);
  scene.drive.source_compliance = 0.5 * (dry + moist);
  EXPECT_TRUE(warns(plan_of(scene, fidelity_level("search")),
                    "at 15 % RH 0.25 mA would need more than source_compliance, "));
  scene.drive.source_compliance = 0.5 * moist;
  EXPECT_TRUE(warns(plan_of(scene, fidelity_level("search")), "at 15 %, 75 % RH 0.25 mA"));
  scene.drive.source_compliance = 2 * dry;
  EXPECT_TRUE(plan_of(scene, fidelity_level("search")).warnings.empty());
}

// What a person reads: a line for each piece, its time and error, its bound, and the sum.
TEST(PlanText, SaysEveryPieceWithItsNumbers) {
  Plan plan;
  plan.grid = {128, 64, 12e-6, 6e-6};
  plan.steps = {{Piece::Contact, "method", "reason", 3, 0.05}, {Piece::Retention, "m", "r", 0, 0}};
  plan.skipped = {{Piece::Kelvin, "why", kInfinity, false},
                  {Piece::Retention, "no water", 0.051, false},
                  {Piece::Coupling, "once", 0.6, true},
                  {Piece::Optics, "apart", 0, true}};
  plan.warnings = {"beware"};
  const std::string text = plan.text();
  EXPECT_TRUE(text.starts_with("patch 12 x 6 um, 128 x 64 pixels of 94 nm\nmodelled:\n"));
  for (const char* said :
       {" reason; about 3 s; error 5.0 %\n", " r\n", " why (no bound)\n",
        " no water (bound 5.1 % of friction)\n", " once (estimate 60 % of friction)\n", " apart\n",
        "\nnot modelled:\n  Kelvin condensation ",
        "\nexpected 3 s on one core of a usual machine\nwarning: beware\n"})
    EXPECT_NE(text.find(said), std::string::npos) << said << text;
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
}  // namespace papilla::tests::plan_prices_test
