// The exact axisymmetric liquid bridge (no gravity) between two plates, or a plate and a sphere.
#pragma once

#include <string_view>

#include "base/rooms.h"

namespace papilla::capillary {

enum class BridgeStatus {
  Converged,
  Ruptured,      // no stable bridge at this gap: beyond bridge_limits().rupture
  NotConverged,  // numerical failure: the values are 0
  Invalid        // volume, gap, tension not positive or an angle outside [0, 180] deg
};
std::string_view text(BridgeStatus status);

struct Bridge {
  BridgeStatus status = BridgeStatus::Invalid;
  double energy = 0;     // free surface - wetted area x cos(theta), times tension [J]
  double force = 0;      // dE/dgap at fixed volume, positive = attracts [N]
  double pressure = 0;   // inside - outside [Pa]
  double radius1 = 0;    // contact circle on surface 1 [m]
  double radius2 = 0;    // on surface 2 [m]
  double free_area = 0;  // liquid-air surface [m^2]
  double arc = 0;        // length of the meridian [m]
};

// Eq. capillary.11: Delaunay surface by Newton on (radius1, pressure, arc). Angles in [0, pi]
// [rad], surface 1 below, 2 above. Continued from the thin-slab limit, so the branch is the stable
// one. Valid for every gap below rupture; relative accuracy 1e-12 of the force and energy scales,
// 2e-11 within a thousandth of the rupture of angles below 5 deg.
// Cost: about 0.03 ms.
Bridge solve_bridge(double volume, double gap, double theta1, double theta2,
                    double surface_tension);

// The same between a plate (surface 1) and a sphere of the given radius above it (surface 2) at
// `distance` >= 0, Eq. capillary.12.
Bridge solve_sphere_bridge(double volume, double distance, double sphere_radius, double theta_plate,
                           double theta_sphere, double surface_tension);

// Gaps at which the state of a volume changes, per volume^(1/3), between plates.
struct BridgeLimits {
  BridgeStatus status = BridgeStatus::Invalid;
  double rupture = 0;      // h_crit: stability limit; 0: no gap has a bridge
  bool pitchfork = false;  // of the antisymmetric kind (equal angles); else a fold
  double switching = 0;    // h_eq: bridge and lower cap cost the same; 0: the cap is always lower
  double snap_in = 0;      // height of the lower cap: it touches the other plate below this gap
  double zero_force = 0;   // the gap that attracts above and repels below; 0: attracts at all gaps
};
// Cost: about 0.3 ms.
BridgeLimits bridge_limits(double theta1, double theta2);

}  // namespace papilla::capillary
