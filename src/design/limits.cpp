#include "design/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"

namespace papilla::design {
namespace {

constexpr int kDigits = 4;  // of a value for people

double bounded(double violation) {
  constexpr double kLarge = 10;
  if (violation > kLarge) return kLarge + 1 - kLarge / violation;
  return std::max(violation, -1.0);
}

const ConstraintKind* kind_of(const Constraint& limit) {
  const auto& kinds = constraint_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const ConstraintKind& k) { return k.name == limit.name; });
  return found == kinds.end() ? nullptr : &*found;
}

}  // namespace

double violation(const Constraint& limit, double value) {
  if (limit.limit <= 0) return limit.at_least ? -1 : bounded(value);
  const double beyond = !limit.at_least ? value / limit.limit - 1
                        : value > 0     ? limit.limit / value - 1
                                        : kInfinity;
  return std::abs(beyond) <= kLimitTolerance ? 0 : bounded(beyond);
}

bool keeps(const Constraint& limit, double value) { return violation(limit, value) <= 0; }

LimitOn limit_on(const Constraint& limit) {
  const ConstraintKind* kind = kind_of(limit);
  return kind ? kind->on : LimitOn::Metric;
}

std::string limit_value_text(const Constraint& limit, double value) {
  if (!std::isfinite(value)) return "none";
  double shown = value;
  std::string unit;
  if (const ConstraintKind* kind = kind_of(limit)) {
    shown /= find_unit(kind->unit)->to_si;
    unit = kind->unit;
  } else {
    const ShownUnit metric = shown_unit(parse_metric(limit.name));
    shown *= metric.scale;
    unit = metric.unit;
  }
  return significant(shown, kDigits) + (unit.empty() ? "" : " " + unit);
}

std::string limit_text(const Constraint& limit) {
  return fmt::format("at {} {}", limit.at_least ? "least" : "most",
                     limit_value_text(limit, limit.limit));
}

}  // namespace papilla::design
