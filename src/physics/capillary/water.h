// Water between two surfaces: surface tension, contact angles, and the closed forms of a drop.
#pragma once

#include "base/rooms.h"

namespace papilla::capillary {

struct WaterProperties {
  double surface_tension = 0.072126;            // [N/m]
  double theta_skin = 1.3962634015954636;       // contact angle on the skin [rad], 80 deg
  double theta_substrate = 0.8726646259971648;  // on the textured surface [rad], 50 deg
  double hysteresis = 0.33;                     // cos(receding) - cos(advancing), weaker surface
  // Preset m3: of the force the Laplace pressure on the footprint alone. Eq. capillary.24
  bool pressure_alone = false;
};

// Eq. capillary.1: C = cos(theta_1) + cos(theta_2), the wetting energy a bridge gains per footprint
// area, in units of the surface tension. Exactly 0 when the angles add up to 180 deg.
double wetting_gain(double theta1, double theta2);

// Eq. capillary.2: energy of a bridge's free surface per (perimeter x gap), in units of the surface
// tension, from the circular meniscus of a slab, its wetting corrections included. 1 at 90/90 deg,
// pi/4 at 0/0. Finite for all angles in [0, pi].
double meniscus_factor(double theta1, double theta2);

// Eq. capillary.24: force of a meniscus's pressure on its footprint, per surface tension [m]: the
// M3 paper's law. gap: at the edge; radius: of the footprint; infinite for a film [m].
double laplace_force(const WaterProperties& water, double area, double gap, double radius);

// A spherical cap of given volume on a plane, Eq. capillary.3. Lengths per volume^(1/3), energy per
// surface tension x volume^(2/3). Contact angles below 1 deg are taken as 1 deg (a film has no
// cap).
struct CapShape {
  double sphere_radius, height, footprint, widest, energy;
};
CapShape cap_shape(double theta);

}  // namespace papilla::capillary
