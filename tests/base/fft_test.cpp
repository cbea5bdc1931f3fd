// The transform of this build: FFTW's, or our own.
#include "base/fft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "base/fft_lanes.h"
#include "base/random.h"

namespace papilla::tests {
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

std::vector<LaneValue> transformed(int n, std::vector<LaneValue> x) {
  const LaneFft fft(n);
  std::vector<LaneValue> scratch(static_cast<std::size_t>(fft.scratch_length()));
  fft.forward(x.data(), scratch.data());
  return x;
}

TEST(LaneFft, TransformsEveryLaneAlone) {
  for (int n : {12, 26, 31, 37, 60, 97}) {
    std::vector<LaneValue> x(static_cast<std::size_t>(n));
    for (int l = 0; l < kLanes; ++l) x[static_cast<std::size_t>(l % n)].re[l] = 1 + l;
    const auto spectrum = transformed(n, x);
    for (int l = 0; l < kLanes; ++l) {
      const std::complex<double> expected = (1.0 + l) * std::polar(1.0, -2 * kPi * 3 * l / n);
      EXPECT_NEAR(spectrum[3].re[l], expected.real(), 1e-13 * (1 + l)) << n << ", lane " << l;
      EXPECT_NEAR(spectrum[3].im[l], expected.imag(), 1e-13 * (1 + l)) << n << ", lane " << l;
    }
  }
}

// Of a full build Fft2d is FFTW: every length up to 300, of any factors.
TEST(LaneFft, HasTheNumbersOfTheTransformOfThisBuild) {
  for (int n = 1; n <= 300; ++n) {
    const Fft2d fft(n, 1);
    const RealArray row = noise(fft.real_size());
    SpectrumArray expected(fft.spectrum_size());
    fft.forward(row.data(), expected.data());
    std::vector<LaneValue> x(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < x.size(); ++i) x[i].re[5] = row[i];
    const auto spectrum = transformed(n, x);
    double worst = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      worst = std::max(worst,
                       std::abs(std::complex(spectrum[k].re[5], spectrum[k].im[5]) - expected[k]));
    }
    EXPECT_LT(worst, 2e-15 * n) << n;
  }
}

}  // namespace
}  // namespace papilla::tests
