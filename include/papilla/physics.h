// Single pieces of the physics on maps of the caller's own. SI units. Whole cases of a rough skin
// or of a drive: papilla/cases.h.
#pragma once

#include <cstdint>
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

// Water between a skin and a surface.
struct Water {
  double surface_tension = 0.072126;       // [N/m]
  double theta_skin = 1.3962634015954636;  // contact angles [rad]
  double theta_substrate = 0.8726646259971648;
  double hysteresis = 0.33;  // cos(receding) - cos(advancing)
};

struct DropletOptions {
  double drops_per_volume = 100e18;   // droplets that a volume starts as [1/m^3]
  double first_step = 200e-9;         // mobility [m]
  std::uint64_t seed = 1, index = 0;  // of the places; a member of their ensemble
  bool threshold = false;             // water at one pressure in place of droplets
};

enum class WaterState { Dry, Discs, Film, Flooded };
enum class DropletPlace { Skin, Substrate, Bridge };

struct DropletState {
  double x = 0, y = 0, volume = 0;  // centre [m], [m^3]
  DropletPlace place = DropletPlace::Substrate;
  double radius = 0, height = 0;  // [m]
  double force = 0;               // [N], positive attracts
};

struct DropletsResult {
  bool converged = false;
  WaterState state = WaterState::Dry;  // flooded: more water than gap, no force
  std::vector<DropletState> droplets;
  std::vector<std::uint8_t> bridged;  // of each pixel: 1 inside a bridge or a film
  double capillary_force = 0;         // on the patch [N], positive attracts
  double retention = 0;               // lateral hysteresis force [N]
  double wetted_fraction = 0;
  int bridges = 0;
  double bridge_volume = 0;                     // of the water [m^3]
  double initial_energy = 0, final_energy = 0;  // [J]
};

// Droplets of sweat in a gap [m], 0 in contact, that settle where their energy is lowest.
// docs/theory/capillary.md. Throws InputError, Stopped.
DropletsResult droplets(const Heights& gap, double volume, const Water& water = {},
                        const DropletOptions& options = {});

enum class FieldMethod { Local, Spread, Full };

struct FieldOptions {
  double thickness = 500e-9, permittivity = 3.9;  // of the dielectric [m]
  double skin_layer = 0;                          // d/eps of the stratum corneum [m]
  double edge_radius = 0;                         // of the electrode's edges below walls [m]
  bool dc = false;                                // else the voltage is the peak of a sine
  FieldMethod method = FieldMethod::Spread;       // columns, spreading flux, 3-D
};

struct FieldResult {
  bool converged = false;
  std::string reason;            // for people
  std::vector<double> pressure;  // time mean on the skin, per pixel [Pa], positive attracts
  double mean_pressure = 0;      // [Pa]
  double force = 0;              // on the patch [N]
  double peak_air_field = 0, peak_oxide_field = 0;  // at peak voltage [V/m]
  double residual = 0;                              // relative; 0 of columns
};

// The electrostatic pull over a gap [m]; surface: the rigid one below it, whose dielectric follows
// its walls; null: flat. docs/theory/electrostatics.md. Throws InputError, Stopped.
FieldResult field(const Heights& gap, double voltage, const FieldOptions& options = {},
                  const Heights* surface = nullptr);

struct LookOptions {
  double index = 1.46, fill_index = 1;  // of the glass, of what fills the texture
  std::vector<double> angles = {0};     // of the light from the normal [rad]
};

// How a periodic map looks on glass, as a thin phase screen. docs/theory/optics.md. Throws
// InputError.
Look look(const Heights& heights, const LookOptions& options = {});

}  // namespace papilla::api
