#include "base/convolution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace papilla::tests {
namespace {

TEST(Convolution, EqualsItsTransformsToRounding) {
  for (const auto& [nx, ny] : {std::pair{32, 32},
                               {64, 32},
                               {32, 128},
                               {256, 64},
                               {128, 128},
                               {96, 112},
                               {80, 144},
                               {176, 208},
                               {240, 336}}) {
    ASSERT_TRUE(Convolution::suits(nx, ny));
    const Fft2d fft(nx, ny);
    const Convolution convolution(nx, ny);
    std::vector<double> symbol(fft.spectrum_size());
    for (int ky = 0; ky < ny; ++ky) {
      for (int kx = 0; kx < fft.half(); ++kx) {
        symbol[static_cast<std::size_t>(ky) * fft.half() + kx] =
            1 / (1.0 + kx + 0.3 * std::abs(signed_mode(ky, ny)));
      }
    }
    RandomStream random(1, "test", 0);
    RealArray in(fft.real_size()), expected(in.size()), out(in.size());
    for (double& v : in) v = random.uniform();
    SpectrumArray spectrum(fft.spectrum_size()), scratch(convolution.scratch_size());
    fft.forward(in.data(), spectrum.data());
    for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= symbol[i];
    fft.inverse(spectrum.data(), expected.data());
    const RealArray arranged = convolution.arrange(symbol);
    convolution.apply(in.data(), arranged, scratch.data(), out.data());
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      worst = std::max(worst, std::abs(out[i] - expected[i]));
      largest = std::max(largest, std::abs(expected[i]));
    }
    EXPECT_LT(worst, 1e-14 * largest) << nx << " x " << ny;
    convolution.apply(in.data(), arranged, scratch.data(), in.data());  // in place
    EXPECT_EQ(in, out);
  }
  EXPECT_FALSE(Convolution::suits(72, 64));
  EXPECT_FALSE(Convolution::suits(16, 64));
  EXPECT_FALSE(Convolution::suits(64, 17 * 16));
}

}  // namespace
}  // namespace papilla::tests
