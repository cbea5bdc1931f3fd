// The voltage of pull-in as the fold of a patch's branch, beside where its equilibrium is lost.
#include "forward/pull_in.h"

#include <gtest/gtest.h>

#include <cmath>

#include "forward/forward.h"

namespace papilla::tests::pull_in_test {
namespace {

Scene dry(double amplitude) {
  Scene scene;
  scene.drive.amplitude = amplitude;
  scene.environment.relative_humidity = {0.15};
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.model.coupling = Coupling::Equilibrium;
  return scene;
}

// Water that attracts with more than the first steps of the load.
Scene wet(double amplitude, double humidity) {
  Scene scene = dry(amplitude);
  scene.environment.relative_humidity = {humidity};
  scene.finger.water = SkinWater{};
  return scene;
}

Fidelity one_skin() {
  Fidelity f = fidelity_level("design");
  f.grid = 64;
  f.skins = 1;
  f.equilibrium_skins = 1;
  f.control_skins = 0;
  f.field_skins = 0;
  return f;
}

PullIn pull_in_of(const Scene& scene) {
  return pull_in(scene, Texture{}, one_skin(), scene.environment.relative_humidity.front());
}

double margin(const Scene& scene) { return pull_in_of(scene).margin.value; }

// A second method: the search for an equilibrium finds the load at which the branch has closed the
// gap, and no jump before it.
TEST(PullIn, OfAGapThatClosesWithoutAFoldIsTheVoltageOfItsEquilibrium) {
  const PullIn far = pull_in_of(dry(200));
  EXPECT_EQ(far.folds, 0);
  const double volts = 200 * far.margin.value;
  EXPECT_GT(volts, 300);
  const Response r = evaluate(dry(volts), Texture{}, one_skin());
  EXPECT_FALSE(r.points[0].status.pull_in()) << text(r.points[0].status);
  const double over_nominal = r.points[0].samples.load_on[0] / r.points[0].samples.load_off[0] - 1;
  EXPECT_NEAR(std::log(over_nominal), std::log(kClosingLoad), 0.15);
}

TEST(PullIn, IsOneVoltageWhateverTheDrive) {
  const double fold = 250 * margin(dry(250));
  for (const double amplitude : {300.0, 400.0, 1000.0})
    EXPECT_NEAR(amplitude * margin(dry(amplitude)), fold, 0.01 * fold) << amplitude;
  const double with_water = 250 * margin(wet(250, 0.5));
  EXPECT_LT(with_water, 250 * kFarthestPullIn);
  for (const double amplitude : {400.0, 1000.0})
    EXPECT_NEAR(amplitude * margin(wet(amplitude, 0.5)), with_water, 0.01 * with_water)
        << amplitude;
}

// Loads that water holds by itself lie below the branch: it neither ends nor turns there.
TEST(PullIn, OfAWetGapIsBeyondAVoltageThatHasAnEquilibrium) {
  const Scene scene = wet(200, 0.75);
  const ResponsePoint there = evaluate(scene, Texture{}, one_skin()).points[0];
  ASSERT_FALSE(there.status.pull_in()) << text(there.status);
  EXPECT_GT(there.capillary_force.value, 0.1 * scene.finger.load);
  EXPECT_GT(margin(scene), 1);
}

// Without a step over load and film: a second difference is of the size that the curve's own bend
// makes it.
TEST(PullIn, IsSmoothOverLoadAndFilm) {
  const auto expect_smooth = [](const auto& change) {
    std::vector<double> log_margin;
    for (int k = 0; k < 9; ++k) {
      Scene scene = dry(300);
      change(scene, std::exp2(k / 8.0));
      log_margin.push_back(std::log(margin(scene)));
    }
    for (std::size_t k = 1; k + 1 < log_margin.size(); ++k) {
      const double before = log_margin[k] - log_margin[k - 1],
                   after = log_margin[k + 1] - log_margin[k];
      EXPECT_GT(before, 0) << k;
      EXPECT_NEAR(after, before, 0.03) << k;
    }
  };
  expect_smooth([](Scene& s, double factor) { s.finger.load *= factor; });
  expect_smooth([](Scene& s, double factor) { s.surface.dielectric[0].thickness *= factor; });
}

// Air that breaks down holds the pull below what closes a gap under a load of this size.
TEST(PullIn, IsFarWhereAirHoldsThePull) {
  Scene scene = dry(200);
  scene.model.air_limit = AirLimit::Emission;
  Scene moist = wet(200, 0.75);
  moist.model.air_limit = AirLimit::Emission;
  for (const Scene& s : {scene, moist}) {
    const PullIn held = pull_in_of(s);
    EXPECT_EQ(held.margin.value, kFarthestPullIn);
    EXPECT_EQ(held.folds, 0);
  }
}

}  // namespace
}  // namespace papilla::tests::pull_in_test
