// Small systems with solutions and determinants worked out by hand.
#include "numerics/dense.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace papilla::tests::dense_test {
namespace {

TEST(LinearSystems, AreSolvedWithTheirDeterminant) {
  std::array<double, 2> two{4, 11};
  EXPECT_NEAR(numerics::solve<2>({{{0, 2}, {3, 4}}}, two), -6, 1e-14);  // 2 y = 4, 3 x + 4 y = 11
  EXPECT_NEAR(two[0], 1, 1e-15);
  EXPECT_NEAR(two[1], 2, 1e-15);
  // Determinant 1 (50 - 48) - 2 (40 - 42) + 3 (32 - 35) = -3, for (1, 2, 3).
  std::array<double, 3> three{14, 32, 53};
  EXPECT_NEAR(numerics::solve<3>({{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}}, three), -3, 1e-13);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(three[i], i + 1, 1e-13);
  // Each row has one entry: an odd permutation, 2 x 3 x 4 x 5.
  std::array<double, 4> four{6, 12, 4, 5};
  EXPECT_NEAR(numerics::solve<4>({{{0, 0, 2, 0}, {0, 3, 0, 0}, {4, 0, 0, 0}, {0, 0, 0, 5}}}, four),
              -120, 1e-12);
  EXPECT_EQ(four, (std::array<double, 4>{1, 4, 3, 1}));
  // A dense one with the pivot last.
  std::array<double, 4> dense{1 + 4 + 9 + 16, 2 + 2 - 3 + 4, 3 - 2 + 3 + 8, 8 + 2 + 6 - 4};
  const std::array<std::array<double, 4>, 4> a{
      {{1, 2, 3, 4}, {2, 1, -1, 1}, {3, -1, 1, 2}, {8, 1, 2, -1}}};
  const double determinant = numerics::solve<4>(a, dense);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(dense[i], i + 1, 1e-13);
  // By cofactors of the first row: see the sum in the comment of each.
  const auto minor = [&](int column) {
    std::array<std::array<double, 3>, 3> m;
    for (int i = 1; i < 4; ++i) {
      for (int j = 0, k = 0; j < 4; ++j) {
        if (j != column) m[i - 1][k++] = a[i][j];
      }
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  EXPECT_NEAR(determinant, minor(0) - 2 * minor(1) + 3 * minor(2) - 4 * minor(3), 1e-12);
  std::array<double, 2> none{1, 2};
  EXPECT_EQ(numerics::solve<2>({{{1, 2}, {2, 4}}}, none), 0);
  EXPECT_EQ(numerics::solve<2>({{{0, 1}, {0, 3}}}, none), 0);
}

// [4 2 -2; 2 10 2; -2 2 6] = L L^T with L = [2; 1 3; -1 1 2].
TEST(Cholesky, LeavesTheTriangleAndSolves) {
  std::vector<double> lower{4, 2, -2, 99, 10, 2, 99, 99, 6};
  Cholesky cholesky;
  ASSERT_TRUE(cholesky.factorise(lower, 3));
  EXPECT_EQ(lower, (std::vector<double>{2, 1, -1, 99, 3, 1, 99, 99, 2}));
  std::vector<double> x{4 + 4 - 6, 2 + 20 + 6, -2 + 4 + 18};
  cholesky.solve(x);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i)], i + 1, 1e-14);
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  std::vector<double> lower{1, 2, 0, 1};
  EXPECT_FALSE(Cholesky().factorise(lower, 2));
}

// The inverse of a covariance exp(-|i - j|/s) is tridiagonal: 1/(1 - r^2) (1, 1 + r^2, ..., 1) with
// -r beside; large enough for the factorisation to go by blocks.
TEST(Cholesky, InvertsAMarkovCovariance) {
  constexpr std::size_t n = 150;
  const double r = 0.6;
  std::vector<double> lower(n * n);
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = c; i < n; ++i) lower[c * n + i] = std::pow(r, static_cast<double>(i - c));
  }
  Cholesky cholesky;
  ASSERT_TRUE(cholesky.factorise(lower, n));
  std::vector<double> x(n, 0.0);
  x[40] = 1;
  cholesky.solve(x);
  for (std::size_t i = 0; i < n; ++i) {
    const double expected = i == 40 ? 1 + r * r : i == 39 || i == 41 ? -r : 0;
    EXPECT_NEAR(x[i], expected / (1 - r * r), 1e-13) << i;
  }
}

}  // namespace
}  // namespace papilla::tests::dense_test
