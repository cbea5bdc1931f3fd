// Layers that conduct a little: skin and resistive dielectrics from DC to 1 MHz.
#pragma once

#include <complex>
#include <span>

namespace papilla {

// Permittivity and resistivity [ohm m] at the frequency asked for; infinite resistivity: an
// insulator.
struct LossyLayer {
  double thickness = 0;     // [m]
  double permittivity = 1;  // relative
  double resistivity = 0;   // [ohm m], > 0

  double relaxation_time() const;  // eps0 eps rho [s]
};

// d/eps(omega) [m], eps(omega) = eps + i/(omega eps0 rho) for fields ~ exp(-i omega t): what a
// layer adds to the gap in series while the gap insulates. At DC 0 for a layer that conducts. Eq.
// electrostatics.10
std::complex<double> equivalent_thickness(const LossyLayer& layer, double frequency);

// Field in a gap [m] for one volt across gap and layers [1/m]; the gap may conduct too. DC: layers
// share the voltage by resistance; a stack with insulators drops it there alone (Johnsen-Rahbek:
// with an insulating gap on resistive layers 1/gap). Infinite for a closed gap that takes all the
// voltage. Eq. electrostatics.11
std::complex<double> gap_field(double gap, double gap_resistivity,
                               std::span<const LossyLayer> layers, double frequency);

}  // namespace papilla
