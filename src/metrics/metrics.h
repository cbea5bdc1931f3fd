// Numbers that judge a design: functions of a Response over humidity. `papilla describe metrics` is
// this list.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"

namespace papilla::metrics {

enum class Better { Higher, Lower, Neither };

struct MetricInfo {
  std::string name, unit, doc;
  Better better = Better::Neither;
  bool needs_drive = false;
  bool appearance = false;  // how the texture looks: from Response::appearance, at no humidity
};

// A quantity at each humidity: modulation, friction, friction_on, adhesion, ...
const std::vector<MetricInfo>& metric_list();
const MetricInfo* find_metric(const std::string& name);

// What the source applies, by the key that sets it.
inline constexpr const char* kAmplitude = "drive.amplitude";

// The one metric with a target of its own: the amplitude at which the modulation reaches a value.
inline constexpr const char* kVoltageFor = "voltage_for";
// The modulation of "voltage_for(modulation = 0.5)"; nothing for another metric. Throws InputError
// where the target is no number above 0.
std::optional<double> voltage_target(const std::string& metric);

// The share of people who would notice: the probability that the modulation of a humidity is above
// a Weber fraction, its errors in it.
inline constexpr const char* kFelt = "felt";
// The least relative difference of friction that people notice: Fehlberg 2022.
inline constexpr double kNoticed = 0.2;
// The fraction of "felt(modulation = 0.2)"; else as above.
std::optional<double> felt_threshold(const std::string& metric);

// Value at one point; nothing when undefined there (a voltage that was not asked for or that does
// not reach its modulation).
std::optional<Measured> metric_at(const std::string& name, const ResponsePoint& point);

// The quantity that carries the errors of a metric; nothing for a voltage, which has its own.
std::optional<Measured PointQuantities::*> metric_quantity(const std::string& metric);

// Value of a metric of the look, in a regime that has one.
double appearance_value(const std::string& metric, const Optics& look);

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
std::optional<SummaryValue> summarise(Summary summary, const std::string& metric,
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
ErrorSamples error_samples(Summary summary, const std::string& metric, const Response& response);
ErrorSamples error_samples_at(std::size_t point, const std::string& metric,
                              const Response& response);
// The error of the first less the second, from samples of the same skins: sampling, grid and method
// part. Nothing where one of them lacks the samples of the other. Eq. accuracy.14
std::optional<double> difference_error(const ErrorSamples& first, const ErrorSamples& second);

// "mean(modulation)", "variation(modulation)", "worst(friction)"; a bare name means mean(name).
struct MetricExpression {
  Summary summary = Summary::Mean;
  std::string metric;
};
MetricExpression parse_metric(const std::string& text);  // throws InputError
std::string metric_text(const MetricExpression& expression);
// Which direction is better, of the metric or of its spread.
Better better_direction(const MetricExpression& expression);

// Why a metric of a response has no value, for people; "" when nothing is known.
std::string why_undefined(const std::string& metric, const Response& response);

}  // namespace papilla::metrics
