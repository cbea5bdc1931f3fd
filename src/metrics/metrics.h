// Summaries of a metric over humidity, each with its errors.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "metrics/metric.h"

namespace papilla::metrics {

// How a quantity is summarised over humidity with the points' weights. Eq. metrics.1-5
enum class Summary { Mean, Variation, Range, Std, Worst, Best, First, Last };
bool is_spread(Summary summary);  // Variation, Range, Std: lower is better

struct SummaryValue {
  double value = 0;
  double se = 0;  // total of the parts
  ErrorParts parts =
      {};  // from the points' errors: in the mean they add linearly (the points share
           // their skins and grid); in the others they add in squares, a bound, as common
           // errors cancel there. humidity: of mean, variation and std (Eq. accuracy.4)
};
// Worst: the smallest for Better::Higher, the largest for Better::Lower. Variation is the weighted
// population standard deviation / mean; range is (max - min) / mean. Nothing when undefined
// (undriven, or a mean of zero).
std::optional<SummaryValue> summarise(Summary summary, const Metric& metric,
                                      const Response& response);

// Half the change of a number over each step of the finger's parameters, one sample per skin whose
// mean it is; nothing where the number is not defined at a step. Eq. accuracy.11
using StepSamples = std::vector<std::vector<double>>;  // [direction][skin]
std::optional<StepSamples> step_samples(
    const std::vector<ParameterStep>& steps,
    const std::function<std::optional<double>(const std::vector<ResponsePoint>&)>& value);
// The standard error that they leave, less what the skins scatter. Eq. accuracy.11
double step_error(const StepSamples& samples);

// The errors of a summary skin by skin, for its difference from that of another design on the same
// skins; empty where the runs behind them are not known. In the unit of the value.
struct ErrorSamples {
  std::vector<double> sampling;      // their mean is the value
  std::vector<double> grid, method;  // of the control skins: their mean is what would be added
};
ErrorSamples error_samples(Summary summary, const Metric& metric, const Response& response);
ErrorSamples error_samples_at(std::size_t point, const Metric& metric, const Response& response);
// The error of the first less the second, from samples of the same skins: sampling, grid and method
// part. Nothing where one of them lacks the samples of the other. Eq. accuracy.14
std::optional<double> difference_error(const ErrorSamples& first, const ErrorSamples& second);

// "mean(modulation)", "variation(modulation)", "worst(friction)"; a bare name means mean(name).
struct MetricExpression {
  Summary summary = Summary::Mean;
  Metric metric{};

  bool operator==(const MetricExpression&) const = default;
};
MetricExpression parse_metric(const std::string& text);  // throws InputError
// Reads back to the same expression.
std::string metric_text(const MetricExpression& expression);
// Which direction is better, of the metric or of its spread.
Better better_direction(const MetricExpression& expression);

}  // namespace papilla::metrics
