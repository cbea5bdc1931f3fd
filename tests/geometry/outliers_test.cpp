// Outliers that are so high that the plane of the map lies above its land: they are judged from its
// median, and count for no plane.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/scan.h"
#include "tests/temporary.h"

namespace papilla::tests::outliers_test {
namespace {

constexpr Grid kGrid{100, 80, 10e-6, 12e-6};

// 150 of 8000 pixels, anywhere, 1 um above land of -1 to 1 nm: their mean is 19 nm, their limit
// some 4 nm.
TEST(Outliers, AreThoseFarFromTheMedianNotFromThePlane) {
  for (const double sign : {1.0, -1.0}) {
    RandomStream random(3, "outliers of a test", 0);
    Heightmap h{kGrid, std::vector<double>(kGrid.size())};
    for (double& z : h.z) z = 1e-9 * random.uniform(-1, 1);
    std::vector<std::uint8_t> spike(h.z.size());
    for (std::size_t k = 0; k < 150; ++k) {
      const std::size_t i = (k * 53 + 17) % h.z.size();
      spike[i] = 1;
      h.z[i] = sign * 1e-6;
    }
    const std::string file = temporary("outliers.gsf");
    write_gsf(file, h, {});
    const Scan scan = read_scan({file, 0});
    EXPECT_EQ(scan.changes.replaced, 150u);
    EXPECT_NEAR(scan.changes.furthest, 1e-6, 10e-9);
    double low = 1, high = -1;  // of the mended map: a land of 2 nm about 0
    for (const double z : scan.map.z) low = std::min(low, z), high = std::max(high, z);
    EXPECT_LT(high - low, 2e-9 + scan.changes.rise);
    EXPECT_LT(scan.changes.rise, 0.2e-9);
    EXPECT_NEAR(0.5 * (low + high), 0, 0.1e-9);
  }
}

// A grain of dust in a corner, 12 x 12 pixels of 3 um: with it the plane would be 2.8 deg, not 1.1.
TEST(Outliers, CountForNoPlane) {
  RandomStream random(5, "outliers of a test", 0);
  Heightmap dusty{kGrid, std::vector<double>(kGrid.size())};
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix)
      dusty(ix, iy) = 20e-9 * random.uniform(-1, 1) + 0.02 * kGrid.x(ix);
  }
  Heightmap holed = dusty;
  for (int iy = 62; iy < 74; ++iy) {
    for (int ix = 82; ix < 94; ++ix) dusty(ix, iy) += 3e-6, holed(ix, iy) = std::nan("");
  }
  const std::string file = temporary("dust.gsf");
  write_gsf(file, dusty, {});
  const Scan scan = read_scan({file, 0});
  EXPECT_EQ(scan.changes.replaced, 144u);
  EXPECT_NEAR(scan.changes.slope_x, 0.02, 3e-4);
  EXPECT_NEAR(scan.changes.slope_y, 0, 3e-4);
  // As if the grain were not measured.
  write_gsf(file, holed, {});
  const Scan filled = read_scan({file, 0, true});
  EXPECT_NEAR(scan.changes.rise, filled.changes.rise, 1e-15);
  EXPECT_NEAR(scan.changes.rms, filled.changes.rms, 1e-15);
  for (std::size_t i = 0; i < dusty.z.size(); ++i)
    ASSERT_NEAR(scan.map.z[i], filled.map.z[i], 1e-15) << i;
}

// A hole in the numbers of 3 x 3 gets, from its border in, the mean of the nearest ring that has
// some: its middle of sixteen, its corner of five, its side of three.
TEST(Outliers, GetTheMeanOfTheNearestSquareAroundThem) {
  RandomStream random(4, "outliers of a test", 0);
  Heightmap h{kGrid, std::vector<double>(kGrid.size())};
  for (double& z : h.z) z = random.uniform(-1e-9, 1e-9);
  for (int iy = 30; iy < 33; ++iy) {
    for (int ix = 50; ix < 53; ++ix) h(ix, iy) = std::nan("");
  }
  const std::string file = temporary("hole.npy");
  write_npy(file, h);
  const Scan scan = read_scan({file, 10e-6, true, true});
  EXPECT_EQ(scan.changes.filled, 9u);
  const auto mean = [&](int ix, int iy, int reach) {
    double sum = 0;
    int count = 0;
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const double z = h(ix + i, iy + j);
        if (std::max(std::abs(i), std::abs(j)) != reach || std::isnan(z)) continue;
        sum += z;
        ++count;
      }
    }
    return sum / count;
  };
  for (int iy = 30; iy < 33; ++iy) {
    for (int ix = 50; ix < 53; ++ix)
      EXPECT_NEAR(scan.map(ix, iy), mean(ix, iy, ix == 51 && iy == 31 ? 2 : 1), 1e-22)
          << ix << " " << iy;
  }
}

}  // namespace
}  // namespace papilla::tests::outliers_test
