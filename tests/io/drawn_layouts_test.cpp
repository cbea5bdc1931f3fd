// Layouts of arrays as wholes: every cell, polygon and reference that a fab gets, by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/io/drawing.h"
#include "geometry/texture.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::drawn_layouts_test {
namespace {

// A line a cell, a polygon, a reference.
std::string text(const Layout& layout) {
  std::string out;
  for (const LayoutCell& cell : layout.cells) {
    out += cell.name + "\n";
    for (const LayoutPolygon& p : cell.polygons) {
      out += fmt::format(" layer {}:", p.layer);
      for (std::size_t i = 0; i < p.outline.x.size(); ++i)
        out += fmt::format(" ({}, {})", p.outline.x[i], p.outline.y[i]);
      out += "\n";
    }
    for (const LayoutReference& r : cell.references) {
      out += fmt::format(" {} at ({}, {})", r.cell, r.x, r.y);
      if (r.array)
        out += fmt::format(" {} x {} by ({}, {})", r.columns, r.rows, r.step_x, r.step_y);
      out += "\n";
    }
  }
  return out;
}

FeatureArray discs(Lattice lattice, double period, double width) {
  return {FeatureArray::Shape::Disc, true, lattice, period, width, "holes"};
}
FeatureArray lines(double period, double width) {
  return {FeatureArray::Shape::Line, true, Lattice::Square, period, width, "grooves"};
}

// Of eight sides a circle of 2 um is wider by sqrt(a / sin a) = 1.053907, a = 45 deg: its corners
// lie 1053.9 nm out at 22.5 deg and so on, 973.7 and 403.3 nm along x and y from the middle of a
// period of 6 um.
TEST(DrawnLayouts, ASquareArrayIsItsCellRepeated) {
  const auto [layout, array] =
      draw_array(discs(Lattice::Square, 6e-6, 2e-6), 18.2e-6, 12e-6, 500e-9);
  EXPECT_EQ(text(layout),
            "CELL\n"
            " layer 1: (3974, 3403) (3403, 3974) (2597, 3974) (2026, 3403) (2026, 2597) "
            "(2597, 2026) (3403, 2026) (3974, 2597)\n"
            "TEXTURE\n"
            " CELL at (0, 0) 3 x 2 by (6000, 6000)\n");
  EXPECT_EQ(array.columns, 3);
  EXPECT_EQ(array.rows, 2);
  EXPECT_DOUBLE_EQ(array.pitch_x, 6e-6);
  EXPECT_DOUBLE_EQ(array.pitch_y, 6e-6);
  EXPECT_EQ(array.drift, 0);
  EXPECT_EQ(array.sides, 8);
  EXPECT_EQ(array.drawn, "holes");
}

TEST(DrawnLayouts, GroovesAreAsHighAsTheArea) {
  const auto [layout, array] = draw_array(lines(4e-6, 1.5e-6), 12e-6, 9.5e-6);
  EXPECT_EQ(text(layout),
            "CELL\n"
            " layer 1: (1250, 0) (2750, 0) (2750, 9500) (1250, 9500)\n"
            "TEXTURE\n"
            " CELL at (0, 0) 3 x 1 by (4000, 9500)\n");
  EXPECT_EQ(array.columns, 3);
  EXPECT_EQ(array.rows, 1);
  EXPECT_DOUBLE_EQ(array.pitch_y, 9.5e-6);
  EXPECT_EQ(array.sides, 0);
  EXPECT_EQ(array.drawn, "grooves");
}

// Rows of 1 um are 866.025 nm apart, two of them 1732.051. Six pairs: one pair of its own would end
// 0.051 nm off the grid, six times that 0.305, less than half: it is repeated as it is. The rows
// lie at a quarter and three quarters of it, 433.01 and 1299.04 nm.
TEST(DrawnLayouts, HexagonsAreABlockOfRowsRepeated) {
  const auto [layout, array] =
      draw_array(discs(Lattice::Hexagonal, 1e-6, 0.2e-6), 3e-6, 6 * std::sqrt(3.0) * 1e-6, 50e-9);
  EXPECT_EQ(text(layout).substr(text(layout).find("BLOCK")),
            "BLOCK\n"
            " CELL at (250, 433)\n"
            " CELL at (750, 1299)\n"
            "TEXTURE\n"
            " BLOCK at (0, 0) 3 x 6 by (1000, 1732)\n");
  // Around the origin: eight sides at 22.5 deg of a radius of 105.39 nm.
  EXPECT_EQ(text(layout).substr(0, text(layout).find("BLOCK")),
            "CELL\n"
            " layer 1: (97, 40) (40, 97) (-40, 97) (-97, 40) (-97, -40) (-40, -97) (40, -97) "
            "(97, -40)\n");
  EXPECT_EQ(array.rows, 6);
  EXPECT_DOUBLE_EQ(array.pitch_y, 1732e-9);
  EXPECT_NEAR(array.drift, 6 * (1000 * std::sqrt(3.0) - 1732) * 1e-9, 1e-20);
}

// Sixteen pairs of rows of 1905.256 nm. Blocks of one to three of them end 0.256, 0.488 and 0.232
// nm off the grid, which adds up to 4.1, 3.9 and 1.2 nm over all; of four 0.024 nm, 0.1 nm over
// all.
TEST(DrawnLayouts, ABlockHasAsManyRowsAsComeBackToTheGrid) {
  const double row = std::sqrt(3.0) * 1.1e-6;
  const auto [layout, array] =
      draw_array(discs(Lattice::Hexagonal, 1.1e-6, 0.2e-6), 2.2e-6, 16 * row, 50e-9);
  EXPECT_EQ(text(layout).substr(text(layout).find("BLOCK")),
            "BLOCK\n"
            " CELL at (275, 476)\n"   // 0.25 of 1905.256
            " CELL at (825, 1429)\n"  // 0.75
            " CELL at (275, 2382)\n"
            " CELL at (825, 3334)\n"
            " CELL at (275, 4287)\n"
            " CELL at (825, 5239)\n"
            " CELL at (275, 6192)\n"
            " CELL at (825, 7145)\n"
            "TEXTURE\n"
            " BLOCK at (0, 0) 2 x 4 by (1100, 7621)\n");
  EXPECT_EQ(array.rows, 16);
  EXPECT_DOUBLE_EQ(array.pitch_y, 7621e-9 / 4);
  EXPECT_NEAR(array.drift, 4 * 1e-9 * std::abs(4e9 * row - 7621), 1e-20);
  // Eighteen pairs: 0.024 x 18 / 4 is still below a half; the last two are a rest of four rows.
  const Layout rest =
      draw_array(discs(Lattice::Hexagonal, 1.1e-6, 0.2e-6), 2.2e-6, 18 * row, 50e-9).layout;
  EXPECT_EQ(text(rest).substr(text(rest).find("REST")),
            "REST\n"
            " CELL at (275, 476)\n"
            " CELL at (825, 1429)\n"
            " CELL at (275, 2382)\n"
            " CELL at (825, 3334)\n"
            "TEXTURE\n"
            " BLOCK at (0, 0) 2 x 4 by (1100, 7621)\n"
            " REST at (0, 30484) 2 x 1 by (1100, 7621)\n");
}

// Less than half a period still is one.
TEST(DrawnLayouts, HaveAColumnAndARowAtLeast) {
  for (const FeatureArray& array : {discs(Lattice::Square, 6e-6, 2e-6),
                                    discs(Lattice::Hexagonal, 6e-6, 2e-6), lines(6e-6, 2e-6)}) {
    const LayoutArray one = draw_array(array, 1e-6, 1e-6).array;
    EXPECT_EQ(one.columns, 1);
    EXPECT_EQ(one.rows, 1);
  }
}

std::string refusal(const FeatureArray& array, double x, double y) {
  return refusal_of([&] { draw_array(array, x, y); });
}

TEST(DrawnLayouts, OffTheirGridOrBeyondItAreRefused) {
  const auto period = [](double nm) {
    return refusal(discs(Lattice::Square, 1e-9 * nm, 1e-6), 1e-4, 1e-4);
  };
  EXPECT_EQ(period(6000.00009), "");  // a ten thousandth of a nanometre
  EXPECT_EQ(period(5999.99991), "");
  EXPECT_EQ(period(6000.00012),
            "period 6000.0001 nm is not on the 1 nm grid of layouts; use 6000 nm or 6001 nm");
  EXPECT_EQ(period(5999.4),
            "period 5999.4 nm is not on the 1 nm grid of layouts; use 5999 nm or 6000 nm");
  EXPECT_EQ(refusal(lines(4000.3e-9, 1e-6), 1e-4, 1e-4),
            "period 4000.3 nm is not on the 1 nm grid of layouts; use 4000 nm or 4001 nm");
  const std::string far = "a layout reaches 2.1 m at most: its unit is 1 nm in 32 bits";
  const FeatureArray array = discs(Lattice::Square, 1e-3, 5e-4);
  EXPECT_EQ(refusal(array, 2.1, 2.1), "");
  EXPECT_EQ(refusal(array, 2.101, 1), far);
  EXPECT_EQ(refusal(array, 1, 2.101), far);
}

// The polygon of a circle of n sides: of the area of the circle before its corners are rounded, the
// first corner half a side above the x axis.
TEST(DrawnLayouts, ACircleHasTheAreaOfItsDiameter) {
  for (const double diameter : {0.8e-6, 3e-6, 40e-6}) {
    const auto [layout, array] =
        draw_array(discs(Lattice::Hexagonal, 50e-6, diameter), 50e-6, 80e-6);
    const Polygon& p = layout.cells[0].polygons[0].outline;
    const int n = array.sides;
    ASSERT_EQ(p.x.size(), static_cast<std::size_t>(n));
    const double radius = 0.5e9 * diameter * std::sqrt(2 * kPi / n / std::sin(2 * kPi / n));
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * kPi * (i + 0.5) / n;
      const auto k = static_cast<std::size_t>(i);
      EXPECT_LE(std::abs(p.x[k] - radius * std::cos(angle)), 0.5 + 1e-9);
      EXPECT_LE(std::abs(p.y[k] - radius * std::sin(angle)), 0.5 + 1e-9);
    }
  }
}

// --- contours ---

// Steps of 10 nm along x, five of them: two levels lie at a quarter and three quarters of 40 nm.
TEST(DrawnContours, OfLevelsLieInTheMiddleOfTheirShares) {
  const Heightmap h{{5, 1, 500e-9, 100e-9}, {0, -10e-9, -20e-9, -30e-9, -40e-9}};
  // Of each layer [nm].
  const auto left = [&](int levels, const std::optional<Planes>& between = std::nullopt) {
    std::vector<std::int32_t> out(static_cast<std::size_t>(levels) + 1, 1000);
    const Layout layout = draw_contours(h, levels, between);
    EXPECT_EQ(layout.cells.size(), 1u);
    EXPECT_EQ(layout.cells[0].name, "TEXTURE");
    for (const LayoutPolygon& p : layout.cells[0].polygons) {
      for (const std::int32_t x : p.outline.x) {
        std::int32_t& least = out.at(static_cast<std::size_t>(p.layer));
        least = std::min(least, x);
      }
    }
    return out;
  };
  // Centres at 50, 150 and so on: -10 nm per 100 nm from there.
  EXPECT_EQ(left(1), (std::vector<std::int32_t>{1000, 250}));
  EXPECT_EQ(left(2), (std::vector<std::int32_t>{1000, 150, 350}));
  EXPECT_EQ(left(4), (std::vector<std::int32_t>{1000, 100, 200, 300, 400}));
  EXPECT_EQ(left(5), (std::vector<std::int32_t>{1000, 90, 170, 250, 330, 410}));
  // Of a design that is deeper than its pixels, and higher: at 35 nm of 90.
  EXPECT_EQ(left(1, Planes{-80e-9, 10e-9}), (std::vector<std::int32_t>{1000, 400}));
}

}  // namespace
}  // namespace papilla::tests::drawn_layouts_test
