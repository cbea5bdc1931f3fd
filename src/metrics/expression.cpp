#include <fmt/format.h>

#include <array>

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

constexpr const char* kPen = "pen.";

// The metric of a name, which may be one of the pen.
std::optional<Metric> named(const std::string& name, bool& pen) {
  pen = name.starts_with(kPen);
  return find_metric(pen ? name.substr(std::string(kPen).size()) : name);
}

}  // namespace

bool is_spread(Summary summary) {
  return summary == Summary::Variation || summary == Summary::Range || summary == Summary::Std;
}

MetricExpression parse_metric(const std::string& text) {
  MetricExpression expression;
  std::string name = text;
  std::optional<Metric> metric = named(name, expression.pen);
  const std::size_t open = text.find('(');
  if (!metric && open != std::string::npos) {
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
    metric = named(name, expression.pen);
  }
  if (!metric) {
    std::vector<std::string> known;
    for (const MetricInfo& info : metric_list()) known.push_back(info.name);
    const std::string near = nearest_name(name, known);
    throw InputError(fmt::format("\"{}\" is no metric{}; see `papilla describe metrics`", name,
                                 near.empty() ? "" : ", did you mean \"" + near + "\"?"));
  }
  expression.metric = *metric;
  return expression;
}

MetricExpression parse_own_metric(const std::string& text) {
  const MetricExpression expression = parse_metric(text);
  if (expression.pen)
    throw InputError("\"" + text +
                     "\": one counterface is judged here; counterface.type = \"pen\" makes it the "
                     "pen");
  return expression;
}

std::string metric_text(const MetricExpression& expression) {
  const std::string name = (expression.pen ? kPen : "") + metric_text(expression.metric);
  for (const auto& [label, summary] : kSummaries) {
    if (summary == expression.summary) return std::string(label) + "(" + name + ")";
  }
  return name;
}

Better better_direction(const MetricExpression& expression) {
  if (is_spread(expression.summary)) return Better::Lower;
  return info_of(expression.metric).better;
}

double resolution(const MetricExpression& expression) {
  return is_spread(expression.summary) ? 0 : info_of(expression.metric).resolution;
}

}  // namespace papilla::metrics
