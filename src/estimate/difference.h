// How two responses of the same skins differ, and what finite steps of a design's numbers do.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "metrics/metrics.h"

namespace papilla::estimate {

// The second less the first, with one standard error of the difference.
struct ResponseDifference {
  double value = 0, error = 0;
  bool paired = false;  // from common samples (Eq. accuracy.14); else both errors in squares
  // Over belief, where both responses have the same members: what it leaves of the difference, and
  // how probable it is that the second has more.
  std::optional<BeliefDifference> model{};
};
// At one humidity, and of a summary over all. NaN where one of the states does not exist
// (`is_known`). Throws InputError where the metric has no value.
ResponseDifference difference_at(std::size_t point, const Metric& metric, const Response& first,
                                 const Response& second);
ResponseDifference difference_of(const MetricExpression& expression, const Response& first,
                                 const Response& second);

// A number of a design moved both ways as far as the design allows.
struct DesignStep {
  std::string path, unit;              // the unit for people
  double value = 0, down = 0, up = 0;  // SI
  bool moves() const { return down < up; }
};
// step: relative to the value; of a 0 a share of the range. A design that another number forbids
// (a hole wider than its period) stays at its value. Throws InputError for a path that is none.
DesignStep design_step(const Design& design, const std::string& path, double step);

// The numbers of the texture and its contact angle.
std::vector<std::string> texture_numbers(const Design& design);

}  // namespace papilla::estimate
