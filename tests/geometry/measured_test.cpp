// A measured map as a texture: where its cut lies, that it is level, mended and without a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

constexpr double kWidth = 20e-6, kHeight = 16e-6, kPatch = 12e-6;

// Waves of 5 um along x and 4 um along y, whole ones on the map: their least-squares plane is flat.
double wave(double x, double y) {
  return 100e-9 * std::cos(2 * kPi * x / 5e-6) + 60e-9 * std::cos(2 * kPi * y / 4e-6);
}

// The cut of a map that a file holds, `change` made to it before.
Heightmap cut_of(const std::string& name,
                 const std::function<double(double x, double y, double z)>& change) {
  const Grid whole{400, 320, kWidth, kHeight};
  Heightmap map{whole, std::vector<double>(whole.size())};
  for (int iy = 0; iy < whole.ny; ++iy) {
    for (int ix = 0; ix < whole.nx; ++ix) {
      const double x = whole.x(ix), y = whole.y(iy);
      map(ix, iy) = change(x, y, wave(x, y));
    }
  }
  const std::string file = temporary(name + ".npy");
  write_npy(file, map);
  Measured3d measured;
  measured.file = file;
  measured.width = kWidth;
  measured.patch = kPatch;
  return generate(Texture{measured}, Grid{96, 96, kPatch, kPatch});
}

double as_it_is(double, double, double z) { return z; }

double largest_difference(const Heightmap& a, const Heightmap& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.z.size(); ++i) out = std::max(out, std::abs(a.z[i] - b.z[i]));
  return out;
}

TEST(MeasuredMap, TheCutIsFromTheMiddle) {
  const Heightmap h = cut_of("plain", as_it_is);
  const double x0 = 0.5 * (kWidth - kPatch), y0 = 0.5 * (kHeight - kPatch);
  // Below the bands that are blended over the border.
  for (int iy = 0; iy < 84; ++iy) {
    for (int ix = 0; ix < 84; ++ix)
      ASSERT_NEAR(h(ix, iy), wave(x0 + h.grid.x(ix), y0 + h.grid.y(iy)), 2e-9) << ix << " " << iy;
  }
}

TEST(MeasuredMap, ATiltIsTakenAway) {
  const Heightmap tilted =
      cut_of("tilted", [](double x, double y, double z) { return z + 2e-6 + 0.05 * x - 0.03 * y; });
  EXPECT_LT(largest_difference(tilted, cut_of("plain", as_it_is)), 1e-12);
}

TEST(MeasuredMap, ASpikeIsMendedByItsNeighboursUpAndDown) {
  for (double spike : {5e-6, -5e-6}) {
    const Heightmap h = cut_of(spike > 0 ? "up" : "down", [&](double x, double y, double z) {
      return std::hypot(x - 9.025e-6, y - 8.025e-6) < 30e-9 ? spike : z;
    });
    EXPECT_LT(largest_difference(h, cut_of("plain", as_it_is)), 1e-9) << spike;
  }
}

TEST(MeasuredMap, RepeatsWithoutAStep) {
  const Heightmap h = cut_of("plain", as_it_is);
  double inside = 0, across = 0;
  for (int i = 0; i < 96; ++i) {
    for (int k = 1; k < 96; ++k) {
      inside = std::max({inside, std::abs(h(k, i) - h(k - 1, i)), std::abs(h(i, k) - h(i, k - 1))});
    }
    across = std::max({across, std::abs(h(0, i) - h(95, i)), std::abs(h(i, 0) - h(i, 95))});
  }
  EXPECT_LT(across, 1.2 * inside);
}

}  // namespace
}  // namespace papilla::tests
