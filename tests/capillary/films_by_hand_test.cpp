// Films on a few pixels, filled and measured by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/film.h"
#include "physics/capillary/threshold.h"
#include "physics/capillary/water.h"

namespace papilla::tests::films_by_hand_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kNm = 1e-9, kDegree = kPi / 180;

// 60 and 70 deg: neither gain nor factor is a round number, the angles differ.
WaterProperties water() {
  return {.surface_tension = 0.05,
          .theta_skin = 70 * kDegree,
          .theta_substrate = 60 * kDegree,
          .hysteresis = 0.4};
}

// Eqs. capillary.9 and 14 of an area, a gap at its edge and a line around it.
double force_of(double area, double height, double line) {
  const double c = std::cos(70 * kDegree) + std::cos(60 * kDegree);
  const double f = (50 * kDegree + std::sin(70 * kDegree) * std::cos(70 * kDegree) +
                    std::sin(60 * kDegree) * std::cos(60 * kDegree)) /
                   (2 * c);
  return 0.05 * (c * area / height + f * line);
}
double retention_of(double line) { return 0.05 * line / 4 * 0.4; }

void expect_measured(double got, double want) { EXPECT_NEAR(got, want, 1e-7 * std::abs(want)); }

Gap gap_of(const Grid& grid, std::vector<double> nm) {
  for (double& h : nm) h *= kNm;
  return {grid, std::move(nm)};
}

// --- water of one level ---

constexpr Grid kEight{4, 2, 4 * kUm, 3 * kUm};  // pixels of 1 x 1.5 um

TEST(FilmsByHand, ThresholdWaterFillsTheLeastGapsTheLastByAFraction) {
  const Gap gap = gap_of(kEight, {10, 20, 30, 40, 50, 60, 70, 80});
  const double pixel = 1.5 * kUm * kUm;
  // The row of 10 to 40 nm, half of the last; its line runs between the pixels' centres.
  const double volume = (10 + 20 + 30 + 20) * kNm * pixel;
  const Wetting w = fill_threshold(gap, volume, water());
  EXPECT_EQ(w.status, WettingStatus::Film);
  EXPECT_EQ(w.bridged, (std::vector<std::uint8_t>{1, 1, 1, 1, 0, 0, 0, 0}));
  std::vector<FilmPixel> film(8, FilmPixel::None);
  std::fill(film.begin(), film.begin() + 4, FilmPixel::Film);
  EXPECT_EQ(w.film, film);
  EXPECT_EQ(w.bridges, 1);
  EXPECT_TRUE(w.droplets.empty());
  EXPECT_EQ(w.volume, volume);
  EXPECT_EQ(w.bridge_volume, volume);
  EXPECT_EQ(w.wicked_volume, 0);
  EXPECT_NEAR(w.wetted_fraction, 3.5 / 8, 1e-12);
  // Heights above 40 nm of the wet row -30, -20, -10, 0, of the dry one 10, 20, 30, 40: the line
  // crosses the columns at 3/4, 1/2, 1/4 and 0 of the way; the same on the other side of the row.
  const double line = 2 * kUm * (3 * std::hypot(1, 0.375) + std::hypot(1, 1.125));
  expect_measured(w.capillary_force, force_of(3.5 * pixel, 40 * kNm, line));
  expect_measured(w.retention, retention_of(line));
  // The paper's law has no line.
  WaterProperties pressure = water();
  pressure.pressure_alone = true;
  const double c = std::cos(70 * kDegree) + std::cos(60 * kDegree);
  const Wetting p = fill_threshold(gap, volume, pressure);
  expect_measured(p.capillary_force, 0.05 * c * 3.5 * pixel / (40 * kNm));
  expect_measured(p.retention, retention_of(line));
}

TEST(FilmsByHand, ThresholdWaterOfAnyVolumeWetsItsPixels) {
  // Twice the same gap, and one in the first of the bins into which gaps are sorted.
  const Gap gap = gap_of(kEight, {0, 20, 20, 0.001, 80, 79.99, 35, 79.995});
  const std::vector<std::pair<double, double>> cases{// sum of gaps, pixels that hold it
                                                     {0.0005, 1.5},
                                                     {10.001, 2.5},
                                                     {30.001, 3.5},
                                                     {45.001, 4 + 5.0 / 35},
                                                     {75.001, 5},
                                                     {75.001 + 39.995, 5.5},
                                                     {75.001 + 79.99 + 39.9975, 6.5},
                                                     {75.001 + 159.985 + 20, 7.25}};
  for (const auto& [sum, pixels] : cases) {
    const double volume = sum * kNm * 1.5 * kUm * kUm;
    const Wetting w = fill_threshold(gap, volume, water());
    EXPECT_EQ(w.status, WettingStatus::Film) << sum;
    EXPECT_NEAR(w.wetted_fraction, pixels / 8, 1e-9) << sum;
  }
}

// Of equal gaps the first pixels are wet, as many as the water fills, with a line around them.
TEST(FilmsByHand, ThresholdWaterOfEqualGapsTakesTheFirst) {
  const Gap gap = gap_of(kEight, std::vector<double>(8, 100));
  const double all = 100 * kNm * 12 * kUm * kUm;
  const Wetting w = fill_threshold(gap, 0.22 * all, water());
  EXPECT_EQ(w.status, WettingStatus::Film);
  EXPECT_NEAR(w.wetted_fraction, 0.22, 1e-12);
  EXPECT_EQ(w.bridged, (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(w.bridges, 1);
  // Half-way to the pixels around: two sides of a pixel's width and four corners.
  const double line = (2 + 4 * std::hypot(0.5, 0.75)) * kUm;
  expect_measured(w.capillary_force, force_of(0.22 * 12 * kUm * kUm, 100 * kNm, line));
  expect_measured(w.retention, retention_of(line));
  // Some of the gaps are equal: 10 nm, 20 nm and half of the next 20 nm.
  const Gap some = gap_of(kEight, {20, 10, 50, 20, 60, 20, 70, 80});
  const Wetting half = fill_threshold(some, 40 * kNm * 1.5 * kUm * kUm, water());
  EXPECT_NEAR(half.wetted_fraction, 2.5 / 8, 1e-9);
  EXPECT_EQ(half.bridged, (std::vector<std::uint8_t>{1, 1, 0, 1, 0, 0, 0, 0}));
}

TEST(FilmsByHand, ThresholdWaterBeyondAllGapsFloodsAndNoneIsDry) {
  const Gap gap = gap_of(kEight, {10, 20, 30, 40, 50, 60, 70, 80});
  const double all = 360 * kNm * 1.5 * kUm * kUm;
  for (const double volume : {1.0001 * all, 5 * all}) {
    const Wetting w = fill_threshold(gap, volume, water());
    EXPECT_EQ(w.status, WettingStatus::Flooded);
    EXPECT_EQ(w.bridged, std::vector<std::uint8_t>(8, 1));
    EXPECT_TRUE(w.film.empty());
    EXPECT_EQ(w.wetted_fraction, 1);
    EXPECT_EQ(w.bridges, 1);
    EXPECT_EQ(w.volume, volume);
    EXPECT_EQ(w.bridge_volume, volume);
    EXPECT_EQ(w.capillary_force, 0);
    EXPECT_EQ(w.retention, 0);
  }
  EXPECT_EQ(fill_threshold(gap, 0.9999 * all, water()).status, WettingStatus::Film);
  const Wetting dry = fill_threshold(gap, 0, water());
  EXPECT_EQ(dry.status, WettingStatus::Dry);
  EXPECT_TRUE(dry.grid == kEight);
  EXPECT_TRUE(dry.bridged.empty() && dry.film.empty());
  EXPECT_EQ(dry.volume + dry.bridge_volume + dry.bridges, 0);
  EXPECT_ANY_THROW(fill_threshold(gap, -1e-30, water()));
}

TEST(FilmsByHand, ALineThroughASaddleKeepsTheWetCornersTogether) {
  // Two wet pixels that touch at their corners, on a patch of four: every cell is a saddle.
  const Grid grid{2, 2, 2 * kUm, 3 * kUm};
  Film film;
  film.wet = {1, 0, 0, 1};
  film.height = 20 * kNm;
  film.area = 3 * kUm * kUm;
  measure_film(gap_of(grid, {10, 50, 30, 10}), water(), film);
  // Above 20 nm they are -10, 30 / 10, -10: a side is crossed at 1/4 towards 30 and 1/2 towards 10.
  const double line = 2 * kUm *
                      (std::hypot(0.75, 1.125) + std::hypot(0.5, 0.75) + std::hypot(0.25, 0.75) +
                       std::hypot(0.5, 0.375));
  expect_measured(film.force, force_of(3 * kUm * kUm, 20 * kNm, line));
  expect_measured(film.retention, retention_of(line));
  EXPECT_EQ(film.regions, 2);
}

TEST(FilmsByHand, WhatIsWetOrDryIsSoWhateverItsHeight) {
  // One dry pixel at the level and one wet above it: the line passes through the dry pixel's centre
  // and, a billionth of the level beside it, the wet one's.
  const Grid grid{4, 4, 4 * kUm, 8 * kUm};
  std::vector<double> nm(16, 30);
  nm[5] = 20;  // wet
  nm[6] = 25;  // wet, above the level
  nm[9] = 10;  // dry, below it
  Film film;
  film.wet.assign(16, 0);
  film.wet[5] = film.wet[6] = 1;
  film.height = 22 * kNm;
  film.area = 4 * kUm * kUm;
  measure_film(gap_of(grid, nm), water(), film);
  // Pixel 5 is 2 below the level: towards 30 it is crossed at 2 / 10 of the way. Pixel 6 counts as
  // at the level. Around 5: left, below, and the dry 9 above at its full distance; around 6: 0.
  const double left = 0.2, below = 0.2 * 2, above = 2;
  const double line = kUm * (std::hypot(left, below)      // the corner left and below of 5
                             + std::hypot(1, below)       // from below 5 to 6
                             + std::hypot(1, above)       // from above 5 to 6
                             + std::hypot(left, above));  // left of 5, up to 9
  expect_measured(film.retention, retention_of(line));
  EXPECT_EQ(film.regions, 1);
}

TEST(FilmsByHand, RegionsAreCountedInTheOrderOfTheirFirstPixels) {
  const Grid grid{5, 4, 1, 1};
  std::vector<int> label{7};
  // The first region hangs together over both borders, the second has a corner only.
  const std::vector<std::uint8_t> mask{1, 0, 1, 0, 1,  //
                                       0, 1, 0, 0, 0,  //
                                       0, 1, 1, 0, 0,  //
                                       1, 0, 0, 1, 0};
  EXPECT_EQ(label_regions(grid, mask, label), 4);
  EXPECT_EQ(label, (std::vector<int>{1, 0, 2, 0, 1,  //
                                     0, 3, 0, 0, 0,  //
                                     0, 3, 3, 0, 0,  //
                                     1, 0, 0, 4, 0}));
}

// --- films that grow ---

constexpr Grid kRow{6, 1, 6 * kUm, 2 * kUm};
constexpr double kPixel = 2 * kUm * kUm;

Gap row() { return gap_of(kRow, {30, 10, 20, 50, 15, 40}); }

struct Asked {
  std::vector<std::pair<int, int>> by;  // pixel, source
};

// volumes: sums of gaps of the row [nm].
FilmRegions grown(const std::vector<std::size_t>& seeds, const std::vector<double>& volumes,
                  const std::vector<double>& shares, Asked& asked, std::size_t other = 99,
                  double its = 0) {
  std::vector<FilmSource> sources;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    sources.push_back({.x = (0.5 + static_cast<double>(seeds[i])) * kUm,
                       .y = kUm,
                       .radius = 2 * kUm,
                       .edge_gap = 20 * kNm,
                       .volume = volumes[i] * kNm * kPixel,
                       .share = shares[i]});
  }
  return grow_films(row(), sources, seeds, water(), [&](std::size_t pixel, int source) {
    asked.by.push_back({static_cast<int>(pixel), source});
    return pixel == other ? its * kNm * kPixel : 0.0;
  });
}

void expect_region(const FilmRegion& r, double volume, double pixels, double height, double line,
                   double share) {
  expect_measured(r.volume, volume * kNm * kPixel);
  expect_measured(r.area, pixels * kPixel);
  expect_measured(r.height, height * kNm);
  expect_measured(r.force, force_of(pixels * kPixel, height * kNm, line * kUm));
  expect_measured(r.retention, retention_of(line * kUm));
  EXPECT_NEAR(r.share, share, 1e-12);
  EXPECT_FALSE(r.full);
}

using Pairs = std::vector<std::pair<int, int>>;
using Pixels = std::vector<int>;

TEST(FilmsByHand, AFilmFillsTheLowestNeighbourNext) {
  Asked asked;
  const FilmRegions f = grown({1}, {45}, {1}, asked);
  ASSERT_EQ(f.regions.size(), 1u);
  // 10 and 20 nm and half of 30; a line across the row on either side.
  expect_region(f.regions[0], 45, 2.5, 30, 4, 1);
  EXPECT_EQ(f.source, (Pixels{1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(f.of_source, (Pixels{0}));
  EXPECT_EQ(asked.by, (Pairs{{1, 0}, {2, 0}, {0, 0}}));
}

TEST(FilmsByHand, AFilmTakesInTheWaterThatItMeets) {
  Asked asked;
  const FilmRegions f = grown({1}, {45}, {1}, asked, 2, 30);
  ASSERT_EQ(f.regions.size(), 1u);
  // 10, 20 and 30 nm and 15 of the 40 beyond the border.
  expect_region(f.regions[0], 75, 3.375, 40, 4, 1);
  EXPECT_EQ(f.source, (Pixels{1, 1, 1, 0, 0, 1}));
  EXPECT_EQ(asked.by, (Pairs{{1, 0}, {2, 0}, {0, 0}, {5, 0}}));
}

TEST(FilmsByHand, FilmsApartStayTwo) {
  Asked asked;
  const FilmRegions f = grown({1, 4}, {25, 50}, {1, 1}, asked);
  ASSERT_EQ(f.regions.size(), 2u);
  expect_region(f.regions[0], 25, 1.75, 20, 4, 1);
  expect_region(f.regions[1], 50, 1.875, 40, 4, 1);  // 15 and 35 of 40
  EXPECT_EQ(f.source, (Pixels{0, 1, 1, 0, 2, 2}));
  EXPECT_EQ(f.of_source, (Pixels{0, 1}));
  EXPECT_EQ(asked.by, (Pairs{{1, 0}, {2, 0}, {4, 1}, {5, 1}}));
}

TEST(FilmsByHand, FilmsSideBySideHaveTheirOwnLines) {
  Asked asked;
  // The second takes 15 and 40 and, beyond the border, 5 of the 30 beside the first.
  const FilmRegions f = grown({1, 4}, {25, 60}, {1, 1}, asked);
  ASSERT_EQ(f.regions.size(), 2u);
  EXPECT_EQ(f.source, (Pixels{2, 1, 1, 0, 2, 2}));
  for (const FilmRegion& r : f.regions) expect_measured(r.retention, retention_of(4 * kUm));
}

TEST(FilmsByHand, FilmsThatMeetGoOnAsOne) {
  Asked asked;
  const FilmRegions f = grown({1, 4}, {25, 100}, {1, 1}, asked);
  ASSERT_EQ(f.regions.size(), 1u);
  // 10, 15, 20, 30, 40 and 10 of 50: all pixels are wet, so there is no line.
  expect_region(f.regions[0], 125, 5.2, 50, 0, 1);
  EXPECT_EQ(f.source, (Pixels{1, 1, 1, 2, 2, 2}));
  EXPECT_EQ(f.of_source, (Pixels{0, 0}));
  // Once a pixel and growth: of the first, of the second up to where it meets the first, of both.
  EXPECT_EQ(
      asked.by,
      (Pairs{
          {1, 0}, {2, 0}, {4, 1}, {5, 1}, {0, 1}, {1, 0}, {4, 1}, {2, 0}, {0, 0}, {5, 1}, {3, 1}}));
}

TEST(FilmsByHand, AmongThreeFilmsTheOneThatMeetsNoneKeepsItsPlace) {
  Asked asked;
  // The first fills half of pixel 1, the second meets it, the third lies alone in pixel 4.
  const FilmRegions f = grown({1, 2, 4}, {5, 40, 6}, {1, 1, 1}, asked);
  ASSERT_EQ(f.regions.size(), 2u);
  expect_region(f.regions[0], 45, 2.5, 30, 4, 1);
  expect_region(f.regions[1], 6, 0.4, 15, 4, 1);
  EXPECT_EQ(f.of_source, (Pixels{0, 0, 1}));
  EXPECT_EQ(f.source[4], 3);
  EXPECT_EQ(f.source[3] + f.source[5], 0);
}

TEST(FilmsByHand, MoreWaterThanGapIsFull) {
  Asked asked;
  const FilmRegions f = grown({1, 3}, {150, 20}, {1, 1}, asked);
  ASSERT_EQ(f.regions.size(), 1u);
  const FilmRegion& r = f.regions[0];
  EXPECT_TRUE(r.full);
  expect_measured(r.volume, 170 * kNm * kPixel);
  expect_measured(r.area, 12 * kUm * kUm);
  EXPECT_EQ(r.force, 0);
  EXPECT_EQ(r.retention, 0);
  EXPECT_EQ(r.share, 1);
  for (const int s : f.source) EXPECT_GT(s, 0);
}

TEST(FilmsByHand, SharesCountByVolume) {
  Asked asked;
  const FilmRegions f = grown({1, 2}, {5, 15}, {0.5, 0.9}, asked);
  ASSERT_EQ(f.regions.size(), 2u);
  EXPECT_NEAR(f.regions[0].share, 0.5, 1e-12);
  EXPECT_NEAR(f.regions[1].share, 0.9, 1e-12);
  Asked more;
  const FilmRegions one = grown({1, 2}, {15, 45}, {0.5, 0.9}, more);
  ASSERT_EQ(one.regions.size(), 1u);
  EXPECT_NEAR(one.regions[0].share, (0.5 * 15 + 0.9 * 45) / 60, 1e-12);
}

TEST(FilmsByHand, OnTheWayTheLevelIsBetweenTheDiscAndTheGap) {
  const FilmSource s{.radius = 2, .edge_gap = 8, .volume = 1, .share = 0.25};
  EXPECT_EQ(film_level(s, 3, 10), 0.75 * 8 * 3 / 4 + 2.5);
  EXPECT_EQ(film_level(s, 0, 10), 2.5);
  FilmSource film = s;
  film.share = 1;
  EXPECT_EQ(film_level(film, 3, 10), 10);
  film.share = 0;
  EXPECT_EQ(film_level(film, 4, 10), 8);
  // Along the row from the middle of pixel 1: 5 + 10 = 15 nm at pixel 0 one away (2.5 + 15), ...
  // the disc's half is 10 nm (distance / 2 um)^2.
  Asked asked;
  const FilmRegions f = grown({1}, {45}, {0.5}, asked);
  // Levels: pixel 1 5, pixel 2 2.5 + 10, pixel 0 2.5 + 15: the order is that of the film.
  EXPECT_EQ(asked.by, (Pairs{{1, 0}, {2, 0}, {0, 0}}));
  ASSERT_EQ(f.regions.size(), 1u);
  expect_region(f.regions[0], 45, 2.5, 17.5, 4, 0.5);
}

TEST(FilmsByHand, NearTheDiscAFilmInAFlatGapIsTheNearestPixelsOverBothBorders) {
  const Grid grid{12, 9, 12 * kUm, 11 * kUm};
  const double x = 0.3 * kUm, y = 10.6 * kUm, pixel = grid.pixel_area(), h = 100 * kNm;
  const Gap gap{grid, std::vector<double>(grid.size(), h)};
  std::vector<std::size_t> order(grid.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return square_distance(grid, a, x, y) < square_distance(grid, b, x, y);
  });
  const FilmSource s{.x = x,
                     .y = y,
                     .radius = 2.5 * kUm,
                     .edge_gap = h,
                     .volume = 13.25 * h * pixel,
                     .share = 0.5};
  const FilmRegions f =
      grow_films(gap, {s}, {order[0]}, water(), [](std::size_t, int) { return 0.0; });
  ASSERT_EQ(f.regions.size(), 1u);
  std::vector<int> want(grid.size(), 0);
  for (std::size_t k = 0; k < 14; ++k) want[order[k]] = 1;
  EXPECT_EQ(f.source, want);
  expect_measured(f.regions[0].area, 13.25 * pixel);
  // 50 nm and 50 nm (rho / r)^2 of the outermost.
  const double rho2 = square_distance(grid, order[13], x, y) / square(2.5 * kUm);
  expect_measured(f.regions[0].height, 50 * kNm * (1 + rho2));
  // Its line is about the circle through that pixel, in cells of 1 x 1.2 um.
  const double circle = 2 * kPi * 2.5 * kUm * std::sqrt(rho2);
  EXPECT_NEAR(f.regions[0].retention, retention_of(circle), 0.04 * retention_of(circle));
}

// Down a slope all water becomes one: it fills what one source of all of it fills from below. Those
// that meet are more than are filled anew for each.
TEST(FilmsByHand, ABodyThatMeetsManyFillsWhatOneOfTheirWaterFills) {
  const Grid grid{300, 3, 300 * kUm, 3 * kUm};
  Gap gap{grid, std::vector<double>(grid.size(), 1e-3)};  // walls of a ditch along y = 1
  for (int ix = 0; ix < grid.nx; ++ix) gap.value[grid.index(ix, 1)] = (100 + ix) * kNm;
  const auto volume_of = [&](int pixels) {  // of the lowest ones
    double sum = 0;
    for (int ix = 0; ix < pixels; ++ix) sum += gap.value[grid.index(ix, 1)] * grid.pixel_area();
    return sum;
  };
  for (const int joining : {3, 8, 9, 40}) {
    const double all = volume_of(200);
    std::vector<FilmSource> sources;
    std::vector<std::size_t> seeds;
    for (int k = 0; k <= joining; ++k) {
      const int at = k == 0 ? 0 : 50 + 130 * k / joining;
      sources.push_back({.x = grid.x(at),
                         .y = grid.y(1),
                         .radius = kUm,
                         .edge_gap = 50 * kNm,
                         .volume = all * (k == 0 ? 0.2 : 0.8 / joining),
                         .share = 1});
      seeds.push_back(grid.index(at, 1));
    }
    const FilmRegions f =
        grow_films(gap, sources, seeds, water(), [](std::size_t, int) { return 0.0; });
    ASSERT_EQ(f.regions.size(), 1u) << joining;
    EXPECT_NEAR(f.regions[0].volume, all, 1e-12 * all);
    EXPECT_NEAR(f.regions[0].area, 200 * grid.pixel_area(), 1e-6 * grid.pixel_area()) << joining;
    EXPECT_NEAR(f.regions[0].height, 299 * kNm, 1.0001 * kNm);
    const auto wet = std::count_if(f.source.begin(), f.source.end(), [](int s) { return s > 0; });
    EXPECT_NEAR(static_cast<double>(wet), 200, 1.01) << joining;
    for (const int region : f.of_source) EXPECT_EQ(region, 0);
  }
}

}  // namespace
}  // namespace papilla::tests::films_by_hand_test
