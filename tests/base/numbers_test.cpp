#include <gtest/gtest.h>

#include <cmath>

#include "base/fft.h"
#include "base/parallel.h"
#include "base/quadrature.h"
#include "base/random.h"
#include "base/statistics.h"

namespace papilla {
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

}  // namespace
}  // namespace papilla
