// Seconds of a transform forth and back, by this build's transform: ninja -C build/release
// fft_bench.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "numerics/fft.h"

int main() {
  using namespace papilla::tests;
  for (const int n : {64, 96, 128, 144, 176, 256, 416, 512, 1024}) {
    const auto fft = Fft2d::shared(n, n);
    RealArray x(fft->real_size(), 1.0);
    SpectrumArray spectrum(fft->spectrum_size());
    const auto pair = [&] {
      fft->forward(x.data(), spectrum.data());
      fft->inverse(spectrum.data(), x.data());
      x[0] = 1e-3 * x[0] / (n * n);
    };
    pair();
    using Clock = std::chrono::steady_clock;
    double best = 1e9;
    for (int round = 0; round < 7; ++round) {
      const auto begin = Clock::now();
      const int repeats = 1 + 2000000 / (n * n);
      for (int i = 0; i < repeats; ++i) pair();
      best = std::min(best, std::chrono::duration<double>(Clock::now() - begin).count() / repeats);
    }
    std::fputs(fmt::format("{:5} x {:<5} {:10.2f} us\n", n, n, 1e6 * best).c_str(), stdout);
  }
}
