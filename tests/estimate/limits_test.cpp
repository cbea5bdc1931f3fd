// What is known of a voltage before any field is solved, and how errors go from modulation to it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "base/constants.h"
#include "estimate/parameters.h"
#include "estimate/target.h"
#include "estimate/voltage.h"
#include "forward/undriven.h"
#include "metrics/metrics.h"
#include "physics/electrostatics/electrode.h"

namespace papilla::tests::limits_test {
namespace {

TEST(Limits, ABridgePutsAllOfTheVoltageOnTheFilm) {
  Scene scene;
  scene.drive.amplitude = 200;
  const Texture flat;
  EXPECT_DOUBLE_EQ(breakdown_voltage(scene.surface, flat, scene.drive), 500);  // 500 nm at 1 GV/m
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

// 100 nm of SiO2 on 10 um of a polymer that leaks: a direct voltage stands on the oxide, a fast one
// on both by d/eps.
TEST(Limits, LayersThatLeakLeaveTheVoltageToThoseThatDoNot) {
  Scene scene;
  const Texture flat;
  scene.drive.source_compliance = 0;
  FilmDielectric oxide = scene.surface.dielectric.front(), polymer = oxide;
  oxide.thickness = 100e-9;
  polymer.thickness = 10e-6, polymer.permittivity = 3, polymer.resistivity = 1e8;
  for (const auto& film : {std::vector{oxide, polymer}, std::vector{polymer, oxide}}) {
    scene.surface.dielectric = film;
    scene.drive.waveform = Waveform::Dc;
    EXPECT_NEAR(amplitude_limit(scene, flat), 100, 0.02);
    // Of 25.6 and 3333 nm, of which the polymer leaks not yet: 1 GV/m in the polymer comes first.
    scene.drive.waveform = Waveform::Sine;
    scene.drive.frequency = 1e6;
    const double series = 100e-9 / 3.9 + 10e-6 / 3;
    EXPECT_NEAR(amplitude_limit(scene, flat), 1e9 * 3 * series, 1e-4 * 1e9 * 3 * series);
    // At its corner the polymer is as much resistor as capacitor: |0.5 - 0.5i| of its d/eps.
    scene.drive.frequency = polymer.corner_frequency();
    const double there = std::hypot(100e-9 / 3.9 + 0.5 * 10e-6 / 3, 0.5 * 10e-6 / 3);
    EXPECT_NEAR(amplitude_limit(scene, flat),
                1e9 * std::min(3.9 * there, 3 * there / std::sqrt(0.5)), 1);
  }
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
  EXPECT_NEAR(breakdown_voltage(scene.surface, holes, scene.drive), 500, 1e-9);
  scene.surface.process = FilmProcess::Planar;
  EXPECT_NEAR(breakdown_voltage(scene.surface, holes, scene.drive), 300, 1e-9);
}

TEST(Limits, ADirectionalFilmIsThinnestOnTheWallsOfHoles) {
  Scene scene;
  scene.surface.process = FilmProcess::Directional;
  const auto breaks = [&](const Texture& t) {
    return breakdown_voltage(scene.surface, t, scene.drive);
  };
  const auto holes = [](double depth) {
    return Texture{HoleArray{.depth = depth, .wall_angle = 0.5 * kPi}};
  };
  EXPECT_NEAR(breaks(holes(350e-9)), 150, 1e-9);
  EXPECT_EQ(breaks(holes(900e-9)), 0);
  EXPECT_EQ(bridged_margin(scene.surface, holes(900e-9), scene.drive, 100), 0);
  // Two of a slope of 2 to 1 whose depth is four times the film's: 500 nm cos(63.4 deg).
  EXPECT_NEAR(breaks({VGrooves{.width = 2e-6, .depth = 2e-6}}), 500 / std::sqrt(5.0), 1e-9);
  // Nothing is known of the walls of what is random.
  EXPECT_NEAR(breaks({RandomRough{.rms = 300e-9}}), 500, 1e-9);
  scene.surface.step_coverage = 0.1;
  EXPECT_NEAR(breaks(holes(900e-9)), 50, 1e-9);
  EXPECT_NEAR(breaks(holes(350e-9)), 500 * std::sqrt(0.09 + 0.01 * 0.91), 1e-9);
}

// Whatever touches where: no column of the film that the rules see is thinner to the field.
TEST(Limits, NoColumnOfTheFilmIsThinnerThanItsThinnestPlace) {
  Surface surface;
  surface.process = FilmProcess::Directional;
  for (const double coverage : {0.0, 0.3, 1.0}) {
    for (const double angle : {45.0, 88.0}) {
      surface.step_coverage = coverage;
      const Texture grooves{Grating{
          .period = 3e-6, .width = 1.5e-6, .depth = 350e-9, .wall_angle = angle * kPi / 180}};
      const CoveredSurface film(generate(grooves, {300, 4, 3e-6, 40e-9}), film_layers(surface));
      const double thinnest = *std::min_element(film.effective.begin(), film.effective.end());
      const double volts = breakdown_voltage(surface, grooves, {});  // 1 GV/m x thickness
      constexpr double kPixels = 1e-3;                               // of the ellipsoid
      EXPECT_GE(thinnest * (1 + kPixels), volts / 1e9 / 3.9) << coverage << ' ' << angle;
    }
  }
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

// dV/V = dm/m over the power with which the modulation m goes with the voltage V.
TEST(VoltageErrors, FollowTheSlopeBetweenTheBrackets) {
  Scene scene;
  scene.drive.amplitude = 60;
  scene.environment.relative_humidity = {0.35};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 4;
  f.threads = 1;
  Response r = evaluate(scene, Texture{}, f);
  const double m = r.points[0].modulation.value;
  const std::vector<double> targets{4 * m, 3 * m, 0.1 * m};
  add_voltages(r, scene, Texture{}, f, targets);
  const UndrivenPatches patches(scene, Texture{}, f);
  for (const VoltageAnswer& answer : r.points[0].voltages) {
    ASSERT_TRUE(answer.reached()) << text(answer);
    const double v = answer.amplitude.value;
    const auto modulation = [&](double amplitude) {
      return patches.drive(amplitude, Estimator::Load).points.front().modulation;
    };
    const Measured at = modulation(v);
    const double power =
        std::log(modulation(1.02 * v).value / modulation(v / 1.02).value) / (2 * std::log(1.02));
    EXPECT_NEAR(answer.amplitude.parts.sampling, v * at.parts.sampling / (power * at.value),
                0.01 * answer.amplitude.parts.sampling);
  }
}

// A contact that is solved to no tolerance at all is a trouble that no voltage cures.
TEST(VoltageFor, EndsWhereTheModelItselfIsUnsound) {
  Scene scene;
  scene.drive.amplitude = 60;
  scene.environment.relative_humidity = {0.35};
  Fidelity f = fidelity_level("search");
  f.grid = 32;
  f.skins = 2;
  f.threads = 1;
  f.control_skins = 0;
  f.contact_tolerance = -1;  // that no residual keeps
  Response r = evaluate(scene, Texture{}, f);
  ASSERT_EQ(r.points[0].status.trouble, Trouble::ContactUnsolved);
  add_voltages(r, scene, Texture{}, f, std::vector<double>{0.1});
  const VoltageAnswer& answer = r.points[0].voltages.at(0);
  EXPECT_EQ(answer.end, VoltageEnd::Unsound);
  EXPECT_EQ(answer.model.trouble, Trouble::ContactUnsolved);
  EXPECT_EQ(answer.evaluations, 1);
  EXPECT_EQ(answer.amplitude.value, 0);
}

// Nine skins are enough by the pilot's scatter, and nine are the most: no tenth is run.
TEST(Target, NeverRunsMoreSkinsThanItMay) {
  Scene scene;
  scene.environment.relative_humidity = {0.35};
  scene.finger.skin.cutoff = 1.5e-6;  // resolved by the pilot: the scatter is what is left
  TargetOptions options{.target = 10, .largest_grid = 64, .most_skins = 9, .threads = 2};
  const Response pilot = evaluate_to_target(scene, Texture{}, options);
  EXPECT_EQ(pilot.accuracy.end, TargetEnd::Reached);
  EXPECT_EQ(pilot.accuracy.steps.size(), 1u);
  EXPECT_EQ(pilot.fidelity.skins, 8);
  EXPECT_EQ(pilot.accuracy.quantity, "mean(friction)");
  const auto friction = *summarise(Summary::Mean, kFriction, pilot);
  EXPECT_NEAR(pilot.accuracy.reached, friction.parts.total() / friction.value, 1e-12);
  // The tolerance of the contact follows the target: once more with nearly the one to come.
  options.target = 1.001 * pilot.accuracy.reached;
  const Response again = evaluate_to_target(scene, Texture{}, options);
  ASSERT_EQ(again.accuracy.steps.size(), 1u);
  const auto there = *summarise(Summary::Mean, kFriction, again);
  options.target =
      std::sqrt(square(there.parts.total()) - square(there.parts.sampling) * (1 - 8 / 8.5)) /
      there.value;
  const Response more = evaluate_to_target(scene, Texture{}, options);
  ASSERT_EQ(more.accuracy.steps.size(), 2u);
  EXPECT_EQ(more.points[0].samples.load_off.size(), 9u);
  EXPECT_GT(more.contact_solves, pilot.contact_solves);
}

// Eight skins on 64 pixels are all there may be: what is left is said, by its largest part.
TEST(Target, OutOfReachNamesTheLargestPartAndTheLimits) {
  Scene scene;
  scene.environment.relative_humidity = {0.35};
  TargetOptions options{.target = 0.003, .largest_grid = 64, .most_skins = 8, .threads = 2};
  const Response r = evaluate_to_target(scene, Texture{}, options);
  EXPECT_EQ(r.accuracy.end, TargetEnd::LimitsReached);
  EXPECT_EQ(r.accuracy.target, 0.003);
  EXPECT_EQ(r.accuracy.largest_grid, 64);
  EXPECT_EQ(r.accuracy.most_skins, 8);
  const auto friction = *summarise(Summary::Mean, kFriction, r);
  const double grid = *friction.parts.grid / friction.value;
  EXPECT_GT(grid, friction.parts.sampling / friction.value);
  EXPECT_STREQ(r.accuracy.largest_part, "grid");
  EXPECT_NEAR(r.accuracy.largest_share, grid, 1e-12);
  EXPECT_NEAR(r.accuracy.reached, friction.parts.total() / friction.value, 1e-12);
  char first[100];
  std::snprintf(first, sizeof first,
                "pilot: 64 pixels, load law, 8 skins: sampling %.2f %%, grid %.2f %%",
                100 * friction.parts.sampling / friction.value, 100 * grid);
  EXPECT_TRUE(r.accuracy.steps.front().starts_with(first)) << r.accuracy.steps.front();
  options.target = 0.01;
  options.largest_grid = 512;
  options.most_seconds = 1e-9;
  const Response spent = evaluate_to_target(scene, Texture{}, options);
  EXPECT_EQ(spent.accuracy.end, TargetEnd::TimeSpent);
  EXPECT_EQ(spent.accuracy.steps.size(), 1u);
}

TEST(Target, OfZeroHasNoRelativeError) {
  Scene scene;
  scene.environment.relative_humidity = {0.35};
  scene.finger.macro.shear_strength = 0;
  scene.finger.water.hysteresis = 0;
  const Response r =
      evaluate_to_target(scene, Texture{}, {.target = 0.05, .largest_grid = 64, .threads = 1});
  EXPECT_EQ(summarise(Summary::Mean, kFriction, r)->value, 0);
  EXPECT_EQ(r.accuracy.end, TargetEnd::NoRelativeError);
  EXPECT_EQ(r.accuracy.steps.size(), 1u);
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
}  // namespace papilla::tests::limits_test
