// Widths of places of few pixels, worked out from what measure_margins does: a middle line from
// four pixels on, below that the largest disc that an opening does not miss.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/constants.h"
#include "geometry/io/mask.h"

namespace papilla::tests::narrow_places_test {
namespace {

constexpr double kPixel = 100e-9;

Heightmap pixels(const Grid& grid, const std::function<bool(int ix, int iy)>& deep) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = deep(ix, iy) ? -1e-7 : 0;
  }
  return h;
}

Grid squares(int nx, int ny) { return {nx, ny, nx * kPixel, ny * kPixel}; }

// In pixels.
PixelMargins margins(const Grid& grid, const std::function<bool(int ix, int iy)>& deep) {
  PixelMargins out = measure_margins(pixels(grid, deep));
  out.min_hole /= kPixel, out.min_wall /= kPixel;
  return out;
}

// The farthest pixel of a stripe of one or two is a pixel from its border, of three two: where even
// the least disc is wider, twice that less half a pixel, or 0.7 more, as of a round hole. From four
// on two neighbours have their borders on either side, or the middle and either neighbour.
TEST(NarrowPlaces, OfStripesAreSaidByTheirPixels) {
  for (const auto& [width, said] : {std::pair{1, 1.5},
                                    {2, 1.5},
                                    {3, 4.7},
                                    {4, 4.0},
                                    {5, 5.0},
                                    {6, 6.0},
                                    {7, 7.0},
                                    {9, 9.0},
                                    {12, 12.0}}) {
    const auto along = [w = width](int i, int) { return i % 32 < w; };
    const auto across = [w = width](int, int j) { return j % 32 < w; };
    EXPECT_NEAR(margins(squares(32, 6), along).min_hole, said, 1e-9) << width;
    EXPECT_NEAR(margins(squares(6, 32), across).min_hole, said, 1e-9) << width;
    EXPECT_NEAR(margins(squares(32, 6), along).min_wall, 32 - width, 1e-9) << width;
  }
}

// A pixel alone, and squares of pixels: their middles are 1, 1, 2, 2 and 3 pixels inside.
TEST(NarrowPlaces, OfSquaresAreSaidByTheirMiddles) {
  for (const auto& [side, said] :
       {std::pair{1, 1.5}, {2, 1.5}, {3, 4.7}, {4, 4.0}, {5, 5.0}, {6, 6.0}, {8, 8.0}}) {
    const double found =
        margins(squares(32, 32), [s = side](int i, int j) { return i < s && j < s; }).min_hole;
    EXPECT_NEAR(found, said, 1e-9) << side;
  }
}

// Two squares of 20 pixels and a way of 14 between them. Of one of three pixels the middle is two
// pixels inside: a disc of a little more misses it, which halving finds to 0.0024 pixels; a quarter
// of a pixel is taken off. From five on the middle line is surer.
TEST(NarrowPlaces, OfALongWayBetweenSquaresAreThoseOfTheWay) {
  const auto way = [](int width) {
    return [=](int i, int j) {
      const bool square = j >= 10 && j < 30 && ((i >= 5 && i < 25) || (i >= 39 && i < 59));
      return square || (i >= 25 && i < 39 && j >= 18 && j < 18 + width);
    };
  };
  EXPECT_NEAR(margins(squares(64, 40), way(3)).min_hole, 2 * 2 - 0.25, 0.003);
  EXPECT_NEAR(margins(squares(64, 40), way(4)).min_hole, 2 * 2 - 0.25, 0.003);
  EXPECT_NEAR(margins(squares(64, 40), way(5)).min_hole, 5, 1e-9);
  EXPECT_NEAR(margins(squares(64, 40), way(8)).min_hole, 8, 1e-9);
  EXPECT_NEAR(margins(squares(64, 40), way(0)).min_hole, 20, 1e-9);
}

// Pixels of 100 x 50 nm: a stripe along the long side is as many short pixels wide, less what a
// long pixel is wider than a short one.
TEST(NarrowPlaces, OfOblongPixelsCountTheLongerSide) {
  const Grid grid{8, 60, 800e-9, 3000e-9};
  for (const int width : {8, 11, 20}) {
    const PixelMargins found = measure_margins(pixels(grid, [&](int, int j) { return j < width; }));
    EXPECT_NEAR(found.min_hole, width * 50e-9 - 50e-9, 1e-15) << width;
    EXPECT_NEAR(found.min_wall, (60 - width) * 50e-9 - 50e-9, 1e-15) << width;
    EXPECT_EQ(found.pixel, 100e-9);
  }
}

// Half the depth parts deep from high: 3 to -7 in steps of 1.
TEST(NarrowPlaces, AreThoseBelowHalfTheDepth) {
  Heightmap h{squares(22, 4), {}};
  for (int iy = 0; iy < 4; ++iy) {
    for (int ix = 0; ix < 22; ++ix) h.z.push_back(3.0 - (ix < 11 ? ix : 21 - ix));
  }
  // Five of either half are below -2; what is at it is not below.
  const PixelMargins found = measure_margins(h);
  EXPECT_NEAR(found.min_hole / kPixel, 10, 1e-9);
  EXPECT_NEAR(found.min_wall / kPixel, 12, 1e-9);
}

// Around a hole of one pixel in a map of 5 x 3 pixels of 1 x 2 um: to the nearest pixel outside.
TEST(Distances, AreToTheNearestPixelOutsideAcrossTheBorder) {
  const Grid grid{5, 3, 5e-6, 6e-6};
  std::vector<std::uint8_t> set(15, 1);
  set[grid.index(4, 2)] = 0;
  const std::vector<double> d = distance_inside(grid, set);
  for (int iy = 0; iy < 3; ++iy) {
    for (int ix = 0; ix < 5; ++ix) {
      const double x = std::min(4 - ix, ix + 1), y = 2 * std::min(2 - iy, iy + 1);
      EXPECT_NEAR(d[grid.index(ix, iy)], 1e-6 * std::hypot(x, y), 1e-18) << ix << " " << iy;
    }
  }
  for (const double v : distance_inside(grid, std::vector<std::uint8_t>(15, 1)))
    EXPECT_EQ(v, kInfinity);
  for (const double v : distance_inside(grid, std::vector<std::uint8_t>(15, 0))) EXPECT_EQ(v, 0);
}

// --- polygons ---

// A pixel of 3 x 3 that is as deep as the others are high: the contour passes half way to each
// neighbour. The cells around it are halved from corner to corner: two have a triangle alone, two
// have two, by the way that their diagonal goes.
TEST(Outlines, OfOneDeepPixelAreSixTriangles) {
  const Grid grid{3, 3, 600e-9, 300e-9};
  const std::vector<Polygon> found =
      polygons_below(pixels(grid, [](int i, int j) { return i == 1 && j == 1; }), -50e-9);
  // Centres lie at 100, 300, 500 along x and 50, 150, 250 along y; half way: 200, 400 and 100, 200.
  EXPECT_EQ(found, (std::vector<Polygon>{{{300, 300, 200}, {100, 150, 100}},
                                         {{200, 300, 200}, {100, 150, 150}},
                                         {{400, 300, 300}, {150, 150, 100}},
                                         {{200, 300, 300}, {150, 150, 200}},
                                         {{300, 400, 400}, {150, 150, 200}},
                                         {{300, 400, 300}, {150, 200, 200}}}))
      << found.size();
}

// The corner of a map is closed at its border: half a pixel, the strip between, the triangle.
TEST(Outlines, OfACornerAreClosedAtTheBorder) {
  const Grid grid{2, 2, 400e-9, 200e-9};  // centres at 100, 300 and 50, 150
  const std::vector<Polygon> found =
      polygons_below(pixels(grid, [](int i, int j) { return i == 0 && j == 0; }), -50e-9);
  double area = 0;
  std::int32_t right = 0, top = 0;
  for (const Polygon& p : found) {
    for (std::size_t i = 0; i < p.x.size(); ++i) {
      const std::size_t j = (i + 1) % p.x.size();
      area += 0.5 * (static_cast<double>(p.x[i]) * p.y[j] - static_cast<double>(p.x[j]) * p.y[i]);
      right = std::max(right, p.x[i]), top = std::max(top, p.y[i]);
    }
  }
  // Half a pixel along either side and the corner between: 100 x 50, two halves of 100 x 50, and
  // two triangles, a quarter of 200 x 100.
  EXPECT_EQ(right, 200);
  EXPECT_EQ(top, 100);
  EXPECT_EQ(area, 100 * 50 + 2 * 100 * 50 + 100 * 50);
  EXPECT_EQ(found.front(), (Polygon{{0, 100, 100, 0}, {0, 0, 50, 50}}));
}

}  // namespace
}  // namespace papilla::tests::narrow_places_test
