// Areas on grids of one row or column, and of shapes with every kind of corner, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla::tests::area_of_grids_test {
namespace {

constexpr double kStar = 12e6 / 0.75;
const LayeredSolid kBulk{1, 0.5, 0, 12e6, 0.5};

// Pressure of '#', and '.' free, its gap so that the edge lies at d of a pixel on a square grid
// (Eq. contact.7).
ContactSolution drawn(const Grid& grid, const std::vector<std::string>& rows, double d) {
  const double p = 1e5 * std::sqrt(d), gap = 4e5 / (3 * kStar) * std::pow(1 - d, 1.5) * grid.dx();
  ContactSolution s;
  for (const std::string& row : rows) {
    for (const char c : row) {
      s.pressure.push_back(c == '#' ? p : 0);
      s.gap.push_back(c == '#' ? 0 : gap);
    }
  }
  EXPECT_EQ(s.pressure.size(), grid.size());
  return s;
}

// An L and one pixel apart. Cells of four centres, by the number of their contact corners:
// whole ones count 1, a straight side its d, a corner d^2/2 outside and 1 - (1-d)^2/2 inside.
TEST(AreaShapes, OfAnglesAndCornersAreAddedCellByCell) {
  const Grid grid{10, 8, 1e-6, 8e-7};
  const ContactKernel kernel(grid, kBulk);
  const std::vector<std::string> shape{"..........", "..##......", "..##......", "..#####...",
                                       "..#####...", "..........", "........#.", ".........."};
  for (const double d : {0.25, 0.6}) {
    const ContactArea a = measure_area(kernel, drawn(grid, shape, d));
    // The L: six whole cells within, and its outline of 18 sides passes 18 more: five corners
    // outwards, one inwards, twelve straight. The pixel apart is four corners.
    const double outer = d * d / 2, inner = 1 - square(1 - d) / 2;
    const double l = 6 + 12 * d + 5 * outer + inner, dot = 4 * outer;
    const double edges = 18 + 4, n = 80, pixels = 15;
    EXPECT_NEAR(a.raw, pixels / n, 1e-12);
    EXPECT_NEAR(a.perimeter, (pixels - 0.106 * edges) / n, 1e-12);
    EXPECT_NEAR(a.near_edge * n, l + dot - 0.0187 * edges + 2 * kPi / 6, 1e-9) << d;
  }
}

// Two pixels that touch by a corner, with their crossings as two triangles; a checkerboard of them
// is full of such cells.
TEST(AreaShapes, OpposedCornersAreTrianglesOfTheirOwn) {
  const Grid grid{4, 4, 4e-7, 4e-7};
  const ContactKernel kernel(grid, kBulk);
  const std::vector<std::string> board{"#.#.", ".#.#", "#.#.", ".#.#"};
  for (const double d : {0.8, 0.95}) {
    const ContactArea a = measure_area(kernel, drawn(grid, board, d));
    // 16 cells, each of two triangles d^2/2; 32 sides; 16 cells of -1/2 island.
    EXPECT_NEAR(16 * a.near_edge, std::max(0.0, 16 * d * d - 0.0187 * 32 - kPi / 6 * 8), 1e-9) << d;
    EXPECT_NEAR(a.raw, 0.5, 1e-12);
  }
}

TEST(AreaShapes, OfOneRowOrColumnAreStripes) {
  for (const bool row : {true, false}) {
    const Grid grid{row ? 12 : 1, row ? 1 : 12, row ? 1.2e-6 : 1e-7, row ? 1e-7 : 1.2e-6};
    const ContactKernel kernel(grid, kBulk);
    ContactSolution s = drawn(grid, {"..####......"}, 0.3);
    const ContactArea a = measure_area(kernel, s);
    EXPECT_NEAR(a.raw, 4.0 / 12, 1e-12);
    EXPECT_NEAR(a.perimeter, (4 - 0.106 * 2) / 12, 1e-12);
    // Three pixels between the centres and d beyond either.
    EXPECT_NEAR(a.near_edge, (3 + 2 * 0.3 - 0.0187 * 2) / 12, 1e-9) << row;
  }
}

TEST(AreaShapes, OfNothingAndOfAllHaveNoEdge) {
  const Grid grid{6, 5, 6e-7, 5e-7};
  const ContactKernel kernel(grid, kBulk);
  const ContactArea none =
      measure_area(kernel, drawn(grid, std::vector<std::string>(5, "......"), 0.5));
  EXPECT_TRUE(none.raw == 0 && none.perimeter == 0 && none.near_edge == 0 && none.se == 0);
  const ContactArea all =
      measure_area(kernel, drawn(grid, std::vector<std::string>(5, "######"), 0.5));
  EXPECT_DOUBLE_EQ(all.raw, 1);
  EXPECT_DOUBLE_EQ(all.perimeter, 1);
  EXPECT_DOUBLE_EQ(all.near_edge, 1);
  EXPECT_DOUBLE_EQ(all.se, 0.001);  // Eq. contact.8 of an infinite chord
}

}  // namespace
}  // namespace papilla::tests::area_of_grids_test
