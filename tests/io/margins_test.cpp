// Widths and outlines of pixels on oblong grids: the same for a map that is turned, mirrored or
// moved, and those of stripes, necks and planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/io/drawing.h"
#include "geometry/io/mask.h"

namespace papilla::tests::margins_test {
namespace {

Heightmap pixels(const Grid& grid, const std::function<bool(int ix, int iy)>& deep) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = deep(ix, iy) ? -1e-7 : 0;
  }
  return h;
}

TEST(PixelMargins, OfStripesAreTheirPixelsAlongEitherSide) {
  const Grid grid{48, 72, 48 * 80e-9, 72 * 100e-9};
  for (int width = 4; width <= 12; ++width) {
    const PixelMargins x =
        measure_margins(pixels(grid, [&](int i, int) { return i % 24 < width; }));
    const PixelMargins y =
        measure_margins(pixels(grid, [&](int, int j) { return j % 24 < width; }));
    EXPECT_NEAR(x.min_hole, width * 80e-9, 25e-9) << width;
    EXPECT_NEAR(x.min_wall, (24 - width) * 80e-9, 25e-9) << width;
    EXPECT_NEAR(y.min_hole, width * 100e-9, 1e-12) << width;
    EXPECT_NEAR(y.min_wall, (24 - width) * 100e-9, 1e-12) << width;
    EXPECT_EQ(x.pixel, 100e-9);
  }
}

// Squares of 20 pixels joined by a neck that is 4 pixels long.
TEST(PixelMargins, OfANeckAreItsWidth) {
  const Grid grid{64, 48, 6.4e-6, 4.8e-6};
  for (int width = 4; width <= 10; ++width) {
    const auto joined = [&](int i, int j) {
      const bool square = j >= 10 && j < 30 && ((i >= 6 && i < 26) || (i >= 30 && i < 50));
      return square || (i >= 26 && i < 30 && j >= 16 && j < 16 + width);
    };
    EXPECT_NEAR(measure_margins(pixels(grid, joined)).min_hole, width * 100e-9, 1e-12) << width;
  }
}

// Blobs of 3 to 12 pixels and what is between them.
Heightmap blobs(const Grid& grid) {
  RandomStream random(11, "blobs of a test", 0);
  std::vector<std::array<double, 3>> discs;
  for (int k = 0; k < 14; ++k) {
    discs.push_back(
        {random.uniform(0, grid.lx), random.uniform(0, grid.ly), random.uniform(2, 7) * grid.dy()});
  }
  Heightmap h = pixels(grid, [](int, int) { return false; });
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      for (const auto& [x, y, r] : discs) {
        const double dx = grid.x(ix) - x, dy = grid.y(iy) - y;
        if (std::hypot(dx - grid.lx * std::round(dx / grid.lx),
                       dy - grid.ly * std::round(dy / grid.ly)) < r)
          h(ix, iy) = -1e-7;
      }
    }
  }
  return h;
}

TEST(PixelMargins, AreTheSameForAMapThatIsTurnedMirroredOrMoved) {
  const Grid grid{80, 60, 80 * 60e-9, 60 * 70e-9}, turned{60, 80, grid.ly, grid.lx};
  const Heightmap h = blobs(grid);
  const PixelMargins known = measure_margins(h);
  ASSERT_GT(known.min_hole, 100e-9);
  ASSERT_GT(known.min_wall, 0);
  const auto expect_same = [&](const Grid& g, const std::function<double(int, int)>& of,
                               const char* how) {
    Heightmap other{g, std::vector<double>(g.size())};
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) other(ix, iy) = of(ix, iy);
    }
    const PixelMargins m = measure_margins(other);
    EXPECT_NEAR(m.min_hole, known.min_hole, 1e-12) << how;
    EXPECT_NEAR(m.min_wall, known.min_wall, 1e-12) << how;
  };
  expect_same(
      turned, [&](int ix, int iy) { return h(iy, ix); }, "turned");
  expect_same(
      grid, [&](int ix, int iy) { return h(79 - ix, iy); }, "mirrored along x");
  expect_same(
      grid, [&](int ix, int iy) { return h(ix, 59 - iy); }, "mirrored along y");
  expect_same(
      grid, [&](int ix, int iy) { return h((ix + 33) % 80, (iy + 21) % 60); }, "moved");
  Heightmap down = h;
  for (double& z : down.z) z = -z;
  EXPECT_NEAR(measure_margins(down).min_hole, known.min_wall, 1e-12);
  EXPECT_NEAR(measure_margins(down).min_wall, known.min_hole, 1e-12);
}

// Area [m^2] and its first moments [m^3] of what polygons cover.
struct Moments {
  double area = 0, x = 0, y = 0;

  explicit Moments(const std::vector<Polygon>& polygons) {
    for (const Polygon& p : polygons) {
      double own = 0;
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const std::size_t j = (i + 1) % p.x.size();
        const double ax = 1e-9 * p.x[i], ay = 1e-9 * p.y[i], bx = 1e-9 * p.x[j], by = 1e-9 * p.y[j],
                     cross = 0.5 * (ax * by - bx * ay);
        own += cross;
        x += cross * (ax + bx) / 3;
        y += cross * (ay + by) / 3;
      }
      EXPECT_GT(own, -2e-16);  // all one way round, but for slivers
      area += own;
    }
  }
};

// A plane is below a level within a triangle at one corner, to the border of the map.
TEST(Polygons, BelowAPlaneFillItsCorner) {
  const Grid grid{40, 30, 8e-6, 9e-6};
  for (const int corner : {0, 1, 2, 3}) {
    Heightmap h{grid, std::vector<double>(grid.size())};
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const double x = corner % 2 ? grid.lx - grid.x(ix) : grid.x(ix),
                     y = corner / 2 ? grid.ly - grid.y(iy) : grid.y(iy);
        h(ix, iy) = 0.02 * x + 0.01 * y;
      }
    }
    const double level = 60e-9, side_x = 3e-6, side_y = 6e-6;  // of the triangle
    const Moments found(polygons_below(h, level));
    const double area = 0.5 * side_x * side_y, x = side_x / 3, y = side_y / 3;
    // Half a pixel at the border holds the border's value.
    EXPECT_NEAR(found.area, area, 0.03 * area) << corner;
    EXPECT_NEAR(found.x / found.area, corner % 2 ? grid.lx - x : x, 0.03e-6) << corner;
    EXPECT_NEAR(found.y / found.area, corner / 2 ? grid.ly - y : y, 0.06e-6) << corner;
  }
}

// Stripes, a rectangle inside and the whole map, to the nanometre: contours pass half way between
// the centres of pixels.
TEST(Polygons, BelowRectanglesAreTheirPixels) {
  const Grid grid{20, 16, 2e-6, 3.2e-6};  // of 100 x 200 nm
  const auto moments = [&](const std::function<bool(int, int)>& deep) {
    return Moments(polygons_below(pixels(grid, deep), -50e-9));
  };
  const Moments all = moments([](int, int) { return true; });
  EXPECT_NEAR(all.area, 6.4e-12, 1e-20);
  EXPECT_NEAR(all.x / all.area, 1e-6, 1e-12);
  EXPECT_NEAR(all.y / all.area, 1.6e-6, 1e-12);
  EXPECT_EQ(moments([](int, int) { return false; }).area, 0);
  const Moments upright = moments([](int i, int) { return i >= 5 && i < 9; });
  EXPECT_NEAR(upright.area, 0.4e-6 * 3.2e-6, 1e-18);
  EXPECT_NEAR(upright.x / upright.area, 0.7e-6, 1e-12);
  EXPECT_NEAR(upright.y / upright.area, 1.6e-6, 1e-12);
  const Moments level = moments([](int, int j) { return j < 3; });  // at the border
  EXPECT_NEAR(level.area, 2e-6 * 0.6e-6, 1e-18);
  EXPECT_NEAR(level.y / level.area, 0.3e-6, 1e-12);
  const Moments inside = moments([](int i, int j) { return i >= 12 && i < 18 && j >= 4 && j < 9; });
  EXPECT_NEAR(inside.area, 0.6e-6 * 1.0e-6, 0.6 * 4 * 100e-9 * 200e-9 / 4);  // corners are cut
  EXPECT_NEAR(inside.x / inside.area, 1.5e-6, 1e-12);
  EXPECT_NEAR(inside.y / inside.area, 1.3e-6, 1e-12);
}

// Share of a triangle below a level, by its corners' heights in order.
double share_below(std::array<double, 3> h, double level) {
  std::sort(h.begin(), h.end());
  if (level <= h[0]) return 0;
  if (level >= h[2]) return 1;
  if (level <= h[1]) return square(level - h[0]) / ((h[1] - h[0]) * (h[2] - h[0]));
  return 1 - square(h[2] - level) / ((h[2] - h[0]) * (h[2] - h[1]));
}

// Every neighbourhood of pixels, against the triangles one by one. Pixels of 40 x 50 um, so that
// whole nanometres are fine.
TEST(Polygons, BelowARandomMapHaveTheAreaOfEachOfItsTriangles) {
  const Grid grid{11, 9, 440e-6, 450e-6};
  RandomStream random(3, "triangles of a test", 0);
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (double& z : h.z) z = random.uniform();
  const auto at = [&](int i, int j) {
    return h(std::clamp(i, 0, grid.nx - 1), std::clamp(j, 0, grid.ny - 1));
  };
  // Half a pixel at the border.
  const auto side = [](int i, int n, double pixel) {
    return i < 0 || i == n - 1 ? 0.5 * pixel : pixel;
  };
  for (const double level : {0.2, 0.5, 0.8}) {
    double area = 0;
    for (int j = -1; j < grid.ny; ++j) {
      for (int i = -1; i < grid.nx; ++i) {
        const double a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        area += 0.5 * side(i, grid.nx, grid.dx()) * side(j, grid.ny, grid.dy()) *
                (share_below({a, b, c}, level) + share_below({a, c, d}, level));
      }
    }
    // Corners are rounded by half a nanometre: of 120 cells some 1e-5 of a cell each at most.
    EXPECT_NEAR(Moments(polygons_below(h, level)).area, area, 120 * 1e-5 * grid.pixel_area())
        << level;
  }
}

TEST(Polygons, BelowAWholeMapAreOneStripARow) {
  const Grid grid{4, 3, 400e-9, 600e-9};
  const std::vector<Polygon> strips =
      polygons_below(pixels(grid, [](int, int) { return true; }), -50e-9);
  const std::vector<std::int32_t> y{0, 100, 300, 500, 600};  // the border and the pixels' centres
  ASSERT_EQ(strips.size(), 4u);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_EQ(strips[j], (Polygon{{0, 400, 400, 0}, {y[j], y[j], y[j + 1], y[j + 1]}})) << j;
  }
}

// Levels of a cone: each contour holds the area below its own height, deeper ones less.
TEST(Contours, LieHalfWayBetweenTheirSteps) {
  const Grid grid{120, 120, 12e-6, 12e-6};
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      h(ix, iy) = std::min(0.0, 0.1 * std::hypot(grid.x(ix) - 7e-6, grid.y(iy) - 5e-6) - 400e-9);
  }
  const double low = *std::min_element(h.z.begin(), h.z.end());
  const Layout layout = draw_contours(h, 4);
  ASSERT_EQ(layout.cells.size(), 1u);
  std::vector<std::vector<Polygon>> levels(5);
  for (const auto& [layer, polygon] : layout.cells[0].polygons)
    levels.at(static_cast<std::size_t>(layer)).push_back(polygon);
  EXPECT_TRUE(levels[0].empty());
  for (int k = 1; k <= 4; ++k) {
    const double level = (k - 0.5) / 4 * low, radius = (level + 400e-9) / 0.1;
    const Moments found(levels[static_cast<std::size_t>(k)]);
    EXPECT_NEAR(found.area, kPi * square(radius), 0.03 * kPi * square(radius)) << k;
    EXPECT_NEAR(found.x / found.area, 7e-6, 10e-9) << k;
    EXPECT_NEAR(found.y / found.area, 5e-6, 10e-9) << k;
  }
  EXPECT_TRUE(
      draw_contours(pixels(grid, [](int, int) { return false; }), 4).cells[0].polygons.empty());
}

}  // namespace
}  // namespace papilla::tests::margins_test
