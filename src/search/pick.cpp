#include "search/pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "search/records.h"

namespace papilla::search {

PickRule read_pick_rule(const std::string& rule, const std::vector<std::string>& objectives,
                        bool has_worst) {
  using Kind = PickRule::Kind;
  if (rule == "worst" && !has_worst)
    throw InputError(
        "--pick worst: without a drive, or with amplitudes that voltage_for finds, there is no "
        "modulation to go by; use \"knee\"");
  if (rule == "knee" || (rule.empty() && !has_worst)) return {Kind::Knee, 0};
  if (rule.empty() || rule == "worst") return {Kind::Worst, 0};
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(rule.data(), rule.data() + rule.size(), number);
  // 0 is no number of a design, and no index: pick_design refuses what is beyond the front.
  if (error == std::errc{} && end == rule.data() + rule.size()) return {Kind::Number, number - 1};
  std::string names;
  std::vector<std::size_t> begun;  // objectives whose names begin so
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    if (objectives[k].starts_with(rule)) begun.push_back(k);
    names += ", \"" + objectives[k] + "\"";
  }
  if (begun.size() == 1) return {Kind::Objective, begun.front()};
  if (begun.size() > 1)
    throw InputError(
        fmt::format("--pick: \"{}\" begins the names of {} objectives; use one of \"worst\", "
                    "\"knee\"{} or the number of a design",
                    rule, begun.size(), names));
  throw InputError(
      fmt::format("--pick: \"{}\" is no rule; use \"worst\", \"knee\"{} or the number of a design",
                  rule, names));
}

PickRule decided_rule(const std::string& rule, const std::vector<std::string>& objectives,
                      bool has_worst) {
  const PickRule asked = read_pick_rule(rule, objectives, has_worst);
  const bool own = rule.empty() || asked.kind == PickRule::Kind::Number;
  if (own && objectives.size() == 1) return {PickRule::Kind::Objective, 0};
  return own ? read_pick_rule("", objectives, has_worst) : asked;
}

// Eq. search.14
std::vector<ObjectiveRange> objective_ranges(const std::vector<PickCandidate>& front) {
  std::vector<ObjectiveRange> out;
  for (std::size_t k = 0; k < front.front().objectives.size(); ++k) {
    double low = front[0].objectives[k], high = low, squares = 0;
    for (const PickCandidate& c : front) {
      low = std::min(low, c.objectives[k]);
      high = std::max(high, c.objectives[k]);
      if (k < c.errors.size() && std::isfinite(c.errors[k])) squares += square(c.errors[k]);
    }
    const double error = std::sqrt(squares / static_cast<double>(front.size()));
    out.push_back({low, std::hypot(high - low, error)});
  }
  return out;
}

double pick_worth(const PickRule& rule, const PickCandidate& design,
                  const std::vector<ObjectiveRange>& ranges) {
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
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (ranges[k].width > 0) sum += (design.objectives.at(k) - ranges[k].low) / ranges[k].width;
  }
  return -sum;
}

std::size_t pick_design(const std::string& text, const std::vector<PickCandidate>& front,
                        std::vector<ObjectiveRange> ranges) {
  if (front.empty()) throw InputError("--pick: the front has no design");
  const PickRule rule = read_pick_rule(text, front[0].names, front[0].worst.has_value());
  if (rule.kind == PickRule::Kind::Number) {
    if (rule.index < front.size()) return rule.index;
    throw InputError(
        fmt::format("--pick {}: the front has the designs 1 to {}", text, front.size()));
  }
  if (ranges.empty()) ranges = objective_ranges(front);
  std::size_t best = 0;
  for (std::size_t i = 1; i < front.size(); ++i) {
    if (pick_worth(rule, front[i], ranges) > pick_worth(rule, front[best], ranges)) best = i;
  }
  return best;
}

namespace {

// The choice of a run that decided over belief by this rule; empty: it did not.
std::string decided_design(const nlohmann::json& run, const std::string& rule,
                           const PickCandidate& like) {
  const std::string best = run.value("/decision/best"_json_pointer, std::string());
  if (best.empty()) return {};
  const bool has_worst = like.worst.has_value();
  const bool same = read_pick_rule(rule, like.names, has_worst) ==
                    decided_rule(run.value("pick", std::string()), like.names, has_worst);
  return same ? best : "";
}

// Of the knee of a run that decided over belief; empty: it did not, or did not say them.
std::vector<ObjectiveRange> decided_ranges(const nlohmann::json& run,
                                           const std::vector<std::string>& objectives) {
  std::vector<ObjectiveRange> out;
  const auto ranges = run.value("/decision/ranges"_json_pointer, nlohmann::json::object());
  for (const std::string& name : objectives) {
    if (!ranges.contains(name)) return {};
    out.push_back({0, ranges.at(name).get<double>()});
  }
  return out;
}

// run: its run.json, where it has one.
[[noreturn]] void refuse_without_front(const Folder& results, const nlohmann::json& run) {
  const auto is_false = [&](const char* key) { return run.contains(key) && run[key] == false; };
  if (is_false("interrupted") && is_false("feasible"))
    throw InputError(
        results.path() +
        ": no design of this run keeps every limit, so there is no front to pick from" +
        (results.has("best/design.toml") ? "; without --pick it is best/, which comes nearest"
                                         : ""));
  throw InputError(results.path() +
                   " has no front/: not the folder of a finished `papilla optimize`" +
                   unfinished_hint(results));
}

}  // namespace

std::string picked_design(const Folder& results, const std::string& rule) {
  if (rule.empty()) {
    if (!results.has("best/design.toml")) {
      throw InputError(results.path() +
                       " has no best/design.toml: not the folder of a finished `papilla optimize`" +
                       unfinished_hint(results));
    }
    return "best";
  }
  std::vector<PickCandidate> front;
  std::vector<std::string> folders;
  std::vector<ObjectiveRange> ranges;
  const char* reading = "metrics.json";
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
        const auto error = value.find("se");
        c.errors.push_back(error != value.end() && error->is_number() ? error->get<double>() : 0);
      }
      if (const auto& worst = metrics.at("worst_modulation"); !worst.is_null())
        c.worst = worst.get<double>();
      front.push_back(std::move(c));
      folders.push_back(folder);
    }
    reading = "run.json";
    if (results.has("run.json")) {
      const auto run = nlohmann::json::parse(results.read("run.json"));
      if (front.empty()) refuse_without_front(results, run);
      const std::string decided = decided_design(run, rule, front[0]);
      if (std::find(folders.begin(), folders.end(), decided) != folders.end()) return decided;
      ranges = decided_ranges(run, front[0].names);
    }
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: {} is damaged: {}", results.path(), reading, e.what()));
  }
  if (front.empty()) refuse_without_front(results, {});
  return folders[pick_design(rule, front, ranges)];
}

std::string picked_design_file(const std::string& results, const std::string& rule) {
  const Folder root(results);
  return root.file(picked_design(root, rule) + "/design.toml");
}

}  // namespace papilla::search
