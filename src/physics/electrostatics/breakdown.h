// What limits the voltage: breakdown of air and of the dielectric.
#pragma once

#include <span>

#include "base/rooms.h"
#include "scene/environment.h"

namespace papilla::electrostatics {

inline constexpr double kAirStrength = 350e6;   // V/m, average field in gaps below 1 um
inline constexpr double kPaschenMinimum = 327;  // V, air at atmospheric pressure
inline constexpr double kPaschenGap = 7.5e-6;   // m, of that minimum

// Largest voltage that air of a width [m] withstands [V]: 350 V/um up to the Paschen minimum of
// 327 V, the Paschen curve beyond its minimum at 7.5 um. Eq. electrostatics.7
double air_breakdown_voltage(double gap);

// How much a convex edge of radius r [m] raises the field in a conformal dielectric of thickness d
// [m]: (d/r)/ln(1 + d/r), a coaxial cylinder; 1 for a flat, infinite for a sharp edge.
// Eq. electrostatics.8
double corner_factor(double thickness, double edge_radius);

// Smallest ratio of strength to field over the layers of a dielectric that carries the whole peak
// voltage [V] (under a bridge or a contact), edges of radius edge_radius [m] included; infinite
// without voltage, 0 without a dielectric under voltage. 1 breaks down; designs ask for 2 or more.
// Eq. electrostatics.9
double dielectric_margin(std::span<const Dielectric> layers, double v_peak, double edge_radius);

}  // namespace papilla::electrostatics
