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

// The number alone, of any points.
std::optional<double> summary_of_points(Summary summary, const Metric& metric,
                                        const std::vector<ResponsePoint>& points);

// Half the change of a number over each step of the finger's parameters, one sample per skin whose
// mean it is; nothing where the number is not defined at a step. Eq. accuracy.11
using StepSamples = std::vector<std::vector<double>>;  // [direction][skin]
std::optional<StepSamples> step_samples(
    const std::vector<ParameterStep>& steps,
    const std::function<std::optional<double>(const std::vector<ResponsePoint>&)>& value);
// The standard error that they leave: what of the moves is meant and not the scatter of the skins;
// 0 where nothing moves alone. Eq. accuracy.18
double step_error(const StepSamples& samples);
// What part of each move that is, 0 to 1; 1 where nothing moves.
double meant_part(const StepSamples& samples);
// Of values of members, a sample per skin: how far each lies from their weighted mean, times the
// root of its weight; the weights are shares of their sum. Empty where members have not the same
// skins.
StepSamples moves_from_mean(const std::vector<double>& weights, StepSamples samples);

// A number as a member of belief has it: `own` and `there` are of the scene as it is and of the
// member, both on few skins. A number that keeps its sign is moved in proportion, by no more than
// twice their difference: a quotient by next to nothing says nothing. Eq. accuracy.15
double moved(double value, double own, double there, bool keeps_sign);
// A number over the members of a belief, each moved so from the response's.
struct BeliefValues {
  std::vector<double> weights, values;  // one per member
  // Root of the weight times value less weighted mean, a sample per skin: the standard deviation
  // over members is step_error of them, that of a difference of two designs step_error of theirs
  // subtracted.
  StepSamples moves;

  double deviation() const { return step_error(moves); }
  // The values, as far from their mean as is meant: 0.025 and 0.975 are the ends of a 95 %
  // interval.
  double quantile(double p) const;
};
// Whether a number that a member moves cannot change its sign: a size, or a spread.
bool keeps_sign(Summary summary, const Metric& metric);
using Number = std::function<std::optional<double>(const std::vector<ResponsePoint>&)>;
// A number of a run, and without each of its skins.
struct RunReading {
  double all = 0;
  std::vector<double> without;

  bool operator==(const RunReading&) const = default;
};
// A number at each member of a belief and of the scene as it is, all on the same few skins.
struct MemberReadings {
  std::vector<double> weights;  // one per member
  std::vector<RunReading> members;
  RunReading own;

  bool operator==(const MemberReadings&) const = default;
};
// Nothing where a run has no number.
std::optional<MemberReadings> member_readings(const BeliefRuns& runs, const Number& number);
// Moved so from `value`.
BeliefValues belief_values(const MemberReadings& readings, double value, bool keeps_sign);
// value: of the response; nothing: of the runs themselves. Nothing where a member has no number.
std::optional<BeliefValues> belief_values(const BeliefRuns& runs, const Number& number,
                                          std::optional<double> value, bool keeps_sign);
std::optional<BeliefValues> belief_values(Summary summary, const Metric& metric,
                                          const Response& response);
std::optional<BeliefValues> belief_values_at(std::size_t point, const Metric& metric,
                                             const Response& response);
// The first less the second, member by member, and how probable it is above 0 by belief alone.
// Nothing where the members are not the same.
struct BeliefDifference {
  double deviation = 0;      // standard deviation over the members
  double low = 0, high = 0;  // 95 %
  double above = 0.5;        // probability
};
std::optional<BeliefDifference> belief_difference(const BeliefValues& first,
                                                  const BeliefValues& second);
// What is not known of finger and model of a number: over the members of a belief, or over the
// steps of the finger's parameters. Both are empty where the number is not defined somewhere.
struct ModelReadings {
  StepSamples steps;
  MemberReadings belief;

  // Of the number where it is `value`.
  StepSamples moves(double value, bool keeps_sign) const;
  bool operator==(const ModelReadings&) const = default;
};
ModelReadings model_readings(const Response& response, const Number& number);

// What the correction to the 3-D field leaves open of a value, in its unit: what a stronger pull
// moves it by, below 0 where it falls. Zeros where there is none.
struct FieldPart {
  double common = 0;                  // where the 3-D field itself is off, as it is for all designs
  double own = 0;                     // where this design's corrections are, which few skins say
  std::vector<double> corrections{};  // their logarithms, of each humidity (and task) with a pull
  double of_skins = 0;                // what those are off by, root mean square

  // Standard deviation, of this design alone.
  double error() const;
};
// How far the corrections of two designs on the same skins are off alike, 0 to 1: they differ by
// what the fields differ by and by what skins scatter, so fields that are alike have corrections
// that are. Eq. accuracy.14
double field_correlation(const FieldPart& first, const FieldPart& second);
// Of the first less the second. Eq. accuracy.14
double field_difference_error(const FieldPart& first, const FieldPart& second);

// The errors of a summary skin by skin, for its difference from that of another design on the same
// skins; empty where the runs behind them are not known. In the unit of the value.
struct ErrorSamples {
  std::vector<double> sampling;      // their mean is the value
  std::vector<double> grid, method;  // of the control skins: their mean is what would be added
  FieldPart field{};
};
ErrorSamples error_samples(Summary summary, const Metric& metric, const Response& response);
ErrorSamples error_samples_at(std::size_t point, const Metric& metric, const Response& response);
// The error of the first less the second, from samples of the same skins: sampling, grid, method
// and field part. Nothing where one of them lacks the samples of the other. Eq. accuracy.14
std::optional<double> difference_error(const ErrorSamples& first, const ErrorSamples& second);

// "mean(modulation)", "variation(modulation)", "worst(friction)"; a bare name means mean(name). Of
// the second counterface of a study: "mean(pen.friction)".
struct MetricExpression {
  Summary summary = Summary::Mean;
  Metric metric{};
  bool pen = false;

  bool operator==(const MetricExpression&) const = default;
};
MetricExpression parse_metric(const std::string& text);  // throws InputError
// The same where one counterface is judged: a pen is refused.
MetricExpression parse_own_metric(const std::string& text);
// Reads back to the same expression.
std::string metric_text(const MetricExpression& expression);
// Which direction is better, of the metric or of its spread.
Better better_direction(const MetricExpression& expression);
// Values closer than this are one to instruments, in the metric's unit; 0: not known, or a spread.
double resolution(const MetricExpression& expression);

}  // namespace papilla::metrics
