#include "physics/macro/fingertip.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/quadrature.h"

namespace papilla::macro {
namespace {

constexpr double kReferenceLoad = 0.2;  // of the finger file's area [N]
constexpr int kNodes = 48;

// d(indentation)/d(radius) of a punch r^m: sqrt(pi) Gamma(m/2 + 1)/Gamma((m + 1)/2) c m a^(m - 1).
double slope(const TipShape& s, double a) {
  const double factor =
      std::sqrt(kPi) * std::exp(std::lgamma(0.5 * s.power + 1) - std::lgamma(0.5 * s.power + 0.5));
  return factor * s.coefficient * s.power * std::pow(a, s.power - 1);
}

}  // namespace

double TipSolid::modulus(double radius) const {
  if (thickness <= 0) return tissue;
  if (radius <= 0) return layer;
  // Gao, Chiu & Lee 1992, for nu = 1/2 in layer and tissue.
  const double t = thickness / radius;
  const double weight = 2 / kPi * std::atan(t) - t / ((1 + t * t) * kPi);
  return tissue + (layer - tissue) * std::clamp(weight, 0.0, 1.0);
}

TipContact tip_contact_at(const TipShape& shape, const TipSolid& solid, double radius) {
  PAPILLA_CHECK(radius >= 0 && shape.power > 0 && shape.coefficient > 0, "a fingertip");
  TipContact out;
  out.radius = radius;
  out.area = kPi * radius * radius;
  if (radius == 0) return out;
  const Quadrature rule = gauss_legendre(kNodes, 0, radius);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double a = rule.nodes[i], w = rule.weights[i];
    out.indentation += w * slope(shape, a);
    out.load += w * 2 * solid.modulus(a) * a * slope(shape, a);
  }
  return out;
}

TipContact tip_contact(const TipShape& shape, const TipSolid& solid, double load) {
  PAPILLA_CHECK(load >= 0, "a load");
  if (load == 0) return {};
  double low = 0, high = 1e-3;
  while (tip_contact_at(shape, solid, high).load < load) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (tip_contact_at(shape, solid, middle).load < load ? low : high) = middle;
  }
  return tip_contact_at(shape, solid, 0.5 * (low + high));
}

double tip_pressure(const TipShape& shape, const TipSolid& solid, double radius, double r) {
  if (r >= radius || radius <= 0) return 0;
  // Sum of flat punches of radius s >= r; s = sqrt(r^2 + t^2) takes the root out of the integral.
  const Quadrature rule = gauss_legendre(kNodes, 0, std::sqrt(radius * radius - r * r));
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double t = rule.nodes[i];
    const double s = std::sqrt(r * r + t * t);
    sum += rule.weights[i] * solid.modulus(s) * slope(shape, s) / s;
  }
  return sum / kPi;
}

Fingertip fingertip(const MacroContact& macro, double relative_humidity, double curvature_radius) {
  const double n = std::clamp(macro.load_exponent, 0.05, 1.0);
  const double a = std::sqrt(macro.area_15 / kPi);
  Fingertip out;
  out.shape.power = 2 / n - 1;
  // As high as the sphere at the edge of the contact at 0.2 N.
  out.shape.coefficient = a * a / (2 * curvature_radius) / std::pow(a, out.shape.power);
  out.solid.tissue = 1;
  const double modulus = kReferenceLoad / tip_contact_at(out.shape, out.solid, a).load;
  const double growth =
      macro.gross_area(kReferenceLoad, relative_humidity) / macro.gross_area(kReferenceLoad, 0.15);
  out.solid.tissue = modulus * std::pow(growth, -1 / n);
  return out;
}

RidgeLoad ridge_load(const MacroContact& macro, double load, double relative_humidity) {
  RidgeLoad out;
  const double gross = macro.gross_area(load, relative_humidity);
  out.area = macro.ridge_share * gross;
  if (load <= 0 || gross <= 0) return out;
  out.mean_pressure = load / out.area;
  const Fingertip tip = fingertip(macro, relative_humidity);
  out.peak_pressure =
      tip_pressure(tip.shape, tip.solid, std::sqrt(gross / kPi), 0) / macro.ridge_share;
  return out;
}

std::vector<PressureRing> pressure_rings(double peak, int rings) {
  PAPILLA_CHECK(peak >= 1 && rings >= 1, "a pressure profile");
  if (peak == 1) return {{}};
  // Over the share of the area inside: 1 - (r/a)^2 falls evenly from 1 to 0.
  const Quadrature rule = gauss_legendre(rings, 0, 1);
  std::vector<PressureRing> out;
  double mean = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    out.push_back({rule.weights[i], peak * std::pow(rule.nodes[i], peak - 1)});
    mean += out.back().share * out.back().over_mean;
  }
  for (PressureRing& ring : out) ring.over_mean /= mean;
  return out;
}

}  // namespace papilla::macro
