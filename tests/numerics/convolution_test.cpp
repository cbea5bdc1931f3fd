#include "numerics/convolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/random.h"
#include "numerics/fft.h"

namespace papilla::tests::convolution_test {
namespace {

template <class Real>
void equals_its_transforms(const std::vector<std::pair<int, int>>& sizes, double tolerance) {
  for (const auto& [nx, ny] : sizes) {
    ASSERT_TRUE(BasicConvolution<Real>::suits(nx, ny));
    const Fft2d fft(nx, ny);
    const BasicConvolution<Real> convolution(nx, ny);
    std::vector<double> symbol(fft.spectrum_size());
    for (int ky = 0; ky < ny; ++ky) {
      for (int kx = 0; kx < fft.half(); ++kx) {
        symbol[static_cast<std::size_t>(ky) * fft.half() + kx] =
            1 / (1.0 + kx + 0.3 * std::abs(signed_mode(ky, ny)));
      }
    }
    RandomStream random(1, "test", 0);
    RealArray values(fft.real_size()), expected(values.size());
    for (double& v : values) v = random.uniform();
    AlignedArray<Real> in(values.begin(), values.end()), out(in.size());
    SpectrumArray spectrum(fft.spectrum_size());
    AlignedArray<std::complex<Real>> scratch(convolution.scratch_size());
    fft.forward(values.data(), spectrum.data());
    for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= symbol[i];
    fft.inverse(spectrum.data(), expected.data());
    const AlignedArray<Real> arranged = convolution.arrange(symbol);
    convolution.apply(in.data(), arranged, scratch.data(), out.data());
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      worst = std::max(worst, std::abs(out[i] - expected[i]));
      largest = std::max(largest, std::abs(expected[i]));
    }
    EXPECT_LT(worst, tolerance * largest) << nx << " x " << ny;
    convolution.apply(in.data(), arranged, scratch.data(), in.data());  // in place
    EXPECT_EQ(in, out);
  }
}

TEST(Convolution, EqualsItsTransformsToRounding) {
  equals_its_transforms<double>({{32, 32},
                                 {64, 32},
                                 {32, 128},
                                 {256, 64},
                                 {128, 128},
                                 {96, 112},
                                 {80, 144},
                                 {176, 208},
                                 {240, 336}},
                                1e-14);
  EXPECT_FALSE(Convolution::suits(72, 64));
  EXPECT_FALSE(Convolution::suits(16, 64));
  EXPECT_FALSE(Convolution::suits(64, 17 * 16));
}

TEST(Convolution, InSinglePrecisionToItsRounding) {
  equals_its_transforms<float>(
      {{32, 32}, {64, 32}, {32, 128}, {256, 64}, {128, 128}, {96, 160}, {352, 416}}, 1e-6);
  EXPECT_FALSE(BasicConvolution<float>::suits(48, 64));
  EXPECT_FALSE(BasicConvolution<float>::suits(64, 80));
}

}  // namespace
}  // namespace papilla::tests::convolution_test
