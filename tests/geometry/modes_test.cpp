// A random surface mode by mode, by sums that know no transform (Eq. geometry.3).
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "geometry/roughness.h"

namespace papilla::tests::modes_test {
namespace {

// Flat to the roll-off, then q^-2(1+H), nothing beyond the cut-off.
double shape(const Spectrum& s, double q) {
  if (q > 2 * kPi / s.cutoff * (1 + 1e-9)) return 0;
  return std::min(1.0, std::pow(q * s.roll_off / (2 * kPi), -2 * (1 + s.hurst)));
}

// Amplitude of each mode [m]: the variance of the reference patch is rms^2, and a mode of another
// patch has its share by the area of wave numbers that it stands for.
double amplitude(const Spectrum& s, const Grid& g, int kx, int ky) {
  const double dq = 2 * kPi / s.reference_length;
  double sum = 0;
  for (int j = -40; j <= 40; ++j) {
    for (int i = -40; i <= 40; ++i) {
      if (i != 0 || j != 0) sum += shape(s, dq * std::hypot(i, j)) * dq * dq;
    }
  }
  const double qx = 2 * kPi / g.lx, qy = 2 * kPi / g.ly;
  return std::sqrt(s.rms * s.rms / sum * qx * qy * shape(s, std::hypot(kx * qx, ky * qy)));
}

std::complex<double> mode(const Heightmap& h, int kx, int ky) {
  std::complex<double> sum = 0;
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      sum += h(ix, iy) / static_cast<double>(h.z.size()) *
             std::polar(1.0,
                        -2 * kPi * (kx * h.grid.x(ix) / h.grid.lx + ky * h.grid.y(iy) / h.grid.ly));
    }
  }
  return sum;
}

// On oblong patches and pixels, smaller and larger than the reference patch of 10 um: cut-offs that
// the grid holds, and one that it does not, where the modes at half the sampling are nothing too.
TEST(Modes, HaveTheAmplitudesOfTheirSpectrum) {
  for (const double cutoff : {2e-6, 0.5e-6}) {
    const Spectrum s{
        .rms = 50e-9, .roll_off = 4e-6, .hurst = 0.6, .cutoff = cutoff, .reference_length = 10e-6};
    for (const Grid& g : {Grid{18, 14, 12e-6, 7e-6}, Grid{14, 20, 6e-6, 16e-6}}) {
      const Heightmap h = random_surface(s, g, 3, 2);
      const Heightmap moved = random_surface(s, g, 3, 2, 1.7e-6, -0.9e-6);
      for (int ky = -g.ny / 2; ky <= g.ny / 2; ++ky) {
        for (int kx = 0; kx <= g.nx / 2; ++kx) {
          const bool held = 2 * kx < g.nx && 2 * std::abs(ky) < g.ny && (kx != 0 || ky != 0);
          const double wanted = held ? amplitude(s, g, kx, ky) : 0;
          const std::complex<double> found = mode(h, kx, ky);
          ASSERT_NEAR(std::abs(found), wanted, 1e-9 * s.rms) << kx << " " << ky;
          // An offset moves the surface: each mode by its own share of a turn.
          const double turn = 2 * kPi * (kx * 1.7e-6 / g.lx - ky * 0.9e-6 / g.ly);
          ASSERT_NEAR(std::abs(mode(moved, kx, ky) - found * std::polar(1.0, -turn)), 0,
                      1e-9 * s.rms)
              << kx << " " << ky;
        }
      }
    }
  }
}

// Heights of 1, 1, 2 and 4 in a row or a column.
TEST(Parameters, OfFewPixelsAreWorkedOutByHand) {
  // Mean 2; deviations -1, -1, 0, 2.
  const RoughnessParameters r = roughness_parameters({{4, 1, 4, 2}, {1, 1, 2, 4}});
  EXPECT_NEAR(r.sa, 1, 1e-15);
  EXPECT_NEAR(r.sq, std::sqrt(1.5), 1e-15);
  EXPECT_NEAR(r.ssk, 1.5 / std::pow(1.5, 1.5), 1e-15);  // (-1 - 1 + 8) / 4
  EXPECT_NEAR(r.sku, 4.5 / 2.25, 1e-15);                // (1 + 1 + 16) / 4
  EXPECT_EQ(r.sp, 2);
  EXPECT_EQ(r.sv, 1);
  EXPECT_EQ(r.sz, 3);
  // Slopes of 0, 1, 2 and, back to the first, -3.
  EXPECT_NEAR(r.sdq, std::sqrt(14.0 / 4), 1e-15);
  EXPECT_NEAR(r.sdr, (std::sqrt(2.0) + std::sqrt(5.0) + std::sqrt(10.0) - 3) / 4, 1e-15);
  EXPECT_TRUE(r.slopes_sampling_limited);
  // Along y, pixels of 1 x 2: half the slopes.
  const RoughnessParameters y = roughness_parameters({{1, 4, 1, 8}, {1, 1, 2, 4}});
  EXPECT_NEAR(y.sdq, 0.5 * std::sqrt(14.0 / 4), 1e-15);
  // A quarter of the whole height in one step is the most that a slope shows: steps of 1 of 4, and
  // of 1.01 of 4.01.
  const auto limited = [](double top) {
    return roughness_parameters({{8, 1, 8, 1}, {0, 1, 2, 3, top, 3, 2, 1}}).slopes_sampling_limited;
  };
  EXPECT_FALSE(limited(4));
  EXPECT_TRUE(limited(4.01));
  // Steps across y as those across x.
  EXPECT_TRUE(
      roughness_parameters({{1, 8, 1, 8}, {0, 1, 2, 3, 4.01, 3, 2, 1}}).slopes_sampling_limited);
  EXPECT_FALSE(
      roughness_parameters({{1, 8, 1, 8}, {0, 1, 2, 3, 4, 3, 2, 1}}).slopes_sampling_limited);
}

}  // namespace
}  // namespace papilla::tests::modes_test
