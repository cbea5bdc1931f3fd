// Nodes and weights of rules for integrals.
#pragma once

#include <vector>

#include "base/rooms.h"

namespace papilla::numerics {

struct Quadrature {
  std::vector<double> nodes, weights;
};

// Gauss and Legendre's rule of n >= 1 nodes for the integral from a to b: exact for polynomials of
// degree 2n - 1. The nodes ascend. Cost: about 10 n^2 operations.
Quadrature gauss_legendre(int n, double a = -1, double b = 1);

}  // namespace papilla::numerics
