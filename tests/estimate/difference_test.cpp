// Differences of responses and steps of numbers, by hand.
#include "estimate/difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "estimate/evaluation.h"
#include "forward/forward.h"

namespace papilla::tests::difference_test {
namespace {

Response with_friction(double dry, double wet, double error) {
  Response r;
  r.driven = false;
  for (const double value : {dry, wet}) {
    ResponsePoint p;
    p.friction_off.value = value;
    p.friction_off.parts.sampling = error;
    r.points.push_back(p);
  }
  return r;
}

TEST(Difference, IsTheSecondLessTheFirstWithBothErrorsInSquares) {
  const Response a = with_friction(1, 2, 0.03), b = with_friction(5, 9, 0.04);
  const ResponseDifference dry = difference_at(0, kFriction, a, b);
  EXPECT_DOUBLE_EQ(dry.value, 4);
  EXPECT_NEAR(dry.error, 0.05, 1e-12);
  EXPECT_FALSE(dry.paired);
  EXPECT_DOUBLE_EQ(difference_at(1, kFriction, a, b).value, 7);
  EXPECT_DOUBLE_EQ(difference_at(1, kFriction, b, a).value, -7);
  EXPECT_DOUBLE_EQ(difference_of(parse_metric("mean(friction)"), a, b).value, 5.5);
  EXPECT_THROW(difference_of(parse_metric("mean(modulation)"), a, b), InputError);
}

// Of a film that breaks down there are numbers without the drive, and none under it.
TEST(Difference, OfAStateThatDoesNotExistIsNoNumber) {
  Response sound = with_friction(1, 2, 0.03), broken = with_friction(5, 9, 0.04);
  sound.driven = broken.driven = true;
  broken.points[1].oxide_margin = 0.5;
  for (const auto& [a, b] : {std::pair(sound, broken), std::pair(broken, sound)}) {
    EXPECT_TRUE(std::isfinite(difference_at(0, kModulation, a, b).value));
    EXPECT_TRUE(std::isnan(difference_at(1, kModulation, a, b).value));
    const ResponseDifference mean = difference_of(parse_metric("mean(modulation)"), a, b);
    EXPECT_TRUE(std::isnan(mean.value) && std::isnan(mean.error) && !mean.paired && !mean.model);
    EXPECT_TRUE(std::isfinite(difference_of(parse_metric("mean(friction)"), a, b).value));
    EXPECT_TRUE(std::isfinite(difference_of(parse_metric("mean(drive.amplitude)"), a, b).value));
  }
}

TEST(Difference, OfTheSameSkinsIsPairedAndOfADesignFromItselfNothing) {
  Scene scene;
  scene.environment.relative_humidity = {0.35};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 4;
  f.threads = 1;
  const Response a = evaluate(scene, Texture{}, f);
  scene.finger.macro.shear_strength *= 1.5;
  scene.finger.water.hysteresis = 0;
  const Response b = evaluate(scene, Texture{}, f);
  const ResponseDifference none = difference_at(0, kFriction, a, a);
  EXPECT_TRUE(none.paired);
  EXPECT_EQ(none.value, 0);
  EXPECT_NEAR(none.error, 0, 1e-15);
  const ResponseDifference more = difference_at(0, kFriction, a, b);
  EXPECT_TRUE(more.paired);
  EXPECT_LT(more.error, std::hypot(a.points[0].friction_off.se(), b.points[0].friction_off.se()));
  EXPECT_DOUBLE_EQ(more.error, difference_at(0, kFriction, b, a).error);
}

Design holes(double period, double diameter) {
  Design d;
  d.texture = Texture{HoleArray{.period = period, .diameter = diameter, .depth = 300e-9}};
  return d;
}

TEST(DesignStep, IsAShareOfTheValueBothWays) {
  const DesignStep step = design_step(holes(10e-6, 4e-6), "texture.diameter", 0.1);
  EXPECT_EQ(step.path, "texture.diameter");
  EXPECT_DOUBLE_EQ(step.value, 4e-6);
  EXPECT_NEAR(step.down, 3.6e-6, 1e-15);
  EXPECT_NEAR(step.up, 4.4e-6, 1e-15);
  EXPECT_TRUE(step.moves());
  EXPECT_THROW(design_step(holes(10e-6, 4e-6), "texture.nothing", 0.1), InputError);
}

// A hole is no wider than its period: of 20 % up half the way is left, and of 50 % none.
TEST(DesignStep, GoesHalfTheWayWhereTheWholeIsForbidden) {
  const Design d = holes(5e-6, 4.2e-6);
  const DesignStep half = design_step(d, "texture.diameter", 0.2);
  EXPECT_NEAR(half.down, 0.8 * 4.2e-6, 1e-15);
  EXPECT_NEAR(half.up, 1.1 * 4.2e-6, 1e-15);
  const DesignStep none = design_step(d, "texture.diameter", 0.5);
  EXPECT_EQ(none.up, 4.2e-6);
  EXPECT_NEAR(none.down, 0.5 * 4.2e-6, 1e-15);
}

TEST(DesignStep, OfNothingIsAShareOfTheRangeAndStaysInIt) {
  Design d = holes(10e-6, 4e-6);
  d.surface.contact_angle = 0;
  const DesignStep step = design_step(d, "surface.contact_angle", 0.1);
  EXPECT_EQ(step.down, 0);
  EXPECT_GT(step.up, 0);
  EXPECT_NEAR(design_step(d, "surface.contact_angle", 0.2).up, 2 * step.up, 1e-12);
}

TEST(DesignStep, ATexturesNumbersAreItsOwnAndTheContactAngle) {
  const std::vector<std::string> numbers = texture_numbers(holes(10e-6, 4e-6));
  for (const char* name : {"texture.period", "texture.diameter", "texture.depth"})
    EXPECT_EQ(std::count(numbers.begin(), numbers.end(), name), 1) << name;
  EXPECT_EQ(numbers.back(), "surface.contact_angle");
}

TEST(Evaluation, GivesWhatADesignOrItsOptionsAskFor) {
  Design d;
  d.accuracy.level = AccuracyLevel::Draft;
  d.accuracy.grid = 32;
  d.environment.relative_humidity = {0.35};
  d.drive.amplitude = 100;
  d.finger.uncertainty = {{"macro.shear_strength", 0.05, {}}};
  const Response plain = evaluate_design(d);
  EXPECT_EQ(plain.fidelity.grid, 32);
  EXPECT_FALSE(plain.appearance);
  EXPECT_TRUE(plain.parameters.steps.empty());
  EXPECT_TRUE(plain.points[0].voltages.empty());
  EXPECT_EQ(plain.accuracy.target, 0);
  EXPECT_DOUBLE_EQ(plain.points[0].bridged_margin, 5);  // 500 nm of 1 GV/m, at 100 V
  const Response all = evaluate_design(
      d, {.parameters = true, .appearance = true, .voltage_for = {0.1}, .threads = 3});
  EXPECT_TRUE(all.appearance);
  EXPECT_EQ(all.fidelity.threads, 3);
  EXPECT_EQ(all.parameters.steps.size(), 1u);
  EXPECT_EQ(all.points[0].voltages.size(), 1u);
  EXPECT_EQ(all.points[0].friction_on.value, plain.points[0].friction_on.value);
  EXPECT_GT(all.contact_solves, plain.contact_solves);
  EXPECT_GT(all.fft_pairs, plain.fft_pairs);
  EXPECT_GT(all.seconds, 0);
  d.accuracy.parameters = true;  // by the file
  EXPECT_EQ(evaluate_design(d).parameters.steps.size(), 1u);
}

}  // namespace
}  // namespace papilla::tests::difference_test
