// Drops where one rule ends and another begins: angles without a bridge, needles beyond the
// rupture, plateaus, textures without edges.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/settling.h"

namespace papilla::tests::drop_borders_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kDegree = kPi / 180;
constexpr Grid kPatch{240, 200, 12 * kUm, 10 * kUm};

template <class Height>
Gap gap_of(Height&& height) {
  Gap gap{kPatch, {}};
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix) gap.value.push_back(height(kPatch.x(ix), kPatch.y(iy)));
  }
  return gap;
}
Gap flat_gap(double h) {
  return gap_of([&](double, double) { return h; });
}

// 0 and 180 deg have no bridge at any gap (bridge.h): drops are caps of 1 deg, and bridge only
// where the gap is lower than these. What is there then is the slab, which neither gains by wetting
// nor has a line.
TEST(DropBorders, WhereNoGapHasABridgeOnlyCapsThatTouchBothSidesAreOne) {
  WaterProperties water;
  water.theta_skin = 0, water.theta_substrate = kPi;
  const double size = 2e-7, volume = cube(size), cap = cap_shape(0).height;
  ASSERT_LT(cap, 0.1);
  const auto at = [&](double h) { return DropEnergy(flat_gap(h * size), water, 0.3e-9); };
  for (const double h : {1.001 * cap, 0.2, 0.9}) {
    DropEnergy energy = at(h);
    const Drop d = energy.placed(kUm, kUm, volume, 0, false);
    EXPECT_FALSE(d.bridge) << h;
    EXPECT_EQ(d.side, DropletState::OnSkin);
    EXPECT_EQ(energy.evaluations(), 0);
    EXPECT_FALSE(energy.kept(kUm, kUm, volume, 0).bridge) << h;
  }
  DropEnergy energy = at(0.999 * cap);
  const Drop d = energy.placed(kUm, kUm, volume, 0, false);
  EXPECT_TRUE(d.bridge);
  EXPECT_NEAR(d.energy, 0, 1e-10 * water.surface_tension * size * size);
  EXPECT_NEAR(energy.force(d), 0, 1e-10 * water.surface_tension * size);
}

TEST(DropBorders, WhereNoGapHasABridgeWaterSettlesWithoutOne) {
  for (const auto& [skin, substrate] :
       {std::pair{0.0, 180.0}, {180.0, 0.0}, {0.5, 179.5}, {1.0, 179.0}}) {
    WaterProperties water;
    water.theta_skin = skin * kDegree, water.theta_substrate = substrate * kDegree;
    const Wetting w = settle_droplets(flat_gap(100e-9), 1e-18, water, {}, 1, 0);
    EXPECT_EQ(w.status, WettingStatus::Discs) << skin;
    EXPECT_EQ(w.bridges, 0) << skin;
    EXPECT_EQ(w.bridge_volume, 0) << skin;
    EXPECT_EQ(w.retention, 0) << skin;
  }
}

// On a needle of the skin a cap must bridge though its mean gap is beyond the rupture: no flat
// bridge says anything then, and its energy is the slab's.
TEST(DropBorders, BeyondTheRuptureTheSlabIsAllThatCounts) {
  const WaterProperties w;
  const double volume = 0.032e-18, size = std::cbrt(volume);
  const double rupture = bridge_limits(w.theta_skin, w.theta_substrate).rupture;
  for (const auto& [curvature, beyond] : {std::pair{8e7, true}, {1e7, false}}) {
    const Gap gap = gap_of([&](double x, double y) {
      return 10e-9 + 0.5 * curvature * (square(x - 6 * kUm) + square(y - 5 * kUm));
    });
    DropEnergy energy(gap, w, 0.3e-9);
    const Drop d = energy.placed(6 * kUm, 5 * kUm, volume, 0, false);
    ASSERT_TRUE(d.bridge) << curvature;
    ASSERT_EQ(volume / (kPi * square(d.radius)) > rupture * size, beyond);
    ASSERT_GT(d.edge_slope, 1);  // which counts as 45 deg
    const double area = kPi * square(d.radius);
    const double slab = -(std::cos(w.theta_skin) + std::cos(w.theta_substrate)) * area -
                        std::cos(w.theta_skin) * square(std::tan(22.5 * kDegree)) * area +
                        2 * kPi * d.radius *
                            meniscus_factor(w.theta_substrate, w.theta_skin + 45 * kDegree) *
                            d.edge_gap;
    EXPECT_EQ(std::abs(d.energy - w.surface_tension * slab) < 1e-9 * std::abs(d.energy), beyond);
  }
}

TEST(DropBorders, OnAPlateauADropStops) {
  // The gap falls to 60 nm at x = 2 um and stays there up to 10 um. Steps of 200 nm from 0.9 um end
  // when all of the bridge lies over the flat: at the edge of its rim's circle.
  const Gap gap = gap_of([](double x, double) {
    return 60e-9 + 0.02 * std::max({0.0, 2 * kUm - x, x - 10 * kUm});
  });
  SettleReport report;
  const double volume = 0.02e-18;
  const Wetting w = settle_droplets(gap, {{0.9 * kUm, 5 * kUm, volume}}, {}, {}, &report);
  const Droplet& d = w.droplets.at(0);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(d.x, 2 * kUm);
  EXPECT_LT(d.x, 2 * kUm + 1.07 * d.radius + 0.2 * kUm);
  EXPECT_LT(report.moves, 12);
  // On the flat itself it does not stir: eight directions for each of five steps.
  const Wetting still = settle_droplets(gap, {{6 * kUm, 5 * kUm, volume}}, {}, {}, &report);
  EXPECT_EQ(report.moves, 0);
  EXPECT_EQ(report.evaluations, 1 + 40);
  EXPECT_EQ(still.droplets.at(0).x, 6 * kUm);
}

TEST(DropBorders, WithoutAMapOfItsEdgesNothingIsHeldAndNothingCreeps) {
  DropletOptions options;
  options.rim_pinning = options.corner_wicking = true;
  const Wetting w = settle_droplets(flat_gap(2 * kUm), {{6 * kUm, 5 * kUm, 1e-21}}, {}, options);
  EXPECT_EQ(w.wicked_volume, 0);
  EXPECT_EQ(w.droplets.size(), 1u);
  // A flat texture has a map without edges.
  options.rims =
      std::make_shared<RimMap>(Heightmap{kPatch, std::vector<double>(kPatch.size(), 1e-7)});
  const Wetting flat = settle_droplets(flat_gap(2 * kUm), {{6 * kUm, 5 * kUm, 1e-21}}, {}, options);
  EXPECT_EQ(flat.wicked_volume, 0);
  EXPECT_EQ(flat.droplets.at(0).x, 6 * kUm);
}

}  // namespace
}  // namespace papilla::tests::drop_borders_test
