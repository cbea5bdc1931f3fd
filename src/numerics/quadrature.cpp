#include "numerics/quadrature.h"

#include <cmath>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::numerics {

Quadrature gauss_legendre(int n, double a, double b) {
  PAPILLA_CHECK(n >= 1, "nodes");
  Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 60; ++step) {
      double p = 1, previous = 0;
      for (int k = 0; k < n; ++k) {
        const double next = ((2 * k + 1) * x * p - k * previous) / (k + 1);
        previous = p;
        p = next;
      }
      slope = n * (x * p - previous) / (x * x - 1);
      const double dx = p / slope;
      x -= dx;
      if (std::abs(dx) < 1e-15) break;
    }
    rule.nodes[i] = 0.5 * (a + b) + 0.5 * (b - a) * x;
    rule.weights[i] = (b - a) / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace papilla::numerics
