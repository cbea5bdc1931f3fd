#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/constants.h"
#include "forward/errors.h"
#include "forward/field_ratio.h"
#include "metrics/metrics.h"
#include "metrics/series.h"
#include "numerics/statistics.h"

namespace papilla::metrics {
namespace {

// A summary of a metric of any points of a response.
Reading reading(Summary summary, const Metric& metric) {
  const Better better = info_of(metric).better;
  return [=](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    std::vector<double> values, weights;
    for (const ResponsePoint& point : points) {
      const auto m = metric_at(metric, point);
      if (!m || !std::isfinite(m->value)) return std::nullopt;
      values.push_back(m->value);
      weights.push_back(point.weight);
    }
    const Series series(values, weights, better);
    if (!series.defined(summary)) return std::nullopt;
    return series.value(summary);
  };
}

// Eq. accuracy.4: every second inner humidity replaced by the line between its neighbours, from the
// first and from the second on; the larger change of the summary, over 3.
std::optional<double> humidity_error(Summary summary, const Response& response,
                                     const std::vector<double>& values,
                                     const std::vector<double>& weights, Better better) {
  const bool smooth =
      summary == Summary::Mean || summary == Summary::Std || summary == Summary::Variation;
  if (!smooth || values.size() < 3) return std::nullopt;
  const auto humidity = [&](std::size_t i) { return response.points[i].relative_humidity; };
  const double full = Series(values, weights, better).value(summary);
  double change = 0;
  for (std::size_t first : {1, 2}) {
    std::vector<double> coarse = values;
    for (std::size_t i = first; i + 1 < values.size(); i += 2) {
      const double span = humidity(i + 1) - humidity(i - 1);
      if (span <= 0) return std::nullopt;  // no order in humidity: nothing to interpolate
      const double t = (humidity(i) - humidity(i - 1)) / span;
      coarse[i] = (1 - t) * values[i - 1] + t * values[i + 1];
    }
    const Series series(coarse, weights, better);
    if (!series.defined(summary)) return std::nullopt;
    change = std::max(change, std::abs(series.value(summary) - full));
  }
  return change / 3;
}

// The 3-D field is off the same way at all humidities, by its pixels and on its few skins; by this
// share they differ. Eq. accuracy.13
constexpr double kFieldApart = 0.3;

// What a summary is off by where each value is by its own field part.
double field_error(const Series& series, Summary summary, const std::vector<double>& field) {
  const double apart = series.error(summary, field);
  return is_spread(summary) ? std::hypot(series.shift(summary, field), kFieldApart * apart) : apart;
}

// Which way a stronger pull moves a metric: it lowers the voltage that a modulation takes, and how
// far pull-in is.
double sign_by_pull(const Metric& metric) {
  const bool falls =
      std::holds_alternative<VoltageFor>(metric) || std::holds_alternative<PullInMargin>(metric);
  return falls ? -1 : 1;
}

// Of a summary over some points of a response.
FieldPart field_part(Summary summary, const Metric& metric, std::span<const ResponsePoint> points) {
  std::vector<double> values, weights, common, own;
  FieldPart out;
  const double sign = sign_by_pull(metric);
  double squares = 0;
  for (const ResponsePoint& point : points) {
    const auto m = metric_at(metric, point);
    if (!m || !std::isfinite(m->value)) return {};
    // A voltage has the field of its own amplitude, not of the design's.
    const VoltageAnswer* voltage = voltage_answer(metric, point);
    const double error = (voltage ? voltage->field_error : point.field_error).value_or(0),
                 field = m->parts.field.value_or(0);
    const double correction = voltage ? voltage->field_correction : point.field_correction;
    const double share =
        error > 0 ? std::min(1.0, forward::full_field_error(correction) / error) : 1;
    values.push_back(m->value);
    weights.push_back(point.weight);
    common.push_back(sign * share * field);
    own.push_back(std::sqrt(1 - square(share)) * field);
    if (field == 0) continue;  // nothing pulls there, or no field is part of it
    out.corrections.push_back(std::log(correction));
    squares += (1 - square(share)) * square(error);
  }
  const Series series(values, weights, info_of(metric).better);
  if (out.corrections.empty() || !series.defined(summary)) return {};
  out.common = series.shift(summary, common);
  out.own = sign * field_error(series, summary, own);
  out.of_skins = std::sqrt(squares / static_cast<double>(out.corrections.size()));
  return out;
}

// The points with each skin left out in turn, of a voltage: it is sought on skins of its own, and
// says itself what it is without each (Eq. metrics.6). Without a skin that one of the points lacks
// that has no value.
std::vector<std::vector<ResponsePoint>> voltages_without(const VoltageFor& metric,
                                                         const Response& response) {
  std::vector<std::vector<ResponsePoint>> out;
  for (std::size_t i = 0; i < response.points.size(); ++i) {
    const ResponsePoint& point = response.points[i];
    const VoltageAnswer* answer = voltage_answer(metric, point);
    const std::size_t skins = answer ? answer->without.size() : 0;
    if (out.size() < skins) out.resize(skins, std::vector<ResponsePoint>(response.points.size()));
    for (std::size_t k = 0; k < skins; ++k) {
      ResponsePoint& there = out[k][i];
      there.relative_humidity = point.relative_humidity;
      there.weight = point.weight;
      there.voltages = {*answer};
      there.voltages.front().amplitude.value = answer->without[k];
    }
  }
  return out;
}

// Of a number without each skin; empty where one of them has none.
std::vector<double> sampling_of(double value, const Reading& number,
                                const std::vector<std::vector<ResponsePoint>>& without_each) {
  std::vector<double> without;
  for (const auto& points : without_each) {
    const auto v = number(points);
    if (!v) return {};
    without.push_back(*v);
  }
  return jackknife_samples(value, without);
}

// The samples behind a number of a metric.
ErrorSamples samples_of(const Metric& metric, const Reading& number, Change kind,
                        const Response& response) {
  ErrorSamples out;
  const auto quantity = metric_quantity(metric);
  const auto* voltage = std::get_if<VoltageFor>(&metric);
  const auto value = quantity || voltage ? number(response.points) : std::nullopt;
  if (!value) return out;
  std::vector<std::vector<ResponsePoint>> voltages;
  if (voltage) voltages = voltages_without(*voltage, response);
  out.sampling = sampling_of(*value, number, voltage ? voltages : response.without);
  if (!quantity) return out;  // no control run has its voltage sought
  const ControlRuns& controls = response.controls;
  const ControlledChange change =
      controlled_change(controls, grid_law(*quantity, controls.friction_by_load), number, kind);
  const double of = kind == Change::Relative ? std::abs(*value) : 1;
  for (const double c : change.grid) out.grid.push_back(c * of);
  for (const double c : change.method) out.method.push_back(c * of);
  return out;
}

}  // namespace

std::optional<StepSamples> step_samples(
    const std::vector<ParameterStep>& steps,
    const std::function<std::optional<double>(const std::vector<ResponsePoint>&)>& value) {
  StepSamples out;
  for (const ParameterStep& step : steps) {
    const auto half = [&](const std::vector<ResponsePoint>& up,
                          const std::vector<ResponsePoint>& down) {
      const auto high = value(up), low = value(down);
      return high && low ? std::optional((*high - *low) / 2) : std::nullopt;
    };
    const auto all = half(step.up.points, step.down.points);
    if (!all) return std::nullopt;
    std::vector<double> without;  // the half difference without each skin
    for (std::size_t k = 0; k < step.up.without.size(); ++k) {
      const auto one = half(step.up.without[k], step.down.without.at(k));
      if (!one) return std::nullopt;
      without.push_back(*one);
    }
    out.push_back(jackknife_samples(*all, without));
  }
  return out;
}

namespace {

// Squares of the moves, and of what the skins scatter them by.
struct Squares {
  double moved = 0, scatter = 0;
};
Squares squares_of(const StepSamples& samples) {
  Squares out;
  for (const std::vector<double>& direction : samples) {
    const Estimate e = mean_estimate(direction);
    out.moved += square(e.value);
    out.scatter += square(e.se);
  }
  return out;
}

double part_of(const Squares& s, const StepSamples& samples) {
  // Of what skins move the members of a belief by: chosen on drawn designs, held on others
  // (results/accuracy/model_part.csv).
  constexpr double kFreedom = 5;
  if (!(s.moved > 0) || !(s.scatter > 0)) return 1;
  const double freedom = std::min(kFreedom, static_cast<double>(samples.size()));
  return std::sqrt(meant_share(s.moved / s.scatter, freedom, samples.front().size()).value);
}

}  // namespace

double step_error(const StepSamples& samples) {
  const Squares s = squares_of(samples);
  return std::sqrt(s.moved) * part_of(s, samples);
}

double meant_part(const StepSamples& samples) { return part_of(squares_of(samples), samples); }

StepSamples moves_from_mean(const std::vector<double>& weights, StepSamples samples) {
  const std::size_t skins = samples.empty() ? 0 : samples.front().size();
  double total = 0;
  std::vector<double> mean(skins, 0);
  for (std::size_t m = 0; m < samples.size(); ++m) {
    if (samples[m].size() != skins) return {};
    total += weights[m];
    for (std::size_t k = 0; k < skins; ++k) mean[k] += weights[m] * samples[m][k];
  }
  for (std::size_t m = 0; m < samples.size(); ++m) {
    for (std::size_t k = 0; k < skins; ++k)
      samples[m][k] = std::sqrt(weights[m]) * (samples[m][k] - mean[k] / total);
  }
  return samples;
}

std::optional<SummaryValue> summarise(Summary summary, const Metric& metric,
                                      const Response& response) {
  const MetricInfo& info = info_of(metric);
  if (const auto* look = std::get_if<LookMetric>(&metric)) {
    if (!response.appearance || response.appearance->refused()) return std::nullopt;
    // One look at all humidities: no spread.
    if (is_spread(summary)) return SummaryValue{};
    return SummaryValue{(*response.appearance).*look->number, 0, {}};
  }
  if (response.points.empty() || (info.needs_drive && !response.driven)) return std::nullopt;
  double total = 0;
  std::vector<double> values, sampling, weights, field;
  std::array<std::vector<double>, kErrorOrigins.size()> errors;
  for (const ResponsePoint& point : response.points) {
    const auto m = metric_at(metric, point);
    if (!m || !std::isfinite(m->value)) return std::nullopt;
    values.push_back(m->value);
    weights.push_back(point.weight);
    sampling.push_back(m->parts.sampling);
    field.push_back(m->parts.field.value_or(0));
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (const auto& part = m->parts.*kErrorOrigins[k].part) errors[k].push_back(*part);
    }
    total += point.weight;
  }
  if (total <= 0) return std::nullopt;
  const Series series(values, weights, info.better);
  if (!series.defined(summary)) return std::nullopt;
  SummaryValue out{series.value(summary), 0, {.sampling = series.error(summary, sampling)}};
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (errors[k].size() == values.size())
      out.parts.*kErrorOrigins[k].part = series.error(summary, errors[k]);
  }
  out.parts.humidity = humidity_error(summary, response, values, weights, info.better);
  // Where the runs behind a part are at hand, the summary itself is followed through them, so that
  // what humidities share cancels where it does. Eq. accuracy.13
  const ErrorSamples samples = error_samples(summary, metric, response);
  if (samples.sampling.size() > 1) out.parts.sampling = mean_estimate(samples.sampling).se;
  if (is_spread(summary)) {
    if (!samples.grid.empty()) out.parts.grid = grid_error(samples.grid);
    if (!samples.method.empty()) out.parts.method = method_error(samples.method);
    if (out.parts.field) out.parts.field = field_error(series, summary, field);
  }
  if (!response.parameters.steps.empty()) {
    if (const auto steps = step_samples(response.parameters.steps, reading(summary, metric)))
      out.parts.parameters = step_error(*steps);
  }
  if (const auto over = belief_values(summary, metric, response))
    out.parts.model = over->deviation();
  out.se = out.parts.total();
  return out;
}

std::optional<double> summary_of_points(Summary summary, const Metric& metric,
                                        const std::vector<ResponsePoint>& points) {
  return reading(summary, metric)(points);
}

ErrorSamples error_samples(Summary summary, const Metric& metric, const Response& response) {
  ErrorSamples out = samples_of(metric, reading(summary, metric),
                                is_spread(summary) ? Change::Absolute : Change::Relative, response);
  out.field = field_part(summary, metric, response.points);
  return out;
}

ErrorSamples error_samples_at(std::size_t point, const Metric& metric, const Response& response) {
  const auto number = [&](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    const auto m = metric_at(metric, points[point]);
    return m ? std::optional(m->value) : std::nullopt;
  };
  ErrorSamples out = samples_of(metric, number, Change::Relative, response);
  out.field = field_part(Summary::Mean, metric, {&response.points[point], 1});
  return out;
}

double FieldPart::error() const { return std::hypot(common, own); }

double field_correlation(const FieldPart& first, const FieldPart& second) {
  const std::size_t n = first.corrections.size();
  const double of_skins = square(first.of_skins) + square(second.of_skins);
  if (n == 0 || n != second.corrections.size() || !(of_skins > 0)) return 0;
  double apart = 0;
  for (std::size_t i = 0; i < n; ++i) apart += square(first.corrections[i] - second.corrections[i]);
  return std::max(0.0, 1 - apart / static_cast<double>(n) / of_skins);
}

double field_difference_error(const FieldPart& first, const FieldPart& second) {
  const double apart = 1 - field_correlation(first, second);
  return std::sqrt(square(first.common - second.common) +
                   apart * (square(first.own) + square(second.own)));
}

std::optional<double> difference_error(const ErrorSamples& first, const ErrorSamples& second) {
  bool same = first.sampling.size() > 1;
  const auto minus = [&](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out = a;
    same = same && a.size() == b.size();
    for (std::size_t k = 0; k < a.size() && same; ++k) out[k] -= b[k];
    return out;
  };
  const double sampling = mean_estimate(minus(first.sampling, second.sampling)).se,
               grid = grid_error(minus(first.grid, second.grid)),
               method = method_error(minus(first.method, second.method));
  if (!same) return std::nullopt;
  return std::sqrt(square(sampling) + square(grid) + square(method) +
                   square(field_difference_error(first.field, second.field)));
}

}  // namespace papilla::metrics
