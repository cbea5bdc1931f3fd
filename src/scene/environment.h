// Air, surface finish and drive. Plain values, SI.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::scene {

struct Environment {
  std::vector<double> relative_humidity = {0.15, 0.35, 0.55, 0.75};
  std::vector<double> weights;  // one per humidity; empty: equal

  bool operator==(const Environment&) const = default;
};
void fields(FieldVisitor& v, Environment& s);

// How a layer came onto the electrode: what decides where the electrode lies below a texture.
enum class FilmProcess {
  Conformal,    // equal along the normal: thermal oxide, atomic layers
  Directional,  // equal along z: evaporation, sputtering; side walls by the step coverage
  Planar,       // a flat electrode; the texture is cut into the layer or imprinted on it
};
// What a layer says of itself: as its surface, or a process of its own.
enum class LayerProcess { Surface, Conformal, Directional, Planar };

// 1/(2 pi eps0 eps rho) [Hz]: below it a material conducts more than it stores. Resistivity
// [ohm m], 0: a perfect insulator, never. Eq. scene.9
double corner_frequency(double permittivity, double resistivity);

// How a permittivity falls with frequency, and what is lost there.
enum class RelaxationLaw { None, Debye, ColeCole, Table };
struct Relaxation {
  RelaxationLaw law = RelaxationLaw::None;
  double infinite = 1;  // permittivity far above the relaxation
  double time = 0;      // [s]
  double alpha = 0;     // Cole-Cole: how much wider than Debye's, 0 to 1
  // Of a table: storing and lossy part, straight over ln f between, held outside.
  std::vector<double> frequency, permittivity, loss;

  // Over the permittivity at rest, fields ~ e^(+jwt): the imaginary part is -loss. Eq. scene.14
  std::complex<double> share(double at_rest, double f) const;

  bool operator==(const Relaxation&) const = default;
};
void fields(FieldVisitor& v, Relaxation& s);

struct Dielectric {
  std::string material = "SiO2";
  double thickness = 500e-9;
  double permittivity = 3.9;  // at rest
  double resistivity = 1e14;  // [ohm m]; 0: a perfect insulator
  double strength = 1e9;      // breakdown field [V/m]
  Relaxation relaxation{};
  double saturation_field = 0;  // from which the polarisation no longer grows [V/m]; 0: none

  double equivalent_thickness() const { return thickness / permittivity; }
  // Below it the layer conducts [Hz]; 0: never. Eq. scene.9
  double corner_frequency() const { return scene::corner_frequency(permittivity, resistivity); }

  bool operator==(const Dielectric&) const = default;
};
void fields(FieldVisitor& v, Dielectric& s);

// Strongest field in the air on these layers that their charge still makes [V/m]; infinite: none
// saturates. Eq. electrostatics.22
double saturated_air_field(std::span<const Dielectric> layers);
// What contradicts in the relaxation of a layer, by key; "" where nothing does.
struct RelaxationProblem {
  std::string key, message;
};
RelaxationProblem relaxation_problem(const Dielectric& layer);

// A layer below a texture.
struct FilmDielectric : Dielectric {
  LayerProcess process = LayerProcess::Surface;
  double refractive_index = 0;  // 0: that of the surface
  double extinction = 0;

  FilmProcess made_by(FilmProcess of_surface) const;

  bool operator==(const FilmDielectric&) const = default;
};
void fields(FieldVisitor& v, FilmDielectric& s);

// What a film lies on, where that makes it thinner than on level ground.
struct FilmGround {
  double deepest = 0;   // lowest place below height 0 [m]
  double height = 0;    // of walls [m]
  double steepest = 0;  // angle of walls from the land [rad]
};

// The finish of the textured surface.
struct Surface {
  double contact_angle = 0.8726646259971648;                    // 50 deg
  std::vector<FilmDielectric> dielectric = {FilmDielectric{}};  // the one on the electrode first
  FilmProcess process = FilmProcess::Conformal;
  double step_coverage = 0;          // of directional layers: side wall / top
  double electrode_edge_radius = 0;  // convex edges under walls [m]; 0: none stated
  double refractive_index = 1.46;
  double modulus = 0;    // Young's modulus of compliant features (particles); 0: rigid
  double poisson = 0.4;  // theirs
  // Of what lies below texture and features, for pins; 0: rigid. Skin takes it as rigid.
  double base_modulus = 0, base_poisson = 0.3;
  double shear_strength = 0;  // against clean skin at 15 % RH [Pa]; 0: that of the finger, on glass
  // Against skin in its other states [Pa]; 0: the clean one's, changed as the finger's state says.
  double shear_strength_natural = 0;  // with its sebum, at 15 % RH
  double shear_strength_wet = 0;      // saturated with water

  double equivalent_thickness() const;     // sum of d/eps [m]
  double dielectric_thickness() const;     // of all layers [m]
  std::vector<Dielectric> layers() const;  // without how they were made
  // Those on the shortest way from the surface to the electrode: at the foot of a wall, over the
  // deepest place of a planar layer and past directional ones, which are thin there.
  // Eq. electrostatics.9
  std::vector<Dielectric> thinnest_layers(const FilmGround& ground) const;
  double saturated_air_field() const { return scene::saturated_air_field(layers()); }
  // The layer that a texture is cut into or imprinted on; -1: none is planar.
  int carrying_layer() const;

  bool operator==(const Surface&) const = default;
};
void fields(FieldVisitor& v, Surface& s);

enum class DriveControl { Voltage, Current };
enum class Waveform { Sine, Square, Dc, Am };

struct Drive {
  DriveControl control = DriveControl::Voltage;
  Waveform waveform = Waveform::Sine;
  double amplitude = 0;    // peak voltage under voltage control [V]; 0: undriven
  double frequency = 5e3;  // carrier [Hz]
  double current = 0;      // peak current under current control [A]
  double modulation_frequency = 0;
  double envelope_exponent = 0.5;
  double source_compliance = 0;  // largest voltage of the source; 0: none given
  double current_limit = 5e-3;   // through the body [A]

  double rms_of_peak() const;                                 // of the waveform, Eq. scene.7
  double v_rms() const { return amplitude * rms_of_peak(); }  // under voltage control
  // What the source holds: a peak voltage [V] or a peak current [A]; 0: undriven.
  double held() const { return control == DriveControl::Current ? current : amplitude; }
  bool driven() const { return held() > 0; }

  bool operator==(const Drive&) const = default;
};
void fields(FieldVisitor& v, Drive& s);

}  // namespace papilla::scene
