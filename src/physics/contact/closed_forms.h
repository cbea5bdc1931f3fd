// Contacts with a closed form: what the solver is tested against, and the laws of single contacts.
// E* in Pa: 1/E* = sum (1 - nu^2)/E over the two surfaces; lengths in m, forces in N.
#pragma once

#include "base/rooms.h"

namespace papilla::contact {

// One-dimensional wave h = D cos(2 pi x / l) under a mean pressure p. Eq. contact.11
struct Westergaard {
  double modulus, amplitude, period;
  double full_pressure() const;               // p*: the pressure that closes the gap
  double area(double p) const;                // share of the surface in contact
  double peak_pressure(double p) const;       // at the crest
  double pressure(double p, double x) const;  // at x from a crest, |x| <= l/2
};

// Two-dimensional wave h = D cos(2 pi x / l) cos(2 pi y / l). Eq. contact.12
struct EggBox {
  double modulus, amplitude, period;
  double full_pressure() const;
  // Share in contact: table of Johnson, Greenwood and Higginson's problem computed at 512^2 (1e-3),
  // between its first entry and zero the Hertz limit.
  double area(double p) const;
  double peak_pressure(double p) const;  // at the crests, from the same solutions (0.5 %)
};

// Paraboloid of radius R under a force. Eq. contact.13
struct Hertz {
  double modulus, radius;
  double contact_radius(double force) const;
  double approach(double force) const;
  double peak_pressure(double force) const;
};

// Cone of slope angle beta to the surface (Sneddon). Eq. contact.14
struct Cone {
  double modulus, slope;  // slope = tan(beta)
  double contact_radius(double force) const;
  double approach(double force) const;
};

// Adhesive sphere of radius R and work of adhesion w [J/m^2]. Eq. contact.15 (JKR),
// Eq. contact.16 (DMT)
struct AdhesiveSphere {
  double modulus, radius, work;
  double jkr_force(double contact_radius) const;
  double jkr_approach(double contact_radius) const;
  double jkr_pull_off() const;
  double dmt_force(double contact_radius) const;
  double dmt_pull_off() const;
  double tabor(double range) const;  // below 0.1: DMT, above 5: JKR; range z0 of the attraction
};

}  // namespace papilla::contact
