#include <cmath>
#include <limits>

#include "base/constants.h"
#include "numerics/quadrature.h"
#include "physics/persson/persson.h"

namespace papilla::persson {
namespace {

double folded_density(double u, double offset, double width) {
  const double a = (u - offset) / width, b = (u + offset) / width;
  // Of the bell's mirror image nothing is left in the sum where it is 1e17 times smaller.
  constexpr double kVanishes = 40;
  const bool both = 0.5 * (b * b - a * a) < kVanishes;
  return (std::exp(-0.5 * a * a) + (both ? std::exp(-0.5 * b * b) : 0)) /
         (width * std::sqrt(2 * kPi));
}

// Nodes u and weights of the rule for integrals over u = |N(offset, width)| above `least`, handed
// to visit(u, weight); adds the share kept there to `kept`. scale [m]: length on which integrands
// vary near u = 0.
template <class Visit>
void folded_nodes(double offset, double width, double scale, double least, double& kept,
                  Visit&& visit) {
  static const Quadrature line = gauss_legendre(40);
  static const Quadrature bell = [] {  // narrow: rule in (u - offset) / width
    Quadrature q = gauss_legendre(24, -6.5, 6.5);
    for (std::size_t k = 0; k < q.nodes.size(); ++k) {
      q.weights[k] *= std::exp(-0.5 * square(q.nodes[k])) / std::sqrt(2 * kPi);
    }
    return q;
  }();
  double share = 1;
  if (least > 0 && offset - 7 * width < least) {
    const double root = std::sqrt(2.0) * width;
    share = width > 0
                ? 0.5 * (std::erfc((least - offset) / root) + std::erfc((least + offset) / root))
                : (offset >= least ? 1.0 : 0.0);
  }
  kept += share;
  if (share == 0) return;
  if (!(width > 1e-4 * (offset + scale))) {
    visit(offset, share);
    return;
  }
  if (share == 1 && width * 6.5 < offset) {
    for (std::size_t k = 0; k < bell.nodes.size(); ++k)
      visit(offset + width * bell.nodes[k], bell.weights[k]);
    return;
  }
  // u = scale (e^v - 1) resolves both the pole at -scale and the bell.
  const double bottom = std::log1p(least / scale);
  const double half = 0.5 * (std::log1p((offset + 7 * width) / scale) - bottom);
  if (half <= 0) return;
  for (std::size_t k = 0; k < line.nodes.size(); ++k) {
    const double u = scale * std::expm1(bottom + half * (1 + line.nodes[k]));
    visit(u, half * line.weights[k] * (u + scale) * folded_density(u, offset, width));
  }
}

// Mean over bands 0..count of a distribution, their share below `least` spread over the rest.
template <class Function>
auto band_sum(const GapDistribution& gaps, std::size_t count, double scale, Function&& f) {
  decltype(f(0.0)) sum = 0;
  double kept = 0, total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double share = 0;
    decltype(sum) band = 0;
    folded_nodes(gaps.offset[i], gaps.width[i], scale, gaps.smallest_gap, share,
                 [&](double u, double weight) { band += weight * f(u); });
    sum += gaps.share[i] * band;
    kept += gaps.share[i] * share;
    total += gaps.share[i];
  }
  return kept > 0 ? sum * total / kept : 0.0;
}

template <class Thickness>
Thickness mean_inverse(const GapDistribution& gaps, Thickness h0) {
  return gaps.contact / h0 +
         band_sum(gaps, gaps.share.size(), std::abs(h0), [&](double u) { return 1.0 / (u + h0); });
}

}  // namespace

double GapDistribution::density(double u) const {
  double sum = 0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (width[i] > 0) sum += share[i] * folded_density(u, offset[i], width[i]);
  }
  return sum;
}

double GapDistribution::cumulative(double u) const {
  double sum = contact;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(width[i] > 0)) {
      sum += u >= offset[i] ? share[i] : 0.0;
      continue;
    }
    const double root = std::sqrt(2.0) * width[i];
    sum += 0.5 * share[i] * (std::erf((u - offset[i]) / root) + std::erf((u + offset[i]) / root));
  }
  return sum;
}

double GapDistribution::inverse_square(std::complex<double> h0) const {
  return contact / std::norm(h0) + far_inverse_square(h0, std::numeric_limits<double>::infinity());
}

double GapDistribution::far_inverse_square(std::complex<double> h0, double q) const {
  const double re = h0.real(), im2 = square(h0.imag());
  return band_sum(*this, far_bands(q), std::abs(h0),
                  [&](double u) { return 1 / (square(u + re) + im2); });
}

void GapDistribution::visit_far(double scale, double q,
                                const std::function<void(double gap, double share)>& visit) const {
  const std::size_t count = far_bands(q);
  for (std::size_t i = 0; i < count; ++i) {
    double kept = 0;
    folded_nodes(offset[i], width[i], scale, 0, kept,
                 [&](double u, double weight) { visit(u, share[i] * weight); });
  }
}

std::size_t GapDistribution::far_bands(double q) const {
  std::size_t count = 0;
  while (count < share.size() && wave_number[count] <= q * (1 + 1e-12)) ++count;
  return count;
}

double GapDistribution::inverse(double h0) const { return mean_inverse(*this, h0); }

std::complex<double> GapDistribution::inverse(std::complex<double> h0) const {
  return mean_inverse(*this, h0);
}

double StepResponse::relaxation_time(double u) const {
  return kVacuumPermittivity * layer_resistivity * layer_permittivity *
         (1 + layer_thickness / layer_permittivity / (u + dielectric_equivalent));
}

double StepResponse::field(double voltage, double u, double t) const {
  const double first = 1 / (u + dielectric_equivalent + layer_thickness / layer_permittivity);
  const double last = 1 / (u + dielectric_equivalent);
  return voltage * (last + (first - last) * std::exp(-t / relaxation_time(u)));
}

double StepResponse::pull(const GapDistribution& gaps, double voltage, double t) const {
  const double open = band_sum(gaps, gaps.share.size(), dielectric_equivalent,
                               [&](double u) { return square(field(voltage, u, t)); });
  return 0.5 * kVacuumPermittivity * (gaps.contact * square(field(voltage, 0, t)) + open);
}

std::vector<StressPoint> stress_distribution(const GapDistribution& gaps, double v_rms,
                                             std::complex<double> h0,
                                             std::span<const double> at_gaps) {
  std::vector<StressPoint> points;
  points.reserve(at_gaps.size());
  const double pressure = 0.5 * kVacuumPermittivity * square(v_rms);
  for (const double u : at_gaps) {
    StressPoint point{};
    point.gap = u;
    const double squared = std::norm(u + h0);
    point.stress = pressure / squared;
    point.density = 0.5 * square(squared) / (u + h0.real()) / pressure * gaps.density(u);
    point.per_decade = std::log(10.0) * square(point.stress) * point.density;
    points.push_back(point);
  }
  return points;
}

}  // namespace papilla::persson
