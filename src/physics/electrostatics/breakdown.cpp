#include "physics/electrostatics/breakdown.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "base/check.h"

namespace papilla::electrostatics {

double air_breakdown_voltage(double gap) {
  if (gap <= kPaschenGap) return std::min(kAirStrength * gap, kPaschenMinimum);
  // Paschen: A = 112.501 /(kPa cm), B = 2737.5 V/(kPa cm), secondary emission 0.01, 101.325 kPa.
  const double pd = 101.325 * 100 * gap;  // kPa cm
  return std::max(kPaschenMinimum,
                  2737.5 * pd / (std::log(112.501 * pd) - std::log(std::log(1 + 1 / 0.01))));
}

double corner_factor(double thickness, double edge_radius) {
  if (thickness <= 0 || std::isinf(edge_radius)) return 1;
  if (edge_radius <= 0) return std::numeric_limits<double>::infinity();
  const double x = thickness / edge_radius;
  return x / std::log1p(x);
}

double dielectric_margin(std::span<const Dielectric> layers, double v_peak, double edge_radius,
                         std::span<const std::complex<double>> divider) {
  PAPILLA_CHECK(divider.empty() || divider.size() == layers.size(), "a share for each layer");
  if (v_peak <= 0) return std::numeric_limits<double>::infinity();
  const auto counts = [&](std::size_t k) { return divider.empty() ? 1.0 : divider[k]; };
  double thickness = 0;
  std::complex<double> series = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    thickness += layers[k].thickness;
    series += counts(k) * layers[k].equivalent_thickness();
  }
  const double corner = corner_factor(thickness, edge_radius), equivalent = std::abs(series);
  if (equivalent <= 0 || std::isinf(corner)) return 0;
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (layers[k].thickness <= 0) continue;
    const double field =
        v_peak * corner * std::abs(counts(k)) / (layers[k].permittivity * equivalent);
    margin = std::min(margin, layers[k].strength / field);
  }
  return margin;
}

}  // namespace papilla::electrostatics
