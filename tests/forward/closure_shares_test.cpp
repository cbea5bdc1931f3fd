// How patches at several pressures make up the finger: shares read off results that are one
// patch's.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "forward/scale_bridge.h"
#include "geometry/grid.h"

namespace papilla::tests::closure_shares_test {
namespace {

const Grid kGrid{64, 64, 12e-6, 12e-6};

Scene persson(double amplitude) {
  Scene scene;
  scene.model.closure = Closure::Persson;
  scene.drive.amplitude = amplitude;
  return scene;
}

// What each patch adds to a member of the mean patch.
std::vector<double> shares(const ScaleBridge& bridge, double PatchResult::*member) {
  const std::size_t count = bridge.pressures().size();
  std::vector<double> out;
  const double none = bridge.combine(std::vector<PatchResult>(count)).*member;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<PatchResult> patches(count);
    patches[k].*member = 1;
    out.push_back(bridge.combine(patches).*member - none);
  }
  return out;
}

double carried(const ScaleBridge& bridge, const std::vector<double>& share) {
  return std::inner_product(share.begin(), share.end(), bridge.pressures().begin(), 0.0);
}

double sum(const std::vector<double>& share) {
  return std::accumulate(share.begin(), share.end(), 0.0);
}

TEST(ClosureShares, PatchesCarryTheLoadOffAndTheLoadAndFarPullOn) {
  const ScaleBridge bridge(persson(150), fidelity_level("search"), kGrid, 0.5);
  ASSERT_GT(bridge.pressures().size(), 1u);
  const std::vector<PatchResult> nothing(bridge.pressures().size());
  const double nominal = bridge.combine(nothing).load / kGrid.area();
  const double far_pull = bridge.combine(nothing).pull / kGrid.area();
  ASSERT_GT(far_pull, 0);
  for (auto member : {&PatchResult::capillary_off, &PatchResult::retention, &PatchResult::area_dry,
                      &PatchResult::area_off}) {
    EXPECT_NEAR(carried(bridge, shares(bridge, member)), nominal, 1e-6 * nominal);
  }
  for (auto member : {&PatchResult::capillary_on, &PatchResult::pull, &PatchResult::area_on}) {
    EXPECT_NEAR(carried(bridge, shares(bridge, member)), nominal + far_pull, 1e-6 * nominal);
  }
}

TEST(ClosureShares, WhatIsOfThePatchesInContactIsTheirMean) {
  const ScaleBridge bridge(persson(150), fidelity_level("search"), kGrid, 0.5);
  const std::vector<double> touching = shares(bridge, &PatchResult::area_off);
  EXPECT_LT(sum(touching), 1);
  for (auto member : {&PatchResult::bridges, &PatchResult::wetted, &PatchResult::bridge_volume,
                      &PatchResult::on_its_way, &PatchResult::volume, &PatchResult::mean_gap,
                      &PatchResult::indentation, &PatchResult::over_limit_area}) {
    const std::vector<double> part = shares(bridge, member);
    EXPECT_NEAR(sum(part), 1, 1e-12);
    for (std::size_t k = 0; k < part.size(); ++k)
      EXPECT_NEAR(part[k], touching[k] / sum(touching), 1e-12);
  }
  EXPECT_NEAR(bridge.mean_pressure(), carried(bridge, touching) / sum(touching),
              1e-6 * bridge.mean_pressure());
}

// A stiff layer over soft tissue: the thicker it is, the less it follows the ridge's roughness.
TEST(ClosureShares, AThickerCorneumTouchesWithLessAtMorePressure) {
  Scene scene = persson(0);
  double last = 0;
  for (double thickness : {20e-6, 200e-6, 2e-3}) {
    scene.finger.macro.corneum_thickness = thickness;
    const ScaleBridge bridge(scene, fidelity_level("search"), kGrid, 0.5);
    EXPECT_GT(bridge.mean_pressure(), 1.02 * last) << thickness;
    last = bridge.mean_pressure();
  }
}

TEST(ClosureShares, WithoutVoltageOnIsOff) {
  const ScaleBridge bridge(persson(0), fidelity_level("search"), kGrid, 0.5);
  EXPECT_EQ(shares(bridge, &PatchResult::area_on), shares(bridge, &PatchResult::area_off));
  EXPECT_EQ(bridge.combine(std::vector<PatchResult>(bridge.pressures().size())).pull, 0);
}

TEST(ClosureShares, TheOverLimitShareIsOfThePullOfAllPatches) {
  const ScaleBridge bridge(persson(150), fidelity_level("search"), kGrid, 0.5);
  std::vector<PatchResult> patches(bridge.pressures().size());
  const std::vector<double> on = shares(bridge, &PatchResult::pull);
  double over = 0, all = bridge.combine(patches).pull;  // of the gaps between patches
  for (std::size_t k = 0; k < patches.size(); ++k) {
    patches[k].pull = 1e-6 * static_cast<double>(k + 1);
    patches[k].over_limit_share = k % 2 ? 0.8 : 0.1;
    over += on[k] * patches[k].pull * patches[k].over_limit_share;
    all += on[k] * patches[k].pull;
  }
  EXPECT_NEAR(bridge.combine(patches).over_limit_share, over / all, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::closure_shares_test
