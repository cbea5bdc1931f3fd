// Curves that are straight in log-log between knots, inside this folder.
#pragma once

#include <cmath>
#include <vector>

namespace papilla {

// int_a^b q^n dq, exact also near n = -1.
inline double power_integral(double n, double a, double b) {
  const double l = std::log(b / a);
  const double x = (n + 1) * l;
  return std::pow(a, n + 1) * l * (std::abs(x) < 1e-12 ? 1.0 : std::expm1(x) / x);
}

// y at `at` on the curve through the knots (x, y); beyond the ends its last pieces go on.
inline double log_log(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.size() == 1) return y[0];
  std::size_t i = 1;
  while (i + 1 < x.size() && at > x[i]) ++i;
  const double slope = std::log(y[i] / y[i - 1]) / std::log(x[i] / x[i - 1]);
  return y[i - 1] * std::pow(at / x[i - 1], slope);
}

}  // namespace papilla
