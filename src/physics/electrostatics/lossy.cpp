#include "physics/electrostatics/lossy.h"

#include <cmath>
#include <limits>

#include "base/constants.h"

namespace papilla {

double LossyLayer::relaxation_time() const {
  return kVacuumPermittivity * permittivity * resistivity;
}

std::complex<double> equivalent_thickness(const LossyLayer& layer, double frequency) {
  if (layer.thickness == 0) return 0;
  const double eps_thickness = layer.thickness / layer.permittivity;
  if (std::isinf(layer.resistivity)) return eps_thickness;
  const double x = 2 * kPi * frequency * layer.relaxation_time();  // omega tau
  // d/(eps (1 + i/x)), regular at DC.
  return eps_thickness * x / std::complex<double>(x, 1);
}

std::complex<double> gap_field(double gap, double gap_resistivity,
                               std::span<const LossyLayer> layers, double frequency) {
  const double omega_eps = 2 * kPi * frequency * kVacuumPermittivity;
  double insulating = std::isinf(gap_resistivity) ? gap : 0;
  bool insulator = insulating > 0;
  for (const LossyLayer& layer : layers) {
    insulator = insulator || (layer.thickness > 0 && std::isinf(layer.resistivity));
  }
  if (frequency == 0 && insulator) {
    // Displacement alone counts, and only across the insulators; a gap that conducts has no field.
    if (!std::isinf(gap_resistivity)) return 0;
    for (const LossyLayer& layer : layers) {
      if (std::isinf(layer.resistivity)) insulating += layer.thickness / layer.permittivity;
    }
    return 1 / insulating;
  }
  // Current density is common: E = j/y with the admittivity y = 1/rho - i omega eps0 eps.
  const std::complex<double> own(1 / gap_resistivity, -omega_eps);
  std::complex<double> sum = gap;
  for (const LossyLayer& layer : layers) {
    if (layer.thickness == 0) continue;
    const std::complex<double> y(1 / layer.resistivity, -omega_eps * layer.permittivity);
    sum += layer.thickness * own / y;
  }
  if (sum == 0.0) return std::numeric_limits<double>::infinity();
  return 1.0 / sum;
}

}  // namespace papilla
