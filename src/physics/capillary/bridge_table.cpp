#include "physics/capillary/bridge_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/constants.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_system.h"
#include "physics/capillary/water.h"

namespace papilla::capillary {

BridgeTable::BridgeTable(double theta1, double theta2, int nodes) {
  using namespace bridge_branch;
  // At 180 deg the meniscus ends on its plate as a tangent, and Newton's equations on the way to
  // the rupture, where it leaves at a point, have no slope: the cosine of this angle is that one to
  // 1e-12.
  constexpr double kDry = kPi - 1e-6;
  theta1 = std::min(theta1, kDry);
  theta2 = std::min(theta2, kDry);
  Limit end;
  limits_ = limits_and_end(theta1, theta2, end);
  if (limits_.status != BridgeStatus::Converged || limits_.rupture == 0) return;
  const double top = std::pow(limits_.rupture, 1.5);
  scale_ = 1 / top;
  step_ = 1.0 / (nodes - 1);
  std::vector<double> value(nodes), slope(nodes);
  // Slab limit: G = -C + 2 sqrt(pi) f h^1.5.
  value[0] = -wetting_gain(theta1, theta2);
  slope[0] = 2 * std::sqrt(kPi) * meniscus_factor(theta1, theta2) * 2 * top * step_;
  Branch branch(theta1, theta2);
  if (!branch.valid()) return;
  double height = 0, e = 0, f = 0;
  for (int k = 1; k < nodes; ++k) {
    const double v = 1 - k * step_;
    // The last node is the limit itself; there dG/du = 0.
    const double h = std::pow(top * (1 - v * v), 2.0 / 3);
    if (k + 1 < nodes) {
      if (!branch.go_to(h)) return;
      e = energy(branch.at(), theta1, theta2);
      f = force(branch.at(), theta1);
      height = h;
      value[k] = height * e;
      // dh/du from h^1.5 = top (1 - (1 - u)^2)
      slope[k] = (e + height * f) * 2 * top * v / (1.5 * std::sqrt(height)) * step_;
    } else {
      value[k] = h * energy(end.at, theta1, theta2);
      slope[k] = 0;
    }
  }
  value_ = std::move(value);
  slope_ = std::move(slope);
}

BridgeTable::Value BridgeTable::operator()(double h) const {
  const double root = std::sqrt(h);
  const double v = std::sqrt(std::max(1 - h * root * scale_, 1e-8));
  const double t = (1 - v) / step_;
  const int k = std::min(static_cast<int>(t), static_cast<int>(value_.size()) - 2);
  const double x = t - k, y = 1 - x;
  const double g0 = value_[k], g1 = value_[k + 1], s0 = slope_[k], s1 = slope_[k + 1];
  const double g = y * y * ((1 + 2 * x) * g0 + x * s0) + x * x * ((1 + 2 * y) * g1 - y * s1);
  const double dg = 6 * x * y * (g1 - g0) + y * (y - 2 * x) * s0 + x * (x - 2 * y) * s1;
  const double e = g / h;
  // dG/dh = dG/du x 1.5 sqrt(h) / (2 h_crit^1.5 v)
  return {e, (dg / step_ * 0.75 * root * scale_ / v - e) / h};
}

BridgeTable::Value BridgeTable::evaluate(double gap, double volume, double surface_tension) const {
  const double size = std::cbrt(volume);
  const Value v = (*this)(gap / size);
  return {surface_tension * size * size * v.energy, surface_tension * size * v.force};
}

std::shared_ptr<const BridgeTable> bridge_table(double theta1, double theta2) {
  static std::mutex mutex;
  static std::map<std::pair<double, double>, std::shared_ptr<const BridgeTable>> tables;
  const auto key = std::minmax(theta1, theta2);
  const std::lock_guard lock(mutex);
  if (tables.size() > 4096) tables.clear();  // a search over angles must not grow without end
  auto& table = tables[{key.first, key.second}];
  if (!table) table = std::make_shared<const BridgeTable>(key.second, key.first);
  return table;
}

}  // namespace papilla::capillary
