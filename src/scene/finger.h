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
  double rms = 207e-9;
  double roll_off = 3.7e-6;  // wavelength
  double hurst = 0.8;
  double cutoff = 100e-9;  // wavelength
  std::string map;         // measured topography instead of the spectrum (a file), or ""
  double map_width = 0;    // its lateral size where the file does not say

  double layer_thickness = 1e-6;
  double layer_modulus = 61.4e6;  // Young's modulus at 15 % RH
  double bulk_modulus = 59.3e6;
  double layer_poisson = 0.5;
  double bulk_poisson = 0.5;
  double softening = 2.0;          // E(15 % RH) / E(75 % RH), both moduli, linear in RH
  double softening_saturated = 5;  // E(75 % RH) / E(100 % RH), both moduli
  double hardness = 0;             // cap on contact pressure; 0: none

  // Share of the stratum corneum in contact that is saturated with water; the rest is in balance
  // with the air. States and touch time add to it.
  double hydration = 0;
  double relief_saturated = 0.8;  // rms height of the saturated corneum over that at hydration 0
  double occlusion_time = 7;      // of a touch, until 1 - 1/e of what was dry is saturated [s]

  // Young's moduli at a relative humidity of the air (0-1), E(RH) / E(15 %), at this hydration.
  // Positive; falls with humidity and hydration. Eq. scene.1, scene.10
  double modulus_factor(double relative_humidity) const;
  double relief_factor() const;  // rms height at this hydration over `rms`. Eq. scene.13

  bool operator==(const Skin&) const = default;
};
void fields(FieldVisitor& v, Skin& s);

// How a fingertip carries its load.
struct MacroContact {
  double area_15 = 45e-6;               // gross contact area at 0.2 N and 15 % RH [m^2]
  double area_growth = 0.585;           // relative growth from 15 to 75 % RH, linear
  double load_exponent = 0.52;          // A ~ F_N^n
  double ridge_share = 0.3;             // share of the gross area on ridges
  double load_share = 0.00728;          // phi: share of the gross area that carries the load
  double shear_strength = 9e6;          // tau, interfacial, at 15 % RH [Pa]
  double shear_fall = 0.095;            // what it loses from 15 to 75 % RH, a share, linear
  double shear_fall_saturated = 0.385;  // and from 75 % RH to saturation, a share of what is left
  // For closures "persson" and "balance": the ridges' surface above the patch size, and what it
  // lies on.
  double ridge_rms = 0.79e-6, ridge_longest = 1e-3;  // rms height, longest wavelength [m]
  double ridge_roll_off = 1e-3;  // wavelength [m]; at least ridge_longest: no roll-off
  double ridge_hurst = 0;        // 0: that of the skin
  double corneum_thickness = 200e-6, tissue_modulus = 10e3;  // [m], Young's modulus [Pa]

  // For closure "balance".
  double pressure_peak = 2;  // of the ridges in the middle of the fingertip, over their mean
  double far_gaps = 1;       // share of the open gaps that pull and hold water

  // Gross contact area at a load [N] and relative humidity (0-1). Eq. scene.2
  double gross_area(double load, double relative_humidity) const;
  // [Pa]; hydration: share of the corneum that is saturated (Skin::hydration). Eq. scene.8,
  // scene.10
  double shear_strength_at(double relative_humidity, double hydration = 0) const;

  bool operator==(const MacroContact&) const = default;
};
void fields(FieldVisitor& v, MacroContact& s);

// The stratum corneum as a dielectric: equivalent thickness d2/eps2 in series with the gap.
struct ElectricalLayer {
  double thickness_15 = 34e-9;   // h_SC at 15 % RH [m]
  double thickness_75 = 44e-9;   // at 75 %; linear between
  double corner_frequency = 60;  // 1/(2 pi eps0 eps rho): below it the layer conducts; 0: never
  // Exponent of its capacitance against frequency, a constant-phase element: 1 a capacitor. Eq.
  // drive.19
  double skin_exponent = 1;
  double dispersion_frequency = 5e3;  // where d2/eps2 is what is stated here [Hz]
  // Of the gap between skin and surface, sweat on its way through it included [ohm m]; 0: an
  // insulator. It bleeds the charge that a direct voltage leaves on an insulating film.
  double gap_resistivity = 4.8e8;
  // Of its conductance, which rises as f^(1 - exponent) above its corner: 1 a resistor. Eq.
  // drive.20
  double gap_exponent = 1;

  // hydration: share of the corneum that is saturated (Skin::hydration). Eq. scene.3, scene.10
  double equivalent_thickness(double relative_humidity, double hydration = 0) const;

  bool operator==(const ElectricalLayer&) const = default;
};
void fields(FieldVisitor& v, ElectricalLayer& s);

// Sweat in a 12 x 12 um patch against relative humidity, and how water meets the skin.
struct SkinWater {
  std::vector<double> relative_humidity = {0.15, 0.35, 0.55, 0.75};
  std::vector<double> volume = {0.07e-18, 0.335e-18, 1.84e-18, 7.1e-18};  // [m^3] per 144 um^2
  double contact_angle = 1.3962634015954636;                              // 80 deg, on clean skin
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
  double rest_low = 0.8726646259971648, saturated_low = 0.6946410422937431;    // 50 -> 39.8 deg
  double rest_high = 1.9198621771937625, saturated_high = 1.3788101090755203;  // 110 -> 79 deg

  double angle(double rest) const;  // [rad] Eq. scene.5

  bool operator==(const Saturation&) const = default;
};
void fields(FieldVisitor& v, Saturation& s);

enum class Preset { Papilla, M3 };
enum class WaterModel { Droplets, Threshold };
enum class Closure { Uniform, Persson, Balance };
enum class Coupling { OnePass, Equilibrium };
// What the air of a gap withstands: anything; the field at which it breaks down; or that field and
// in any gap the voltage that ionises it.
enum class AirLimit { None, Emission, Ionisation };
enum class FieldMethod { Local, Spread, Full };

// Options that move results at first order: fixed before calibration, recorded in the finger file,
// which is where a design's come from. By themselves they are the published model's: one pass, and
// air that insulates.
struct ModelOptions {
  Preset preset = Preset::Papilla;
  WaterModel water = WaterModel::Droplets;
  Closure closure = Closure::Uniform;
  Coupling coupling = Coupling::OnePass;
  FieldMethod field = FieldMethod::Spread;
  AirLimit air_limit = AirLimit::None;  // Eq. electrostatics.21
  double droplet_step = 200e-9;         // first step of a moving droplet [m]: mobility
  bool droplet_enhancement = true;      // droplets that do not bridge raise the pull
  bool rim_pinning = false;             // contact lines do not pass the edges of holes
  bool corner_wicking = false;          // droplets at the foot of a wall creep along it

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
  double hydration = 0;  // share of the stratum corneum that is saturated: it is softer

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
  SkinState wet{1.0471975511965976, 20, 1, 1};
  double load = 0.2;  // normal force [N]
  // How long the finger has been on the surface [s]; 0: as in the papers that it is fitted to.
  double touch_time = 0;
  Skin skin;
  MacroContact macro;
  ElectricalLayer electrical;
  SkinWater water;
  Saturation saturation;
  ModelOptions calibrated_for{.coupling = Coupling::Equilibrium, .air_limit = AirLimit::Ionisation};
  // Ids of the published claims that its fit used, separated by spaces.
  std::string fitted_to = "M1 M2 M3 M4 M5 M9 M13 M15 C_gap";
  std::vector<ParameterDeviation> uncertainty;  // of the fitted numbers; empty: not known
  std::string belief;                           // file of weighted members (scene/belief.h), or ""

  double patch_pressure(double relative_humidity) const;  // F_N / (phi A) [Pa], Eq. scene.6
  // The clean finger with the skin angle, sweat, shear and hydration of its state, and what the
  // touch has added to its hydration. Eq. scene.11
  Finger applied() const;
  // This finger by the load, the state and the time of another's touch.
  Finger touching_as(const Finger& other) const;
  // d/eps of its stratum corneum [m], at its hydration.
  double skin_layer(double relative_humidity) const;

  bool operator==(const Finger&) const = default;
};
void fields(FieldVisitor& v, Finger& s);

}  // namespace papilla::scene
