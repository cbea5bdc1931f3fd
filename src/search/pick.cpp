#include "search/pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace papilla::search {
namespace {

// Index of the largest value; the first among equals.
template <class F>
std::size_t largest(std::size_t count, const F& value) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (value(i) > value(best)) best = i;
  }
  return best;
}

// Least sum of the objectives, each scaled to the front's extent.
std::size_t knee(const std::vector<PickCandidate>& front) {
  std::vector<double> sum(front.size(), 0);
  for (std::size_t k = 0; k < front[0].objectives.size(); ++k) {
    double low = front[0].objectives[k], high = low;
    for (const PickCandidate& c : front) {
      low = std::min(low, c.objectives[k]);
      high = std::max(high, c.objectives[k]);
    }
    for (std::size_t i = 0; i < front.size() && high > low; ++i)
      sum[i] += (front[i].objectives[k] - low) / (high - low);
  }
  return largest(front.size(), [&](std::size_t i) { return -sum[i]; });
}

}  // namespace

std::size_t pick_design(const std::string& rule, const std::vector<PickCandidate>& front) {
  if (front.empty()) throw InputError("--pick: the front has no design");
  const bool driven = front[0].worst.has_value();
  if (rule == "worst" && !driven)
    throw InputError("--pick worst: without a drive there is no modulation; use \"knee\"");
  if (rule == "knee" || (rule.empty() && !driven)) return knee(front);
  if (rule.empty() || rule == "worst")
    return largest(front.size(), [&](std::size_t i) { return front[i].worst.value_or(0); });
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(rule.data(), rule.data() + rule.size(), number);
  if (error == std::errc{} && end == rule.data() + rule.size()) {
    if (number >= 1 && number <= front.size()) return number - 1;
    throw InputError(
        fmt::format("--pick {}: the front has the designs 1 to {}", rule, front.size()));
  }
  std::string names;
  for (std::size_t k = 0; k < front[0].names.size(); ++k) {
    if (front[0].names[k].starts_with(rule))
      return largest(front.size(), [&](std::size_t i) { return -front[i].objectives[k]; });
    names += ", \"" + front[0].names[k] + "\"";
  }
  throw InputError(
      fmt::format("--pick: \"{}\" is no rule; use \"worst\", \"knee\"{} or the number of a design",
                  rule, names));
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
