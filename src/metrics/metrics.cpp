#include "metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/statistics.h"
#include "base/text.h"
#include "forward/forward.h"

namespace papilla {
namespace {

struct Entry {
  MetricInfo info;
  Measured ResponsePoint::*member;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> list{
      {{"modulation", "", "(F_on - F_off) / F_off", Better::Higher, true},
       &ResponsePoint::modulation},
      {{"friction", "N", "friction of the finger, drive off", Better::Lower, false},
       &ResponsePoint::friction_off},
      {{"friction_on", "N", "friction of the finger, drive on", Better::Higher, true},
       &ResponsePoint::friction_on},
      {{"capillary_force", "N", "capillary force on the finger, drive off; negative: it pushes off",
        Better::Lower, false},
       &ResponsePoint::capillary_force},
      {{"electrostatic_force", "N", "pull of the field on the finger", Better::Higher, true},
       &ResponsePoint::electrostatic_force},
      {{"retention_force", "N", "lateral force of contact-angle hysteresis", Better::Lower, false},
       &ResponsePoint::retention_force},
      {{"contact_area", "", "contact fraction of the load-carrying patches, drive off",
        Better::Neither, false},
       &ResponsePoint::area_fraction_off},
      {{"bridges", "", "capillary bridges a patch", Better::Neither, false},
       &ResponsePoint::bridges},
      {{"wetted_fraction", "", "bridged share of the patch", Better::Neither, false},
       &ResponsePoint::wetted_fraction},
      {{"mean_gap", "m", "mean gap of the patch", Better::Neither, false},
       &ResponsePoint::mean_gap},
  };
  return list;
}

struct AppearanceEntry {
  MetricInfo info;
  double Optics::*member;
};

const std::vector<AppearanceEntry>& appearance_entries() {
  static const std::vector<AppearanceEntry> list{
      {{"haze", "", "share of the transmitted light beyond 2.5 deg", Better::Lower, false, true},
       &Optics::haze},
      {{"transmittance", "", "undeviated share of the light on the plate", Better::Higher, false,
        true},
       &Optics::transmittance},
      {{"gloss", "", "specular reflection at 60 deg over that of flat glass", Better::Higher, false,
        true},
       &Optics::gloss},
      {{"colour_shift", "", "CIE 1976 u'v' distance of the undeviated light from the source",
        Better::Lower, false, true},
       &Optics::colour_shift},
  };
  return list;
}

bool is_spread(Summary summary) {
  return summary == Summary::Variation || summary == Summary::Range || summary == Summary::Std;
}

constexpr const char* kVoltageFor = "voltage_for";

constexpr std::array<std::pair<const char*, Summary>, 8> kSummaries{
    {{"mean", Summary::Mean},
     {"variation", Summary::Variation},
     {"range", Summary::Range},
     {"std", Summary::Std},
     {"worst", Summary::Worst},
     {"best", Summary::Best},
     {"first", Summary::First},
     {"last", Summary::Last}}};

// What holds the finger: repulsion by drops on surfaces that repel water is no merit.
Measured adhesion(const ResponsePoint& point) {
  Measured a = point.capillary_force;
  a.value = std::max(a.value, 0.0);
  return a;
}

// Indentation over pressure [m/Pa]: how far the finger sinks in.
Measured compliance(const ResponsePoint& point) {
  Measured c = point.indentation;
  c.value /= point.patch_pressure;
  c.parts.sampling /= point.patch_pressure;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (auto& part = c.parts.*origin.part) *part /= point.patch_pressure;
  }
  return c;
}

}  // namespace

const std::vector<MetricInfo>& metric_list() {
  static const std::vector<MetricInfo> list = [] {
    std::vector<MetricInfo> infos;
    for (const Entry& entry : entries()) infos.push_back(entry.info);
    infos.push_back({"adhesion", "N", "capillary force on the finger, drive off; never below 0",
                     Better::Lower, false});
    infos.push_back({"compliance", "m/Pa", "indentation since first touch over patch pressure",
                     Better::Neither, false});
    for (const AppearanceEntry& entry : appearance_entries()) infos.push_back(entry.info);
    infos.push_back(
        {kVoltageFor, "V",
         "voltage_for(modulation = 0.5): amplitude at which the modulation reaches that "
         "value; whatever the design's own amplitude",
         Better::Lower, false});
    return infos;
  }();
  return list;
}

std::optional<double> voltage_target(const std::string& metric) {
  std::string compact;
  for (char c : metric) {
    if (c != ' ') compact += c;
  }
  if (!compact.starts_with(kVoltageFor)) return std::nullopt;
  const std::string head = std::string(kVoltageFor) + "(modulation=";
  if (compact.starts_with(head) && compact.back() == ')') {
    const std::string text = compact.substr(head.size(), compact.size() - head.size() - 1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && value > 0 && value < 1e6)
      return value;
  }
  throw InputError("\"" + metric + "\": expected voltage_for(modulation = X), X above 0");
}

const MetricInfo* find_metric(const std::string& name) {
  const std::string base = name.substr(0, name.find('('));
  for (const MetricInfo& info : metric_list()) {
    if (info.name == base && (base == name) == (base != kVoltageFor)) return &info;
  }
  return nullptr;
}

std::optional<Measured> metric_at(const std::string& name, const ResponsePoint& point) {
  if (name == "adhesion") return adhesion(point);
  if (name == "compliance") return compliance(point);
  if (const auto target = voltage_target(name)) {
    for (const VoltageAnswer& answer : point.voltages) {
      if (answer.target == *target && answer.reached()) return answer.amplitude;
    }
    return std::nullopt;
  }
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return point.*entry.member;
  }
  return std::nullopt;
}

namespace {

// Values of one metric over humidity.
class Series {
 public:
  Series(std::vector<double> values, std::vector<double> weights, Better better)
      : values_(std::move(values)), weights_(std::move(weights)), better_(better) {
    double total = 0;
    for (double w : weights_) total += w;
    for (double& w : weights_) w /= total;
    for (std::size_t i = 0; i < values_.size(); ++i) mean_ += weights_[i] * values_[i];
    double variance = 0;
    for (std::size_t i = 0; i < values_.size(); ++i)
      variance += weights_[i] * square(values_[i] - mean_);
    sd_ = std::sqrt(variance);
    const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
    low_ = static_cast<std::size_t>(low - values_.begin());
    high_ = static_cast<std::size_t>(high - values_.begin());
  }

  bool defined(Summary summary) const {
    return mean_ != 0 || (summary != Summary::Variation && summary != Summary::Range);
  }

  double value(Summary summary) const {
    switch (summary) {
      case Summary::Mean:
        return mean_;
      case Summary::Std:
        return sd_;
      case Summary::Variation:
        return sd_ / std::abs(mean_);
      case Summary::Range:
        return (values_[high_] - values_[low_]) / std::abs(mean_);
      default:
        return values_[index(summary)];
    }
  }

  // Error of the summary from one origin's errors of the values.
  double error(Summary summary, const std::vector<double>& errors) const {
    double mean_error = 0, sd_error = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      mean_error += weights_[i] * errors[i];
      // d(sd)/d(value_i) = w_i (value_i - mean) / sd
      if (sd_ > 0) sd_error += square(weights_[i] * (values_[i] - mean_) / sd_ * errors[i]);
    }
    sd_error = std::sqrt(sd_error);
    switch (summary) {
      case Summary::Mean:
        return mean_error;
      case Summary::Std:
        return sd_error;
      case Summary::Variation:
        return std::hypot(sd_error, sd_ / mean_ * mean_error) / std::abs(mean_);
      case Summary::Range:
        return std::hypot(errors[high_], errors[low_]) / std::abs(mean_);
      default:
        return errors[index(summary)];
    }
  }

 private:
  std::size_t index(Summary summary) const {
    const bool low_is_better = better_ == Better::Lower;
    if (summary == Summary::First) return 0;
    if (summary == Summary::Last) return values_.size() - 1;
    return (summary == Summary::Worst) == low_is_better ? high_ : low_;
  }

  std::vector<double> values_, weights_;
  Better better_;
  double mean_ = 0, sd_ = 0;
  std::size_t low_ = 0, high_ = 0;
};

// A summary of a metric of any points of a response.
Reading reading(Summary summary, const std::string& metric) {
  const Better better = find_metric(metric)->better;
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

// The quantity that carries the errors of a metric; nothing for a voltage, which has its own.
std::optional<Measured ResponsePoint::*> quantity_of(const std::string& metric) {
  if (metric == "adhesion") return &ResponsePoint::capillary_force;
  if (metric == "compliance") return &ResponsePoint::indentation;
  for (const Entry& entry : entries()) {
    if (entry.info.name == metric) return entry.member;
  }
  return std::nullopt;
}

// The samples behind a number of a metric.
ErrorSamples samples_of(const std::string& metric, const Reading& number,
                        const Response& response) {
  ErrorSamples out;
  const auto quantity = quantity_of(metric);
  const auto value = quantity ? number(response.points) : std::nullopt;
  if (!value) return out;
  std::vector<double> without;
  for (const auto& points : response.without) {
    if (const auto v = number(points)) without.push_back(*v);
  }
  if (without.size() == response.without.size()) out.sampling = jackknife_samples(*value, without);
  const ControlledChange change = controlled_change(response.controls, *quantity, number);
  for (const double c : change.grid) out.grid.push_back(c * std::abs(*value));
  for (const double c : change.method) out.method.push_back(c * std::abs(*value));
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
    std::vector<double> rest;  // the half difference without each skin
    for (std::size_t k = 0; k < step.up.without.size(); ++k) {
      const auto one = half(step.up.without[k], step.down.without.at(k));
      if (!one) return std::nullopt;
      rest.push_back(*one);
    }
    out.push_back(jackknife_samples(*all, rest));
  }
  return out;
}

double step_error(const StepSamples& samples) {
  double sum = 0;
  for (const std::vector<double>& direction : samples) {
    const Estimate e = mean_estimate(direction);
    sum += square(e.value) - square(e.se);
  }
  return std::sqrt(std::max(0.0, sum));
}

std::optional<SummaryValue> summarise(Summary summary, const std::string& metric,
                                      const Response& response) {
  const MetricInfo* info = find_metric(metric);
  if (info && info->appearance) {
    if (!response.appearance || response.appearance->refused()) return std::nullopt;
    // One look at all humidities: no spread.
    if (is_spread(summary)) return SummaryValue{};
    for (const AppearanceEntry& entry : appearance_entries()) {
      if (entry.info.name == metric)
        return SummaryValue{(*response.appearance).*entry.member, 0, {}};
    }
  }
  if (!info || response.points.empty() || (info->needs_drive && !response.driven))
    return std::nullopt;
  double total = 0;
  std::vector<double> values, sampling, weights;
  std::array<std::vector<double>, kErrorOrigins.size()> errors;
  for (const ResponsePoint& point : response.points) {
    const auto m = metric_at(metric, point);
    if (!m || !std::isfinite(m->value)) return std::nullopt;
    values.push_back(m->value);
    weights.push_back(point.weight);
    sampling.push_back(m->parts.sampling);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (const auto& part = m->parts.*kErrorOrigins[k].part) errors[k].push_back(*part);
    }
    total += point.weight;
  }
  if (total <= 0) return std::nullopt;
  const Series series(values, weights, info->better);
  if (!series.defined(summary)) return std::nullopt;
  SummaryValue out{series.value(summary), 0, {.sampling = series.error(summary, sampling)}};
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (errors[k].size() == values.size())
      out.parts.*kErrorOrigins[k].part = series.error(summary, errors[k]);
  }
  out.parts.humidity = humidity_error(summary, response, values, weights, info->better);
  // Where the runs behind a part are at hand, the summary itself is followed through them, so that
  // what humidities share cancels where it does. Eq. accuracy.13
  const ErrorSamples samples = error_samples(summary, metric, response);
  if (samples.sampling.size() > 1) out.parts.sampling = mean_estimate(samples.sampling).se;
  if (is_spread(summary)) {
    if (!samples.grid.empty()) out.parts.grid = grid_error(samples.grid);
    if (!samples.method.empty()) out.parts.method = method_error(samples.method);
  }
  if (!response.parameters.steps.empty()) {
    if (const auto steps = step_samples(response.parameters.steps, reading(summary, metric)))
      out.parts.parameters = step_error(*steps);
  }
  out.se = out.parts.total();
  return out;
}

ErrorSamples error_samples(Summary summary, const std::string& metric, const Response& response) {
  return samples_of(metric, reading(summary, metric), response);
}

ErrorSamples error_samples_at(std::size_t point, const std::string& metric,
                              const Response& response) {
  const auto number = [&](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    const auto m = metric_at(metric, points[point]);
    return m ? std::optional(m->value) : std::nullopt;
  };
  return samples_of(metric, number, response);
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
  return std::sqrt(square(sampling) + square(grid) + square(method));
}

MetricExpression parse_metric(const std::string& text) {
  MetricExpression expression;
  std::string name = text;
  const std::size_t open = text.find('(');
  if (open != std::string::npos && !voltage_target(text)) {
    const std::string word = text.substr(0, open);
    if (text.back() != ')') throw InputError("\"" + text + "\": missing )");
    name = text.substr(open + 1, text.size() - open - 2);
    std::vector<std::string> known;
    bool found = false;
    for (const auto& [label, summary] : kSummaries) {
      known.push_back(label);
      if (word == label) {
        expression.summary = summary;
        found = true;
      }
    }
    if (!found) {
      throw InputError(fmt::format("\"{}\" is no summary over humidity; use one of {}", word,
                                   join_names(known)));
    }
  }
  if (!find_metric(name)) {
    std::vector<std::string> known;
    for (const MetricInfo& info : metric_list()) known.push_back(info.name);
    const std::string near = nearest_name(name, known);
    throw InputError(fmt::format("\"{}\" is no metric{}; see `papilla describe metrics`", name,
                                 near.empty() ? "" : ", did you mean \"" + near + "\"?"));
  }
  if (const auto target = voltage_target(name))
    name = fmt::format("{}(modulation = {})", kVoltageFor, *target);
  expression.metric = name;
  return expression;
}

std::string metric_text(const MetricExpression& expression) {
  for (const auto& [label, summary] : kSummaries) {
    if (summary == expression.summary) return std::string(label) + "(" + expression.metric + ")";
  }
  return expression.metric;
}

Better better_direction(const MetricExpression& expression) {
  if (is_spread(expression.summary)) return Better::Lower;
  return find_metric(expression.metric)->better;
}

std::string why_undefined(const std::string& metric, const Response& response) {
  const auto target = voltage_target(metric);
  if (!target)
    return find_metric(metric)->needs_drive && !response.driven ? "not driven (0 V)" : "";
  for (const ResponsePoint& point : response.points) {
    for (const VoltageAnswer& answer : point.voltages) {
      if (answer.target != *target || answer.reached()) continue;
      return fmt::format("{:.0f} % RH: {} (modulation {:.3g})", 100 * point.relative_humidity,
                         text(answer), answer.modulation);
    }
  }
  return "";
}

}  // namespace papilla
