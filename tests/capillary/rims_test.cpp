#include "physics/capillary/rims.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/droplets.h"

namespace papilla::tests::rims_test {
namespace {

constexpr double kPatch = 12e-6, kDegree = kPi / 180;

// One round hole in the middle of a flat texture.
Heightmap holed(double diameter, double depth, int n = 256) {
  Heightmap out{{n, n, kPatch, kPatch}, {}};
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      const double r = std::hypot(out.grid.x(ix) - kPatch / 2, out.grid.y(iy) - kPatch / 2);
      out.z.push_back(r < 0.5 * diameter ? -depth : 0);
    }
  }
  return out;
}

Gap gap_over(const Heightmap& texture, double above) {
  Gap gap{texture.grid, {}};
  for (double z : texture.z) gap.value.push_back(above - z);
  return gap;
}

TEST(Rims, GibbsRangeIsThetaToThetaPlusTurn) {
  const AngleRange square_edge = gibbs_range(50 * kDegree, 90 * kDegree);
  EXPECT_DOUBLE_EQ(square_edge.low, 50 * kDegree);
  EXPECT_DOUBLE_EQ(square_edge.high, 140 * kDegree);
  EXPECT_DOUBLE_EQ(gibbs_range(110 * kDegree, 90 * kDegree).high, kPi);
  EXPECT_DOUBLE_EQ(gibbs_range(50 * kDegree, 0).high, 50 * kDegree);
}

TEST(Rims, ALinePassesAnEdgeWhereItsAngleLeavesTheRange) {
  // One pressure: cos(theta*) = C h/h_m - cos(theta_skin). At the range's end the two gaps are
  // related in closed form.
  const double skin = 80 * kDegree, theta = 50 * kDegree, turn = 30 * kDegree;
  const double c = std::cos(skin) + std::cos(theta);
  const double share = (std::cos(theta + turn) + std::cos(skin)) / c;
  ASSERT_GT(share, 0);
  EXPECT_TRUE(passes_edge(skin, theta, turn, 100e-9, 0.999 * share * 100e-9));
  EXPECT_FALSE(passes_edge(skin, theta, turn, 100e-9, 1.001 * share * 100e-9));
  // theta + turn + theta_skin beyond 180 deg: never, however narrow the gap.
  for (double gap : {0.0, 1e-9, 100e-9}) {
    EXPECT_FALSE(passes_edge(skin, theta, 90 * kDegree, 100e-9, gap));
  }
  // No edge: the line moves wherever the gap is narrower than the mean.
  EXPECT_TRUE(passes_edge(skin, theta, 0, 100e-9, 99e-9));
}

TEST(Rims, WaterCreepsBelow90DegreesMinusHalfTheOpening) {
  for (double opening : {30.0, 60.0, 90.0, 120.0}) {
    const double limit = 90 - opening / 2;
    EXPECT_TRUE(creeps_along((limit - 0.01) * kDegree, opening * kDegree));
    EXPECT_FALSE(creeps_along((limit + 0.01) * kDegree, opening * kDegree));
    EXPECT_EQ(corner_fillet((limit + 0.01) * kDegree, opening * kDegree).area, 0);
    EXPECT_NEAR(corner_fillet((limit - 0.01) * kDegree, opening * kDegree).area, 0, 1e-6);
  }
}

TEST(Rims, TheFilletOfASquareCornerHasItsClosedForm) {
  const Fillet dry = corner_fillet(0, 90 * kDegree);
  EXPECT_NEAR(dry.area, 1 - kPi / 4, 1e-15);
  EXPECT_NEAR(dry.leg, 1, 1e-15);
  // Section = the triangle of the legs less the segment under the arc, for any angles.
  for (double theta : {5.0, 20.0, 40.0}) {
    const double opening = 80 * kDegree, half_arc = kPi / 2 - theta * kDegree - opening / 2;
    const Fillet f = corner_fillet(theta * kDegree, opening);
    const double chord = 2 * f.leg * std::sin(opening / 2);
    EXPECT_NEAR(chord, 2 * std::sin(half_arc), 1e-14);
    const double triangle = 0.5 * f.leg * f.leg * std::sin(opening);
    const double segment = half_arc - std::sin(half_arc) * std::cos(half_arc);
    EXPECT_NEAR(f.area, triangle - segment, 1e-14);
    // Free surface less wetted walls, per tension: -2 area R.
    EXPECT_NEAR(2 * half_arc - 2 * f.leg * std::cos(theta * kDegree), -2 * f.area, 1e-14);
  }
}

TEST(Rims, AHoleHasItsAreaPerimeterDepthAndWalls) {
  const RimMap map(holed(5e-6, 600e-9));
  ASSERT_TRUE(map.valid());
  ASSERT_EQ(map.holes().size(), 1u);
  EXPECT_NEAR(map.depth(), 600e-9, 1e-15);
  EXPECT_NEAR(map.turn(), kPi / 2, 1e-12);
  EXPECT_NEAR(map.holes()[0].area, kPi * square(2.5e-6), 0.01 * kPi * square(2.5e-6));
  EXPECT_NEAR(map.holes()[0].perimeter, kPi * 5e-6, 0.03 * kPi * 5e-6);
  EXPECT_FALSE(RimMap(holed(5e-6, 0)).valid());
  // A cone has no two levels.
  Heightmap cone = holed(5e-6, 0);
  for (int iy = 0; iy < 256; ++iy) {
    for (int ix = 0; ix < 256; ++ix) {
      cone.z[cone.grid.index(ix, iy)] =
          -0.1 * std::hypot(cone.grid.x(ix) - kPatch / 2, cone.grid.y(iy) - kPatch / 2);
    }
  }
  EXPECT_FALSE(RimMap(cone).valid());
}

// A fillet grows up to the top of the wall, in a narrow hole up to its middle: half the radius of a
// round one, whose area over its perimeter that is.
TEST(Rims, TheCornerOfAHoleHoldsAFilletUpToItsWallOrItsMiddle) {
  const double theta = 20 * kDegree;
  const Fillet fillet = corner_fillet(theta, kPi / 2);
  for (const auto& [diameter, depth] : {std::pair{5e-6, 600e-9}, {2e-6, 900e-9}, {2e-6, 3e-6}}) {
    const RimMap map(holed(diameter, depth));
    const RimMap::Hole& hole = map.holes().at(0);
    const double leg = std::min(depth, 2 * hole.area / hole.perimeter);
    EXPECT_NEAR(2 * hole.area / hole.perimeter, 0.5 * diameter, 0.04 * diameter);
    const double held = hole.perimeter * fillet.area * square(leg / fillet.leg);
    EXPECT_NEAR(map.capacity(hole, theta), held, 1e-9 * held) << diameter << " " << depth;
    EXPECT_EQ(map.capacity(hole, 50 * kDegree), 0);  // water creeps along no right angle
  }
}

TEST(Rims, APinnedBridgeStaysOnItsSideOfTheEdge) {
  // A shallow hole under a skin that comes down towards its middle: free bridges run in.
  const Heightmap texture = holed(5e-6, 5e-9);
  Gap gap = gap_over(texture, 40e-9);
  for (int iy = 0; iy < 256; ++iy) {
    for (int ix = 0; ix < 256; ++ix) {
      const double r = std::hypot(gap.grid.x(ix) - kPatch / 2, gap.grid.y(iy) - kPatch / 2);
      gap.value[gap.grid.index(ix, iy)] += 0.06 * r;
    }
  }
  DropletOptions free, pinned;
  pinned.rims = std::make_shared<RimMap>(texture);
  pinned.rim_pinning = true;
  const auto inside = [&](const DropletOptions& options, int& count) {
    double volume = 0;
    count = 0;
    for (std::uint64_t member = 0; member < 12; ++member) {
      const double v = 0.3e-18;
      SettleReport report;
      const Wetting w = settle_droplets(gap, v, {}, options, 3, member, &report);
      EXPECT_FALSE(report.energy_rose);
      double sum = 0;
      for (const Droplet& d : w.droplets) {
        sum += d.volume;
        count += 1;
        const double r = std::hypot(d.x - kPatch / 2, d.y - kPatch / 2);
        if (r < 2.5e-6) volume += d.volume;
      }
      EXPECT_NEAR(sum, v, 1e-12 * v);
    }
    return volume;
  };
  int free_count = 0, pinned_count = 0;
  const double ran_in = inside(free, free_count), kept_out = inside(pinned, pinned_count);
  EXPECT_LT(kept_out, 0.8 * ran_in);
  EXPECT_GT(pinned_count, free_count);
}

TEST(Rims, DropsAtTheFootOfAWallCreepAwayBelow45Degrees) {
  const Heightmap texture = holed(5e-6, 600e-9);
  const Gap gap = gap_over(texture, 300e-9);
  DropletOptions options;
  options.rims = std::make_shared<RimMap>(texture);
  options.corner_wicking = true;
  for (double theta : {30.0, 44.0, 46.0, 50.0}) {
    WaterProperties water;
    water.theta_substrate = theta * kDegree;
    const double v = 2e-18;
    const Wetting w = settle_droplets(gap, v, water, options, 1, 0);
    double sum = w.wicked_volume;
    for (const Droplet& d : w.droplets) sum += d.volume;
    EXPECT_NEAR(sum, v, 1e-12 * v);
    EXPECT_EQ(w.wicked_volume > 0, theta < 45) << theta;
    EXPECT_LE(w.wicked_volume,
              options.rims->capacity(options.rims->holes()[0], water.theta_substrate));
    EXPECT_EQ(rewet(w, gap, water, options).wicked_volume, w.wicked_volume);
  }
}

TEST(Rims, WaterThatIsAllInCornersBridgesNothingWhenTheDriveLowersItsAngle) {
  const Heightmap texture = holed(5e-6, 600e-9);
  DropletOptions options;
  options.rims = std::make_shared<RimMap>(texture);
  options.corner_wicking = true;
  WaterProperties water, driven;
  water.theta_substrate = 25 * kDegree;
  driven.theta_substrate = 15 * kDegree;
  const DropletSeed at_the_wall{kPatch / 2 + 2.4e-6, kPatch / 2, 1e-21};
  const Wetting w = settle_droplets(gap_over(texture, 300e-9), {at_the_wall}, water, options);
  ASSERT_EQ(w.wicked_volume, w.volume);
  ASSERT_TRUE(w.droplets.empty());
  const Wetting on = rewet(w, gap_over(texture, 250e-9), driven, options);
  EXPECT_EQ(on.status, WettingStatus::Discs);
  EXPECT_EQ(on.bridges, 0);
  EXPECT_EQ(on.capillary_force, 0);
  EXPECT_EQ(on.bridge_volume, 0);
  EXPECT_EQ(on.bridged, std::vector<std::uint8_t>(texture.grid.size(), 0));
  EXPECT_EQ(on.wicked_volume, w.volume);
  EXPECT_EQ(on.volume, w.volume);
}

}  // namespace
}  // namespace papilla::tests::rims_test
