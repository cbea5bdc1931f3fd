// Edges of holes on a few pixels, and what they do to drops, by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/drop_population.h"
#include "physics/capillary/rims.h"
#include "physics/capillary/settling.h"

namespace papilla::tests::rims_by_hand_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kDegree = kPi / 180;

// --- the map ---

// Two rectangles of depth 500 nm: columns 1 and 2 of rows 1 to 3, and pixel (5, 0); 1 x 2 um
// pixels.
Heightmap two_holes(double depth = 0.5e-6) {
  Heightmap out{Grid{7, 5, 7 * kUm, 10 * kUm}, std::vector<double>(35, 2e-6)};
  for (int iy = 1; iy <= 3; ++iy)
    out.z[out.grid.index(1, iy)] = out.z[out.grid.index(2, iy)] = 2e-6 - depth;
  out.z[5] = 2e-6 - depth;
  return out;
}

TEST(RimsByHand, OfTwoHolesEveryNumberIsCounted) {
  const RimMap map(two_holes());
  ASSERT_TRUE(map.valid());
  EXPECT_NEAR(map.depth(), 0.5e-6, 1e-18);
  EXPECT_EQ(map.turn(), kPi / 2);
  ASSERT_EQ(map.holes().size(), 2u);
  // In the order of their first pixels: the single one, 1 x 2 um, around it 2 (1 + 2) um; the other
  // 2 x 6 um, around it 2 (2 + 6) um. Lines in any direction are pi / 4 of their steps.
  EXPECT_NEAR(map.holes()[0].area, 2e-12, 1e-24);
  EXPECT_NEAR(map.holes()[0].perimeter, kPi / 4 * 6e-6, 1e-18);
  EXPECT_NEAR(map.holes()[1].area, 12e-12, 1e-24);
  EXPECT_NEAR(map.holes()[1].perimeter, kPi / 4 * 16e-6, 1e-18);
  std::vector<int> hole, edge;
  for (std::size_t k = 0; k < 35; ++k) {
    hole.push_back(map.hole_of(k));
    edge.push_back(map.edge(k));
  }
  EXPECT_EQ(hole, (std::vector<int>{-1, -1, -1, -1, -1, 0,  -1,  //
                                    -1, 1,  1,  -1, -1, -1, -1,  //
                                    -1, 1,  1,  -1, -1, -1, -1,  //
                                    -1, 1,  1,  -1, -1, -1, -1,  //
                                    -1, -1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(edge, (std::vector<int>{0, 1, 1, 0, 1, 1, 1,  //
                                    1, 1, 1, 1, 0, 1, 0,  //
                                    1, 1, 1, 1, 0, 0, 0,  //
                                    1, 1, 1, 1, 0, 0, 0,  //
                                    0, 1, 1, 0, 0, 1, 0}));
}

// At a square corner and 0 deg the fillet's section is (1 - pi / 4) R^2 and its leg R: R is the
// wall's height or, in a narrow hole, twice its area over its perimeter.
TEST(RimsByHand, ACornerHoldsAFilletAsHighAsTheWallOrAsWideAsTheHole) {
  const RimMap shallow(two_holes());
  const double small = kPi / 4 * 6e-6, large = kPi / 4 * 16e-6;
  EXPECT_NEAR(shallow.capacity(shallow.holes()[0], 0), small * (1 - kPi / 4) * 0.25e-12, 1e-30);
  EXPECT_NEAR(shallow.capacity(shallow.holes()[1], 0), large * (1 - kPi / 4) * 0.25e-12, 1e-30);
  const RimMap deep(two_holes(1.5e-6));
  const double narrow = 2 * 2e-12 / small;  // 0.85 um; the other's would be 1.9 um
  EXPECT_NEAR(deep.capacity(deep.holes()[0], 0), small * (1 - kPi / 4) * narrow * narrow, 1e-30);
  EXPECT_NEAR(deep.capacity(deep.holes()[1], 0), large * (1 - kPi / 4) * 2.25e-12, 1e-30);
  // At 30 deg: leg cos(75) / sin(45), section leg cos(30) - 15 deg.
  const double leg = std::cos(75 * kDegree) / std::sin(45 * kDegree),
               section = leg * std::cos(30 * kDegree) - 15 * kDegree;
  const double held = large * section * square(0.5e-6 / leg);
  EXPECT_NEAR(shallow.capacity(shallow.holes()[1], 30 * kDegree), held, 1e-9 * held);
  EXPECT_EQ(shallow.capacity(shallow.holes()[1], 45.001 * kDegree), 0);
}

// A trench along y on 1 um pixels, its levels from 0 (deep) to 1.
RimMap trench(const std::vector<double>& levels, double depth = 4 * kUm) {
  const int n = static_cast<int>(levels.size());
  Heightmap map{Grid{n, 4, n * kUm, 4 * kUm}, {}};
  for (int iy = 0; iy < 4; ++iy) {
    for (const double level : levels) map.z.push_back((level - 1) * depth);
  }
  return RimMap(map);
}

TEST(RimsByHand, WallsAreAsSteepAsTheirPixelsBetweenTheLevels) {
  // Four columns of walls on a line that counts as 2 x 4 um pi / 4: 0.8 of the depth over the
  // width.
  const RimMap sloped = trench({1, 1, 1, 0.85, 0.15, 0, 0, 0, 0.15, 0.85, 0.95, 1});
  ASSERT_TRUE(sloped.valid());
  ASSERT_EQ(sloped.holes().size(), 1u);
  EXPECT_NEAR(sloped.holes()[0].area, 20e-12, 1e-24);
  EXPECT_NEAR(sloped.holes()[0].perimeter, 2 * kPi * kUm, 1e-17);
  EXPECT_NEAR(sloped.turn(), std::atan(0.8 * 4 * 2 * kPi / 16), 1e-12);
  EXPECT_NEAR(trench({1, 1, 1, 0.85, 0.15, 0, 0, 0, 0.15, 0.85, 0.95, 1}, 1 * kUm).turn(),
              std::atan(0.8 * 2 * kPi / 16), 1e-12);
  // Three columns: 12 / (2 pi) = 1.9 um are below 2 pixels, a vertical wall.
  EXPECT_EQ(trench({1, 1, 1, 1, 0.15, 0, 0, 0, 0.15, 0.85, 0.95, 1}).turn(), kPi / 2);
  // 95 and 5 % are the levels themselves.
  EXPECT_EQ(trench({1, 0.95, 0.95, 1, 0.05, 0, 0.05, 0, 0.05, 0.95, 0.95, 1}).turn(), kPi / 2);
  // The middle belongs to the high level.
  const RimMap middle = trench({1, 1, 1, 0.5, 0, 0, 0.499, 1, 1, 1, 1, 1});
  EXPECT_NEAR(middle.holes().at(0).area, 12e-12, 1e-24);
}

TEST(RimsByHand, ATextureOfWhichMoreThanAThirdIsBetweenTheLevelsHasNoEdges) {
  EXPECT_TRUE(trench({1, 1, 1, 0.85, 0.15, 0, 0, 0, 0.15, 0.85, 1, 1}).valid());      // 4 of 12
  EXPECT_FALSE(trench({1, 1, 0.85, 0.85, 0.15, 0, 0, 0, 0.15, 0.85, 1, 1}).valid());  // 5 of 12
  EXPECT_FALSE(trench({1, 1, 1, 1}).valid());
  EXPECT_FALSE(trench({1, 1, 1, 0}, 0).valid());
}

TEST(RimsByHand, ALineBehavesAsItsAngleSays) {
  // C = 1 at 60 and 60 deg: cos(theta*) = local / edge - 1/2 is compared with cos(60 deg + turn).
  EXPECT_TRUE(passes_edge(60 * kDegree, 60 * kDegree, 30 * kDegree, 2, 0.99));   // -0.005 < 0
  EXPECT_FALSE(passes_edge(60 * kDegree, 60 * kDegree, 30 * kDegree, 2, 1.01));  // 0.005
  EXPECT_FALSE(passes_edge(60 * kDegree, 60 * kDegree, 60 * kDegree, 2, 0.01));  // -0.495 > -1/2
  EXPECT_FALSE(passes_edge(60 * kDegree, 60 * kDegree, 120 * kDegree, 2, -9));  // at 180 deg: never
  EXPECT_TRUE(passes_edge(60 * kDegree, 60 * kDegree, 0, 2, 1.99));
  EXPECT_FALSE(passes_edge(60 * kDegree, 60 * kDegree, 0, 2, 2.01));
  EXPECT_TRUE(creeps_along(29 * kDegree, 120 * kDegree));
  EXPECT_FALSE(creeps_along(31 * kDegree, 120 * kDegree));
  EXPECT_EQ(corner_fillet(31 * kDegree, 120 * kDegree).leg, 0);
}

// --- drops at the foot of a wall ---

constexpr Grid kFine{120, 120, 12 * kUm, 12 * kUm};

// Holes of 4 x 4 um at the middle and 1 x 1 um at a corner, 600 nm deep.
Heightmap fine_holes() {
  Heightmap out{kFine, {}};
  for (int iy = 0; iy < 120; ++iy) {
    for (int ix = 0; ix < 120; ++ix) {
      const bool large = std::abs(ix - 59.5) < 20 && std::abs(iy - 59.5) < 20;
      const bool small = ix < 10 && iy < 10;
      out.z.push_back(large || small ? -600e-9 : 0);
    }
  }
  return out;
}

struct Wicked {
  double went = 0;
  std::vector<double> left;  // volumes; 0: gone
};

Wicked wick(const std::vector<DropletSeed>& seeds, double above, double theta_substrate,
            DropletState side = DropletState::OnSubstrate) {
  const Heightmap texture = fine_holes();
  Gap gap{kFine, {}};
  for (const double z : texture.z) gap.value.push_back(above - z);
  WaterProperties water;
  water.theta_substrate = theta_substrate;
  DropEnergy energy(gap, water, 0.3e-9);
  std::vector<Drop> placed;
  for (const DropletSeed& s : seeds) placed.push_back(energy.placed(s.x, s.y, s.volume, 0, false));
  DropPopulation drops(kFine, energy);
  drops.take(std::move(placed));
  Wicked out;
  out.went = wick_into_corners(kFine, RimMap(texture), water, side, drops);
  for (int i = 0; i < drops.size(); ++i) out.left.push_back(drops[i].alive ? drops[i].volume : 0);
  return out;
}

TEST(RimsByHand, DropsThatMeetTheFootOfAWallGiveTheirWaterToItsCorner) {
  // 20 deg; a cap of 1e-20 m3 is about 0.33 um wide. The large hole's rows and columns are 40 to
  // 79, its walls at 4 and 8 um.
  const double theta = 20 * kDegree, v = 1e-20;
  const double radius = cap_shape(theta).widest * std::cbrt(v);
  ASSERT_NEAR(radius, 0.33e-6, 0.01e-6);
  const Wicked w = wick({{4.2e-6, 5e-6, v},      // meets the wall
                         {6e-6, 6e-6, v},        // in the middle of the hole
                         {7.8e-6, 7e-6, 2 * v},  // meets another wall
                         {3.8e-6, 7e-6, v},      // meets the wall from above
                         {1.5e-6, 10e-6, v}},    // far from any
                        3e-6, theta);
  EXPECT_NEAR(w.went, 3 * v, 1e-12 * v);
  EXPECT_EQ(w.left, (std::vector<double>{0, v, 0, v, v}));
}

TEST(RimsByHand, ACornerTakesNoMoreThanItHolds) {
  const double theta = 20 * kDegree;
  const RimMap map(fine_holes());
  ASSERT_EQ(map.holes().size(), 2u);
  const double room = map.capacity(map.holes()[0], theta);  // of the small hole, about 0.1 um3
  const double v = 0.6 * room;
  const Wicked w =
      wick({{0.2e-6, 0.2e-6, v}, {0.7e-6, 0.2e-6, 0.1 * v}, {6e-6, 6e-6, 0.01 * v}}, 9e-6, theta);
  // The first two overlap and are one.
  EXPECT_NEAR(w.went, 1.1 * v, 1e-9 * v);
  const Wicked more = wick({{0.3e-6, 0.3e-6, 2 * v}}, 9e-6, theta);
  EXPECT_NEAR(more.went, room, 1e-9 * v);
  EXPECT_NEAR(more.left[0], 2 * v - room, 1e-9 * v);
  // A second drop at the same corner finds what the first has left.
  const double u = 0.9 * map.capacity(map.holes()[1], theta);
  const Wicked two =
      wick({{4.1e-6, 7.9e-6, u}, {7.9e-6, 7.9e-6, 1e-20}, {7.9e-6, 4.1e-6, u}}, 30e-6, theta);
  EXPECT_NEAR(two.went, u / 0.9, 1e-9 * u);
  EXPECT_EQ(two.left[0] + two.left[1], 0);
  EXPECT_NEAR(two.left[2], 2 * u + 1e-20 - u / 0.9, 1e-9 * u);
}

TEST(RimsByHand, NothingCreepsFromTheSkinFromBridgesOrAbove45Degrees) {
  const double v = 1e-20;
  const std::vector<DropletSeed> at_the_wall{{4.2e-6, 5e-6, v}};
  EXPECT_GT(wick(at_the_wall, 3e-6, 44 * kDegree).went, 0);
  EXPECT_EQ(wick(at_the_wall, 3e-6, 46 * kDegree).went, 0);
  EXPECT_EQ(wick(at_the_wall, 3e-6, 20 * kDegree, DropletState::OnSkin).went, 0);
  // Under a skin that is 10 nm above the land the drop over its edge is a bridge.
  const Wicked bridge = wick({{4.02e-6, 5e-6, 20 * v}}, 1e-9, 20 * kDegree);
  EXPECT_EQ(bridge.went, 0);
  EXPECT_NEAR(bridge.left[0], 20 * v, 1e-12 * v);
}

}  // namespace
}  // namespace papilla::tests::rims_by_hand_test
