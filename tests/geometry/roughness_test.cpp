// Roughness parameters of surfaces whose integrals are known.
#include "geometry/roughness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/constants.h"

namespace papilla::tests::roughness_test {
namespace {

Heightmap surface(const Grid& grid, const std::function<double(double, double)>& height) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy)
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = height(grid.x(ix), grid.y(iy));
  return h;
}

// One wave on an oblong grid, along x and along y; the mean plane counts for nothing.
TEST(RoughnessParameters, OfAWaveAreItsIntegrals) {
  const Grid grid{240, 160, 12e-6, 4e-6};
  const double a = 50e-9, kx = 2 * kPi / 6e-6, ky = 2 * kPi / 2e-6;
  for (const bool along_x : {true, false}) {
    const Heightmap h = surface(
        grid, [&](double x, double y) { return 3e-6 + a * std::sin(along_x ? kx * x : ky * y); });
    const RoughnessParameters r = roughness_parameters(h);
    EXPECT_NEAR(r.sa, 2 * a / kPi, 1e-3 * a);
    EXPECT_NEAR(r.sq, a / std::sqrt(2.0), 1e-6 * a);
    EXPECT_NEAR(r.ssk, 0, 1e-6);
    EXPECT_NEAR(r.sku, 1.5, 1e-6);
    EXPECT_NEAR(r.sp, a, 1e-3 * a);
    EXPECT_NEAR(r.sv, a, 1e-3 * a);
    EXPECT_NEAR(r.sz, 2 * a, 2e-3 * a);
    const double slope = a * (along_x ? kx : ky) / std::sqrt(2.0);
    EXPECT_NEAR(r.sdq, slope, 1e-3 * slope);
    EXPECT_NEAR(r.sdr, slope * slope / 2, 0.02 * slope * slope);  // of small slopes
    EXPECT_FALSE(r.slopes_sampling_limited);
  }
}

TEST(RoughnessParameters, OfTwoLevelsAreThoseOfTheirShare) {
  const Grid grid{40, 10, 4e-6, 1e-6};
  const double share = 0.2, depth = 100e-9;  // of the lower level
  const Heightmap h =
      surface(grid, [&](double x, double) { return x < share * 4e-6 ? -depth : 0.0; });
  const RoughnessParameters r = roughness_parameters(h);
  EXPECT_NEAR(r.sa, 2 * share * (1 - share) * depth, 1e-15);
  EXPECT_NEAR(r.sq, std::sqrt(share * (1 - share)) * depth, 1e-15);
  EXPECT_NEAR(r.ssk, (2 * share - 1) / std::sqrt(share * (1 - share)), 1e-9);
  EXPECT_NEAR(r.sku, 1 / (share * (1 - share)) - 3, 1e-9);
  EXPECT_NEAR(r.sp, share * depth, 1e-15);
  EXPECT_NEAR(r.sv, (1 - share) * depth, 1e-15);
  // Two walls a row, each a whole depth in one pixel of 100 nm: slope 1.
  EXPECT_NEAR(r.sdq, std::sqrt(2.0 / 40), 1e-9);
  EXPECT_NEAR(r.sdr, 2.0 / 40 * (std::sqrt(2.0) - 1), 1e-9);
  EXPECT_TRUE(r.slopes_sampling_limited);
}

TEST(RoughnessParameters, OfAPlaneAreNothing) {
  const RoughnessParameters r =
      roughness_parameters(surface({8, 8, 1, 1}, [](double, double) { return 0.25; }));
  for (const double v : {r.sa, r.sq, r.ssk, r.sku, r.sp, r.sv, r.sz, r.sdq, r.sdr}) EXPECT_EQ(v, 0);
  EXPECT_FALSE(r.slopes_sampling_limited);
}

// The spectrum has its rms over the reference patch, whatever the patch; on a larger one the long
// waves add, on a coarse grid the short ones are missing.
TEST(RandomSurface, HasTheVarianceOfItsSpectrum) {
  const Spectrum s{
      .rms = 100e-9, .roll_off = 2e-6, .hurst = 0.8, .cutoff = 0.5e-6, .reference_length = 10e-6};
  const Grid square{128, 128, 10e-6, 10e-6}, oblong{256, 64, 20e-6, 5e-6};
  for (const Grid& grid : {square, oblong}) {
    const Heightmap h = random_surface(s, grid, 3, 1);
    EXPECT_NEAR(roughness_parameters(h).sq, s.rms, 0.03 * s.rms);
    // Moved by whole pixels it is the same surface.
    const Heightmap moved = random_surface(s, grid, 3, 1, 5 * grid.dx(), -7 * grid.dy());
    for (int iy = 0; iy < grid.ny; iy += 9) {
      for (int ix = 0; ix < grid.nx; ix += 11)
        ASSERT_NEAR(moved(wrap(ix + 5, grid.nx), wrap(iy - 7, grid.ny)), h(ix, iy), 1e-18);
    }
  }
  // Twice as fine a grid samples the same heights.
  const Heightmap fine = random_surface(s, {384, 384, 10e-6, 10e-6}, 3, 1),
                  coarse = random_surface(s, square, 3, 1);
  for (int i = 0; i < 128; i += 5) ASSERT_NEAR(fine(3 * i + 1, 3 * i + 1), coarse(i, i), 1e-18);
  EXPECT_EQ(random_surface({.rms = 0}, square, 1, 1).z, std::vector<double>(square.size(), 0));
}

}  // namespace
}  // namespace papilla::tests::roughness_test
