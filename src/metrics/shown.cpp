#include "metrics/shown.h"

#include <fmt/format.h>

#include "base/text.h"

namespace papilla::metrics {

ShownUnit shown_unit(const MetricExpression& e) {
  const std::string& unit = info_of(e.metric).unit;
  // As a share of its mean over humidity it has no unit.
  if (e.summary == Summary::Variation || e.summary == Summary::Range || unit.empty())
    return {1, ""};
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e9, "nm"};
  if (unit == "m/Pa") return {1e12, "um/MPa"};
  return {1, unit};
}

std::string shown_value(const MetricExpression& e, double si, bool with_sign) {
  const ShownUnit shown = shown_unit(e);
  const double v = si * shown.scale;
  // + 0.0: a zero has no sign.
  const std::string text = shown.unit.empty() ? fixed(v, 3) : fmt::format("{:.4g}", v + 0.0);
  return fmt::format("{}{}", with_sign && !text.starts_with('-') ? "+" : "", text);
}

std::string shown_change(const MetricExpression& e, double si) {
  return fmt::format("{:+.2g}", si * shown_unit(e).scale + 0.0);  // + 0.0: a zero has no sign
}

std::string shown_error(const MetricExpression& e, double si) {
  const ShownUnit shown = shown_unit(e);
  return shown.unit.empty() ? fmt::format("{:.3f}", si) : fmt::format("{:.2g}", si * shown.scale);
}

}  // namespace papilla::metrics
