// The equations of a bridge between plates and their small linear systems, inside this folder.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/rooms.h"
#include "physics/capillary/bridge.h"
#include "physics/capillary/bridge_branch.h"

namespace papilla::capillary::bridge_branch {

// Gaussian elimination with partial pivoting; returns the determinant.
template <std::size_t N>
double solve(std::array<std::array<double, N>, N> a, std::array<double, N>& b) {
  double determinant = 1;
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < N; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    if (pivot != k) {
      std::swap(a[k], a[pivot]);
      std::swap(b[k], b[pivot]);
      determinant = -determinant;
    }
    determinant *= a[k][k];
    if (a[k][k] == 0) return 0;
    for (std::size_t i = k + 1; i < N; ++i) {
      const double m = a[i][k] / a[k][k];
      for (std::size_t j = k; j < N; ++j) a[i][j] -= m * a[k][j];
      b[i] -= m * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t j = k + 1; j < N; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return determinant;
}

// Residuals {angle at plate 2, height, volume} and their Jacobian, for volume 1.
struct System {
  std::array<double, 3> residual;
  std::array<std::array<double, 3>, 3> jacobian;
};

System plate_system(const Profile& q, double theta2, double height);

// bridge_limits, and the end of the stable branch that they rest on (found: where there is one).
BridgeLimits limits_and_end(double theta1, double theta2, Limit& end);

// Whether unknowns can be those of a surface: finite, lengths positive.
bool usable(const Unknowns& x);

}  // namespace papilla::capillary::bridge_branch
