// Single pieces of the physics. SI units.
#pragma once

#include <string>
#include <vector>

#include "papilla/design.h"

namespace papilla::api {

// A layer bonded on a half-space; a thickness of 0 leaves the half-space alone.
// docs/theory/contact.md
struct Solid {
  double layer_modulus = 1, layer_poisson = 0.5, layer_thickness = 0;  // [Pa], share, [m]
  double bulk_modulus = 1, bulk_poisson = 0.5;

  static Solid half_space(double contact_modulus);  // E* [Pa]
};

struct ContactResult {
  bool converged = false;
  std::string reason;                 // for people
  std::vector<double> pressure, gap;  // [Pa], [m] of each pixel
  double area_fraction = 0;           // with a sub-pixel edge, Eq. contact.7
  double area_fraction_error = 0;     // by the grid, Eq. contact.8
  double mean_pressure = 0;           // [Pa]
  double approach = 0;                // of the mean planes since first touch [m]
  double elastic_energy = 0;          // [J]
  double certificate = 0;             // bound on the energy error, relative, Eq. contact.4
};

// A rigid rough surface on a solid, without friction, on a periodic grid: under a mean pressure
// [Pa]; hardness [Pa] caps the pressure, 0: no cap. Throws InputError.
ContactResult contact(const Heights& heights, const Solid& solid, double mean_pressure,
                      double tolerance = 1e-8, double hardness = 0);

struct BridgeResult {
  bool exists = false;
  std::string reason;               // for people
  double energy = 0, force = 0;     // [J], [N]; positive attracts
  double pressure = 0;              // inside - outside [Pa]
  double radius1 = 0, radius2 = 0;  // of the contact circles [m]
  double rupture_gap = 0;           // [m]; 0: not known
};

// A bridge of a volume [m^3] between two plates at a gap [m], contact angles [rad], without
// gravity. Throws InputError.
BridgeResult bridge(double volume, double gap, double theta1, double theta2,
                    double surface_tension);

}  // namespace papilla::api
