// What limits the voltage: breakdown of air and of the dielectric.
#pragma once

#include <complex>
#include <span>

#include "base/constants.h"
#include "base/rooms.h"
#include "numerics/vector.h"
#include "scene/environment.h"
#include "scene/finger.h"

namespace papilla::electrostatics {

inline constexpr double kAirStrength = 350e6;   // V/m, average field in gaps below 1 um
inline constexpr double kPaschenMinimum = 327;  // V, air at atmospheric pressure
inline constexpr double kPaschenGap = 7.5e-6;   // m, of that minimum
inline constexpr double kIonisation = 12.07;    // V, of oxygen: less starts no discharge in air

// Largest voltage that air of a width [m] withstands [V]: 350 V/um up to the Paschen minimum of
// 327 V, the Paschen curve beyond its minimum at 7.5 um. Eq. electrostatics.7
double air_breakdown_voltage(double gap);

// Strongest field [V/m] that the air of a gap [m] holds: Eq. electrostatics.7 up to its minimum as
// a field (350 V/um below 0.93 um), with Ionisation at least 12.07 V over the gap. Infinite for
// None. T: double or a vector of pixels. Eq. electrostatics.21
template <class T>
T air_field_limit(AirLimit law, const T& gap) {
  if (law == AirLimit::None) return T(kInfinity);
  const T per_gap = 1 / gap;
  const T held = smaller(T(kAirStrength), kPaschenMinimum * per_gap);
  return law == AirLimit::Ionisation ? larger(held, kIonisation * per_gap) : held;
}

// Mean square of a field that a discharge clips, over that of the free one; x: limit over free
// peak. steady: of one magnitude; else a sine. 1 and without slope at x = 1. Eq. electrostatics.21
template <class T>
T clipped_share(const T& x, bool steady) {
  const T y = smaller(x, T(1));
  if (steady) return y * y;
  // pi/2 - asin(y) = sqrt(1 - y) P(y) to 2e-8 (Abramowitz & Stegun 4.4.46).
  constexpr double kP[] = {1.5707963050, -0.2145988016, 0.0889789874, -0.0501743046,
                           0.0308918810, -0.0170881256, 0.0066700901, -0.0012624911};
  T p(kP[7]);
  for (int k = 6; k >= 0; --k) p = p * y + kP[k];
  const T rest = root(1 - y) * p;  // of the quarter cycle, where the field is held
  const T share = 1 - 2 / kPi * (rest + y * root(1 - y * y)) + 4 / kPi * y * y * rest;
  return chosen(x < T(1), share, T(1));
}

// Share of a voltage that stands on a film of which the gap takes a share of its free field alone:
// what it cannot take stands on the film. free: the share by their divider; held: the field that
// the film allows over the free one, peaks, at most 1. Eq. electrostatics.22
template <class T>
T share_on_film(const T& free, const T& held) {
  return 1 - held * (1 - free);
}

// How much a convex edge of radius r [m] raises the field in a conformal dielectric of thickness d
// [m]: (d/r)/ln(1 + d/r), a coaxial cylinder; 1 for a flat, infinite for a sharp edge.
// Eq. electrostatics.8
double corner_factor(double thickness, double edge_radius);

// Smallest ratio of strength to field over the layers of a dielectric that carries the whole peak
// voltage [V] (under a bridge or a contact), edges of radius edge_radius [m] included; infinite
// without voltage, 0 without a dielectric under voltage. 1 breaks down; designs ask for 2 or more.
// divider: by what the d/eps of each layer counts in the series, where layers leak or relax; empty:
// all by 1. Eq. electrostatics.9, drive.4
double dielectric_margin(std::span<const Dielectric> layers, double v_peak, double edge_radius,
                         std::span<const std::complex<double>> divider = {});

}  // namespace papilla::electrostatics
