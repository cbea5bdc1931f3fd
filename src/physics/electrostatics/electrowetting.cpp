#include "physics/electrostatics/electrowetting.h"

#include <cmath>
#include <limits>

#include "base/constants.h"

namespace papilla::electrostatics {

double electrowetting_number(double v, double dielectric_equivalent, double surface_tension) {
  if (v == 0) return 0;
  if (dielectric_equivalent <= 0) return std::numeric_limits<double>::infinity();
  return kVacuumPermittivity * v * v / (2 * surface_tension * dielectric_equivalent);
}

double electrowetted_cosine(double cos_rest, double cos_saturated, double eta_peak, bool sine,
                            double held) {
  const double room = cos_saturated - cos_rest;
  if (room <= 0 || eta_peak <= 0) return cos_rest;
  // At a voltage over the peak: the work of the charge, the integral of D dV, over gamma.
  const auto eta = [&](double u) {
    return u <= held ? eta_peak * u * u : eta_peak * held * (2 * u - held);
  };
  if (!sine) return cos_rest + room * std::tanh(eta(1) / room);
  // Mean over a quarter period by the midpoint rule: spectrally exact for the periodic integrand.
  constexpr int kSteps = 64;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = std::sin(0.5 * kPi * (i + 0.5) / kSteps);
    sum += std::tanh(eta(s) / room);
  }
  return cos_rest + room * sum / kSteps;
}

}  // namespace papilla::electrostatics
