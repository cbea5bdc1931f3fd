// The equations of a bridge between plates inside this folder.
#pragma once

#include <array>

#include "base/rooms.h"
#include "numerics/dense.h"
#include "physics/capillary/bridge.h"
#include "physics/capillary/bridge_branch.h"

namespace papilla::capillary::bridge_branch {

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
