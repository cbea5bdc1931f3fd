// Values of metrics as people read them.
#pragma once

#include <optional>
#include <string>

#include "base/rooms.h"
#include "metrics/metrics.h"

namespace papilla::metrics {

// Its value in SI times `scale` is in `unit`.
struct ShownUnit {
  double scale = 1;
  std::string unit;  // "" of a share that is read as a number
};
ShownUnit shown_unit(const MetricExpression& expression);

// The SI unit of its value; "" of a share.
std::string si_unit(const MetricExpression& expression);

// Of a number without a unit and of a per cent: a decimal beyond what instruments resolve, three
// where that is not known. Nothing of a quantity: it has so many digits.
std::optional<int> shown_decimals(const MetricExpression& expression);

// 0 where the value is less than a thousandth of what instruments resolve: what theory leaves there
// is the last bits of its sums.
double without_noise(const MetricExpression& expression, double si);

// With these decimals, `decimals` at least; of a quantity four digits. What reads as 0 has no sign.
std::string shown_value(const MetricExpression& expression, double si, bool with_sign = false,
                        int decimals = 0);
// "+0.0051", "-1.2": a small change.
std::string shown_change(const MetricExpression& expression, double si);
// As few digits as an error has.
std::string shown_error(const MetricExpression& expression, double si, int decimals = 0);
// "0.612 ± 0.014": decimals as far as the first digit of the error, where the usual ones end before
// it.
std::string shown_with_error(const MetricExpression& expression, double si, double error,
                             bool with_sign = false);

}  // namespace papilla::metrics
