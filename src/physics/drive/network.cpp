#include "physics/drive/network.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"

namespace papilla::drive {

std::complex<double> ImpedanceLayer::impedance(double frequency) const {
  const double omega = 2 * kPi * frequency;
  if (relaxation.law != RelaxationLaw::None && omega > 0) {
    const std::complex<double> stores =
        std::complex<double>(0, omega * capacitance) * relaxation.share(permittivity, frequency);
    return 1.0 / (1 / resistance + stores);
  }
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
  // Gap and skin, then the layers of the film.
  std::vector<const ImpedanceLayer*> layers{&network.gap.layer, &network.skin, &network.dielectric};
  for (const auto* others : {&network.relaxing, &network.apart}) {
    for (const ImpedanceLayer& layer : *others) layers.push_back(&layer);
  }
  const auto of_film = [](const std::vector<std::complex<double>>& each) {
    return std::accumulate(each.begin() + 2, each.end(), std::complex<double>(0));
  };
  std::vector<std::complex<double>> z;
  std::complex<double> total = 0;
  bool open = false;
  for (const ImpedanceLayer* layer : layers) {
    z.push_back(layer->impedance(frequency));
    total += z.back();
    open = open || std::isinf(z.back().real());
  }
  if (control == DriveControl::Current && std::isinf(network.shunt)) {
    return {z[0], open ? kInfinity : total, 1, of_film(z)};
  }
  Transfer out{0, 1, 0};                              // of a volt
  std::vector<std::complex<double>> share(z.size());  // of that volt
  if (!open) {
    for (std::size_t i = 0; i < z.size(); ++i) share[i] = z[i] / total;
    out.current = 1.0 / total;
  } else {  // only insulators hold a constant voltage, by their capacitances
    double elastance = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (std::isinf(z[i].real())) elastance += 1 / layers[i]->capacitance;
    }
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (std::isinf(z[i].real())) share[i] = 1 / layers[i]->capacitance / elastance;
    }
  }
  out.gap_voltage = share[0];
  out.film_voltage = of_film(share);
  if (control == DriveControl::Current) {
    const std::complex<double> volts = 1.0 / (1 / network.shunt + out.current);
    out.gap_voltage *= volts;
    out.film_voltage *= volts;
    out.source_voltage = volts;
    out.current *= volts;
  }
  return out;
}

namespace {

// Mean square of a sine of a peak that is held at a voltage, and the amplitude of its square at
// twice the frequency [V^2]. Eq. drive.23
struct HeldSquare {
  double mean = 0, ripple = 0;
};
HeldSquare held_square(double peak, double held) {
  if (peak <= held) return {0.5 * square(peak), 0.5 * square(peak)};
  constexpr int kSteps = 4096;  // midpoints of a quarter cycle
  HeldSquare out;
  for (int i = 0; i < kSteps; ++i) {
    const double turn = 0.5 * kPi * (i + 0.5) / kSteps;
    const double v2 = square(std::min(peak * std::sin(turn), held));
    out.mean += v2 / kSteps;
    out.ripple -= 2 * v2 * std::cos(2 * turn) / kSteps;
  }
  return out;
}

}  // namespace

DriveResponse respond(const Network& network, DriveControl control, double amplitude,
                      double frequency) {
  const Transfer t = transfer(network, control, frequency);
  DriveResponse out;
  out.gap_voltage = amplitude * std::abs(t.gap_voltage);
  out.source_voltage = amplitude * std::abs(t.source_voltage);
  out.current = amplitude * std::abs(t.current);
  out.film_voltage = amplitude * std::abs(t.film_voltage);
  const double factor = network.gap.force_factor, held = network.gap.held;
  if (frequency > 0) {
    const HeldSquare v2 = held_square(out.gap_voltage, held);
    out.mean_force = factor * v2.mean;
    out.ripple = factor * v2.ripple;
  } else {
    out.mean_force = factor * square(std::min(out.gap_voltage, held));
  }
  // Exact where film and gap are in phase, else a little more than the film's peak.
  out.film_voltage += std::max(0.0, out.gap_voltage - held);
  out.gap_voltage = std::min(out.gap_voltage, held);
  return out;
}

double onset_friction(double shear_strength, double real_area, double beta, double load,
                      double pull, double static_share) {
  return shear_strength * real_area + beta * (load + pull) * (1 - static_share);
}

}  // namespace papilla::drive
