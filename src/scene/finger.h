// The finger: skin, its load-carrying share, its electrical layer, its water. Plain values, SI.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::scene {

// Micro-topography and elasticity of the stratum corneum within one patch.
struct Skin {
  // Self-affine spectrum: flat from the patch size to the roll-off, then C(q) ~ q^-2(1+H) to the
  // cut-off; rms over a 12 um patch.
  double rms = 256e-9;
  double roll_off = 3.7e-6;  // wavelength
  double hurst = 0.8;
  double cutoff = 100e-9;  // wavelength
  std::string map;         // measured topography instead of the spectrum (a file), or ""
  double map_width = 0;    // its lateral size where the file does not say

  double layer_thickness = 1e-6;
  double layer_modulus = 66e6;  // Young's modulus at 15 % RH
  double bulk_modulus = 60e6;
  double layer_poisson = 0.5;
  double bulk_poisson = 0.5;
  double softening = 1.98;  // E(15 % RH) / E(75 % RH), both moduli, linear in RH
  double hardness = 0;      // cap on contact pressure; 0: none

  // Young's moduli at a relative humidity (0-1). Eq. scene.1
  double modulus_factor(double relative_humidity) const;  // E(RH) / E(15 %)

  bool operator==(const Skin&) const = default;
};
void fields(FieldVisitor& v, Skin& s);

// How a fingertip carries its load.
struct MacroContact {
  double area_15 = 45e-6;       // gross contact area at 0.2 N and 15 % RH [m^2]
  double area_growth = 0.585;   // relative growth from 15 to 75 % RH, linear
  double load_exponent = 0.52;  // A ~ F_N^n
  double ridge_share = 0.3;     // share of the gross area on ridges
  double load_share = 0.0063;   // phi: share of the gross area that carries the load
  double shear_strength = 9e6;  // tau, interfacial, at 15 % RH [Pa]
  double shear_fall = 0.08;     // what it loses from 15 to 75 % RH, a share, linear
  // For closures "persson" and "balance": the ridges' surface above the patch size, and what it
  // lies on.
  double ridge_rms = 2.2e-6, ridge_longest = 1e-3;  // rms height, longest wavelength [m]
  double ridge_roll_off = 1e-3;  // wavelength [m]; at least ridge_longest: no roll-off
  double ridge_hurst = 0;        // 0: that of the skin
  double corneum_thickness = 200e-6, tissue_modulus = 10e3;  // [m], Young's modulus [Pa]

  // For closure "balance".
  double pressure_peak = 2;  // of the ridges in the middle of the fingertip, over their mean
  double far_gaps = 1;       // share of the open gaps that pull and hold water

  // Gross contact area at a load [N] and relative humidity (0-1). Eq. scene.2
  double gross_area(double load, double relative_humidity) const;
  double shear_strength_at(double relative_humidity) const;  // [Pa] Eq. scene.8

  bool operator==(const MacroContact&) const = default;
};
void fields(FieldVisitor& v, MacroContact& s);

// The stratum corneum as a dielectric: equivalent thickness d2/eps2 in series with the gap.
struct ElectricalLayer {
  double thickness_15 = 30e-9;   // h_SC at 15 % RH [m]
  double thickness_75 = 17e-9;   // at 75 %; linear between
  double corner_frequency = 60;  // 1/(2 pi eps0 eps rho): below it the layer conducts; 0: never
  // Of the gap between skin and surface, sweat on its way through it included [ohm m]; 0: an
  // insulator. It bleeds the charge that a direct voltage leaves on an insulating film.
  double gap_resistivity = 4.8e8;

  double equivalent_thickness(double relative_humidity) const;  // Eq. scene.3

  bool operator==(const ElectricalLayer&) const = default;
};
void fields(FieldVisitor& v, ElectricalLayer& s);

// Sweat in a 12 x 12 um patch against relative humidity, and how water meets the skin.
struct SkinWater {
  std::vector<double> relative_humidity = {0.15, 0.35, 0.55, 0.75};
  std::vector<double> volume = {0.07e-18, 0.36e-18, 1.8e-18, 8.8e-18};  // [m^3] per 144 um^2
  double contact_angle = 1.3962634015954636;                            // 80 deg, on clean skin
  double surface_tension = 0.072126;
  double hysteresis = 0.33;    // cos(theta_r) - cos(theta_a) of the weaker surface
  double drops_per_um3 = 100;  // initial droplets per um^3 of water
  double volume_spread = 0;    // low and high volume, as a share beside the mean; 0: the mean alone

  // Water volume per area [m]: log-linear between nodes, end slopes outside. Eq. scene.4
  double volume_per_area(double relative_humidity) const;

  bool operator==(const SkinWater&) const = default;
};
void fields(FieldVisitor& v, SkinWater& s);

// Saturated angle under voltage from the angle at rest: linear through two anchors, never above the
// angle at rest.
struct Saturation {
  double rest_low = 0.8726646259971648, saturated_low = 0.6457718232379019;    // 50 -> 37 deg
  double rest_high = 1.9198621771937625, saturated_high = 1.3788101090755203;  // 110 -> 79 deg

  double angle(double rest) const;  // [rad] Eq. scene.5

  bool operator==(const Saturation&) const = default;
};
void fields(FieldVisitor& v, Saturation& s);

enum class Preset { Papilla, M3 };
enum class WaterModel { Droplets, Threshold };
enum class Closure { Uniform, Persson, Balance };
enum class Coupling { OnePass, SelfConsistent };
enum class FieldMethod { Local, Spread, Full };

// Options that move results at first order: fixed before calibration, recorded in the finger file.
struct ModelOptions {
  Preset preset = Preset::Papilla;
  WaterModel water = WaterModel::Droplets;
  Closure closure = Closure::Uniform;
  Coupling coupling = Coupling::OnePass;
  FieldMethod field = FieldMethod::Spread;
  bool breakdown_cap = false;       // gap pressure <= eps0/2 (350 V/um)^2
  double droplet_step = 200e-9;     // first step of a moving droplet [m]: mobility
  bool droplet_enhancement = true;  // droplets that do not bridge raise the pull
  bool rim_pinning = false;         // contact lines do not pass the edges of holes
  bool corner_wicking = false;      // droplets at the foot of a wall creep along it

  bool operator==(const ModelOptions&) const = default;
};
void fields(FieldVisitor& v, ModelOptions& s);

enum class FingerState { Clean, Natural, Wet };
const std::vector<std::string>& finger_state_names();  // "clean", "natural", "wet"

// How sebum and sweat change the clean finger.
struct SkinState {
  double contact_angle;  // of the skin [rad]
  double water_factor;   // on the volume of sweat
  double shear_factor;   // on the interfacial shear strength: lipids and water lower it

  bool operator==(const SkinState&) const = default;
};
void fields(FieldVisitor& v, SkinState& s);

// How well the fit knows one number of the finger.
struct ParameterDeviation {
  std::string parameter;            // path into the finger: "skin.rms"; "water.scale": all volumes
  double deviation = 0;             // one standard deviation of its logarithm
  std::vector<double> correlation;  // with those before it in the list; missing ones are 0

  bool operator==(const ParameterDeviation&) const = default;
};
void fields(FieldVisitor& v, ParameterDeviation& s);

struct Finger {
  std::string name = "reference";
  FingerState state = FingerState::Clean;
  SkinState natural{1.0471975511965976, 8, 0.75};  // 60 deg
  SkinState wet{1.0471975511965976, 20, 0.56};
  double load = 0.2;  // normal force [N]
  Skin skin;
  MacroContact macro;
  ElectricalLayer electrical;
  SkinWater water;
  Saturation saturation;
  ModelOptions calibrated_for;
  // Ids of the published claims that its fit used, separated by spaces.
  std::string fitted_to = "M1 M2 M3 M4 M5 M6 M7 M8 M9 M10 M11 M12 M13 M14 M15 M16 M17 M21";
  std::vector<ParameterDeviation> uncertainty;  // of the fitted numbers; empty: not known

  double patch_pressure(double relative_humidity) const;  // F_N / (phi A) [Pa], Eq. scene.6
  Finger applied() const;  // the clean finger with the skin angle, sweat and shear of its state

  bool operator==(const Finger&) const = default;
};
void fields(FieldVisitor& v, Finger& s);

}  // namespace papilla::scene
