// The whole fingertip pressed on a flat: gross contact area, where the pressure is, what the ridges
// carry. Axisymmetric, frictionless, linear elastic; a skin layer on soft tissue.
// Equations macro.N: docs/theory/macro.md.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "scene/finger.h"

namespace papilla::macro {

// Height of the fingertip over the flat before loading: z = coefficient r^power [m]. power 2 is a
// sphere of radius 1/(2 coefficient); a pad that is flatter in the middle and steeper at its sides
// has more than 2.
struct TipShape {
  double power = 2;
  double coefficient = 62.5;  // [m^(1 - power)]
};

// Plane-strain moduli E/(1 - nu^2) [Pa]; thickness 0: tissue alone.
struct TipSolid {
  double tissue = 25e3;
  double layer = 0, thickness = 0;  // of the skin [Pa], [m]

  // What a contact of radius a feels: between layer and tissue by Gao's weight. Eq. macro.1
  double modulus(double radius) const;
};

struct TipContact {
  double radius = 0, area = 0, indentation = 0;  // [m], [m^2], [m]
  double load = 0;                               // [N]

  double mean_pressure() const { return area > 0 ? load / area : 0; }
};

// Contact of a given radius [m], or under a load [N] >= 0. Eq. macro.2. Exact (Hertz, Sneddon) for
// one material; with a layer within the accuracy of Gao's weight. Cost 1 us and 50 us.
TipContact tip_contact_at(const TipShape& shape, const TipSolid& solid, double radius);
TipContact tip_contact(const TipShape& shape, const TipSolid& solid, double load);
// Pressure [Pa] at distance r of the centre of a contact of that radius; 0 outside. Eq. macro.3
double tip_pressure(const TipShape& shape, const TipSolid& solid, double radius, double r);

// The finger file's law of gross area (Eq. scene.2) as such a fingertip: the shape follows from the
// load exponent n (power 2/n - 1), the modulus from the area at 0.2 N and its growth over humidity.
// curvature_radius [m] is that of the undeformed tip, seen over the contact at 0.2 N. Eq. macro.4
struct Fingertip {
  TipShape shape;
  TipSolid solid;  // at the humidity asked for
};
Fingertip fingertip(const MacroContact& macro, double relative_humidity,
                    double curvature_radius = 8e-3);

// What the ridges carry at a load [N] and humidity.
struct RidgeLoad {
  double area = 0;           // of the ridges in contact [m^2]
  double mean_pressure = 0;  // on them [Pa]
  double peak_pressure = 0;  // on the ridge in the middle [Pa]
};
RidgeLoad ridge_load(const MacroContact& macro, double load, double relative_humidity);

// Rings of the fingertip of given shares of the area, and their pressure over the mean: p(r) =
// K mean (1 - r^2/a^2)^(K - 1), K = peak >= 1. Their mean is 1. Eq. macro.5
struct PressureRing {
  double share = 1, over_mean = 1;
};
std::vector<PressureRing> pressure_rings(double peak, int rings);

}  // namespace papilla::macro
