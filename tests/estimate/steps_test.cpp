// Steps of numbers to their borders, differences with all that they say, and refusals in full.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "estimate/difference.h"
#include "estimate/evaluation.h"
#include "estimate/parameters.h"
#include "forward/forward.h"

namespace papilla::tests::steps_test {
namespace {

Design holes(double period, double diameter) {
  Design d;
  d.texture = Texture{HoleArray{.period = period, .diameter = diameter, .depth = 300e-9}};
  return d;
}

// Contact angles of 0 to 180 deg and loads of 0 to 100 N: no step leads beyond.
TEST(Steps, EndAtTheRangeOfTheirKey) {
  Design d = holes(10e-6, 4e-6);
  const double degree = std::acos(-1.0) / 180;
  d.surface.contact_angle = 150 * degree;
  DesignStep step = design_step(d, "surface.contact_angle", 0.5);
  EXPECT_EQ(step.unit, "deg");
  EXPECT_EQ(step.value, d.surface.contact_angle);
  EXPECT_NEAR(step.down, 75 * degree, 1e-12);
  EXPECT_NEAR(step.up, 180 * degree, 1e-12);
  step = design_step(d, "surface.contact_angle", 2);
  EXPECT_NEAR(step.down, 0, 1e-15);
  d.surface.contact_angle = 0;
  step = design_step(d, "surface.contact_angle", 0.1);
  EXPECT_EQ(step.down, 0);
  EXPECT_NEAR(step.up, 18 * degree, 1e-12);
  EXPECT_TRUE(step.moves());
  EXPECT_FALSE((DesignStep{"p", "m", 1, 1, 1}).moves());
}

TEST(Steps, OfADifferenceSayWhatHasNoValue) {
  Response r;
  r.driven = false;
  r.points.resize(1);
  const auto refusal = [&](auto&& call) -> std::string {
    try {
      call();
    } catch (const InputError& e) {
      return e.problems().at(0).key + ": " + e.problems().at(0).message;
    }
    return "";
  };
  Response sound = r;
  sound.driven = true;
  EXPECT_EQ(refusal([&] { difference_of(parse_metric("modulation"), sound, r); }),
            "metric: modulation has no value here: not driven (0 V)");
  EXPECT_EQ(refusal([&] { difference_of(parse_metric("modulation"), r, sound); }),
            "metric: modulation has no value here: not driven (0 V)");
  EXPECT_EQ(refusal([&] { difference_at(0, VoltageFor{0.2}, sound, sound); }),
            "metric: voltage_for(modulation = 0.2) has no value here");
  EXPECT_EQ(refusal([&] { difference_of(parse_metric("friction"), sound, r); }), "");
}

// Two skins of a friction of 2 and 4, and of 3 and 8: the difference of the pairs is 1 and 4, its
// mean 2.5 with the standard error 1.5.
TEST(Steps, ADifferenceOfTheSameSkinsIsThatOfItsPairs) {
  const auto response = [](double a, double b) {
    Response r;
    r.driven = false;
    r.points.resize(1);
    r.points[0].friction_off.value = (a + b) / 2;
    r.points[0].friction_off.parts.sampling = 9;
    for (const double other : {b, a}) {
      r.without.emplace_back(1);
      r.without.back()[0].friction_off.value = other;
    }
    return r;
  };
  const Response first = response(2, 4), second = response(3, 8);
  for (const ResponseDifference& d : {difference_at(0, kFriction, first, second),
                                      difference_of(parse_metric("friction"), first, second)}) {
    EXPECT_TRUE(d.paired);
    EXPECT_NEAR(d.value, 2.5, 1e-12);
    EXPECT_NEAR(d.error, 1.5, 1e-12);
  }
}

// Of each number of a response: half the difference of the moved fingers, one standard error; what
// the steps cost is in what the response cost.
TEST(Steps, OfTheFingersParametersAreInEveryNumberAndInTheCost) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.35};
  scene.finger.uncertainty = {{"macro.shear_strength", 0.1, {}}, {"skin.rms", 0.1, {}}};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 3;
  f.threads = 1;
  const Response before = evaluate(scene, Texture{}, f);
  Response r = before;
  add_parameter_errors(r, scene, Texture{}, f);
  EXPECT_EQ(r.parameters.skins, 3);
  EXPECT_EQ(r.parameters.grid, 32);
  EXPECT_TRUE(r.parameters.troubles.empty());
  const std::vector<FingerStep> steps = finger_steps(scene.finger);
  ASSERT_EQ(r.parameters.steps.size(), 2u);
  int solves = before.contact_solves;
  double pairs = before.fft_pairs;
  std::vector<Response> moved;
  for (const FingerStep& step : steps) {
    for (const Finger& finger : {step.up, step.down}) {
      Scene there = scene;
      there.finger = finger;
      moved.push_back(evaluate(there, Texture{}, step_fidelity(f)));
      solves += moved.back().contact_solves;
      pairs += moved.back().fft_pairs;
    }
  }
  EXPECT_EQ(r.contact_solves, solves);
  EXPECT_EQ(r.fft_pairs, pairs);
  EXPECT_GT(r.seconds, before.seconds);
  for (const PointQuantity& quantity : kPointQuantities) {
    const auto value = [&](const std::vector<ResponsePoint>& points) {
      return std::optional((points[0].*quantity.value).value);
    };
    const std::vector<ParameterStep> by_hand{{moved[0], moved[1]}, {moved[2], moved[3]}};
    EXPECT_NEAR((r.points[0].*quantity.value).parts.parameters.value(),
                step_error(*step_samples(by_hand, value)), 1e-12);
  }
  const Measured& known = r.points[0].modulation;
  for (const ParameterStep& step : r.parameters.steps) {
    for (const Resampled& run : {step.up, step.down})
      EXPECT_NEAR(run.points[0].felt_error.value(), known.parts.numerical() / (1 + known.value),
                  1e-12);
  }
}

// As a share of F_on/F_off, without what the steps themselves say; no other number of the run
// changes.
TEST(Steps, WhatIsFeltOfARunTakesTheErrorOfItsResponse) {
  const auto points = [](double first, double second, double error) {
    std::vector<ResponsePoint> out(2);
    out[0].modulation = {first, {.sampling = error}};
    out[1].modulation = {second, {.sampling = error}};
    return out;
  };
  Resampled run{points(0.19, 0.1, 0.006), {points(0.18, 0.1, 0.006)}};
  const Resampled before = run;
  std::vector<ResponsePoint> response = points(-0.2, 0, 0.04);
  response[1].modulation.parts.parameters = 0.1;
  take_felt_errors(run, response);
  EXPECT_NEAR(run.points[0].felt_error.value(), 0.05, 1e-12);
  EXPECT_NEAR(run.without[0][0].felt_error.value(), 0.05, 1e-12);
  EXPECT_NEAR(run.points[1].felt_error.value(), 0.04, 1e-12);
  for (ResponsePoint& point : run.points) point.felt_error.reset();
  EXPECT_EQ(run.points, before.points);
}

// What the file asks for, what the options ask for instead of it.
TEST(Evaluation, TheOptionsTargetComesBeforeTheFiles) {
  Design d;
  d.environment.relative_humidity = {0.35};
  d.accuracy.level = AccuracyLevel::Draft;
  d.accuracy.grid = 32;
  d.accuracy.seed = 5;
  d.accuracy.target = 9;
  const Response by_file = evaluate_design(d);
  EXPECT_EQ(by_file.accuracy.target, 9);
  EXPECT_EQ(by_file.fidelity.seed, 5u);
  EXPECT_EQ(by_file.fidelity.grid, 64);  // of the pilot
  EXPECT_EQ(evaluate_design(d, {.target = 8, .voltage_for = {}}).accuracy.target, 8);
  d.accuracy.target = 0;
  EXPECT_EQ(evaluate_design(d).fidelity.grid, 32);
}

TEST(Evaluation, AModelThatTheFingerWasNotFittedWithIsRefused) {
  Design d;
  EXPECT_NO_THROW(require_fitted_model(d, "mine.toml", "run with --force"));
  d.model.air_limit = AirLimit::Emission;
  d.model.rim_pinning = true;
  try {
    require_fitted_model(d, "mine.toml", "run with --force");
    FAIL();
  } catch (const InputError& e) {
    ASSERT_EQ(e.problems().size(), 3u);
    EXPECT_EQ(e.problems()[0].file, "mine.toml");
    EXPECT_EQ(
        e.problems()[0].message,
        "model.air_limit is \"emission\", the finger \"reference\" was fitted with \"ionisation\"");
    EXPECT_EQ(e.problems()[2].message,
              "such a change moves the modulation by tens of percent; fit the finger again, or run "
              "with --force");
  }
}

}  // namespace
}  // namespace papilla::tests::steps_test
