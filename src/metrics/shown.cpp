#include "metrics/shown.h"

#include <fmt/format.h>

#include "base/text.h"

namespace papilla::metrics {
namespace {

// What people read: three decimals of a number without a unit, two of a per cent, else four digits.
std::string in_shown_unit(const ShownUnit& shown, double si) {
  const double v = si * shown.scale + 0.0;  // a zero has no sign
  if (shown.unit.empty()) return fixed(v, 3);
  return shown.unit == "%" ? fixed(v, 2) : fmt::format("{:.4g}", v);
}

}  // namespace

ShownUnit shown_unit(const MetricExpression& e) {
  const std::string& unit = info_of(e.metric).unit;
  const bool relative = e.summary == Summary::Variation || e.summary == Summary::Range;
  if (!relative && info_of(e.metric).share_of_light) return {100, "%"};
  // As a share of its mean over humidity it has no unit.
  if (relative || unit.empty()) return {1, ""};
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e9, "nm"};
  if (unit == "m/Pa") return {1e12, "um/MPa"};
  return {1, unit};
}

std::string shown_value(const MetricExpression& e, double si, bool with_sign) {
  const std::string text = in_shown_unit(shown_unit(e), si);
  return fmt::format("{}{}", with_sign && !text.starts_with('-') ? "+" : "", text);
}

std::string shown_change(const MetricExpression& e, double si) {
  return fmt::format("{:+.2g}", si * shown_unit(e).scale + 0.0);  // + 0.0: a zero has no sign
}

std::string shown_error(const MetricExpression& e, double si) {
  const ShownUnit shown = shown_unit(e);
  if (shown.unit.empty() || shown.unit == "%") return in_shown_unit(shown, si);
  return fmt::format("{:.2g}", si * shown.scale);
}

}  // namespace papilla::metrics
