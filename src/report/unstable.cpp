#include "report/unstable.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/text.h"
#include "report/limits.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"

namespace papilla::report {
namespace {

// Why a design lost its place in one of the checks.
std::string why_lost(const ResultFiles& f, const StabilityVariant& v, std::size_t place) {
  if (v.values[place].empty()) return no_value_text(v, place);
  if (place < v.broken.size() && !v.broken[place].empty())
    return limit_broken(v.broken[place].front());
  if (place < v.beaten_by.size() && v.beaten_by[place])
    return design_name(f.result.finalists[v.beaten_by[place].value()].folder) + " is better";
  return "another is better";
}

// "A, B, C and 8 more": the table of checks has them all.
std::string first_of(std::vector<std::string> checks) {
  constexpr std::size_t kNamed = 3;
  if (checks.size() <= kNamed + 1) return join_names(checks);
  const std::size_t more = checks.size() - kNamed;
  checks.resize(kNamed);
  return join_names(checks, ", ") + fmt::format(" and {} more", more);
}

}  // namespace

std::string no_value_text(const StabilityVariant& v, std::size_t place) {
  const bool known = place < v.unanswered.size() && !v.unanswered[place].empty();
  return "it has no value" + (known ? " (" + v.unanswered[place] + ")" : std::string());
}

std::string unstable_text(const ResultFiles& f, std::size_t place) {
  const Stability& s = f.result.stability;
  if (!s.judged(place) || s.stable(place)) return {};
  std::vector<std::pair<std::string, std::vector<std::string>>> checks_by_reason;
  for (const StabilityVariant& v : s.variants) {
    if (v.on_front[place]) continue;
    const std::string reason = why_lost(f, v, place);
    const auto known = std::find_if(checks_by_reason.begin(), checks_by_reason.end(),
                                    [&](const auto& r) { return r.first == reason; });
    if (known == checks_by_reason.end())
      checks_by_reason.push_back({reason, {v.name}});
    else
      known->second.push_back(v.name);
  }
  std::vector<std::string> lost;
  for (const auto& [reason, checks] : checks_by_reason)
    lost.push_back(first_of(checks) + ": " + reason);
  const auto most = std::max_element(s.times_on_front.begin(), s.times_on_front.end());
  const auto times = [](const char* words, int count) {
    return stated(
        count_number(words, static_cast<std::size_t>(count), {Stage::Confirm, Stage::Stability}),
        fmt::format("{}", count));
  };
  std::string out = fmt::format(" Its place holds in {} of {} checks only ({}).",
                                times("checks in which its place holds", s.times_on_front[place]),
                                times("checks of the order", static_cast<int>(s.variants.size())),
                                join_names(lost, "; "));
  if (*most > s.times_on_front[place]) {
    const FinalDesign& steady =
        f.result.finalists[static_cast<std::size_t>(most - s.times_on_front.begin())];
    out += fmt::format(
        " The alternative that holds in {} of {} is {} ({}).",
        times("checks in which the alternative's place holds", *most),
        times("checks of the order", static_cast<int>(s.variants.size())),
        design_name(steady.folder),
        facts(steady.design.texture).relief.present ? shape_text(steady.design) : "flat");
  } else {
    out += " No design of the front holds more often.";
  }
  return out;
}

}  // namespace papilla::report
