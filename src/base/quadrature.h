// Nodes and weights.
#pragma once

#include <vector>

namespace papilla {

struct Quadrature {
  std::vector<double> nodes, weights;
};

Quadrature gauss_legendre(int n, double a = -1, double b = 1);
Quadrature gauss_laguerre(int n);  // integral over [0, inf) with weight e^-t
std::vector<double> trapezoid_weights(const std::vector<double>& nodes);  // sum = range

}  // namespace papilla
