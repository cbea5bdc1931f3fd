// Where drops are in a periodic patch, which pixels they cover and which others they meet, counted
// by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "physics/capillary/drop.h"
#include "physics/capillary/drop_hash.h"

namespace papilla::tests::places_by_hand_test {
namespace {

using namespace papilla::capillary;

constexpr Grid kPixels{4, 3, 8, 9};  // pixels of 2 x 3

TEST(PlacesByHand, AreBroughtIntoThePeriod) {
  const std::vector<std::vector<double>> cases{
      {0, 0},      {2.5, 2.5}, {2.999, 2.999}, {3, 0},      {7, 1},
      {-0.5, 2.5}, {-6, 0},    {-7.25, 1.75},  {-1e-20, 0}, {31, 1}};
  for (const auto& c : cases) EXPECT_DOUBLE_EQ(into_period(c[0], 3), c[1]) << c[0];
}

TEST(PlacesByHand, AreAsFarApartAsTheirNearestImages) {
  const std::vector<std::vector<double>> cases{{0, 0},      {3, 3},      {3.9, 3.9}, {4, 4},
                                               {4.5, -3.5}, {7, -1},     {-3, -3},   {-3.9, -3.9},
                                               {-4, -4},    {-4.5, 3.5}, {-7, 1}};
  for (const auto& c : cases) EXPECT_EQ(nearest_image(c[0], 8), c[1]) << c[0];
}

TEST(PlacesByHand, HaveSquaredDistancesToPixelCentres) {
  // Pixel 5 is (1, 1) with its centre at (3, 4.5).
  EXPECT_EQ(square_distance(kPixels, 5, 3, 4.5), 0);
  EXPECT_EQ(square_distance(kPixels, 5, 2, 2.5), 1 + 4);
  EXPECT_EQ(square_distance(kPixels, 5, 7.5, 8), 12.25 + 12.25);  // x over the border: 3.5, not 4.5
  EXPECT_EQ(square_distance(kPixels, 5, 5, 9), 4 + 20.25);
  EXPECT_EQ(square_distance(kPixels, 11, 0.5, 0.5), 2.25 + 4);  // (7, 7.5): both over the border
}

TEST(PlacesByHand, LieInThePixelAroundThem) {
  EXPECT_EQ(pixel_of(kPixels, 0, 0), 0u);
  EXPECT_EQ(pixel_of(kPixels, 1.99, 2.99), 0u);
  EXPECT_EQ(pixel_of(kPixels, 2.01, 2.99), 1u);
  EXPECT_EQ(pixel_of(kPixels, 1.99, 3.01), 4u);
  EXPECT_EQ(pixel_of(kPixels, 7.99, 0.1), 3u);
  EXPECT_EQ(pixel_of(kPixels, 4.1, 8.9), 10u);
  EXPECT_EQ(pixel_of(kPixels, 8, 9), 11u);  // the border itself
}

std::vector<std::size_t> covered(const Disc& disc) {
  std::vector<std::size_t> out;
  for_pixels(kPixels, disc, [&](std::size_t k) { out.push_back(k); });
  return out;
}

TEST(PlacesByHand, DiscsCoverTheCentresInsideThem) {
  using Pixels = std::vector<std::size_t>;
  // Centres of a row are 2 apart, of a column 3.
  EXPECT_EQ(covered({1, 1.5, 0.1}), (Pixels{0}));
  EXPECT_EQ(covered({1.9, 1.5, 0.8}), (Pixels{}));
  EXPECT_EQ(covered({1, 1.5, 2.1}), (Pixels{3, 0, 1}));
  EXPECT_EQ(covered({1, 1.5, 3.1}), (Pixels{8, 3, 0, 1, 4}));
  // sqrt(13) = 3.606 to the diagonal ones.
  EXPECT_EQ(covered({3, 4.5, 3.5}), (Pixels{1, 4, 5, 6, 9}));
  EXPECT_EQ(covered({3, 4.5, 3.7}), (Pixels{0, 1, 2, 4, 5, 6, 8, 9, 10}));
  EXPECT_EQ(disc_of(Drop{.x = 1, .y = 2, .radius = 3}).radius, 3);
  EXPECT_EQ(disc_of(Drop{.x = 1, .y = 2, .radius = 3}).x, 1);
  EXPECT_EQ(disc_of(Drop{.x = 1, .y = 2, .radius = 3}).y, 2);
}

TEST(PlacesByHand, DiscsWiderThanThePatchCoverEachPixelOnce) {
  for (const double radius : {6.5, 20.0, 1e3}) {
    for (const auto& [x, y] : {std::pair{1.3, 2.2}, {7.7, 8.9}, {4.2, 0.1}, {3.0, 4.5}}) {
      std::vector<std::size_t> all = covered({x, y, radius});
      std::sort(all.begin(), all.end());
      std::vector<std::size_t> each;
      for (std::size_t k = 0; k < 12; ++k) each.push_back(k);
      EXPECT_EQ(all, each) << radius << " about " << x << " " << y;
    }
  }
  // In the rows beside the middle one it is sqrt(4.95^2 - 3^2) = 3.94 wide, which is all but the
  // patch.
  std::vector<int> times(12);
  for (const std::size_t k : covered({3.1, 4.5, 4.95})) ++times[k];
  EXPECT_EQ(times, (std::vector<int>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
}

// 15 drops in 12.3 x 10: a cell would be 1.5 sqrt(123 / 16) = 4.16 wide, so 2 x 2 of 6.15 x 5; for
// 16 drops it would be 4.03 and 3 x 2. Small are those up to three times the mean radius.
struct Hashed {
  std::vector<Drop> drops;
  DropHash hash{Grid{41, 50, 12.3, 10}};

  // Drops at x, y with their radii.
  explicit Hashed(const std::vector<std::vector<double>>& places) {
    for (const auto& p : places) drops.push_back({.x = p[0], .y = p[1], .radius = p[2]});
    hash.build(drops);
  }
  std::vector<int> met_by(double x, double y, double radius, std::vector<int> known = {}) const {
    hash.collect_overlaps({.x = x, .y = y, .radius = radius}, known);
    return known;
  }
};

const std::vector<std::vector<double>> kFifteen{
    {1, 1, 1},   {5, 1, 1},     {7, 1, 1},   {9, 4, 1},  {11, 4.9, 1},
    {1, 6, 1},   {4.5, 5.1, 1}, {6.3, 6, 1}, {12, 9, 1}, {3, 9, 1},
    {8.5, 9, 1}, {2, 4, 3.5},   {6, 4, 5},   {10, 6, 1}, {0.1, 9.9, 1}};

TEST(DropHashByHand, FindsTheLargeOnesFirstThenCellByCellTheLastComeFirst) {
  const Hashed h(kFifteen);
  // The mean radius is (13 + 3.5 + 5) / 15 = 1.433: 5 is large, 3.5 (below 4.3) is not. From cell
  // (0, 0) at x < 6.15, y < 5: drops 0, 1, 11; (1, 0): 2, 3, 4; (0, 1): 5, 6, 9, 14; (1, 1): 7, 8,
  // 10, 13. A disc over all of the patch: its reach of 20 + 4.3 begins at x = 6 - 24.3 = -18.3,
  // column -3 = 1 of two; at y = 5 - 24.3 = -19.3, row -4 = 0.
  EXPECT_EQ(h.met_by(6, 5, 20),
            (std::vector<int>{12, 4, 3, 2, 11, 1, 0, 13, 10, 8, 7, 14, 9, 6, 5}));
  // Begins at x = 12.2 - 24.3 = -12.1, column -2 = 0; y = 1 - 24.3, row -5 = 1.
  EXPECT_EQ(h.met_by(12.2, 1, 20),
            (std::vector<int>{12, 14, 9, 6, 5, 13, 10, 8, 7, 11, 1, 0, 4, 3, 2}));
  // Those that it knows stay where they are.
  EXPECT_EQ(h.met_by(6, 5, 20, {7, 12, 0}),
            (std::vector<int>{7, 12, 0, 4, 3, 2, 11, 1, 13, 10, 8, 14, 9, 6, 5}));
}

TEST(DropHashByHand, MeetsDiscsThatOverlapAndNotThoseThatTouch) {
  const Hashed h({{2, 2, 1}, {12, 9.5, 1}, {2, 8, 1}});
  EXPECT_EQ(h.met_by(5, 2, 2), (std::vector<int>{}));  // 3 apart: they touch
  EXPECT_EQ(h.met_by(5, 2, 2.001), (std::vector<int>{0}));
  EXPECT_EQ(h.met_by(2, 5, 2), (std::vector<int>{}));
  EXPECT_EQ(h.met_by(5, 6, 4), (std::vector<int>{2}));  // 5 apart the one, sqrt(13) the other
  EXPECT_EQ(h.met_by(5, 6, 4.001), (std::vector<int>{2, 0}));
  EXPECT_EQ(h.met_by(0.2, 0.5, 0.2), (std::vector<int>{1}));  // (0.5, 1) over both borders
}

TEST(DropHashByHand, KnowsNoFilmButWhatIsOnItsWay) {
  std::vector<Drop> drops(3);
  for (int i = 0; i < 3; ++i) drops[i] = {.x = 3.0 + i, .y = 3, .radius = 1, .film = 0.5 * i};
  DropHash hash(Grid{41, 50, 12.3, 10});
  hash.build(drops);
  std::vector<int> met;
  hash.collect_overlaps({.x = 4, .y = 3, .radius = 5}, met);
  std::sort(met.begin(), met.end());
  EXPECT_EQ(met, (std::vector<int>{0, 1}));
}

TEST(DropHashByHand, ForgetsWhatIsTakenOutUntilItIsPutBack) {
  Hashed h(kFifteen);
  for (const int i : {12, 9, 14, 5}) h.hash.unlink(i, h.drops[i]);  // a large one and of one cell
  EXPECT_EQ(h.met_by(6, 5, 20), (std::vector<int>{4, 3, 2, 11, 1, 0, 13, 10, 8, 7, 6}));
  // Back elsewhere and of another size: 9 in cell (1, 0), 12 a small one in (0, 1), 5 a large one.
  h.drops[9].x = 6.2, h.drops[9].y = 4.9;
  h.drops[12].radius = 4.2, h.drops[12].y = 5.1;
  h.drops[5].radius = 4.4;
  for (const int i : {9, 12, 5}) h.hash.link(i, h.drops[i]);
  EXPECT_EQ(h.met_by(6, 5, 20), (std::vector<int>{5, 9, 4, 3, 2, 11, 1, 0, 13, 10, 8, 7, 12, 6}));
}

}  // namespace
}  // namespace papilla::tests::places_by_hand_test
