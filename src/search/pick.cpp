#include "search/pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace papilla::search {

PickRule read_pick_rule(const std::string& rule, const std::vector<std::string>& objectives,
                        bool driven) {
  using Kind = PickRule::Kind;
  if (rule == "worst" && !driven)
    throw InputError("--pick worst: without a drive there is no modulation; use \"knee\"");
  if (rule == "knee" || (rule.empty() && !driven)) return {Kind::Knee, 0};
  if (rule.empty() || rule == "worst") return {Kind::Worst, 0};
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(rule.data(), rule.data() + rule.size(), number);
  // 0 is no number of a design, and no index: pick_design refuses what is beyond the front.
  if (error == std::errc{} && end == rule.data() + rule.size()) return {Kind::Number, number - 1};
  std::string names;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    if (objectives[k].starts_with(rule)) return {Kind::Objective, k};
    names += ", \"" + objectives[k] + "\"";
  }
  throw InputError(
      fmt::format("--pick: \"{}\" is no rule; use \"worst\", \"knee\"{} or the number of a design",
                  rule, names));
}

std::vector<Extent> extents(const std::vector<PickCandidate>& front) {
  std::vector<Extent> out;
  for (std::size_t k = 0; k < front.front().objectives.size(); ++k) {
    Extent& e = out.emplace_back(Extent{front[0].objectives[k], front[0].objectives[k]});
    for (const PickCandidate& c : front) {
      e.low = std::min(e.low, c.objectives[k]);
      e.high = std::max(e.high, c.objectives[k]);
    }
  }
  return out;
}

double pick_worth(const PickRule& rule, const PickCandidate& design,
                  const std::vector<Extent>& extents) {
  switch (rule.kind) {
    case PickRule::Kind::Worst:
      return design.worst.value_or(0);
    case PickRule::Kind::Objective:
      return -design.objectives.at(rule.index);
    case PickRule::Kind::Knee:
    case PickRule::Kind::Number:
      break;
  }
  double sum = 0;
  for (std::size_t k = 0; k < extents.size(); ++k) {
    const auto [low, high] = extents[k];
    if (high > low) sum += (design.objectives.at(k) - low) / (high - low);
  }
  return -sum;
}

std::size_t pick_design(const std::string& text, const std::vector<PickCandidate>& front) {
  if (front.empty()) throw InputError("--pick: the front has no design");
  const PickRule rule = read_pick_rule(text, front[0].names, front[0].worst.has_value());
  if (rule.kind == PickRule::Kind::Number) {
    if (rule.index < front.size()) return rule.index;
    throw InputError(
        fmt::format("--pick {}: the front has the designs 1 to {}", text, front.size()));
  }
  const std::vector<Extent> of = extents(front);
  std::size_t best = 0;
  for (std::size_t i = 1; i < front.size(); ++i) {
    if (pick_worth(rule, front[i], of) > pick_worth(rule, front[best], of)) best = i;
  }
  return best;
}

std::string picked_design(const Folder& results, const std::string& rule) {
  if (rule.empty()) {
    if (!results.has("best/design.toml")) {
      throw InputError(results.path() +
                       " has no best/design.toml: not the folder of a finished `papilla optimize`");
    }
    return "best";
  }
  std::vector<PickCandidate> front;
  std::vector<std::string> folders;
  try {
    for (int i = 1;; ++i) {
      const std::string folder = fmt::format("front/{:02d}", i);
      if (!results.has(folder + "/metrics.json")) break;
      const auto metrics = nlohmann::ordered_json::parse(results.read(folder + "/metrics.json"));
      PickCandidate c;
      for (const auto& [name, value] : metrics.at("objectives").items()) {
        c.names.push_back(name);
        const double v = value.at("value").get<double>();
        c.objectives.push_back(value.at("maximise").get<bool>() ? -v : v);
      }
      if (const auto& worst = metrics.at("worst_modulation"); !worst.is_null())
        c.worst = worst.get<double>();
      front.push_back(std::move(c));
      folders.push_back(folder);
    }
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: metrics.json is damaged: {}", results.path(), e.what()));
  }
  if (front.empty()) {
    throw InputError(results.path() +
                     " has no front/: not the folder of a finished `papilla optimize`");
  }
  return folders[pick_design(rule, front)];
}

std::string picked_design_file(const std::string& results, const std::string& rule) {
  const Folder root(results);
  return root.file(picked_design(root, rule) + "/design.toml");
}

}  // namespace papilla::search
