#include "search/risk.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"

namespace papilla::search {
namespace {

double parse_number(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError("objective.risk: \"" + whole +
                     "\": expected \"mean\", \"mean - 2 std\", \"cvar 20 %\" or \"worst\"");
  }
  return value;
}

}  // namespace

Risk parse_risk(const std::string& text) {
  std::string compact;
  for (char c : text) {
    if (c != ' ') compact += c;
  }
  if (compact.empty() || compact == "mean") return {};
  if (compact == "worst") return {Risk::Kind::Worst, 0};
  if (compact.starts_with("mean-") && compact.ends_with("std")) {
    const std::string factor = compact.substr(5, compact.size() - 8);
    const double k = factor.empty() ? 1 : parse_number(factor, text);
    if (k < 0) throw InputError("objective.risk: \"" + text + "\": a factor below 0 seeks risk");
    return {Risk::Kind::MeanStd, k};
  }
  for (const std::string name : {"cvar", "worst"}) {
    if (!compact.starts_with(name) || !compact.ends_with("%")) continue;
    const std::string number = compact.substr(name.size(), compact.size() - name.size() - 1);
    const double share = 0.01 * parse_number(number, text);
    if (share > 0 && share <= 1) return {Risk::Kind::Cvar, share};
  }
  parse_number("", text);
  return {};
}

double apply_risk(const Risk& risk, bool higher_is_better, const std::vector<double>& values,
                  const std::vector<double>& weights) {
  PAPILLA_CHECK(!values.empty() && values.size() == weights.size(), "one weight per value");
  const double sign = higher_is_better ? 1 : -1;  // from here on, low is bad
  // In the sign that it was given in: a haze of 0 is 0, not -0.
  const auto as_given = [&](double v) { return higher_is_better ? v : 0 - v; };
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double mean = 0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += sign * values[i] * weights[i] / total;
  switch (risk.kind) {
    case Risk::Kind::Mean:
      return as_given(mean);
    case Risk::Kind::MeanStd: {
      double variance = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double d = sign * values[i] - mean;
        variance += d * d * weights[i] / total;
      }
      // Eq. search.4
      return as_given(mean - risk.parameter * std::sqrt(variance));
    }
    case Risk::Kind::Worst: {
      double worst = kInfinity;  // Eq. search.6
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (weights[i] > 0) worst = std::min(worst, sign * values[i]);
      }
      return as_given(worst);
    }
    case Risk::Kind::Cvar: {
      // Eq. search.5: mean over the worst share.
      std::vector<std::size_t> order(values.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return sign * values[a] < sign * values[b];
      });
      double left = risk.parameter, sum = 0;
      for (std::size_t i : order) {
        const double share = std::min(left, weights[i] / total);
        sum += share * sign * values[i];
        left -= share;
      }
      return as_given(sum / (risk.parameter - left));
    }
  }
  return as_given(mean);
}

ScatterQuadratic::ScatterQuadratic(double at_nominal, const std::vector<double>& lower,
                                   const std::vector<double>& upper)
    : nominal(at_nominal) {
  PAPILLA_CHECK(lower.size() == upper.size(), "both ends of each scatter");
  for (std::size_t k = 0; k < lower.size(); ++k) {
    a.push_back(0.5 * (upper[k] - lower[k]));
    b.push_back(0.5 * (upper[k] + lower[k]) - nominal);
  }
}

double ScatterQuadratic::at(const std::vector<double>& u) const {
  double out = nominal;
  for (std::size_t k = 0; k < a.size(); ++k) out += a[k] * u[k] + b[k] * u[k] * u[k];
  return out;
}

std::vector<double> scattered_values(const Risk& risk, bool higher_is_better, double nominal,
                                     const std::vector<double>& lower,
                                     const std::vector<double>& upper, const ScatterLaw& law) {
  PAPILLA_CHECK(lower.size() == law.size(), "both ends of each scatter");
  if (lower.empty()) return {nominal};
  const ScatterQuadratic q(nominal, lower, upper);
  double mean = nominal, variance = 0, worst = nominal;
  for (std::size_t k = 0; k < lower.size(); ++k) {
    const double a = q.a[k], b = q.b[k];
    mean += b / 3;
    variance += square(a) / 3 + law.variance_of_square(k) * square(b);
    double least = 0;
    for (double u : {-1.0, 1.0, b != 0 ? std::clamp(-0.5 * a / b, -1.0, 1.0) : 0.0}) {
      const double change = a * u + b * u * u;
      least = higher_is_better ? std::min(least, change) : std::max(least, change);
    }
    worst += least;
  }
  switch (risk.kind) {
    case Risk::Kind::Mean:
      return {mean};
    case Risk::Kind::Worst:
      return {worst};
    case Risk::Kind::MeanStd:
      if (!law.correlated()) return {mean - std::sqrt(variance), mean + std::sqrt(variance)};
      break;
    case Risk::Kind::Cvar:
      break;
  }
  constexpr std::uint64_t kSample = 128;
  std::vector<double> out;
  for (std::uint64_t i = 0; i < kSample; ++i) out.push_back(q.at(law.plate(1, i)));
  return out;
}

}  // namespace papilla::search
