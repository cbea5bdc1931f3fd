// Transforms against their definition.
#include "numerics/fft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "base/random.h"

namespace papilla::tests::fft_test {
namespace {

RealArray noise(std::size_t count) {
  RandomStream random(7, "fft", 0);
  RealArray out(count);
  for (double& v : out) v = random.uniform() - 0.5;
  return out;
}

class Fft : public ::testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(Fft, IsTheSumOfItsDefinition) {
  const auto [nx, ny] = GetParam();
  const Fft2d fft(nx, ny);
  const RealArray x = noise(fft.real_size());
  SpectrumArray spectrum(fft.spectrum_size());
  fft.forward(x.data(), spectrum.data());
  for (const auto& [kx, ky] : {std::pair{0, 0},
                               {1 % fft.half(), 0},
                               {fft.half() - 1, ny - 1},
                               {fft.half() / 2, ny / 2},
                               {0, ny - 1}}) {
    std::complex<double> sum = 0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        sum += x[static_cast<std::size_t>(j * nx + i)] *
               std::polar(1.0, -2 * kPi * (1.0 * kx * i / nx + 1.0 * ky * j / ny));
      }
    }
    const auto got = spectrum[static_cast<std::size_t>(ky * fft.half() + kx)];
    EXPECT_NEAR(std::abs(got - sum), 0, 1e-12 * nx * ny) << kx << ", " << ky;
  }
}

TEST_P(Fft, ComesBackByTheInverse) {
  const auto [nx, ny] = GetParam();
  const auto fft = Fft2d::shared(nx, ny);
  const RealArray x = noise(fft->real_size());
  SpectrumArray spectrum(fft->spectrum_size());
  RealArray back(fft->real_size());
  fft->forward(x.data(), spectrum.data());
  fft->inverse(spectrum.data(), back.data());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::abs(back[i] / (nx * ny) - x[i]));
  EXPECT_LT(worst, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Fft,
                         ::testing::Values(std::tuple{1, 1}, std::tuple{2, 3}, std::tuple{8, 8},
                                           std::tuple{96, 80}, std::tuple{144, 128},
                                           std::tuple{154, 130}, std::tuple{45, 63},
                                           std::tuple{31, 29}, std::tuple{37, 74},
                                           std::tuple{202, 101}, std::tuple{113, 34}));

TEST(Fft2d, HoldsAWaveAtItsModeAlone) {
  const int nx = 12, ny = 10;
  const Fft2d fft(nx, ny);
  for (const auto& [mx, my] : {std::pair{2, 3}, {1, -4}, {0, 2}}) {
    RealArray x(fft.real_size());
    for (int iy = 0; iy < ny; ++iy)
      for (int ix = 0; ix < nx; ++ix)
        x[static_cast<std::size_t>(iy) * nx + ix] =
            std::cos(2 * kPi * (mx * ix / double(nx) + my * iy / double(ny)));
    SpectrumArray s(fft.spectrum_size());
    fft.forward(x.data(), s.data());
    for (int iy = 0; iy < ny; ++iy) {
      for (int kx = 0; kx < fft.half(); ++kx) {
        const int ky = signed_mode(iy, ny);
        const bool here = kx == mx && (ky == my || (mx == 0 && ky == -my));
        const auto& v = s[static_cast<std::size_t>(iy) * fft.half() + kx];
        EXPECT_NEAR(std::abs(v), here ? nx * ny / 2 : 0, 1e-12) << kx << " " << ky;
      }
    }
  }
}

TEST(Fft2d, ForwardThenInverseIsTheIdentityTimesN) {
  for (auto [nx, ny] : {std::pair{8, 8}, {15, 7}, {13, 16}}) {
    const Fft2d fft(nx, ny);
    RealArray x(fft.real_size()), y(fft.real_size());
    SpectrumArray s(fft.spectrum_size());
    RandomStream random(3, "test");
    for (double& v : x) v = random.normal();
    fft.forward(x.data(), s.data());
    fft.inverse(s.data(), y.data());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i] / (nx * ny), x[i], 1e-14);
  }
}

}  // namespace
}  // namespace papilla::tests::fft_test
