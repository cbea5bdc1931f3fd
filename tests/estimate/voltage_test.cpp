#include "estimate/voltage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "metrics/metrics.h"

namespace papilla::tests::voltage_test {
namespace {

Scene scene_at(double humidity) {
  Scene scene;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {humidity};
  return scene;
}

Fidelity small(Estimator estimator) {
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  f.skins = 3;
  f.estimator = estimator;
  return f;
}

VoltageAnswer voltage(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                      double target) {
  Response r = evaluate(scene, texture, fidelity);
  add_voltages(r, scene, texture, fidelity, std::vector<double>{target});
  return r.points.at(0).voltages.at(0);
}

TEST(VoltageFor, ReachesItsModulationWhenTheDesignIsDrivenSo) {
  for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
    const Fidelity f = small(estimator);
    Scene scene = scene_at(0.35);
    const VoltageAnswer a = voltage(scene, Texture{HoleArray{}}, f, 0.2);
    ASSERT_TRUE(a.reached()) << text(a);
    EXPECT_GT(a.amplitude.se(), 0);
    EXPECT_LE(a.evaluations, 14);
    scene.drive.amplitude = a.amplitude.value;
    const double m = evaluate(scene, Texture{HoleArray{}}, f).points[0].modulation.value;
    EXPECT_NEAR(m, 0.2, estimator == Estimator::Load ? 2e-3 : 6e-3);
  }
}

TEST(VoltageFor, DoesNotDependOnTheAmplitudeOfTheDesign) {
  Scene scene = scene_at(0.55);
  const VoltageAnswer a = voltage(scene, Texture{Flat{}}, small(Estimator::Load), 0.3);
  scene.drive.amplitude = 0;
  const VoltageAnswer b = voltage(scene, Texture{Flat{}}, small(Estimator::Load), 0.3);
  ASSERT_TRUE(a.reached() && b.reached()) << text(a) << text(b);
  EXPECT_NEAR(a.amplitude.value / b.amplitude.value, 1, 2e-3);
}

TEST(VoltageFor, DoesNotDependOnWhatTheDielectricWouldHold) {
  Scene scene = scene_at(0.55);
  scene.drive.amplitude = 90;  // above the answer
  std::vector<double> amplitudes;
  for (const double strength : {1e9, 1e12}) {
    scene.surface.dielectric[0].strength = strength;
    const VoltageAnswer a = voltage(scene, Texture{Flat{}}, small(Estimator::Load), 0.05);
    ASSERT_TRUE(a.reached()) << text(a);
    EXPECT_LT(a.amplitude.value, 80);
    amplitudes.push_back(a.amplitude.value);
  }
  EXPECT_NEAR(amplitudes[1], amplitudes[0], 1e-3 * amplitudes[0]);
}

// Nor where the rule is held against the 3-D field, from which it is farther the higher the
// voltage.
TEST(VoltageFor, HasTheFieldOfItsOwnAmplitude) {
  Fidelity f = small(Estimator::Load);
  f.skins = 2, f.field_skins = 1;
  Scene scene = scene_at(0.55);
  std::vector<double> amplitudes;
  for (const double own : {0.0, 40.0, 300.0}) {
    scene.drive.amplitude = own;
    const VoltageAnswer a = voltage(scene, Texture{Flat{}}, f, 0.3);
    ASSERT_TRUE(a.reached()) << text(a);
    amplitudes.push_back(a.amplitude.value);
  }
  for (const double v : amplitudes) EXPECT_NEAR(v / amplitudes[0], 1, 0.015);
  scene.drive.amplitude = amplitudes[0];
  EXPECT_NEAR(evaluate(scene, Texture{Flat{}}, f).points[0].modulation.value, 0.3, 0.01);
}

TEST(VoltageFor, RisesWithTheModulation) {
  Response r = evaluate(scene_at(0.35), Texture{Flat{}}, small(Estimator::Load));
  const std::vector<double> targets{0.05, 0.2, 0.4};
  add_voltages(r, scene_at(0.35), Texture{Flat{}}, small(Estimator::Load), targets);
  double before = 0;
  for (const VoltageAnswer& a : r.points[0].voltages) {
    ASSERT_TRUE(a.reached()) << text(a);
    EXPECT_GT(a.amplitude.value, before);
    before = a.amplitude.value;
  }
}

TEST(VoltageFor, SaysThatTheDielectricBreaksDownFirst) {
  const VoltageAnswer a = voltage(scene_at(0.35), Texture{Flat{}}, small(Estimator::Load), 1e3);
  EXPECT_FALSE(a.reached());
  EXPECT_EQ(text(a), "the dielectric breaks down at 500 V");  // 500 nm at 1 GV/m
  EXPECT_DOUBLE_EQ(a.limit, 500);
  EXPECT_GT(a.modulation, 0.5);
}

TEST(VoltageFor, SaysThatTheSourceEndsFirst) {
  Scene scene = scene_at(0.35);
  scene.drive.amplitude = 10;
  scene.drive.source_compliance = 20;
  const VoltageAnswer a = voltage(scene, Texture{Flat{}}, small(Estimator::Load), 0.5);
  EXPECT_EQ(text(a), "the source ends at 20 V");
}

TEST(VoltageFor, SaysThatTheGapPullsInFirst) {
  // A dielectric that never breaks down: the search runs into the collapse of the gap.
  Scene scene = scene_at(0.15);
  scene.model.coupling = Coupling::Equilibrium;
  scene.surface.dielectric[0].strength = 1e12;
  scene.surface.dielectric[0].thickness = 20e-9;
  const VoltageAnswer a = voltage(scene, Texture{Flat{}}, small(Estimator::Load), 1e3);
  EXPECT_FALSE(a.reached());
  EXPECT_EQ(a.end, VoltageEnd::ModelEnds);
  EXPECT_TRUE(a.model.pull_in() || a.model.trouble == Trouble::PassesUsedUp ||
              a.model.trouble == Trouble::FullContact)
      << text(a);
  EXPECT_GT(a.limit, 0);
  EXPECT_LT(a.limit, 20e3);
}

TEST(VoltageFor, NeedsADielectric) {
  Scene scene = scene_at(0.35);
  scene.drive.amplitude = 0;
  scene.surface.dielectric.clear();
  EXPECT_EQ(voltage(scene, Texture{Flat{}}, small(Estimator::Load), 0.5).end,
            VoltageEnd::NoDielectric);
}

TEST(VoltageFor, TheStatedEdgeRadiusLowersTheLimit) {
  Scene scene = scene_at(0.35);
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, Texture{HoleArray{}}), 500);
  scene.surface.electrode_edge_radius = 500e-9;
  EXPECT_NEAR(amplitude_limit(scene, Texture{HoleArray{}}), 500 * std::log(2), 1e-9);
  EXPECT_DOUBLE_EQ(amplitude_limit(scene, Texture{Flat{}}), 500);
  // Etched into a planar film, the texture leaves the electrode flat.
  scene.surface.process = FilmProcess::Planar;
  const double planar = amplitude_limit(scene, Texture{HoleArray{}});
  scene.surface.electrode_edge_radius = 0;
  EXPECT_DOUBLE_EQ(planar, amplitude_limit(scene, Texture{HoleArray{}}));
}

TEST(VoltageFor, IsAMetric) {
  Response r = evaluate(scene_at(0.35), Texture{Flat{}}, small(Estimator::Load));
  const MetricExpression e = parse_metric("worst(voltage_for(modulation=0.2))");
  EXPECT_EQ(metric_text(e), "worst(voltage_for(modulation = 0.2))");
  EXPECT_FALSE(summarise(e.summary, e.metric, r));
  add_voltages(r, scene_at(0.35), Texture{Flat{}}, small(Estimator::Load),
               std::vector<double>{std::get<VoltageFor>(e.metric).modulation});
  EXPECT_DOUBLE_EQ(summarise(e.summary, e.metric, r)->value,
                   r.points[0].voltages[0].amplitude.value);
  EXPECT_EQ(metric_text(parse_metric("voltage_for(modulation=0.5)")),
            "mean(voltage_for(modulation = 0.5))");
  for (const char* wrong :
       {"voltage_for", "voltage_for(friction = 1)", "voltage_for(modulation = 0)",
        "worst(voltage_for)", "voltage_for(modulation = x)"}) {
    EXPECT_THROW(parse_metric(wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace papilla::tests::voltage_test
