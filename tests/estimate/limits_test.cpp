// What is known of a voltage before any field is solved, and how errors go from modulation to it.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "estimate/parameters.h"
#include "estimate/target.h"
#include "estimate/voltage.h"

namespace papilla::tests {
namespace {

TEST(Limits, ABridgePutsAllOfTheVoltageOnTheFilm) {
  Scene scene;
  scene.drive.amplitude = 200;
  const Texture flat;
  EXPECT_DOUBLE_EQ(breakdown_voltage(scene.surface, flat), 500);  // 500 nm at 1 GV/m
  EXPECT_DOUBLE_EQ(bridged_margin(scene.surface, flat, scene.drive, 200), 2.5);
  EXPECT_DOUBLE_EQ(bridged_margin(scene.surface, flat, scene.drive, 50), 10);
  EXPECT_EQ(bridged_margin(scene.surface, flat, scene.drive, 0), kInfinity);
}

// A layer whose corner is beyond a hundredth of the drive's frequency leaves its share to others.
TEST(Limits, ALeakyLayerHasNoMarginThatIsKnownBefore) {
  Scene scene;
  const Texture flat;
  FilmDielectric& layer = scene.surface.dielectric.front();
  layer.resistivity = 1e9;
  const double corner = layer.corner_frequency();
  ASSERT_GT(corner, 0);
  scene.drive.frequency = 101 * corner;
  EXPECT_DOUBLE_EQ(bridged_margin(scene.surface, flat, scene.drive, 200), 2.5);
  scene.drive.frequency = 99 * corner;
  EXPECT_EQ(bridged_margin(scene.surface, flat, scene.drive, 200), kInfinity);
  scene.drive.frequency = 101 * corner;
  scene.drive.waveform = Waveform::Dc;
  EXPECT_EQ(bridged_margin(scene.surface, flat, scene.drive, 200), kInfinity);
}

TEST(Limits, TheAmplitudeEndsAtTheLeastOfFilmSourceAndKey) {
  Scene scene;
  const Texture flat;
  scene.drive.source_compliance = 0;
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, flat), 500);
  scene.drive.source_compliance = 499;
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, flat), 499);
  scene.drive.source_compliance = 501;
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, flat), 500);
  scene.drive.source_compliance = 0;
  scene.surface.dielectric[0].strength = 1e15;
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, flat), 1e5);
}

TEST(Limits, APlanarFilmIsThinnestBelowTheFloorsOfHoles) {
  Scene scene;
  const Texture holes{HoleArray{.depth = 200e-9}};
  EXPECT_NEAR(breakdown_voltage(scene.surface, holes), 500, 1e-9);
  scene.surface.process = FilmProcess::Planar;
  EXPECT_NEAR(breakdown_voltage(scene.surface, holes), 300, 1e-9);
}

TEST(StepFidelity, IsNoFinerThanDifferencesNeedAndNeverFinerThanGiven) {
  Fidelity f = fidelity_level("design");
  const Fidelity few = step_fidelity(f);
  EXPECT_EQ(few.skins, 8);
  EXPECT_EQ(few.grid, 128);
  EXPECT_EQ(few.contact_tolerance, 1e-3);
  EXPECT_EQ(few.estimator, Estimator::Load);
  EXPECT_EQ(few.control_skins, 0);
  EXPECT_EQ(few.field_skins, 0);
  f.skins = 3;
  f.grid = 64;
  f.contact_tolerance = 0.02;
  EXPECT_EQ(step_fidelity(f).skins, 3);
  EXPECT_EQ(step_fidelity(f).grid, 64);
  EXPECT_EQ(step_fidelity(f).contact_tolerance, 0.02);
}

TEST(PilotFidelity, IsTheSmallestPlanWithATenthOfAPercentOfTheTarget) {
  TargetOptions options{.target = 0.05, .seed = 9, .threads = 3};
  const Fidelity f = pilot_fidelity(options);
  EXPECT_EQ(f.level, "target");
  EXPECT_EQ(f.grid, 64);
  EXPECT_EQ(f.skins, 8);
  EXPECT_EQ(f.seed, 9u);
  EXPECT_EQ(f.threads, 3);
  EXPECT_EQ(f.estimator, Estimator::Load);
  EXPECT_DOUBLE_EQ(f.contact_tolerance, 5e-4);
  options.target = 0.5;
  EXPECT_DOUBLE_EQ(pilot_fidelity(options).contact_tolerance, 1e-3);
  options.target = 1e-6;
  EXPECT_DOUBLE_EQ(pilot_fidelity(options).contact_tolerance, 1e-6);
}

// Modulation goes with the square of a voltage that is small: half of its relative error is the
// voltage's, and the search adds a thousandth.
TEST(VoltageErrors, AreHalfThoseOfTheModulation) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.35};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 4;
  f.threads = 1;
  Response r = evaluate(scene, Texture{}, f);
  const Measured m = r.points[0].modulation;
  const std::vector<double> targets{m.value, 0.25 * m.value};
  add_voltages(r, scene, Texture{}, f, targets);
  const VoltageAnswer& same = r.points[0].voltages.at(0);
  ASSERT_TRUE(same.reached());
  EXPECT_EQ(same.target, m.value);
  EXPECT_NEAR(same.amplitude.value, 100, 0.5);
  EXPECT_NEAR(same.modulation, m.value, 0.01 * m.value);
  EXPECT_NEAR(same.amplitude.parts.sampling / 100, m.parts.sampling / m.value / 2,
              0.1 * m.parts.sampling / m.value / 2);
  const double solver = 100 * m.parts.solver.value_or(0) / m.value / 2;
  EXPECT_NEAR(same.amplitude.parts.solver.value_or(0), std::hypot(solver, 0.1), 0.1 * solver);
  EXPECT_NEAR(r.points[0].voltages.at(1).amplitude.value, 50, 3);
}

}  // namespace
}  // namespace papilla::tests
