#include "estimate/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "config/describe.h"

namespace papilla::estimate {
namespace {

ResponseDifference difference(double first, double second, double first_error, double second_error,
                              const ErrorSamples& of_first, const ErrorSamples& of_second) {
  const auto paired = difference_error(of_second, of_first);
  return {second - first, paired ? *paired : std::hypot(first_error, second_error),
          paired.has_value(), std::nullopt};
}

std::optional<BeliefDifference> over_belief(const std::optional<BeliefValues>& first,
                                            const std::optional<BeliefValues>& second,
                                            const Response& a, const Response& b) {
  if (!first || !second || a.belief.file != b.belief.file) return std::nullopt;
  return belief_difference(*second, *first);
}

// Where one of two states does not exist, beyond breakdown or full contact, nothing is known of
// what lies between them.
ResponseDifference no_difference() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {kNone, kNone, false, std::nullopt};
}

[[noreturn]] void undefined(const Metric& metric, const Response& response) {
  const std::string why = why_undefined(metric, response);
  throw InputError(
      {Problem{"", 0, 0, "metric",
               metric_text(metric) + " has no value here" + (why.empty() ? "" : ": " + why)}});
}

// The nearest value towards `to` that makes a design: whole or half of the way, else none of it.
double reached(const Design& design, const std::string& path, double from, double to) {
  for (const double share : {1.0, 0.5}) {
    const double value = from + share * (to - from);
    Design moved = design;
    set_number(moved, path, value);
    if (design_problems(moved).empty()) return value;
  }
  return from;
}

}  // namespace

ResponseDifference difference_at(std::size_t point, const Metric& metric, const Response& first,
                                 const Response& second) {
  const auto a = metric_at(metric, first.points.at(point)),
             b = metric_at(metric, second.points.at(point));
  if (!a) undefined(metric, first);
  if (!b) undefined(metric, second);
  if (!is_known(metric, first.points[point]) || !is_known(metric, second.points[point]))
    return no_difference();
  ResponseDifference out =
      difference(a->value, b->value, a->se(), b->se(), error_samples_at(point, metric, first),
                 error_samples_at(point, metric, second));
  out.model = over_belief(belief_values_at(point, metric, first),
                          belief_values_at(point, metric, second), first, second);
  return out;
}

ResponseDifference difference_of(const MetricExpression& e, const Response& first,
                                 const Response& second) {
  const auto a = summarise(e.summary, e.metric, first), b = summarise(e.summary, e.metric, second);
  if (!a) undefined(e.metric, first);
  if (!b) undefined(e.metric, second);
  if (!is_known(e.metric, first) || !is_known(e.metric, second)) return no_difference();
  ResponseDifference out =
      difference(a->value, b->value, a->se, b->se, error_samples(e.summary, e.metric, first),
                 error_samples(e.summary, e.metric, second));
  out.model = over_belief(belief_values(e.summary, e.metric, first),
                          belief_values(e.summary, e.metric, second), first, second);
  return out;
}

DesignStep design_step(const Design& design, const std::string& path, double step) {
  Design copy = design;
  const NumberField field = find_number(copy, path);
  const double to_si = find_unit(field.unit)->to_si;
  const double low = field.low * to_si, high = field.high * to_si, value = *field.value;
  const double length = value != 0 ? step * std::abs(value) : step * (high - low);
  return {field.path, field.unit, value,
          reached(design, field.path, value, std::max(low, value - length)),
          reached(design, field.path, value, std::min(high, value + length))};
}

std::vector<std::string> texture_numbers(const Design& design) {
  Design copy = design;
  std::vector<std::string> out;
  for (const NumberField& field : number_fields(copy.texture, "texture")) out.push_back(field.path);
  out.push_back("surface.contact_angle");
  return out;
}

}  // namespace papilla::estimate
