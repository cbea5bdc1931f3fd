#include "physics/capillary/water.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::capillary {

double wetting_gain(double theta1, double theta2) {
  const double u = kPi / 2 - 0.5 * (theta1 + theta2), d = 0.5 * (theta1 - theta2);
  return 2 * std::sin(u) * std::cos(d);
}

double meniscus_factor(double theta1, double theta2) {
  const double u = kPi / 2 - 0.5 * (theta1 + theta2), d = 0.5 * (theta1 - theta2);
  const double cos_d = std::cos(d);
  if (cos_d < 1e-12) return 0;  // 0 and 180 deg
  const double inverse_sinc = std::abs(u) < 1e-8 ? 1 : u / std::sin(u);
  return (inverse_sinc + std::cos(u) * std::cos(2 * d)) / (2 * cos_d);
}

double laplace_force(const WaterProperties& water, double area, double gap, double radius) {
  return area * (wetting_gain(water.theta_skin, water.theta_substrate) / gap - 1 / radius);
}

CapShape cap_shape(double theta) {
  theta = std::max(theta, kPi / 180);
  const double c = std::cos(theta);
  const double rise = 2 * square(std::sin(0.5 * theta));  // 1 - c without cancellation
  const double radius = std::cbrt(3 / (kPi * (2 + c) * square(rise)));
  const double foot = radius * std::sin(theta);
  return {radius, radius * rise, foot, theta > kPi / 2 ? radius : foot, 3 / radius};
}

}  // namespace papilla::capillary
