#include "physics/persson/persson.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "base/quadrature.h"

namespace papilla {
namespace {

// int_a^b q^n dq for C ~ q^e pieces.
double power_integral(double n, double a, double b) {
  const double l = std::log(b / a);
  const double x = (n + 1) * l;
  return std::pow(a, n + 1) * l * (std::abs(x) < 1e-12 ? 1.0 : std::expm1(x) / x);
}

// ---- F(x) = int_x^inf dt/t e^-t^2 [gamma + 3 (1 - gamma) erf^2 t] as H(y) = F(y^-1/2) y^-1/2.
// Tabulated at 2^k (1 + j/128): the cell of y is read off its bits.
constexpr int kLowExponent = -6;  // y below 2^-6: x > 8, F = 0
constexpr int kHighExponent = 120;
constexpr int kCellsPerOctave = 128;
constexpr int kTableSize = (kHighExponent - kLowExponent) * kCellsPerOctave + 1;

double table_node(int i) {
  return std::ldexp(1.0 + (i % kCellsPerOctave) / double(kCellsPerOctave),
                    i / kCellsPerOctave + kLowExponent);
}

struct GapIntegrals {
  std::vector<double> plain, squared;  // with weights 1 and erf^2, times y^-1/2
};

const GapIntegrals& gap_integrals() {
  static const GapIntegrals tables = [] {
    GapIntegrals t{std::vector<double>(kTableSize), std::vector<double>(kTableSize)};
    const Quadrature rule = gauss_legendre(4);
    double plain = 0, squared = 0;
    for (int i = 0; i < kTableSize; ++i) {
      const double y = table_node(i);
      if (i > 0) {  // in ln t over the cell, t from y^-1/2 of this node to that of the last one
        const double low = -0.5 * std::log(y), high = -0.5 * std::log(table_node(i - 1));
        for (int k = 0; k < 4; ++k) {
          const double x = std::exp(0.5 * (low + high) + 0.5 * (high - low) * rule.nodes[k]);
          const double w = 0.5 * (high - low) * rule.weights[k] * std::exp(-x * x);
          plain += w;
          squared += w * square(std::erf(x));
        }
      }
      t.plain[i] = plain / std::sqrt(y);
      t.squared[i] = squared / std::sqrt(y);
    }
    return t;
  }();
  return tables;
}

double look_up(const std::vector<double>& table, double y) {
  if (!(y > 0.015625)) return 0;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(y);
  const std::uint64_t cell = (bits >> 45) - (std::uint64_t(1023 + kLowExponent) << 7);
  if (cell >= kTableSize - 1) return table.back();
  // Fraction of the cell from the remaining mantissa bits.
  const double fraction = double(bits & ((std::uint64_t(1) << 45) - 1)) * 0x1p-45;
  return table[cell] + fraction * (table[cell + 1] - table[cell]);
}

double folded_density(double u, double offset, double width) {
  const double a = (u - offset) / width, b = (u + offset) / width;
  return (std::exp(-0.5 * a * a) + std::exp(-0.5 * b * b)) / (width * std::sqrt(2 * kPi));
}

// Integral of f(u) over u = |N(offset, width)| above `least`; adds the share kept there to `kept`.
// scale [m]: length on which f varies near u = 0.
template <class Function>
double folded_integral(double offset, double width, double scale, double least, double& kept,
                       Function&& f) {
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
  if (share == 0) return 0;
  if (!(width > 1e-4 * (offset + scale))) return share * f(offset);
  double sum = 0;
  if (share == 1 && width * 6.5 < offset) {
    for (std::size_t k = 0; k < bell.nodes.size(); ++k) {
      sum += bell.weights[k] * f(offset + width * bell.nodes[k]);
    }
    return sum;
  }
  // u = scale (e^v - 1) resolves both the pole at -scale and the bell.
  const double bottom = std::log1p(least / scale);
  const double half = 0.5 * (std::log1p((offset + 7 * width) / scale) - bottom);
  if (half <= 0) return 0;
  for (std::size_t k = 0; k < line.nodes.size(); ++k) {
    const double u = scale * std::expm1(bottom + half * (1 + line.nodes[k]));
    sum += line.weights[k] * (u + scale) * folded_density(u, offset, width) * f(u);
  }
  return half * sum;
}

// Mean over bands 0..count of a distribution, their share below `least` spread over the rest.
template <class Function>
double band_sum(const GapDistribution& gaps, std::size_t count, double scale, Function&& f) {
  double sum = 0, kept = 0, total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double share = 0;
    sum += gaps.share[i] *
           folded_integral(gaps.offset[i], gaps.width[i], scale, gaps.smallest_gap, share, f);
    kept += gaps.share[i] * share;
    total += gaps.share[i];
  }
  return kept > 0 ? sum * total / kept : 0.0;
}

double log_log(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.size() == 1) return y[0];
  std::size_t i = 1;
  while (i + 1 < x.size() && at > x[i]) ++i;
  const double slope = std::log(y[i] / y[i - 1]) / std::log(x[i] / x[i - 1]);
  return y[i - 1] * std::pow(at / x[i - 1], slope);
}

}  // namespace

// ---- Spectrum
// ------------------------------------------------------------------------------------

double PowerSpectrum::at(double q) const {
  if (q < lowest() || q > highest()) return 0;
  return log_log(wave_number, density, q);
}

double PowerSpectrum::moment(int order, double low, double high) const {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < wave_number.size(); ++i) {
    const double a = std::max(low, wave_number[i]), b = std::min(high, wave_number[i + 1]);
    if (!(b > a)) continue;
    const double e =
        std::log(density[i + 1] / density[i]) / std::log(wave_number[i + 1] / wave_number[i]);
    // In units of the knot: steep pieces (steps) do not overflow.
    const double unit = wave_number[i];
    sum +=
        density[i] * std::pow(unit, order + 2) * power_integral(order + 1 + e, a / unit, b / unit);
  }
  return 2 * kPi * sum;
}

double PowerSpectrum::rms() const { return std::sqrt(moment(0, lowest(), highest())); }
double PowerSpectrum::slope() const { return std::sqrt(moment(2, lowest(), highest())); }

PowerSpectrum PowerSpectrum::scaled(double factor) const {
  PowerSpectrum result = *this;
  for (double& c : result.density) c *= factor;
  return result;
}

PowerSpectrum PowerSpectrum::between(double low, double high) const {
  low = std::max(low, lowest());
  high = std::min(high, highest());
  PAPILLA_CHECK(low < high, "empty band of a spectrum");
  PowerSpectrum result{{low}, {at(low)}};
  for (std::size_t i = 0; i < wave_number.size(); ++i) {
    if (wave_number[i] > low && wave_number[i] < high) {
      result.wave_number.push_back(wave_number[i]);
      result.density.push_back(density[i]);
    }
  }
  result.wave_number.push_back(high);
  result.density.push_back(at(high));
  return result;
}

PowerSpectrum self_affine_spectrum(double rms, double q_low, double q_roll_off, double q_cutoff,
                                   double hurst) {
  PAPILLA_CHECK(q_low > 0 && q_low <= q_roll_off && q_roll_off < q_cutoff, "wave numbers ascend");
  PowerSpectrum s;
  if (q_low < q_roll_off) {
    s.wave_number.push_back(q_low);
    s.density.push_back(1);
  }
  s.wave_number.insert(s.wave_number.end(), {q_roll_off, q_cutoff});
  s.density.insert(s.density.end(), {1, std::pow(q_cutoff / q_roll_off, -2 * (1 + hurst))});
  return s.scaled(square(rms / s.rms()));
}

PowerSpectrum wrist_spectrum() { return self_affine_spectrum(22e-6, 800, 5998.2, 1e8, 0.86); }

// ---- Elasticity
// ----------------------------------------------------------------------------------

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
  const double e = std::exp(-2 * x), rest = -std::expm1(-2 * x);
  // Factored so that a stiff layer at small q d loses no digits.
  const double above = 1 - m * n * e * e + 4 * m * x * e;
  const double below = (one_minus_m + m * rest) * (one_minus_n + n * rest) - 4 * m * x * x * e;
  return layer * below / above;
}

// ---- Mean field
// ----------------------------------------------------------------------------------

MeanField::MeanField(PowerSpectrum spectrum, MeanFieldSolid solid, MeanFieldOptions options)
    : spectrum_(std::move(spectrum)), solid_(solid), options_(options) {
  PAPILLA_CHECK(spectrum_.wave_number.size() >= 2, "a spectrum has at least two knots");
  PAPILLA_CHECK(spectrum_.wave_number.size() == spectrum_.density.size(), "one density a knot");
  PAPILLA_CHECK(options_.kappa > 0 && options_.intervals > 0, "mean-field options");

  const double step = std::log(spectrum_.highest() / spectrum_.lowest()) / options_.intervals;
  q_ = {spectrum_.lowest()};
  std::vector<double> exponent, scale, unit;  // C = scale (q/unit)^exponent in each interval
  for (std::size_t i = 0; i + 1 < spectrum_.wave_number.size(); ++i) {
    const double a = spectrum_.wave_number[i], b = spectrum_.wave_number[i + 1];
    PAPILLA_CHECK(a > 0 && b > a && spectrum_.density[i] > 0 && spectrum_.density[i + 1] > 0,
                  "knots ascend, densities are positive");
    const double length = std::log(b / a);
    const double e = std::log(spectrum_.density[i + 1] / spectrum_.density[i]) / length;
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int k = 1; k <= pieces; ++k) {
      q_.push_back(k == pieces ? b : a * std::exp(length * k / pieces));
      exponent.push_back(e);
      scale.push_back(spectrum_.density[i]);
      unit.push_back(a);
    }
  }
  const std::size_t n = q_.size() - 1;
  const double reduction = square(kPurePersson / options_.kappa);
  const Quadrature rule = gauss_legendre(4);
  measure_.assign(n + 1, 0);
  measure_mid_.resize(2 * n);
  weight_.resize(2 * n);
  const auto measure_between = [&](std::size_t i, double a, double b) {
    const double mid = 0.5 * std::log(a * b), half = 0.5 * std::log(b / a);
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double q = std::exp(mid + half * rule.nodes[k]);
      const double c = scale[i] * std::pow(q / unit[i], exponent[i]);
      sum += half * rule.weights[k] * square(q * q * effective_modulus(solid_, q)) * c;
    }
    return kPi * reduction * sum;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double mid = 0.5 * std::log(q_[i] * q_[i + 1]), half = 0.5 * std::log(q_[i + 1] / q_[i]);
    const double first = std::exp(mid - half / std::sqrt(3.0)),
                 second = std::exp(mid + half / std::sqrt(3.0));
    measure_mid_[2 * i] = measure_[i] + measure_between(i, q_[i], first);
    measure_mid_[2 * i + 1] = measure_mid_[2 * i] + measure_between(i, first, second);
    measure_[i + 1] = measure_mid_[2 * i + 1] + measure_between(i, second, q_[i + 1]);
    for (int k = 0; k < 2; ++k) {
      const double q = k == 0 ? first : second;
      weight_[2 * i + k] = std::sqrt(kPi) * cube(q) * scale[i] *
                           std::pow(q / unit[i], exponent[i]) * effective_modulus(solid_, q) * half;
    }
  }
  variance_.assign(n + 1, 0);
  for (std::size_t i = n; i-- > 0;) {
    variance_[i] = variance_[i + 1] +
                   2 * kPi * scale[i] * square(unit[i]) *
                       power_integral(1 + exponent[i], q_[i] / unit[i], q_[i + 1] / unit[i]);
  }
  const GapIntegrals& integrals = gap_integrals();
  gap_table_.resize(kTableSize);
  for (int i = 0; i < kTableSize; ++i) {
    gap_table_[i] = options_.energy_factor * integrals.plain[i] +
                    3 * (1 - options_.energy_factor) * integrals.squared[i];
  }
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
  double sum = 0;
  for (std::size_t k = weight_.size(); k-- > 2 * node;) {
    const double y = (measure_mid_[k] - start) * inverse;
    if (y <= 0.015625) break;  // M rises with q: nothing nearer contributes
    sum += weight_[k] * look_up(gap_table_, y);
  }
  return sum / pressure_here;
}

double MeanField::mean_gap(double pressure) const {
  PAPILLA_CHECK(pressure > 0, "the mean gap needs a pressure > 0");
  return gap_from(0, pressure);
}

GapDistribution MeanField::gaps(double pressure) const {
  PAPILLA_CHECK(pressure > 0, "the gap distribution needs a pressure > 0");
  const std::size_t n = q_.size() - 1;
  GapDistribution result;
  result.pressure = pressure;
  result.smallest_gap = options_.smallest_gap;
  result.contact = area(pressure);
  result.mean_gap = gap_from(0, pressure);
  // Open share 1 - A by erfc: no cancellation near full contact.
  double previous_open = 0, previous_volume = result.mean_gap;  // A u: what is still to come
  for (std::size_t i = 1; i <= n; ++i) {
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
  std::size_t count = 0;
  while (count < share.size() && wave_number[count] <= q * (1 + 1e-12)) ++count;
  return band_sum(*this, count, std::abs(h0), [&](double u) { return 1 / (square(u + re) + im2); });
}

double GapDistribution::inverse(double h0) const {
  return contact / h0 + band_sum(*this, share.size(), h0, [&](double u) { return 1 / (u + h0); });
}

// ---- Plasticity
// ----------------------------------------------------------------------------------

ContactShares plastic_shares(double pressure, double stress_measure, double yield) {
  ContactShares shares;
  const double p = pressure / yield;
  if (p >= 1) return {0, 1};
  const double th = kPi * kPi * stress_measure / (4 * square(yield));
  if (th < 1) {  // images in the absorbing walls at 0 and yield: converges at once for small spread
    const double root = std::sqrt(stress_measure) / yield;
    const auto hits = [&](double distance) {  // share that reached the wall at this distance first
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        sum += std::erfc((2 * k + distance) / root) - std::erfc((2 * k + 2 - distance) / root);
      }
      return sum;
    };
    shares.plastic = hits(1 - p);
    shares.elastic = std::max(0.0, 1 - hits(p) - shares.plastic);
    return shares;
  }
  shares.plastic = p;
  for (int n = 1; n <= 12; ++n) {
    const double decay = 2 / (n * kPi) * std::sin(n * kPi * p) * std::exp(-n * n * th);
    shares.plastic += n % 2 ? -decay : decay;
    if (n % 2) shares.elastic += 2 * decay;
  }
  return shares;
}

PowerSpectrum plastic_smoothing(const PowerSpectrum& spectrum, const MeanFieldSolid& solid,
                                double yield, double pressure, double kappa) {
  MeanFieldOptions options;
  options.kappa = kappa;
  const MeanField field(spectrum, solid, options);
  const double step = std::log(spectrum.highest() / spectrum.lowest()) / options.intervals;
  PowerSpectrum result;
  const auto keep = [&](double q) {
    const double m = field.stress_measure(q);
    const double yielded = m > 0 ? plastic_shares(pressure, m, yield).plastic : 0.0;
    const double factor = 1 - std::pow(yielded / (pressure / yield), 6);
    if (factor < 1e-9) return false;
    result.wave_number.push_back(q);
    result.density.push_back(factor * spectrum.at(q));
    return true;
  };
  bool open = keep(spectrum.lowest());
  for (std::size_t i = 0; open && i + 1 < spectrum.wave_number.size(); ++i) {
    const double a = spectrum.wave_number[i], b = spectrum.wave_number[i + 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::log(b / a) / step)));
    for (int k = 1; open && k <= pieces; ++k) {
      open = keep(k == pieces ? b : a * std::pow(b / a, double(k) / pieces));
    }
  }
  PAPILLA_CHECK(result.wave_number.size() >= 2, "the solid yields at every scale");
  return result;
}

// ---- Voltage
// -------------------------------------------------------------------------------------

PullState solve_pull(const MeanField& field, double external_pressure, double v_rms,
                     std::complex<double> h0, double finite_size_pressure) {
  PullState state;
  const double factor = 0.5 * kVacuumPermittivity * v_rms * v_rms;
  const auto pull_at = [&](double p) {
    return factor * field.gaps(std::max(p, finite_size_pressure)).inverse_square(h0);
  };
  const auto finish = [&](double p, double pull) {
    state.pressure = p;
    state.pull = pull;
    state.area = field.area(p);
    state.mean_gap =
        p > 0 || finite_size_pressure > 0 ? field.mean_gap(std::max(p, finite_size_pressure)) : 0.0;
    return state;
  };
  PAPILLA_CHECK(
      external_pressure > 0 || finite_size_pressure > 0,
      "without load the gaps of an infinite body are infinite: give a finite-size pressure");
  if (v_rms == 0) return finish(external_pressure, 0);

  // The pull rises with p, so every fixed-point iterate is below the first equilibrium: march up
  // from there, aiming a little past the secant's guess, until the excess p0 + pull(p) - p changes
  // sign.
  double previous = external_pressure, previous_pull = pull_at(previous);
  double low = external_pressure + previous_pull;
  if (low <= finite_size_pressure) return finish(low, previous_pull);  // the gaps stay as they are
  double pull = pull_at(low), excess_low = external_pressure + pull - low;
  double high = low, excess_high = 0;
  for (;;) {
    if (std::abs(excess_low) <= 1e-9 * low) return finish(low, pull);
    const double slope = (pull - previous_pull) / (low - previous);
    high = low + (slope < 0.9 ? 1.02 * excess_low / (1 - slope) : 0.5 * (low - external_pressure));
    if (high > 1e9) {
      state.status = PullStatus::Collapsed;
      return finish(low, pull);
    }
    const double next = pull_at(high);
    excess_high = external_pressure + next - high;
    if (excess_high <= 0) break;
    previous = low;
    previous_pull = pull;
    low = high;
    pull = next;
    excess_low = excess_high;
  }
  for (int i = 0; i < 60 && high - low > 1e-9 * high; ++i) {  // regula falsi, Illinois
    double p = low + (high - low) * excess_low / (excess_low - excess_high);
    p = std::clamp(p, low, high);
    pull = pull_at(p);
    const double excess = external_pressure + pull - p;
    if (std::abs(excess) < 1e-8 * p) {
      return finish(p, pull);
    }
    if (excess > 0) {
      low = p;
      excess_low = excess;
      excess_high *= 0.5;
    } else {
      high = p;
      excess_high = excess;
      excess_low *= 0.5;
    }
  }
  return finish(0.5 * (low + high), 0.5 * (low + high) - external_pressure);
}

FrictionPoint friction_at(const MeanField& field, double normal_force, double nominal_area,
                          double shear_strength, double v_rms, std::complex<double> h0,
                          double finite_size_pressure) {
  FrictionPoint point{};
  point.normal_force = normal_force;
  point.pull = solve_pull(field, normal_force / nominal_area, v_rms, h0, finite_size_pressure);
  point.friction = shear_strength * nominal_area * point.pull.area;
  point.coefficient = normal_force > 0 ? point.friction / normal_force : 0.0;
  return point;
}

// ---- Dielectrics in time and frequency
// -----------------------------------------------------------

double SkinDielectric::permittivity_at(double f) const {
  return log_log(frequency, permittivity, f);
}
double SkinDielectric::resistivity_at(double f) const {
  return log_log(resistivity_frequency, resistivity, f);
}

std::complex<double> SkinDielectric::complex_permittivity(double f) const {
  return {permittivity_at(f), 1 / (2 * kPi * f * kVacuumPermittivity * resistivity_at(f))};
}

std::complex<double> series_thickness(double dielectric_equivalent, double skin_thickness,
                                      const SkinDielectric& skin, double f,
                                      double gap_resistivity) {
  const std::complex<double> h0 =
      dielectric_equivalent + skin_thickness / skin.complex_permittivity(f);
  if (gap_resistivity == 0) return h0;
  return h0 * std::complex<double>(1, 1 / (2 * kPi * f * kVacuumPermittivity * gap_resistivity));
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

std::vector<StressPoint> stress_distribution(const GapDistribution& gaps, double v_rms, double h0,
                                             std::span<const double> at_gaps) {
  std::vector<StressPoint> points;
  points.reserve(at_gaps.size());
  const double pressure = 0.5 * kVacuumPermittivity * square(v_rms);
  for (const double u : at_gaps) {
    StressPoint point{};
    point.gap = u;
    point.stress = pressure / square(u + h0);
    point.density = 0.5 * cube(u + h0) / pressure * gaps.density(u);
    point.per_decade = std::log(10.0) * square(point.stress) * point.density;
    points.push_back(point);
  }
  return points;
}

}  // namespace papilla
