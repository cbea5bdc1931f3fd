#include "physics/electrostatics/breakdown.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

double dielectric_margin(std::span<const Dielectric> layers, double v_peak, double edge_radius) {
  if (v_peak <= 0) return std::numeric_limits<double>::infinity();
  double thickness = 0, equivalent = 0;
  for (const Dielectric& layer : layers) {
    thickness += layer.thickness;
    equivalent += layer.equivalent_thickness();
  }
  const double corner = corner_factor(thickness, edge_radius);
  if (equivalent <= 0 || std::isinf(corner)) return 0;
  double margin = std::numeric_limits<double>::infinity();
  for (const Dielectric& layer : layers) {
    if (layer.thickness <= 0) continue;
    const double field = v_peak * corner / (layer.permittivity * equivalent);
    margin = std::min(margin, layer.strength / field);
  }
  return margin;
}

}  // namespace papilla::electrostatics
