#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/quadrature.h"
#include "physics/persson/gap_integrals.h"
#include "physics/persson/persson.h"
#include "physics/persson/power_law.h"

namespace papilla::persson {
namespace {

// A spectrum in short intervals of ln q: nodes, and C = scale (q/unit)^exponent between them.
struct Intervals {
  std::vector<double> q, exponent, scale, unit;
};

Intervals divide(const PowerSpectrum& spectrum, int count) {
  const double step = std::log(spectrum.highest() / spectrum.lowest()) / count;
  Intervals out;
  out.q = {spectrum.lowest()};
  for (std::size_t i = 0; i + 1 < spectrum.wave_number.size(); ++i) {
    const double a = spectrum.wave_number[i], b = spectrum.wave_number[i + 1];
    PAPILLA_CHECK(a > 0 && b > a && spectrum.density[i] > 0 && spectrum.density[i + 1] > 0,
                  "knots ascend, densities are positive");
    const double length = std::log(b / a);
    const double e = std::log(spectrum.density[i + 1] / spectrum.density[i]) / length;
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int k = 1; k <= pieces; ++k) {
      out.q.push_back(k == pieces ? b : a * std::exp(length * k / pieces));
      out.exponent.push_back(e);
      out.scale.push_back(spectrum.density[i]);
      out.unit.push_back(a);
    }
  }
  return out;
}

// int (q^2 E*)^2 C dln q over part of interval i, by four points.
double stress_integral(const Intervals& in, const MeanFieldSolid& solid, std::size_t i, double a,
                       double b) {
  static const Quadrature rule = gauss_legendre(4);
  const double mid = 0.5 * std::log(a * b), half = 0.5 * std::log(b / a);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const double q = std::exp(mid + half * rule.nodes[k]);
    const double c = in.scale[i] * std::pow(q / in.unit[i], in.exponent[i]);
    sum += half * rule.weights[k] * square(q * q * effective_modulus(solid, q)) * c;
  }
  return sum;
}

}  // namespace

double effective_modulus(const MeanFieldSolid& s, double q) {
  const double layer = s.layer_modulus / (1 - square(s.layer_poisson));
  const double bulk = s.bulk_modulus / (1 - square(s.bulk_poisson));
  if (s.layer_thickness == 0) return bulk;
  const double x = q * s.layer_thickness;
  if (x > 40) return layer;
  const double ratio =
      s.layer_modulus * (1 + s.bulk_poisson) / (s.bulk_modulus * (1 + s.layer_poisson));
  const double one_minus_m = 4 * (1 - s.layer_poisson) / (ratio + 3 - 4 * s.layer_poisson);
  const double one_minus_n = 4 * (1 - s.layer_poisson) / (1 + ratio * (3 - 4 * s.bulk_poisson));
  const double m = 1 - one_minus_m, n = 1 - one_minus_n;
  const double e = std::exp(-2 * x), one_minus_e = -std::expm1(-2 * x);
  // Factored so that a stiff layer at small q d loses no digits.
  const double above = 1 - m * n * e * e + 4 * m * x * e;
  const double below =
      (one_minus_m + m * one_minus_e) * (one_minus_n + n * one_minus_e) - 4 * m * x * x * e;
  return layer * below / above;
}

MeanField::MeanField(PowerSpectrum spectrum, MeanFieldSolid solid, MeanFieldOptions options)
    : spectrum_(std::move(spectrum)), solid_(solid), options_(options) {
  PAPILLA_CHECK(spectrum_.wave_number.size() >= 2, "a spectrum has at least two knots");
  PAPILLA_CHECK(spectrum_.wave_number.size() == spectrum_.density.size(), "one density per knot");
  PAPILLA_CHECK(options_.kappa > 0 && options_.intervals > 0, "mean-field options");
  const Intervals intervals = divide(spectrum_, options_.intervals);
  const auto& [q, exponent, scale, unit] = intervals;
  const std::size_t n = q.size() - 1;
  const double reduction = square(kPurePersson / options_.kappa);
  measure_.assign(n + 1, 0);
  measure_mid_.resize(2 * n);
  weight_.resize(2 * n);
  const auto measure_between = [&](std::size_t i, double a, double b) {
    return kPi * reduction * stress_integral(intervals, solid_, i, a, b);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double mid = 0.5 * std::log(q[i] * q[i + 1]), half = 0.5 * std::log(q[i + 1] / q[i]);
    const double first = std::exp(mid - half / std::sqrt(3.0)),
                 second = std::exp(mid + half / std::sqrt(3.0));
    measure_mid_[2 * i] = measure_[i] + measure_between(i, q[i], first);
    measure_mid_[2 * i + 1] = measure_mid_[2 * i] + measure_between(i, first, second);
    measure_[i + 1] = measure_mid_[2 * i + 1] + measure_between(i, second, q[i + 1]);
    for (int k = 0; k < 2; ++k) {
      const double at = k == 0 ? first : second;
      weight_[2 * i + k] = std::sqrt(kPi) * cube(at) * scale[i] *
                           std::pow(at / unit[i], exponent[i]) * effective_modulus(solid_, at) *
                           half;
    }
  }
  variance_.assign(n + 1, 0);
  for (std::size_t i = n; i-- > 0;) {
    variance_[i] =
        variance_[i + 1] + 2 * kPi * scale[i] * square(unit[i]) *
                               power_integral(1 + exponent[i], q[i] / unit[i], q[i + 1] / unit[i]);
  }
  q_ = q;
  gap_table_ = gap_integral_table(options_.energy_factor);
}

double MeanField::stress_measure(double q) const {
  if (q <= q_.front()) return 0;
  if (q >= q_.back()) return measure_.back();
  const std::size_t i =
      static_cast<std::size_t>(std::upper_bound(q_.begin(), q_.end(), q) - q_.begin()) - 1;
  // Cubic in ln q through the four values known in the interval.
  const double t = std::log(q / q_[i]) / std::log(q_[i + 1] / q_[i]);
  const double t1 = 0.5 - 0.5 / std::sqrt(3.0), t2 = 1 - t1;
  const std::array<double, 4> at{0, t1, t2, 1};
  const std::array<double, 4> m{measure_[i], measure_mid_[2 * i], measure_mid_[2 * i + 1],
                                measure_[i + 1]};
  double value = 0;
  for (int a = 0; a < 4; ++a) {
    double l = 1;
    for (int b = 0; b < 4; ++b) {
      if (b != a) l *= (t - at[b]) / (at[a] - at[b]);
    }
    value += l * m[a];
  }
  return value;
}

double MeanField::area(double pressure) const {
  return std::erf(pressure / std::sqrt(measure_.back()));
}

double MeanField::area(double pressure, double q) const {
  const double m = stress_measure(q);
  return m > 0 ? std::erf(pressure / std::sqrt(m)) : (pressure > 0 ? 1.0 : 0.0);
}

double MeanField::pressure_density(double s, double pressure, double q) const {
  const double m = stress_measure(q);
  PAPILLA_CHECK(m > 0, "no pressure distribution without roughness");
  return (std::exp(-square(s - pressure) / m) - std::exp(-square(s + pressure) / m)) /
         std::sqrt(kPi * m);
}

double MeanField::elastic_energy(double pressure) const {
  double sum = 0;
  const double g = options_.energy_factor;
  for (std::size_t k = 0; k < weight_.size(); ++k) {
    const double a = std::erf(pressure / std::sqrt(measure_mid_[k]));
    sum += weight_[k] * a * (g + (1 - g) * a * a);
  }
  return 0.5 * std::sqrt(kPi) * sum;
}

double MeanField::gap_from(std::size_t node, double pressure_here) const {
  const double start = measure_[node], inverse = 1 / square(pressure_here);
  const std::vector<double>& table = *gap_table_;
  double sum = 0;
  for (std::size_t k = weight_.size(); k-- > 2 * node;) {
    const double y = (measure_mid_[k] - start) * inverse;
    if (y <= kLowestNode) break;  // M rises with q: nothing nearer contributes
    sum += weight_[k] * look_up(table, y);
  }
  return sum / pressure_here;
}

double MeanField::mean_gap(double pressure) const {
  PAPILLA_CHECK(pressure > 0, "the mean gap needs a pressure > 0");
  return gap_from(0, pressure);
}

GapDistribution MeanField::gaps(double pressure, double up_to) const {
  PAPILLA_CHECK(pressure > 0, "the gap distribution needs a pressure > 0");
  const std::size_t n = q_.size() - 1;
  GapDistribution result;
  result.pressure = pressure;
  result.smallest_gap = options_.smallest_gap;
  result.contact = area(pressure);
  result.mean_gap = gap_from(0, pressure);
  // Open share 1 - A by erfc: no cancellation near full contact.
  double previous_open = 0, previous_volume = result.mean_gap;  // A u: what is still to come
  for (std::size_t i = 1; i <= n && q_[i - 1] <= up_to; ++i) {
    const double x = pressure / std::sqrt(measure_[i]);
    const double open = std::erfc(x), contact = std::erf(x);
    const double share = open - previous_open;
    // The first bands hold next to nothing, and their gap would be a difference of rounded numbers:
    // merged. (Later ones are small as well where the contact is, but carry the pull.)
    if (!(share > (result.share.empty() && i < n ? 1e-5 * (1 - result.contact) : 0.0))) continue;
    const double volume = i < n ? contact * gap_from(i, pressure / contact) : 0.0;
    const double offset = std::max(0.0, (previous_volume - volume) / share);
    const double variance = 0.5 * (variance_[i - 1] + variance_[i]);
    result.share.push_back(share);
    result.offset.push_back(offset);
    result.width.push_back(offset > 0 ? 1 / std::sqrt(1 / variance + 1 / square(offset)) : 0.0);
    result.wave_number.push_back(q_[i]);
    previous_open = open;
    previous_volume = volume;
  }
  return result;
}

}  // namespace papilla::persson
