#include "rank/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/text.h"

namespace papilla::rank {
namespace {

// "METRIC", "METRIC:low" or "METRIC:high".
Criterion parse_criterion(std::string word) {
  Criterion c;
  std::string direction;
  if (const std::size_t colon = word.rfind(':'); colon != std::string::npos) {
    direction = word.substr(colon + 1);
    word.resize(colon);
  }
  c.expression = parse_own_metric(word);
  if (info_of(c.expression.metric).takes_modulation)
    throw InputError(fmt::format("\"{}\": a ranking is by forces at the designs' own drive", word));
  const Better better = better_direction(c.expression);
  if (direction.empty() && better == Better::Neither) {
    throw InputError(
        fmt::format("{0} has no better direction of its own; say {0}:low or {0}:high", word));
  }
  if (!direction.empty() && direction != "low" && direction != "high")
    throw InputError(fmt::format("\"{}\" is no direction; use low or high", direction));
  c.high = direction.empty() ? better == Better::Higher : direction == "high";
  return c;
}

}  // namespace

const MetricInfo& Criterion::info() const { return info_of(expression.metric); }

std::string Criterion::text() const { return metric_text(expression) + (high ? ":high" : ":low"); }

bool RankOptions::felt() const {
  return std::any_of(criteria.begin(), criteria.end(),
                     [](const Criterion& c) { return !c.info().appearance; });
}

std::vector<Criterion> parse_criteria(const std::string& text) {
  std::vector<Criterion> out;
  for (const std::string& word : split(text, ',')) {
    if (word.empty()) throw InputError("\"" + text + "\": expected METRIC:low or METRIC:high");
    Criterion c = parse_criterion(word);
    const std::string metric = metric_text(c.expression);
    for (const Criterion& other : out) {
      if (metric_text(other.expression) == metric)
        throw InputError(fmt::format("\"{}\": {} is named twice", text, metric));
    }
    out.push_back(std::move(c));
  }
  return out;
}

}  // namespace papilla::rank
