#include <gtest/gtest.h>

#include <cmath>

#include "base/fft.h"
#include "base/parallel.h"
#include "base/quadrature.h"
#include "base/random.h"
#include "base/statistics.h"
#include "base/text.h"

namespace papilla::tests {
namespace {

TEST(Quadrature, GaussLegendreIsExactForDegree2nMinus1) {
  const Quadrature rule = gauss_legendre(5, 0, 2);
  double sum = 0;
  for (int i = 0; i < 5; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], 9);
  EXPECT_NEAR(sum, std::pow(2, 10) / 10, 1e-11);
}

TEST(Statistics, StudentQuantilesMatchTables) {
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.7062, 1e-3);
  EXPECT_NEAR(student_t_quantile(0.975, 2), 4.30265, 1e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.22814, 1e-3);
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 1e-6);
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
