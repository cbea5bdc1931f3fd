// What is changed in a measured map before anything is computed from it: a plane, outliers, places
// without a number; and what is said about it.
#include "geometry/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/measured_map.h"
#include "geometry/texture.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::scan_test {
namespace {

constexpr Grid kGrid{200, 120, 20e-6, 9e-6};  // oblong pixels
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Heightmap map_of(const Grid& grid, const std::function<double(double x, double y)>& height) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = height(grid.x(ix), grid.y(iy));
  }
  return h;
}

// Whole waves, even about the middle: their plane is level.
double waves(double x, double y) {
  return 50e-9 * std::cos(2 * kPi * x / 4e-6) + 30e-9 * std::cos(2 * kPi * y / 3e-6);
}

// Heights of -1 to 1 nm, each as often, in an order that is none: their median deviation is 0.5 nm.
Heightmap even_shares() {
  Heightmap h{kGrid, std::vector<double>(kGrid.size())};
  const std::size_t n = h.z.size();
  for (std::size_t i = 0; i < n; ++i)
    h.z[i * 7919 % n] = 1e-9 * (2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 1);
  return h;
}

Scan scanned(const Heightmap& h, bool fill = false, bool as_is = false) {
  const std::string file = temporary("scan.gsf");  // holds both sides
  write_gsf(file, h, {});
  return read_scan({file, 0, fill, as_is});
}

std::string refusal(const Heightmap& h, bool fill) {
  return refusal_of([&] { scanned(h, fill); });
}

TEST(Scan, IsLevelledMendedAndSaysByHowMuchAndWhere) {
  Heightmap h = map_of(kGrid, [](double x, double y) { return waves(x, y) + 0.02 * x - 0.03 * y; });
  h(30, 20) += 5e-6;
  h(33, 25) -= 4e-6;
  const Scan scan = scanned(h);
  const ScanChanges& c = scan.changes;
  EXPECT_FALSE(c.as_is);
  EXPECT_NEAR(c.width, 20e-6, 1e-15);
  EXPECT_NEAR(c.height, 9e-6, 1e-15);
  EXPECT_EQ(c.pixels, 24000u);
  EXPECT_NEAR(c.slope_x, 0.02, 1e-4);  // two spikes tilt it a little
  EXPECT_NEAR(c.slope_y, -0.03, 1e-4);
  EXPECT_NEAR(c.rise, 0.02 * 20e-6 + 0.03 * 9e-6, 4e-9);
  EXPECT_NEAR(c.tilt(), std::atan(std::hypot(0.02, 0.03)), 1e-4);
  EXPECT_EQ(c.replaced, 2u);
  EXPECT_NEAR(c.furthest, 5e-6, 0.02 * 5e-6);
  EXPECT_NEAR(c.where.x0, kGrid.x(30), 1e-15);
  EXPECT_NEAR(c.where.x1, kGrid.x(33), 1e-15);
  EXPECT_NEAR(c.where.y0, kGrid.y(20), 1e-15);
  EXPECT_NEAR(c.where.y1, kGrid.y(25), 1e-15);
  EXPECT_EQ(c.filled, 0u);
  // Each is the mean of the eight around it, all others are what they were.
  double around = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) around += i == 0 && j == 0 ? 0 : scan.map(30 + i, 20 + j) / 8;
  }
  EXPECT_NEAR(scan.map(30, 20), around, 1e-16);
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix)
      ASSERT_NEAR(scan.map(ix, iy), waves(kGrid.x(ix), kGrid.y(iy)), 3e-9) << ix << " " << iy;
  }
  // As it is: to the last bit of the file, and nothing is said to have changed.
  const Scan same = scanned(h, false, true);
  EXPECT_TRUE(same.changes.as_is);
  EXPECT_EQ(same.changes.replaced, 0u);
  EXPECT_EQ(same.changes.rise, 0);
  EXPECT_EQ(same.map(33, 25), static_cast<double>(static_cast<float>(h(33, 25))));
}

TEST(Scan, AnOutlierIsBeyondEightMedianDeviations) {
  for (const double sign : {1.0, -1.0}) {
    Heightmap h = even_shares();
    h(100, 60) = sign * 3.9e-9;
    h(40, 60) = sign * 4.1e-9;
    const ScanChanges c = scanned(h).changes;
    EXPECT_EQ(c.replaced, 1u);
    EXPECT_NEAR(c.where.x0, kGrid.x(40), 1e-15);
    EXPECT_NEAR(c.furthest, 4.1e-9, 0.05e-9);
  }
}

TEST(Scan, MoreThanFiftyInAHundredAreNoOutliersButFeatures) {
  for (const auto& [spikes, replaced] : {std::pair{470u, 470u}, {490u, 0u}}) {  // 2 % are 480
    Heightmap h = even_shares();
    for (std::size_t i = 0; i < spikes; ++i) h.z[i * 49] = 20e-9;
    EXPECT_EQ(scanned(h).changes.replaced, replaced);
  }
}

TEST(Scan, WhatIsNoNumberIsFilledWhenAskedAndCountsForNoPlane) {
  Heightmap h = map_of(kGrid, [](double x, double y) { return 0.01 * x + 0.02 * y; });
  for (int iy = 0; iy < 4; ++iy) {
    for (int ix = 0; ix < 5; ++ix) h(ix, iy) = kNan;
  }
  const Scan scan = scanned(h, true);
  EXPECT_EQ(scan.changes.filled, 20u);
  EXPECT_EQ(scan.changes.replaced, 0u);
  EXPECT_NEAR(scan.changes.slope_x, 0.01, 1e-8);
  EXPECT_NEAR(scan.changes.slope_y, 0.02, 1e-8);
  for (const double z : scan.map.z) ASSERT_NEAR(z, 0, 1e-13);
  EXPECT_NE(refusal(h, false), "");
  // As it is, a corner gets the mean of the nearest square around it: row 4 and column 5 of it.
  const Scan flat = scanned(h, true, true);
  EXPECT_NEAR(flat.map(4, 3), (h(3, 4) + h(4, 4) + h(5, 4) + h(5, 3) + h(5, 2)) / 5, 1e-14);
  EXPECT_NEAR(flat.map(0, 0), (h(0, 4) + h(1, 4) + h(2, 4) + h(3, 4) + h(4, 4)) / 5, 1e-14);
}

// An array and an export keep their plane: the mean that is taken away is of what is a number.
TEST(Scan, AMadeMapIsFilledAboutTheMeanOfItsNumbers) {
  Heightmap h = map_of(kGrid, [](double x, double) { return 1e-6 + 0.01 * x; });
  h(50, 40) = kNan;
  const std::string array = temporary("holed.npy"), exported = temporary("holed.gsf");
  write_npy(array, h);
  write_gsf(exported, h, {.comment = "a design"});
  for (const ScanSource& source :
       {ScanSource{array, kGrid.lx, true}, ScanSource{exported, 0, true}}) {
    const Scan scan = read_scan(source);
    EXPECT_TRUE(scan.changes.made);
    EXPECT_EQ(scan.changes.filled, 1u);
    // The one that is missing is not in the mean of 23,999; its neighbours are even about it.
    const double missing = 0.01 * (kGrid.x(50) - 10e-6), mean = -missing / 23999;
    for (const int ix : {0, 49, 50, 199})
      EXPECT_NEAR(scan.map(ix, 40), 0.01 * (kGrid.x(ix) - 10e-6) - mean, 3e-13) << ix;
    EXPECT_NEAR(scan.changes.rms, 0.01 * 20e-6 / std::sqrt(12.0), 1e-11);
  }
}

TEST(Scan, HeightsWhoseSquaresAreNoNumbersAreRefused) {
  const std::string file = temporary("huge.npy");
  write_npy(file, map_of(kGrid, [](double x, double) { return x < 10e-6 ? 1e308 : -1e308; }));
  for (const bool as_is : {false, true}) {
    const std::string why = refusal_of([&] { read_scan({file, kGrid.lx, false, as_is}); });
    EXPECT_NE(why.find("a height of 1e+308 m is no surface's"), std::string::npos) << why;
  }
}

TEST(Scan, AFifthWithoutNumbersIsTheMost) {
  for (const auto& [share, taken] : {std::pair{0.199, true}, {0.201, false}}) {
    Heightmap h = even_shares();
    const auto bad = static_cast<std::size_t>(share * 24000);
    for (std::size_t i = 0; i < bad; ++i) h.z[i * 4] = kNan;
    const std::string why = refusal(h, true);
    EXPECT_EQ(why.empty(), taken) << why;
    if (!taken) {
      EXPECT_NE(why.find("4824 of 24000 pixels (20 %) are no numbers"), std::string::npos) << why;
    }
  }
  Heightmap none = even_shares();
  std::fill(none.z.begin(), none.z.end(), kNan);
  EXPECT_NE(refusal(none, true).find("24000 of 24000 pixels (100 %) are no"), std::string::npos);
}

TEST(Scan, HeightsOfTenTimesTheWidthAreOfAnotherUnit) {
  for (const double times : {9.5, 10.5}) {
    const Heightmap h =
        map_of(kGrid, [&](double x, double) { return x > 7e-6 && x < 13e-6 ? 0 : times * 20e-6; });
    const std::string why = refusal(h, false);
    EXPECT_EQ(why.empty(), times < 10) << why;
    if (times > 10) {
      EXPECT_NE(why.find("over 210 um on a width of 20 um"), std::string::npos) << why;
    }
  }
}

TEST(Scan, ItsWordsHoldItsNumbersInTheirUnits) {
  ScanChanges c;
  c.slope_x = 0.03, c.slope_y = -0.04, c.rise = 540e-9, c.pixels = 4000;
  const std::string plane = "a.gsf: a plane of 2.86 deg (540 nm over the map) was taken away; ";
  EXPECT_EQ(text("a.gsf", c), plane + "no pixel was replaced");
  c.replaced = 3, c.furthest = 1.25e-6, c.where = {1e-6, 2e-6, 3e-6, 4.5e-6};
  const std::string mended =
      plane +
      "3 of 4000 pixels (0.075 %) replaced by their neighbours, 1250 nm from the median at "
      "most, within x = 1 to 2 um, y = 3 to 4.5 um";
  EXPECT_EQ(text("a.gsf", c), mended);
  c.filled = 8;
  EXPECT_EQ(text("a.gsf", c),
            mended + "; 8 of 4000 pixels (0.2 %) were no numbers and were filled");
  c = ScanChanges{};
  c.as_is = true;
  EXPECT_EQ(text("b.npy", c), "b.npy: taken as it is, neither levelled nor mended");
}

// An exported texture repeats by itself, whatever the phase that it is cut at: the least-squares
// plane of that phase is no tilt. A real tilt, or a rough surface that ends anywhere, is levelled.
TEST(Scan, FromAMapThatRepeatsNoPlaneIsTaken) {
  const auto grooves = [](double x, double) {
    return -40e-9 * (1 - std::cos(2 * kPi * x / 4e-6 + 1));
  };
  const Scan kept = scanned(map_of(kGrid, grooves));
  EXPECT_TRUE(kept.changes.repeats);
  EXPECT_EQ(kept.changes.rise, 0);
  EXPECT_NE(text("a.gsf", kept.changes)
                .find("its borders meet, it repeats by itself: no plane was taken away"),
            std::string::npos);
  const Scan tilted = scanned(
      map_of(kGrid, [&](double x, double y) { return grooves(x, y) + 0.5e-3 * x - 1e-3 * y; }));
  EXPECT_FALSE(tilted.changes.repeats);
  EXPECT_NEAR(tilted.changes.slope_y, -1e-3, 1e-5);
  const Scan cut = scanned(map_of(kGrid, [](double x, double) {
    return 40e-9 * std::sin(2 * kPi * x / 3.7e-6);  // 5.4 periods
  }));
  EXPECT_FALSE(cut.changes.repeats);
  RandomStream random(1, "noise");  // neighbours know nothing of each other
  const Scan noise = scanned(map_of(kGrid, [&](double, double) { return 1e-9 * random.normal(); }));
  EXPECT_FALSE(noise.changes.repeats);
}

TEST(Scan, HeightsInAnotherUnitAreSaidOrRefused) {
  const auto high = [](double times) {
    return map_of(kGrid, [=](double x, double y) { return times * waves(x, y); });
  };
  for (const bool as_is : {false, true}) {
    EXPECT_THROW(scanned(high(1e9), false, as_is), InputError);  // nm as m
    EXPECT_NO_THROW(scanned(high(100), false, as_is));           // 16 um on 20
  }
  EXPECT_EQ(text("a", scanned(high(1)).changes).find("another unit"), std::string::npos);
  EXPECT_NE(text("a", scanned(high(1e-3)).changes).find("an rms of 0.041 nm, smoother than any"),
            std::string::npos)
      << text("a", scanned(high(1e-3)).changes);
}

// A map that repeats is taken to the last bit on its own pixels, and between them by straight
// lines.
TEST(MiddleOfAMap, IsTheMapItselfWhereItIsKnown) {
  const Heightmap h = map_of(kGrid, [](double x, double y) { return 1e-3 * x - 2e-3 * y; });
  const std::string file = temporary("known.gsf");
  write_gsf(file, h, {});
  const ScanSource source{file, 0, false, true};
  const Heightmap same = patch_of_map(source, 9e-6, {}, kGrid);
  for (std::size_t i = 0; i < h.z.size(); ++i)
    ASSERT_EQ(same.z[i], static_cast<double>(static_cast<float>(h.z[i])));
  EXPECT_EQ(changes_of_map(source).as_is, true);
  // Finer pixels, a part of it about its middle: 6.5 um and 1 um from the corner.
  const Grid part{84, 70, 7e-6, 7e-6};
  const Heightmap cut = patch_of_map(source, 7e-6, {}, part);
  for (int iy = 0; iy < part.ny; ++iy) {
    for (int ix = 0; ix < part.nx; ++ix) {
      ASSERT_NEAR(cut(ix, iy), 1e-3 * (6.5e-6 + part.x(ix)) - 2e-3 * (1e-6 + part.y(iy)), 1e-14);
    }
  }
  // Beyond the centres of the last pixels come those of the other side, here three eighths of the
  // way to them.
  const Grid whole{800, 480, 20e-6, 9e-6};
  const Heightmap fine = patch_of_map(source, 9e-6, {}, whole);
  const auto mixed = [](double near, double far) { return (5 * near + 3 * far) / 8; };
  EXPECT_NEAR(fine(0, 0),
              mixed(mixed(same(0, 0), same(199, 0)), mixed(same(0, 119), same(199, 119))), 1e-20);
  EXPECT_NEAR(fine(799, 479),
              mixed(mixed(same(199, 119), same(0, 119)), mixed(same(199, 0), same(0, 0))), 1e-20);
}

// One period on finer pixels than its own: from the last to the first it is the same curve.
TEST(MiddleOfAMap, OneThatRepeatsHasNoLedgeAtItsBorder) {
  const Grid own{16, 16, 12e-6, 12e-6}, fine{64, 64, 12e-6, 12e-6};
  const std::string file = temporary("ledge.gsf");
  write_gsf(file,
            map_of(own,
                   [](double x, double y) {
                     return 1e-7 * (std::sin(2 * kPi * x / 12e-6) + std::sin(2 * kPi * y / 12e-6));
                   }),
            {});
  const double steepest = 1e-7 * 2 * std::sin(kPi / 16) / 4;  // a pixel of 16, in four steps
  for (const bool as_is : {true, false}) {
    const Heightmap h = patch_of_map({file, 0, false, as_is}, 12e-6, {}, fine);
    for (int i = 0; i < 64; ++i) {
      EXPECT_NEAR(h(0, i) - h(63, i), steepest, 1e-3 * steepest) << as_is << i;
      EXPECT_NEAR(h(i, 0) - h(i, 63), steepest, 1e-3 * steepest) << as_is << i;
      EXPECT_NEAR(h(1, i) - h(0, i), steepest, 1e-3 * steepest) << as_is << i;
    }
  }
}

// On another patch than its own a map that repeats begins at its corner, as often as it takes,
// whether that is said of it or seen by its borders.
TEST(MiddleOfAMap, OneThatRepeatsIsTiledOverOtherSides) {
  const Grid grid{60, 60, 6e-6, 6e-6}, oblong{120, 180, 12e-6, 18e-6};
  const auto lattice = [](double x, double y) {
    return 40e-9 * std::sin(2 * kPi * x / 6e-6) + 30e-9 * std::cos(2 * kPi * y / 3e-6);
  };
  const std::string file = temporary("tile.gsf");
  write_gsf(file, map_of(grid, lattice), {});
  for (const bool as_is : {true, false}) {
    const Heightmap h = patch_of_map({file, 0, false, as_is}, 6e-6, {}, oblong);
    for (int iy = 0; iy < oblong.ny; ++iy) {
      for (int ix = 0; ix < oblong.nx; ++ix)
        ASSERT_NEAR(h(ix, iy), lattice(oblong.x(ix), oblong.y(iy)), 1e-14) << ix << " " << iy;
    }
  }
  EXPECT_NE(
      refusal_of([&] {
        patch_of_map({file, 0}, 6e-6, {}, {60, 80, 6e-6, 8e-6});
      })
          .find("6 x 6 um is smaller than the 6 x 8 um of the stack that it is a part of, and "
                "they are no whole number of it"),
      std::string::npos);
}

// The patch of a map under as_is is said to be its period: where the map is no whole number of it,
// what lies beyond its border is taken a period before, not from its other border.
TEST(MiddleOfAMap, OneOfNoWholePeriodsIsTiledByItsPeriod) {
  const auto lattice = [](double x, double y) {
    return 40e-9 * std::sin(2 * kPi * x / 8e-6) + 30e-9 * std::cos(2 * kPi * y / 8e-6 + 1);
  };
  const std::string file = temporary("period.gsf");
  write_gsf(file, map_of({160, 120, 16e-6, 12e-6}, lattice), {});
  // As fine as the map, and finer: there bilinear values are off by the waves' curvature.
  for (const auto& [pixels, off] : {std::pair{160, 1e-14}, {320, 1e-10}}) {
    const Grid stack{pixels, pixels, 16e-6, 16e-6};
    const Heightmap h = patch_of_map({file, 0, false, true}, 8e-6, {}, stack);
    for (int iy = 0; iy < pixels; ++iy) {
      for (int ix = 0; ix < pixels; ++ix)
        ASSERT_NEAR(h(ix, iy), lattice(stack.x(ix), stack.y(iy)), off) << ix << " " << iy;
    }
  }
}

// Sides that the map holds are cut out of it, with whatever differs from period to period: grains
// beside a lattice are not those of the first cell again and again.
TEST(MiddleOfAMap, OneThatHoldsAllOfItsSidesIsNotRepeated) {
  const auto beside = [](double x, double y) {
    return 40e-9 * std::sin(2 * kPi * x / 8e-6) + 30e-9 * std::cos(2 * kPi * (x + y) / 20e-6);
  };
  const std::string file = temporary("held.gsf");
  write_gsf(file, map_of({200, 200, 20e-6, 20e-6}, beside), {});
  const Grid stack{160, 80, 16e-6, 8e-6};
  const Heightmap h = patch_of_map({file, 0, false, true}, 8e-6, {}, stack);
  for (int iy = 0; iy < stack.ny; ++iy) {
    for (int ix = 0; ix < stack.nx; ++ix)
      ASSERT_NEAR(h(ix, iy), beside(stack.x(ix), stack.y(iy)), 1e-14) << ix << " " << iy;
  }
}

// Without a word the patch is 12 um: a map that repeats is taken twice each way, whole.
TEST(MiddleOfAMap, OneThatRepeatsIsTakenAsOftenAsThePatchIsLong) {
  const auto lattice = [](double x, double y) {
    return 40e-9 * std::sin(2 * kPi * x / 6e-6) + 30e-9 * std::cos(2 * kPi * y / 3e-6);
  };
  const std::string file = temporary("twice.gsf");
  write_gsf(file, map_of({60, 60, 6e-6, 6e-6}, lattice), {});
  const Grid patch{120, 120, 12e-6, 12e-6};
  for (const bool as_is : {true, false}) {
    const Heightmap h = patch_of_map({file, 0, false, as_is}, 12e-6, {}, patch);
    for (int iy = 0; iy < patch.ny; ++iy) {
      for (int ix = 0; ix < patch.nx; ++ix)
        ASSERT_NEAR(h(ix, iy), lattice(patch.x(ix), patch.y(iy)), 1e-14) << ix << " " << iy;
    }
  }
  const ScanSource source{file, 0, false, true};
  EXPECT_EQ(refusal_of([&] {
              patch_of_map(source, 13e-6, {}, {130, 130, 13e-6, 13e-6});
            }),
            "texture.patch: " + file +
                ": 6 x 6 um is smaller than the patch of 13 um, which is no whole number of it; "
                "lower it");
  EXPECT_NE(refusal_of([&] {
              patch_of_map(source, 12e-6, {1e-6, 0}, patch);
            }).find("at_x, at_y"),
            std::string::npos);
}

// A width of 20 mm where um were meant: the patch lies within one pixel.
TEST(MiddleOfAMap, OneOfPixelsTooWideForThePatchIsRefused) {
  const std::string file = temporary("wide.npy");
  Heightmap h{{96, 96, 1e-3, 1e-3}, std::vector<double>(96 * 96, 0)};
  for (std::size_t i = 0; i < h.z.size(); i += 7) h.z[i] = 1e-8;
  write_npy(file, h);
  const auto refused = [&](double width) {
    return refusal_of([&] { patch_of_map({file, width}, 12e-6, {}, {32, 32, 12e-6, 12e-6}); });
  };
  EXPECT_EQ(refused(8 * 12e-6 * 1.5), "");  // 8 pixels of 1.5 um
  EXPECT_EQ(refused(19.2e-3),
            "texture.patch: " + file +
                ": a pixel is 200 um wide, of a map of 1.92e+04 x 1.92e+04 um: the patch of 12 um "
                "holds 0.06 of them a side, and needs 8; give the scale of the map (texture.width "
                "of an array, the sides in the file), or a map with finer pixels");
  EXPECT_NE(refused(0.15e-3), "");
}

// In a stack of a longer period the sides are those of the stack: what the map does not hold is
// not made up.
TEST(MiddleOfAMap, OneThatIsSmallerThanItsStackIsRefused) {
  const std::string file = temporary("narrow.gsf");
  const Grid own{100, 200, 20e-6, 40e-6};
  write_gsf(file,
            map_of(own,
                   [](double x, double y) {
                     return 3e-8 * std::sin(2 * kPi * x / 7.3e-6) +
                            2e-8 * std::sin(2 * kPi * y / 9.1e-6);
                   }),
            {});
  const auto part = [&](double side, const MapPlace& at) {
    return refusal_of([&] { patch_of_map({file, 0}, 12e-6, at, {64, 64, side, side}); });
  };
  EXPECT_EQ(part(20e-6, {}), "");
  EXPECT_EQ(part(25e-6, {}), file +
                                 ": 20 x 40 um is smaller than the 25 x 25 um of the stack that it "
                                 "is a part of; give a larger map, or the other parts a shorter "
                                 "period");
  EXPECT_EQ(part(18e-6, {1e-6, 11e-6}), "");
  EXPECT_NE(part(18e-6, {2e-6, 0})
                .find("the patch of 18 x 18 um round (2, 0) um reaches 1 um "
                      "beyond the map"),
            std::string::npos);
}

TEST(MiddleOfAMap, ALargerPixelIsTheMeanOverItsArea) {
  const double k = 2 * kPi / 4e-6;
  const Grid fine{400, 400, 16e-6, 16e-6}, coarse{16, 8, 8e-6, 8e-6};
  const Heightmap h =
      map_of(fine, [&](double x, double y) { return 50e-9 * (std::cos(k * x) + std::cos(k * y)); });
  const std::string file = temporary("fine.gsf");
  write_gsf(file, h, {});
  const Heightmap cut = patch_of_map({file, 0, false, true}, 8e-6, {}, coarse);
  const auto mean = [&](double pixel) { return std::sin(0.5 * k * pixel) / (0.5 * k * pixel); };
  for (int iy = 0; iy < coarse.ny; ++iy) {
    for (int ix = 0; ix < coarse.nx; ++ix) {
      const double expected = 50e-9 * (mean(coarse.dx()) * std::cos(k * (4e-6 + coarse.x(ix))) +
                                       mean(coarse.dy()) * std::cos(k * (4e-6 + coarse.y(iy))));
      ASSERT_NEAR(cut(ix, iy), expected, 0.2e-9) << ix << " " << iy;
    }
  }
}

// Pixels of the same size are taken over, not smeared; the rest is blended over the border, where a
// wave that is no whole number of periods would leave a step.
TEST(MiddleOfAMap, RepeatsWithoutAStepAndIsTheMapElsewhere) {
  const Grid grid{300, 200, 15e-6, 10e-6}, part{140, 140, 7e-6, 7e-6};
  const Heightmap h = map_of(grid, [](double x, double y) {
    return 50e-9 * std::sin(2 * kPi * x / 3e-6) + 40e-9 * std::sin(2 * kPi * y / 2.5e-6 + 1);
  });
  const std::string file = temporary("odd.gsf");
  write_gsf(file, h, {});
  const Scan scan = read_scan({file, 0});
  const Heightmap cut = patch_of_map({file, 0}, 7e-6, {}, part);
  double inside = 0, across = 0, step = 0;
  for (int i = 0; i < 140; ++i) {
    for (int k = 1; k < 140; ++k)
      inside = std::max(
          {inside, std::abs(cut(k, i) - cut(k - 1, i)), std::abs(cut(i, k) - cut(i, k - 1))});
    across =
        std::max({across, std::abs(cut(0, i) - cut(139, i)), std::abs(cut(i, 0) - cut(i, 139))});
    step = std::max(step, std::abs(h(80, 30 + i) - h(219, 30 + i)));
  }
  EXPECT_GT(step, 3 * inside);  // without a seam
  EXPECT_LT(across, 1.2 * inside);
  for (int iy = 0; iy < 126; ++iy) {
    for (int ix = 0; ix < 126; ++ix) ASSERT_NEAR(cut(ix, iy), scan.map(80 + ix, 30 + iy), 1e-15);
  }
}

// Cuts of a bowl, as skin: each has its own plane taken away, its height with it.
TEST(MeasuredSkin, IsLevelWhereverItIsCut) {
  const Grid grid{200, 160, 40e-6, 32e-6};
  const Heightmap h = map_of(grid, [](double x, double y) {
    return (std::pow(x - 20e-6, 2) + std::pow(y - 16e-6, 2)) / 2e-3;
  });
  const std::string file = temporary("bowl.gsf");
  write_gsf(file, h, {});
  const double own = std::pow(4e-6, 2) / 2e-3;  // from its middle to its corner, along a side
  for (std::uint64_t index = 0; index < 8; ++index) {
    const Heightmap cut = measured_skin(file, 0, {40, 40, 8e-6, 8e-6}, 3, index);
    // Between the seams, of either hand: symmetric and near zero.
    double mean = 0;
    for (int iy = 4; iy < 36; ++iy) {
      for (int ix = 4; ix < 36; ++ix) mean += cut(ix, iy) / (32 * 32);
    }
    EXPECT_NEAR(mean, 0, 0.5 * own) << index;
    EXPECT_NEAR(cut(4, 20), cut(35, 20), 0.6 * own) << index;
    EXPECT_NEAR(cut(20, 4), cut(20, 35), 0.6 * own) << index;
  }
}

TEST(MeasuredMap, OneThatIsTooSmallIsRefusedWithItsSides) {
  const std::string file = temporary("small.gsf");
  write_gsf(file, map_of(kGrid, waves), {});
  const auto middle = [&](double patch) {
    return refusal_of([&] { patch_of_map({file, 0}, patch, {}, {32, 32, patch, patch}); });
  };
  EXPECT_EQ(middle(9e-6), "");
  EXPECT_EQ(middle(9.1e-6),
            "texture.patch: " + file +
                ": 20 x 9 um is smaller than the patch of 9.1 um, which is no whole number of it; "
                "lower it");
  // As skin it needs a tenth more on either side, for the seam.
  const auto skin = [&](double lx, double ly) {
    return refusal_of([&] { measured_skin(file, 0, {32, 32, lx, ly}, 1, 0); });
  };
  EXPECT_EQ(skin(20e-6 / 1.1, 9e-6 / 1.1), "");
  EXPECT_NE(skin(18.3e-6, 8e-6).find("20 x 9 um is smaller than the patch of 18.3 x 8 um"),
            std::string::npos);
  EXPECT_NE(skin(18e-6, 8.3e-6), "");
  EXPECT_DOUBLE_EQ(measured_skin_cutoff(file, 0), 2 * kGrid.dx());  // of the longer pixel side
}

// A stack says it by the part whose key it is, however deep the part lies.
TEST(MeasuredMap, WhatIsWrongWithItAsAPartIsSaidByTheKeyOfThePart) {
  const std::string file = temporary("part.gsf");
  write_gsf(file, map_of(kGrid, waves), {});
  Measured3d map;
  map.file = file, map.patch = 9.1e-6;
  const auto refused = [&](double side) {
    Stack inner, outer;
    inner.parts = {Texture{Flat{}}, Texture{map}};
    outer.parts = {Texture{inner}};
    return refusal_of([&] { generate(Texture{outer}, {32, 32, side, side}); });
  };
  EXPECT_EQ(refused(9.1e-6), "texture.parts.0.parts.1.patch: " + file +
                                 ": 20 x 9 um is smaller than the patch of 9.1 um, which is no "
                                 "whole number of it; lower it");
  map.patch = 8e-6, map.at_x = 7e-6;
  EXPECT_TRUE(refused(8e-6).starts_with(
      "texture.parts.0.parts.1.at_x, at_y: the patch of 8 x 8 um round (7, 0) um reaches 1 um "))
      << refused(8e-6);
  map.at_x = 0;
  EXPECT_EQ(refused(8e-6), "");
}

// One keeps the plane that the other takes away.
TEST(MeasuredTexture, IsNotLevelledAndAsItIsAtOnce) {
  Measured3d map;
  map.as_is = true;
  EXPECT_TRUE(problems(Texture{map}).empty());
  map.level = true;
  const TextureProblems found = problems(Texture{map});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().first, "level");
}

}  // namespace
}  // namespace papilla::tests::scan_test
