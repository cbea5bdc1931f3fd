#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/fft.h"
#include "base/parallel.h"
#include "base/quadrature.h"
#include "base/random.h"
#include "base/statistics.h"
#include "base/text.h"

namespace papilla::tests {
namespace {

TEST(Quadrature, GaussLegendreIsExactForDegree2nMinus1) {
  for (int n : {1, 2, 3, 5, 8, 13, 40}) {
    const Quadrature rule = gauss_legendre(n, 0, 2);
    for (int degree = 0; degree < 2 * n; degree += degree < 4 ? 1 : 5) {
      const double exact = std::pow(2, degree + 1) / (degree + 1);
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
      EXPECT_NEAR(sum, exact, 1e-12 * exact) << n << " nodes, degree " << degree;
    }
    for (int i = 0; i < n; ++i) {  // ascending, and the same from both ends
      EXPECT_NEAR(rule.nodes[i] + rule.nodes[n - 1 - i], 2, 1e-14);
      if (i > 0) {
        EXPECT_GT(rule.nodes[i], rule.nodes[i - 1]);
      }
    }
  }
}

TEST(RandomStream, HasUnitVarianceAndIndependentStreams) {
  RandomStream a(1, "skin", 0), b(1, "skin", 1);
  double sum = 0, squares = 0, cross = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = a.normal(), y = b.normal();
    sum += x;
    squares += x * x;
    cross += x * y;
  }
  EXPECT_NEAR(sum / n, 0, 0.01);
  EXPECT_NEAR(squares / n, 1, 0.02);
  EXPECT_NEAR(cross / n, 0, 0.01);
}

// By splitmix64 and Box and Muller as they are published, in another language: committed results
// rest on these numbers.
TEST(RandomStream, GivesTheSameNumbersForEver) {
  RandomStream bits(7, "skin", 3), normal(7, "skin", 3);
  EXPECT_EQ(bits.bits(), 0x9b7f177232625335u);
  EXPECT_EQ(bits.bits(), 0xa35781a1f5d6de4du);
  EXPECT_NEAR(normal.normal(), -0.8844745968633166, 1e-15);
  EXPECT_NEAR(normal.normal(), -1.0429158671584529, 1e-15);
  EXPECT_EQ(hash_uniform(7, 2, 3), 0.17259623044524586);
}

TEST(RandomStream, IsUniformOverItsRangeAndNamed) {
  RandomStream random(5, "range");
  double low = 1, high = 0, sum = 0;
  std::vector<int> counts(7);
  constexpr int n = 70000;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(2, 5);
    low = std::min(low, (u - 2) / 3);
    high = std::max(high, (u - 2) / 3);
    sum += u;
    ++counts[static_cast<std::size_t>(random.below(7))];
  }
  EXPECT_GE(low, 0);
  EXPECT_LT(low, 1e-3);
  EXPECT_LT(high, 1);
  EXPECT_GT(high, 1 - 1e-3);
  EXPECT_NEAR(sum / n, 3.5, 0.02);
  for (int count : counts) EXPECT_NEAR(count, n / 7, 400);  // four standard deviations
  const double first = RandomStream(5, "range", 0).uniform();
  EXPECT_NE(first, RandomStream(6, "range", 0).uniform());
  EXPECT_NE(first, RandomStream(5, "rangf", 0).uniform());
  EXPECT_NE(first, RandomStream(5, "range", 1).uniform());
  EXPECT_NE(hash_uniform(1, 2, 3), hash_uniform(1, 3, 2));
  EXPECT_NE(hash_uniform(1, 2, 3), hash_uniform(2, 2, 3));
}

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

TEST(ParallelFor, RethrowsTheLowestFailure) {
  try {
    parallel_for(100, [](int i) {
      if (i % 7 == 5) throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "5");
  }
}

TEST(ParallelFor, CallsEachOnceWhateverTheThreads) {
  for (int threads : {0, 1, 3}) {
    std::vector<int> calls(50);
    parallel_for(
        50, [&](int i) { ++calls[static_cast<std::size_t>(i)]; }, threads);
    EXPECT_EQ(calls, std::vector<int>(50, 1));
  }
}

// Tables of Student's distribution (Abramowitz & Stegun 26.10), and its closed forms at 1 and 2.
TEST(Statistics, StudentsDistributionHasItsTabulatedValues) {
  EXPECT_NEAR(student_t_cdf(2.571, 5), 0.975, 2e-5);
  EXPECT_NEAR(student_t_cdf(4.032, 5), 0.995, 2e-5);
  EXPECT_NEAR(student_t_cdf(1.812, 10), 0.95, 5e-5);
  EXPECT_NEAR(student_t_cdf(3.385, 30), 0.999, 2e-6);
  for (double t : {-30.0, -1.7, -0.01, 0.0, 0.3, 2.5, 400.0}) {
    EXPECT_NEAR(student_t_cdf(t, 1), 0.5 + std::atan(t) / std::acos(-1.0), 1e-10) << t;
    EXPECT_NEAR(student_t_cdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-10) << t;
    EXPECT_NEAR(student_t_cdf(t, 1e9), normal_cdf(t), 1e-9) << t;
    EXPECT_NEAR(student_t_cdf(t, 0.9999e5), student_t_cdf(t, 1.0001e5), 1e-9) << t;
  }
}

TEST(Text, AZeroHasNoSign) {
  EXPECT_EQ(fixed(-0.0001, 3), "0.000");
  EXPECT_EQ(fixed(0.0, 3), "0.000");
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed(12.5, 1), "12.5");
  EXPECT_EQ(fixed(-10.0, 0), "-10");
}

}  // namespace
}  // namespace papilla::tests
