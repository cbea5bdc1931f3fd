// Small dense systems of equations, by Eigen.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/rooms.h"

namespace papilla::numerics {

// A symmetric, positive definite matrix as the product of a triangle and its mirror image.
class Cholesky {
 public:
  // lower: its lower triangle, n columns one after another, what is above not read; destroyed.
  // False: it is not positive definite. n^3/3 operations.
  bool factorise(std::vector<double>& lower, std::size_t n);
  void solve(std::vector<double>& x) const;  // in place, from the right-hand side; n^2 operations

 private:
  const double* triangle_ = nullptr;  // what factorise() left in its matrix
  std::size_t n_ = 0;
};

// a x = b, in place, by elimination with partial pivoting; returns the determinant of a, and leaves
// b where that is 0. Of rows. N from 2 to 4.
template <std::size_t N>
double solve(const std::array<std::array<double, N>, N>& a, std::array<double, N>& b);

}  // namespace papilla::numerics
