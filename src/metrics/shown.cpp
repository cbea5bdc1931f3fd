#include "metrics/shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace papilla::metrics {
namespace {

bool is_relative(const MetricExpression& e) {
  return e.summary == Summary::Variation || e.summary == Summary::Range;
}

}  // namespace

std::string si_unit(const MetricExpression& e) {
  // As a share of its mean over humidity it has none.
  return is_relative(e) ? "" : info_of(e.metric).unit;
}

ShownUnit shown_unit(const MetricExpression& e) {
  const std::string unit = si_unit(e);
  if (!is_relative(e) && info_of(e.metric).in_per_cent) return {100, "%"};
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e9, "nm"};
  if (unit == "m/Pa") return {1e12, "um/MPa"};
  return {1, unit};
}

std::optional<int> shown_decimals(const MetricExpression& e) {
  const ShownUnit shown = shown_unit(e);
  if (!shown.unit.empty() && shown.unit != "%") return std::nullopt;
  const double resolved = resolution(e) * shown.scale;
  return resolved > 0 ? std::max(0, 1 - static_cast<int>(std::round(std::log10(resolved)))) : 3;
}

double without_noise(const MetricExpression& e, double si) {
  constexpr double kNoise = 1e-3;
  return std::abs(si) < kNoise * resolution(e) ? 0 : si;
}

std::string shown_value(const MetricExpression& e, double si, bool with_sign, int decimals) {
  const double v = si * shown_unit(e).scale + 0.0;  // a zero has no sign
  const std::optional<int> usual = shown_decimals(e);
  const std::string text = usual ? fixed(v, std::max(decimals, *usual)) : fmt::format("{:.4g}", v);
  const bool nothing = text.find_first_of("123456789") == std::string::npos && std::isfinite(v);
  return fmt::format("{}{}", with_sign && !nothing && !text.starts_with('-') ? "+" : "", text);
}

std::string shown_change(const MetricExpression& e, double si) {
  return fmt::format("{:+.2g}", si * shown_unit(e).scale + 0.0);  // + 0.0: a zero has no sign
}

std::string shown_error(const MetricExpression& e, double si, int decimals) {
  if (shown_decimals(e)) return shown_value(e, si, false, decimals);
  return fmt::format("{:.2g}", si * shown_unit(e).scale);
}

std::string shown_with_error(const MetricExpression& e, double si, double error, bool with_sign) {
  // That of a look that nothing scatters is its last bits.
  constexpr double kBits = 1e-9;
  const double shown = error * shown_unit(e).scale;
  const bool scatters = shown > kBits && std::isfinite(shown);
  const int decimals = scatters ? static_cast<int>(std::ceil(-std::log10(shown) - 1e-9)) : 0;
  return shown_value(e, si, with_sign, decimals) + " ± " + shown_error(e, error, decimals);
}

}  // namespace papilla::metrics
