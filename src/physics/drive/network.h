// The electrical path from source to finger: dielectric, gap and skin in series, each a resistor in
// parallel with a capacitor. Phasors ~ e^(+jwt), peak amplitudes. Equations: docs/theory/drive.md.
#pragma once

#include <complex>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "scene/environment.h"

namespace papilla::drive {

// A resistance may be infinite, a capacitance 0; not both.
struct ImpedanceLayer {
  double resistance = 0;    // [ohm]
  double capacitance = 0;   // [F], at rest
  Relaxation relaxation{};  // of the permittivity behind it, and that at rest. Eq. drive.22
  double permittivity = 1;

  // Z = R / (1 + jwRC) [ohm]; infinite for an insulator at 0 Hz. Eq. drive.1
  std::complex<double> impedance(double frequency) const;
  double corner_frequency() const;  // 1 / (2 pi R C) [Hz]; 0 for an insulator
  // False: nothing lies there, and its capacitance of 0 stands for no number.
  bool present() const { return resistance > 0; }
};

// Thickness [m], area [m^2], resistivity [ohm m] (infinite: an insulator). Thickness 0: none, which
// conducts without a resistance.
ImpedanceLayer slab(double thickness, double permittivity, double resistivity, double area);

// The gap as one element with the force it makes: F = force_factor V_gap^2.
struct GapElement {
  ImpedanceLayer layer;
  double distance = 0;      // equivalent plane gap by capacitance [m]
  double force_factor = 0;  // [N/V^2]
  // The most that stands across it [V]: a film that saturates has no charge for more. Eq. drive.23
  double held = kInfinity;
};
// Parallel plates. Eq. drive.2
GapElement plane_gap(double distance, double permittivity, double resistance, double area);
// A rough gap u under layers of total equivalent thickness h0 = sum d/eps: means over the area of
// 1/(u + h0) [1/m] and 1/(u + h0)^2 [1/m^2]. The resistance is of the gap alone. Eq. drive.3
GapElement rough_gap(double mean_inverse, double mean_inverse_square, double h0, double resistance,
                     double area);

struct Network {
  ImpedanceLayer dielectric, skin;
  GapElement gap;
  std::vector<ImpedanceLayer> relaxing{};  // layers of the film whose permittivity does
  std::vector<ImpedanceLayer> apart{};     // others that leak at another time constant
  // Across a current source: its output resistance, or one that keeps charge from building up
  // [ohm]; the voltage source does not feel it.
  double shunt = kInfinity;
};

// What the network makes of a unit of the source (1 V or 1 A) at a frequency. Ideal insulators at 0
// Hz share the voltage by capacitance, and no current flows; a current source without a shunt then
// has no answer (infinite). Eq. drive.4
struct Transfer {
  std::complex<double> gap_voltage, source_voltage, current;
  std::complex<double> film_voltage = 0;  // across the dielectric, all of its layers
};
Transfer transfer(const Network& network, DriveControl control, double frequency);

// A sine (or, at 0 Hz, a constant) of a peak amplitude. Eq. drive.5
struct DriveResponse {
  double gap_voltage = 0, source_voltage = 0, current = 0;  // peak
  double mean_force = 0;                                    // rectified part [N]
  double ripple = 0;                                        // amplitude at twice the frequency [N]
  // Peak across the dielectric; what a saturated film keeps from the gap stands on it. Eq. drive.23
  double film_voltage = 0;
};
DriveResponse respond(const Network& network, DriveControl control, double amplitude,
                      double frequency);

// Onset of sliding: F = tau0 A_real + beta (W + F_e)(1 - alpha), alpha the share of the patch in
// static contact. Eq. drive.6
double onset_friction(double shear_strength, double real_area, double beta, double load,
                      double pull, double static_share);

}  // namespace papilla::drive
