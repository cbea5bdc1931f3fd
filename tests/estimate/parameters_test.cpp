#include "estimate/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "design/design.h"
#include "metrics/metrics.h"

namespace papilla::tests::parameters_test {
namespace {

Response of_modulation(const std::vector<double>& values) {
  Response r;
  r.driven = true;
  for (const double v : values) {
    ResponsePoint point;
    point.modulation.value = v;
    r.points.push_back(point);
  }
  return r;
}

Scene small_scene() {
  Scene scene;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.35, 0.65};
  return scene;
}

Fidelity small_fidelity() {
  Fidelity f = fidelity_level("draft");
  f.grid = 64;
  f.skins = 4;
  f.control_skins = 0;
  f.threads = 2;
  return f;
}

// x = (a + 2 b, 3 a - b) of two correlated numbers: mean 2 a + b/2, by hand.
TEST(Parameters, OfALinearModelTheErrorOfTheMeanIsExact) {
  const std::vector<ParameterDeviation> list{{"a", 0.1, {}}, {"b", 0.2, {0.5}}};
  const std::vector<double> l = covariance_factor(list);
  const auto model = [](double a, double b) {
    return of_modulation({1 + a + 2 * b, 1 + 3 * a - b}).points;
  };
  Response r = of_modulation({1, 1});
  for (std::size_t k = 0; k < 2; ++k)
    r.parameters.steps.push_back({{model(l[k], l[2 + k]), {}}, {model(-l[k], -l[2 + k]), {}}});
  const double variance = 4 * square(0.1) + 0.25 * square(0.2) + 2 * 2 * 0.5 * 0.5 * 0.1 * 0.2;
  EXPECT_NEAR(*summarise(Summary::Mean, kModulation, r)->parts.parameters, std::sqrt(variance),
              1e-15);
  // The first humidity alone: a + 2 b.
  const double first = square(0.1) + 4 * square(0.2) + 2 * 2 * 0.5 * 0.1 * 0.2;
  EXPECT_NEAR(*summarise(Summary::First, kModulation, r)->parts.parameters, std::sqrt(first),
              1e-15);
}

// Draws of a change that scatters by 0.2 from skin to skin: little of the scatter is taken for the
// change, and no change for scatter.
TEST(Parameters, WhatSkinsScatterIsTakenOff) {
  RandomStream random(1, "steps", 0);
  constexpr int kDraws = 2000, kSkins = 4;
  constexpr double kScatter = 0.2;
  const auto stated = [&](double change) {
    double squares = 0, least = kInfinity;
    for (int draw = 0; draw < kDraws; ++draw) {
      StepSamples samples(5, std::vector<double>(kSkins));
      for (auto& direction : samples) {
        for (double& s : direction) s = change + kScatter * random.normal();
      }
      const double error = step_error(samples);
      squares += square(error) / kDraws;
      least = std::min(least, error);
    }
    EXPECT_GT(least, 0);
    return std::sqrt(squares / 5);
  };
  EXPECT_LT(stated(0),
            0.65 * kScatter / std::sqrt(kSkins));  // the error of the mean of a direction
  EXPECT_NEAR(stated(0.3), 0.3, 0.03);
  EXPECT_NEAR(stated(1), 1, 0.01);
}

// Friction is proportional to the shear strength, and the modulation free of it.
TEST(Parameters, TheShearStrengthMovesFrictionByItsShareAndNotTheModulation) {
  Scene scene = small_scene();
  scene.finger.water.hysteresis = 0;
  scene.finger.uncertainty = {{"macro.shear_strength", 0.05, {}}};
  const Texture flat;
  Response r = evaluate(scene, flat, small_fidelity());
  EXPECT_FALSE(r.points[0].friction_off.parts.parameters);
  add_parameter_errors(r, scene, flat, small_fidelity());
  const ParameterStep& step = r.parameters.steps.at(0);
  for (std::size_t i = 0; i < r.points.size(); ++i) {
    const ResponsePoint& p = r.points[i];
    EXPECT_NEAR((step.up.points[i].friction_off.value - step.down.points[i].friction_off.value) /
                    2 / p.friction_off.value,
                std::sinh(0.05), 1e-9);
    const double stated = *p.friction_off.parts.parameters / p.friction_off.value;
    EXPECT_LT(stated, std::sinh(0.05));
    EXPECT_GT(stated, 0.97 * std::sinh(0.05));  // skins scatter
    EXPECT_LT(*p.modulation.parts.parameters, 1e-12);
  }
  EXPECT_EQ(r.parameters.steps.size(), 1u);
}

TEST(Parameters, AFingerOfUnknownUncertaintySaysSo) {
  const Scene scene = small_scene();
  Response r;
  EXPECT_THROW(add_parameter_errors(r, scene, Texture{}, small_fidelity()), InputError);
}

}  // namespace
}  // namespace papilla::tests::parameters_test
