#include "physics/drive/network.h"

#include <array>
#include <cmath>

#include "base/check.h"

namespace papilla::drive {

std::complex<double> ImpedanceLayer::impedance(double frequency) const {
  const double omega = 2 * kPi * frequency;
  if (std::isinf(resistance)) {
    if (omega * capacitance == 0) return kInfinity;
    return {0, -1 / (omega * capacitance)};
  }
  return resistance / std::complex<double>(1, omega * resistance * capacitance);
}

double ImpedanceLayer::corner_frequency() const {
  const double time = resistance * capacitance;
  return std::isfinite(time) && time > 0 ? 1 / (2 * kPi * time) : 0;
}

ImpedanceLayer slab(double thickness, double permittivity, double resistivity, double area) {
  PAPILLA_CHECK(thickness >= 0 && area > 0 && permittivity > 0, "a layer has a shape");
  if (thickness == 0) return {0, 0};
  return {resistivity * thickness / area, kVacuumPermittivity * permittivity * area / thickness};
}

GapElement plane_gap(double distance, double permittivity, double resistance, double area) {
  PAPILLA_CHECK(distance > 0, "plates that touch have no gap");
  const double capacitance = kVacuumPermittivity * permittivity * area / distance;
  return {{resistance, capacitance}, distance, 0.5 * capacitance / distance};
}

GapElement rough_gap(double mean_inverse, double mean_inverse_square, double h0, double resistance,
                     double area) {
  // The whole stack has the capacitance eps0 A <1/(u + h0)>; what is left after the layers is the
  // gap's. The force of the stack is referred to the gap's share of the voltage.
  const double stack = 1 / mean_inverse, distance = stack - h0;
  PAPILLA_CHECK(distance > 0, "a gap that is closed everywhere has no voltage");
  const double per_stack = 0.5 * kVacuumPermittivity * area * mean_inverse_square;
  return {{resistance, kVacuumPermittivity * area / distance},
          distance,
          per_stack * square(stack / distance)};
}

Transfer transfer(const Network& network, DriveControl control, double frequency) {
  const std::array<const ImpedanceLayer*, 3> layers{&network.gap.layer, &network.dielectric,
                                                    &network.skin};
  std::array<std::complex<double>, 3> z;
  bool open = false;
  for (std::size_t i = 0; i < 3; ++i) {
    z[i] = layers[i]->impedance(frequency);
    open = open || std::isinf(z[i].real());
  }
  const std::complex<double> total = z[0] + z[1] + z[2];
  if (control == DriveControl::Current && std::isinf(network.shunt)) {
    return {z[0], open ? kInfinity : total, 1};
  }
  Transfer out{0, 1, 0};  // of a volt
  if (!open) {
    out.gap_voltage = z[0] / total;
    out.current = 1.0 / total;
  } else {  // only insulators hold a constant voltage, by their capacitances
    double elastance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::isinf(z[i].real())) elastance += 1 / layers[i]->capacitance;
    }
    if (std::isinf(z[0].real())) out.gap_voltage = 1 / layers[0]->capacitance / elastance;
  }
  if (control == DriveControl::Current) {
    const std::complex<double> volts = 1.0 / (1 / network.shunt + out.current);
    out.gap_voltage *= volts;
    out.source_voltage = volts;
    out.current *= volts;
  }
  return out;
}

DriveResponse respond(const Network& network, DriveControl control, double amplitude,
                      double frequency) {
  const Transfer t = transfer(network, control, frequency);
  DriveResponse out{amplitude * std::abs(t.gap_voltage), amplitude * std::abs(t.source_voltage),
                    amplitude * std::abs(t.current), 0, 0};
  const double peak = network.gap.force_factor * square(out.gap_voltage);
  out.mean_force = frequency > 0 ? 0.5 * peak : peak;
  out.ripple = frequency > 0 ? 0.5 * peak : 0;
  return out;
}

double onset_friction(double shear_strength, double real_area, double beta, double load,
                      double pull, double static_share) {
  return shear_strength * real_area + beta * (load + pull) * (1 - static_share);
}

}  // namespace papilla::drive
