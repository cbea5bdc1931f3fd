// Energy and force of a bridge between plates in nanoseconds: one table an angle pair.
#pragma once

#include <memory>
#include <vector>

#include "base/rooms.h"
#include "physics/capillary/bridge.h"

namespace papilla::capillary {

// Eq. capillary.13: G = h E over u = 1 - sqrt(1 - (h/h_crit)^1.5) is analytic from the slab (u = 0,
// known in closed form) to the rupture (u = 1), where h is the gap per volume^(1/3): cubic Hermite
// with exact values and slopes at equal steps of u. The force is the exact derivative of the
// tabulated energy. Error of the force < 0.05 % of |F| + tension x volume^(1/3) for
// h < 0.999 h_crit. Evaluation: below 50 ns. Building: about 0.5 ms.
class BridgeTable {
 public:
  BridgeTable(double theta1, double theta2, int nodes = 65);

  struct Value {
    double energy, force;  // of volume 1 and tension 1
  };
  bool valid() const { return !value_.empty(); }
  const BridgeLimits& limits() const { return limits_; }
  // h > 0 per volume^(1/3); beyond the rupture, where there is no bridge, G stays as it is there.
  Value operator()(double h) const;
  // SI: gap [m], volume [m^3], tension [N/m] -> [J], [N].
  Value evaluate(double gap, double volume, double surface_tension) const;

 private:
  BridgeLimits limits_;
  double step_ = 0, scale_ = 0;
  std::vector<double> value_, slope_;  // G and dG/du x step
};

// The table of an angle pair; each is built once and kept.
std::shared_ptr<const BridgeTable> bridge_table(double theta1, double theta2);

}  // namespace papilla::capillary
