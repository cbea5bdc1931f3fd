#include <fmt/format.h>

#include <array>
#include <charconv>

#include "base/error.h"
#include "base/text.h"
#include "metrics/metrics.h"

namespace papilla::metrics {
namespace {

constexpr std::array<std::pair<const char*, Summary>, 8> kSummaries{
    {{"mean", Summary::Mean},
     {"variation", Summary::Variation},
     {"range", Summary::Range},
     {"std", Summary::Std},
     {"worst", Summary::Worst},
     {"best", Summary::Best},
     {"first", Summary::First},
     {"last", Summary::Last}}};

}  // namespace

bool is_spread(Summary summary) {
  return summary == Summary::Variation || summary == Summary::Range || summary == Summary::Std;
}

namespace {

// X of "NAME(modulation = X)"; nothing where another name stands.
std::optional<double> modulation_of(const std::string& metric, const char* name) {
  std::string compact;
  for (char c : metric) {
    if (c != ' ') compact += c;
  }
  if (compact != name && !compact.starts_with(std::string(name) + '(')) return std::nullopt;
  const std::string head = std::string(name) + "(modulation=";
  if (compact.starts_with(head) && compact.back() == ')') {
    const std::string text = compact.substr(head.size(), compact.size() - head.size() - 1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && value > 0 && value < 1e6)
      return value;
  }
  throw InputError(fmt::format("\"{}\": expected {}(modulation = X), X above 0", metric, name));
}

// A metric of a modulation of its own, written one way; nothing for the others.
std::optional<std::string> with_modulation(const std::string& metric) {
  for (const char* name : {kVoltageFor, kFelt}) {
    if (const auto value = modulation_of(metric, name))
      return fmt::format("{}(modulation = {})", name, *value);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> voltage_target(const std::string& metric) {
  return modulation_of(metric, kVoltageFor);
}

std::optional<double> felt_threshold(const std::string& metric) {
  return modulation_of(metric, kFelt);
}

MetricExpression parse_metric(const std::string& text) {
  MetricExpression expression;
  std::string name = text;
  const std::size_t open = text.find('(');
  if (open != std::string::npos && !with_modulation(text)) {
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
  expression.metric = with_modulation(name).value_or(name);
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

}  // namespace papilla::metrics
