// The corners of the water piece, one named fact each: right answers or clear statuses.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/capillary/bridge.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"
#include "physics/capillary/water.h"

namespace papilla::tests::extremes_test {
namespace {

constexpr double kPatch = 12e-6, kDegree = kPi / 180;

Gap flat_gap(double h, int n = 64) {
  const Grid g{n, n, kPatch, kPatch};
  return {g, std::vector<double>(g.size(), h)};
}

// A paraboloid above the middle of the patch: lowest gap `least`, radius of curvature `radius`.
Gap bowl_gap(double least, double radius, int n = 128) {
  Gap gap = flat_gap(0, n);
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      const double r2 = square(gap.grid.x(ix) - kPatch / 2) + square(gap.grid.y(iy) - kPatch / 2);
      gap.value[gap.grid.index(ix, iy)] = least + r2 / (2 * radius);
    }
  }
  return gap;
}

DropletOptions one_drop() {
  DropletOptions options;
  options.drops_per_volume = 1e-6;
  return options;
}

TEST(WaterExtremes, ForcePassesThroughZeroSmoothlyAsTheAnglesPass180) {
  // One bridge in a flat gap, 80 deg on the skin: attracts below a sum near 180, repels above, and
  // is the exact bridge everywhere.
  const double v = 0.01e-18, h = 40e-9;
  double previous = 0;
  bool attracted = false, repelled = false;
  for (double sum = 150; sum <= 210; sum += 2) {
    WaterProperties water;
    water.theta_substrate = (sum - 80) * kDegree;
    const Wetting w = settle_droplets(flat_gap(h), v, water, one_drop(), 1, 0);
    const Bridge exact =
        solve_bridge(v, h, water.theta_skin, water.theta_substrate, water.surface_tension);
    ASSERT_EQ(exact.status, BridgeStatus::Converged) << sum;
    const double scale = std::abs(exact.force) + water.surface_tension * std::cbrt(v);
    if (w.bridges == 1) {
      EXPECT_NEAR(w.capillary_force, exact.force, 1e-3 * scale) << sum;
    }
    if (sum > 150) {
      EXPECT_LT(exact.force, previous) << sum;
    }
    previous = exact.force;
    attracted = attracted || w.capillary_force > 0;
    repelled = repelled || w.capillary_force < 0;
  }
  EXPECT_TRUE(attracted);
  EXPECT_TRUE(repelled);
  EXPECT_EQ(wetting_gain(80 * kDegree, 100 * kDegree), 0);
}

TEST(WaterExtremes, TheStateSwitchesAtTheExactGapForRepellingWallsToo) {
  // Even beyond a sum of 180 deg a bridge costs less than the cap up to a gap well above the cap's
  // height; it attracts there and repels when squeezed.
  for (double theta : {100.0, 110.0}) {
    WaterProperties water;
    water.theta_skin = water.theta_substrate = theta * kDegree;
    const double v = 0.01e-18, size = std::cbrt(v);
    const BridgeLimits limits = bridge_limits(theta * kDegree, theta * kDegree);
    ASSERT_GT(limits.switching, limits.snap_in);
    const auto at = [&](double h) {
      return settle_droplets(flat_gap(h * size), v, water, one_drop(), 1, 0);
    };
    EXPECT_EQ(at(1.01 * limits.switching).bridges, 0) << theta;
    EXPECT_EQ(at(0.99 * limits.switching).bridges, 1) << theta;
    EXPECT_GT(at(0.99 * limits.switching).capillary_force, 0) << theta;
    EXPECT_LT(at(0.5 * limits.zero_force).capillary_force, 0) << theta;
  }
}

TEST(WaterExtremes, OneDropletRunsToTheNarrowestPlaceInReach) {
  // To the bottom of a bowl, within its last step.
  const Gap gap = bowl_gap(100e-9, 60e-6);
  const double v = 0.2e-18, last = DropletOptions{}.first_step / 16;
  const auto distance = [&](const WaterProperties& water, std::uint64_t member) {
    const Wetting w = settle_droplets(gap, v, water, one_drop(), 1, member);
    EXPECT_EQ(w.droplets.size(), 1u);
    if (w.bridges != 1) return -1.0;
    return std::hypot(w.droplets[0].x - kPatch / 2, w.droplets[0].y - kPatch / 2);
  };
  int arrived = 0;
  for (std::uint64_t member = 0; member < 12; ++member) {
    const double d = distance({}, member);
    if (d < 0) continue;
    ++arrived;
    EXPECT_LT(d, 2 * last) << member;
  }
  EXPECT_GE(arrived, 3);
}

TEST(WaterExtremes, OneDropletBetweenRepellingWallsLeavesTheNarrowPlace) {
  // It starts squeezed at the bottom of a bowl and ends where the walls no longer press on it.
  const Gap gap = bowl_gap(100e-9, 60e-6);
  WaterProperties water;
  water.theta_skin = water.theta_substrate = 110 * kDegree;
  const double v = 0.05e-18, size = std::cbrt(v);
  const DropletSeed bottom{kPatch / 2 + 0.3e-6, kPatch / 2, v};
  DropletOptions held = one_drop();
  held.max_moves = 0;
  const Wetting before = settle_droplets(gap, {bottom}, water, held);
  ASSERT_EQ(before.bridges, 1);
  EXPECT_LT(before.capillary_force, 0);
  const Wetting after = settle_droplets(gap, {bottom}, water, one_drop());
  ASSERT_EQ(after.droplets.size(), 1u);
  const Droplet& d = after.droplets[0];
  EXPECT_LT(d.energy, before.droplets[0].energy);
  const double r2 = square(d.x - kPatch / 2) + square(d.y - kPatch / 2);
  const double there = (100e-9 + r2 / 120e-6) / size;
  const BridgeLimits limits = bridge_limits(110 * kDegree, 110 * kDegree);
  EXPECT_EQ(d.state, DropletState::Bridge);
  EXPECT_NEAR(there, limits.zero_force, 0.03 * limits.zero_force);
  EXPECT_LT(std::abs(after.capillary_force), 0.01 * std::abs(before.capillary_force));
}

TEST(WaterExtremes, ACoatingOf110DegreesHasTheExactBridgeAndAttractsMoreUnderTheField) {
  // Skin of 80 deg: the sum is 190 deg. Drops sit on the skin; a bridge is the exact one, and pulls
  // more once electrowetting has lowered the angle.
  WaterProperties coating, driven;
  coating.theta_substrate = 110 * kDegree;
  driven.theta_substrate = 80 * kDegree;
  const double v = 0.01e-18, size = std::cbrt(v);
  EXPECT_LT(wetting_gain(coating.theta_skin, coating.theta_substrate), 0);
  EXPECT_EQ(settle_droplets(flat_gap(2 * size), v, coating, one_drop(), 1, 0).droplets[0].state,
            DropletState::OnSkin);
  for (double h : {0.1, 0.3, 0.6, 0.9}) {
    const Wetting off = settle_droplets(flat_gap(h * size), v, coating, one_drop(), 1, 0);
    ASSERT_EQ(off.bridges, 1) << h;
    const Bridge exact = solve_bridge(v, h * size, coating.theta_skin, coating.theta_substrate,
                                      coating.surface_tension);
    const double scale = std::abs(exact.force) + coating.surface_tension * size;
    EXPECT_NEAR(off.capillary_force, exact.force, 1e-3 * scale) << h;
    const Wetting on = rewet(off, flat_gap(h * size), driven);
    EXPECT_EQ(on.bridges, 1) << h;
    EXPECT_GT(on.capillary_force, off.capillary_force) << h;
  }
}

TEST(WaterExtremes, NoWaterIsDryInEveryModel) {
  const Gap gap = bowl_gap(0, 60e-6);
  for (const Wetting& w : {settle_droplets(gap, 0, {}, {}, 1, 0), fill_threshold(gap, 0, {})}) {
    EXPECT_EQ(w.status, WettingStatus::Dry);
    EXPECT_EQ(w.capillary_force, 0);
    EXPECT_EQ(w.bridges, 0);
    EXPECT_EQ(rewet(w, gap, {}).status, WettingStatus::Dry);
  }
}

TEST(WaterExtremes, FloodingEndsInItsStatusWithoutForce) {
  const Gap gap = bowl_gap(50e-9, 60e-6);
  double space = 0;
  for (double h : gap.value) space += h * gap.grid.pixel_area();
  for (double share : {1.0, 1.5, 100.0}) {
    for (const Wetting& w : {settle_droplets(gap, share * space, {}, {}, 1, 0),
                             fill_threshold(gap, share * space, {})}) {
      EXPECT_EQ(w.status, WettingStatus::Flooded) << share;
      EXPECT_EQ(w.capillary_force, 0);
      EXPECT_EQ(w.wetted_fraction, 1);
    }
  }
  for (double share : {0.5, 0.9, 0.99}) {
    const Wetting w = settle_droplets(gap, share * space, {}, {}, 1, 0);
    EXPECT_EQ(w.status, WettingStatus::Film) << share;
    EXPECT_NEAR(w.volume, share * space, 1e-12 * space);
    EXPECT_TRUE(std::isfinite(w.capillary_force));
  }
}

TEST(WaterExtremes, ADropletLargerThanThePatchIsAFilmOfItsVolume) {
  // As a sphere it would be wider than the patch; the gap holds it as one film.
  const double h = 1e-6, v = 0.9 * h * square(kPatch);
  ASSERT_GT(2 * cap_shape(50 * kDegree).footprint * std::cbrt(v), kPatch / 3);
  const Wetting film = settle_droplets(flat_gap(h), v, {}, one_drop(), 1, 0);
  EXPECT_EQ(film.status, WettingStatus::Film);
  EXPECT_NEAR(film.bridge_volume, v, 1e-12 * v);
  EXPECT_NEAR(film.wetted_fraction, 0.9, 1e-9);
  // In a gap taller than the cap it cannot bridge: what spreads over the patch is a film as well.
  const double tall = 40e-6, big = 3e-15;
  ASSERT_GT(2 * cap_shape(50 * kDegree).footprint * std::cbrt(big), kPatch);
  ASSERT_LT(cap_shape(50 * kDegree).height * std::cbrt(big), tall);
  const Wetting cap = settle_droplets(flat_gap(tall), big, {}, one_drop(), 1, 0);
  EXPECT_NE(cap.status, WettingStatus::Discs);
  EXPECT_TRUE(std::isfinite(cap.capillary_force));
}

}  // namespace
}  // namespace papilla::tests::extremes_test
