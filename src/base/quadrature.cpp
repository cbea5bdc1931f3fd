#include "base/quadrature.h"

#include <cmath>

#include "base/check.h"
#include "base/constants.h"

namespace papilla {

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

Quadrature gauss_laguerre(int n) {
  PAPILLA_CHECK(n >= 1 && n <= 30, "nodes");
  Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
  double x = 0;
  for (int i = 0; i < n; ++i) {
    // Starting guesses after Stroud and Secrest, then Newton.
    if (i == 0) {
      x = 3.0 / (1 + 2.4 * n);
    } else if (i == 1) {
      x += 15.0 / (1 + 2.5 * n);
    } else {
      const double k = i - 1;
      x += (1 + 2.55 * k) / (1.9 * k) * (x - rule.nodes[i - 2]);
    }
    double previous = 0, slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1;
      previous = 0;
      for (int k = 0; k < n; ++k) {
        const double next = ((2 * k + 1 - x) * p - k * previous) / (k + 1);
        previous = p;
        p = next;
      }
      slope = n * (p - previous) / x;
      const double dx = p / slope;
      x -= dx;
      if (std::abs(dx) < 1e-14 * x) break;
    }
    rule.nodes[i] = x;
    rule.weights[i] = -1 / (slope * n * previous);
  }
  return rule;
}

std::vector<double> trapezoid_weights(const std::vector<double>& nodes) {
  std::vector<double> weights(nodes.size(), nodes.size() == 1 ? 1.0 : 0.0);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double half = 0.5 * (nodes[i + 1] - nodes[i]);
    weights[i] += half;
    weights[i + 1] += half;
  }
  return weights;
}

}  // namespace papilla
