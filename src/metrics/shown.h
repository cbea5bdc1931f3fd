// Values of metrics as people read them.
#pragma once

#include <string>

#include "base/rooms.h"
#include "metrics/metrics.h"

namespace papilla::metrics {

// Its value in SI times `scale` is in `unit`.
struct ShownUnit {
  double scale = 1;
  std::string unit;  // "" of a share
};
ShownUnit shown_unit(const MetricExpression& expression);

// Three decimals of a share, four digits of a quantity; never "-0.000".
std::string shown_value(const MetricExpression& expression, double si, bool with_sign = false);
// "+0.0051", "-1.2": a small change.
std::string shown_change(const MetricExpression& expression, double si);
// As few digits as an error has.
std::string shown_error(const MetricExpression& expression, double si);

}  // namespace papilla::metrics
