// Rules for integrals against integrals known in closed form.
#include "numerics/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "base/error.h"

namespace papilla::tests::quadrature_test {
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

TEST(GaussLegendre, OfFewNodesIsPrintedAndOfManyAddsUp) {
  const Quadrature two = gauss_legendre(2), three = gauss_legendre(3, 1, 5);
  EXPECT_NEAR(two.nodes[0], -1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(two.nodes[1], 1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(two.weights[0], 1, 1e-15);
  EXPECT_NEAR(two.weights[1], 1, 1e-15);
  EXPECT_NEAR(three.nodes[0], 3 - 2 * std::sqrt(0.6), 1e-14);
  EXPECT_NEAR(three.nodes[1], 3, 1e-14);
  EXPECT_NEAR(three.nodes[2], 3 + 2 * std::sqrt(0.6), 1e-14);
  EXPECT_NEAR(three.weights[0], 10 / 9.0, 1e-14);
  EXPECT_NEAR(three.weights[1], 16 / 9.0, 1e-14);
  for (const int n : {64, 401, 800}) {
    const Quadrature rule = gauss_legendre(n, -3, 4);
    double length = 0, oscillating = 0;
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      ASSERT_TRUE(i == 0 || rule.nodes[at] > rule.nodes[at - 1]) << i;
      length += rule.weights[at];
      oscillating += rule.weights[at] * std::cos(11 * rule.nodes[at]);
    }
    EXPECT_NEAR(length, 7, 1e-11) << n;
    EXPECT_NEAR(oscillating, (std::sin(44.0) + std::sin(33.0)) / 11, 1e-12) << n;
  }
  EXPECT_THROW(gauss_legendre(0), InternalError);
}

}  // namespace
}  // namespace papilla::tests::quadrature_test
