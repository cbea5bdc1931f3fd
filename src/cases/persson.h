// A rough layered skin on a driven dielectric as a file (`papilla solve persson`): mean field of
// the roughness spectrum, no texture.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "config/reader.h"
#include "physics/persson/persson.h"
#include "scene/environment.h"

namespace papilla::cases {

// Self-affine by four numbers, or a measured spectrum by its knots (then the numbers are ignored).
struct SpectrumSettings {
  double rms = 22e-6, lowest = 800, roll_off = 5998.2, cutoff = 1e8, hurst = 0.86;
  double scale = 1;                          // C(q) times this
  std::vector<double> wave_number, density;  // [1/m], [m^4]

  PowerSpectrum spectrum() const;
};
void fields(FieldVisitor& v, SpectrumSettings& s);
// What contradicts, by key.
std::vector<std::pair<std::string, std::string>> spectrum_problems(const SpectrumSettings& s);

struct SolidSettings {
  MeanFieldSolid solid;
  double hardness = 0;  // [Pa]; 0: elastic
};
void fields(FieldVisitor& v, SolidSettings& s);

// Layers in series with the gap: the surface's dielectrics and the stratum corneum.
struct InterfaceSettings {
  std::vector<Dielectric> dielectric = {{"oxide", 1e-6, 3.9, 1e14, 1e9}};
  double skin_equivalent = 0;  // d2/eps2 where the skin is taken as lossless [m]
  bool lossy_skin = true;      // instead: thickness of the solid's layer, SkinDielectric
  double gap_resistivity = 0;  // [ohm m]; 0: insulating

  double surface_thickness() const;  // sum of d/eps of the dielectric [m]
  // h0 at a frequency; at 0 Hz lossy skin conducts. Infinite where the gap conducts at 0 Hz.
  std::complex<double> thickness(double skin_thickness, double frequency) const;
  // Smallest ratio of strength to field over the layers of the dielectric at a peak voltage [V],
  // where the skin touches it; infinite without one. Eq. electrostatics.9
  double dielectric_margin(double skin_thickness, double voltage, double frequency) const;
};
void fields(FieldVisitor& v, InterfaceSettings& s);

struct TouchSettings {
  double load = 0.5;                   // [N]
  double area = 1e-4;                  // nominal [m^2]
  double shear_strength = 8e6;         // [Pa]
  double finite_size_pressure = 10e3;  // [Pa]
};
void fields(FieldVisitor& v, TouchSettings& s);

// Each list that is given makes one table, the rest held at its value.
struct SweepSettings {
  std::vector<double> voltage, load, frequency;  // peak [V], [N], [Hz]
};
void fields(FieldVisitor& v, SweepSettings& s);

struct TheorySettings {
  double kappa = 2, energy_factor = 0.45;
};
void fields(FieldVisitor& v, TheorySettings& s);

struct MeanFieldCase {
  int schema_version = 1;
  std::string title;
  SpectrumSettings roughness;
  SolidSettings skin;
  InterfaceSettings interface;
  TouchSettings touch;
  Drive drive;
  SweepSettings sweep;
  TheorySettings theory;
};
void fields(FieldVisitor& v, MeanFieldCase& s);

// Throws InputError with every problem.
MeanFieldCase read_mean_field(const std::string& path,
                              const std::vector<std::string>& overrides = {});
MeanFieldCase read_mean_field(Document document);

struct MeanFieldPoint {
  double voltage = 0, load = 0, frequency = 0;  // peak [V], [N], [Hz]
  std::complex<double> thickness;               // h0 [m]
  double area_off = 0;                          // A/A0 without voltage
  FrictionPoint on;
  // Of the nominal area, gap and layers in series [F], of a skin or gap that conducts by the size
  // of the admittance; 0 where the gap conducts at 0 Hz or no layer insulates.
  double capacitance = 0;
  double dielectric_margin = kInfinity;  // InterfaceSettings::dielectric_margin
  // Under the voltage the dielectric breaks down where the skin touches it.
  bool breaks_down() const { return dielectric_margin < 1; }
  // There is an equilibrium, on a dielectric that holds. Else `on` and the capacitance are of no
  // state, and no number of them is told.
  bool sound() const { return on.pull.status == PullStatus::Solved && !breaks_down(); }
  // With the pull, the pressure is at the hardness or beyond: all of the skin yields, and the
  // numbers under voltage, which are of a skin that carries it, mean nothing.
  bool yielded = false;
};

struct MeanFieldResult {
  double rms = 0, slope = 0, contact_modulus = 0;  // of the smoothed spectrum; E* at its cut-off
  MeanFieldPoint point;
  std::vector<MeanFieldPoint> voltage, load, frequency;  // one per sweep
};
// Milliseconds per point; a skin that yields is flattened at each load by that load. Throws
// InputError for what has no answer (a skin that yields at every scale).
MeanFieldResult solve_mean_field(const MeanFieldCase& c);

// What the case's own point consists of, as curves.
struct MeanFieldCurves {
  struct Roughness {  // over wave number [1/m]
    double wave_number;
    double given, smoothed;   // C(q) [m^4], before and after plastic smoothing
    double area;              // A/A0 of the smoothed spectrum up to here
    double elastic, yielded;  // of the given one, where the skin yields; else area and 0
  };
  struct Separation {  // over nominal pressure [Pa], of the skin that the case's load has flattened
    double pressure;
    double gap, held_gap;  // mean gap [m]: of an infinite body, and of one of a finite size
  };
  struct Step {                // after a step to the drive's amplitude; t [s]
    double time, field, pull;  // in the mean gap [V/m]; mean over the area [Pa]
  };
  std::vector<Roughness> roughness;
  // Over the gaps of the point, under its drive; empty unless that is sound.
  std::vector<StressPoint> stress;
  std::vector<Separation> separation;
  std::vector<Step> step;  // empty without a lossy skin or without a dielectric to hold the voltage
  std::vector<MeanFieldPoint> grid;  // every voltage of the sweep at every load, where both are
};
// Some 100 points each. Cost: 50 ms, and 15 ms for each point of the grid.
MeanFieldCurves mean_field_curves(const MeanFieldCase& c);

}  // namespace papilla::cases
