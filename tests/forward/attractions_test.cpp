// Attractions across known gaps, and the band of the water from patches whose loads are known.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "forward/forward.h"
#include "forward/skips.h"
#include "forward/water_band.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla::tests::attractions_test {
namespace {

TEST(Attraction, VanDerWaalsFallsWithTheCubeOfTheGapAndStopsInContact) {
  const Gap gap{{2, 2, 1e-6, 1e-6}, {0, 0.7e-9, 1.7e-9, 99.7e-9}};
  const Traction t = van_der_waals_traction(gap);
  EXPECT_EQ(t.value[0], 0);
  EXPECT_NEAR(t.value[1], 5e-20 / (6 * kPi * 1e-27), 1);
  EXPECT_NEAR(t.value[2], t.value[1] / 8, 1);
  EXPECT_NEAR(t.value[3], t.value[1] / 1e6, 1e-3);
}

// Kelvin: RT/Vm ln(1/RH), up to the gap that gamma (cos + cos) over that spans.
TEST(Attraction, OfMenisciIsKelvinsSuctionUpToTheGapThatTheySpan) {
  Scene scene;
  scene.surface.contact_angle = kPi / 3;
  scene.finger.water.contact_angle = 0;
  scene.finger.water.surface_tension = 0.07;
  const double suction = 2479 / 1.8e-5 * std::log(2), widest = 0.07 * 1.5 / suction;
  const Gap gap{{2, 2, 1e-6, 1e-6}, {0, 0.99 * widest, 1.01 * widest, 1e-6}};
  const Traction t = kelvin_traction(gap, scene, 0.5);
  EXPECT_EQ(t.value[0], 0);
  EXPECT_NEAR(t.value[1], suction, 1e-6 * suction);
  EXPECT_EQ(t.value[2], 0);
  EXPECT_EQ(t.value[3], 0);
  EXPECT_EQ(kelvin_traction(gap, scene, 0).mean(), 0);
  EXPECT_EQ(kelvin_traction(gap, scene, 1).mean(), 0);    // saturated air does not suck
  EXPECT_EQ(kelvin_traction(gap, scene, 1.2).mean(), 0);  // nor does it push
  scene.finger.water.contact_angle = 0.7 * kPi;
  EXPECT_EQ(kelvin_traction(gap, scene, 0.5).mean(), 0);  // nothing wets
}

struct Banded {
  ResponsePoint point;
  std::vector<PatchResult> patches;
  Grid grid{16, 16, 10e-6, 10e-6};
  DropletBand band;
};

Banded two_patches() {
  Banded out;
  out.patches.resize(2);
  out.patches[0].load = 1e-6;
  out.patches[1].load = 3e-6;
  out.patches[0].capillary_off = 0.5e-6;
  out.patches[1].capillary_off = 1.5e-6;
  out.patches[0].pull = 2e-6;
  out.patches[1].pull = 1e-6;
  out.patches[0].volume = 2e-18;
  out.patches[1].volume = 4e-18;
  for (PatchResult& p : out.patches) p.bridge_volume = 1e-18;
  out.point.mean_gap.value = 200e-9;
  out.point.bridge_water_share = 0.5;
  out.point.friction_off.value = 2;
  out.point.friction_on.value = 3;
  out.point.capillary_force.value = -0.4;
  out.point.electrostatic_force.value = 0.6;
  out.band = droplet_band(3e-18 / out.grid.area(), 200e-9, 0.5);
  return out;
}

TEST(WaterBand, ReachesForcesWholeAndFrictionsByTheirLoads) {
  Banded b = two_patches();
  add_water_band(b.point, b.patches, WaterModel::Droplets, b.grid, {0.9, 0.9});
  EXPECT_GT(b.band.capillary, 0);
  EXPECT_NEAR(*b.point.capillary_force.parts.water, 0.4 * b.band.capillary, 1e-12);
  EXPECT_NEAR(*b.point.electrostatic_force.parts.water, 0.6 * b.band.pull, 1e-12);
  EXPECT_NEAR(*b.point.friction_off.parts.water, 2 * 0.9 * b.band.capillary * 2 / (4 + 2), 1e-12);
  EXPECT_NEAR(*b.point.friction_on.parts.water,
              3 * 0.9 * std::abs(b.band.capillary * 2 - b.band.pull * 3) / (4 + 2 + 3), 1e-12);
}

// Patches whose water goes over to a film add a step each, in squares.
TEST(WaterBand, AHandOverAddsTheStepsOfItsPatches) {
  Banded b = two_patches();
  b.patches[0].on_its_way = 0.5e-18;
  b.patches[1].on_its_way = 0.25e-18;
  add_water_band(b.point, b.patches, WaterModel::Droplets, b.grid, {0.9, 0.9});
  const double force = 0.18 * std::hypot(0.5 * 0.5, 0.25 * 1.5) / 2,
               pull = 0.10 * std::hypot(0.5 * 2, 0.25 * 1) / 3;
  EXPECT_NEAR(*b.point.capillary_force.parts.water, 0.4 * std::hypot(b.band.capillary, force),
              1e-12);
  EXPECT_NEAR(*b.point.electrostatic_force.parts.water, 0.6 * std::hypot(b.band.pull, pull), 1e-12);
}

TEST(WaterBand, OfThresholdWaterIsWhatItFallsShortOfDroplets) {
  Banded b = two_patches();
  b.point.modulation.value = -0.3;
  add_water_band(b.point, b.patches, WaterModel::Threshold, b.grid, {0.9, 0.9});
  const double missing = threshold_shortfall(3e-18 / b.grid.area());
  EXPECT_NEAR(*b.point.modulation.parts.water, 0.3 * missing / (1 - missing), 1e-12);
  EXPECT_FALSE(b.point.friction_off.parts.water);
}

}  // namespace
}  // namespace papilla::tests::attractions_test
