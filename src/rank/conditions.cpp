#include "rank/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "config/writer.h"

namespace papilla::rank {
namespace {

using KeyValues = std::vector<std::pair<std::string, std::string>>;

// Every value below a node as a file has it, by its key; a list is one value.
void leaves(const Node& node, const std::string& path, KeyValues& out) {
  if (node.is_table()) {
    for (const Node& child : node.children)
      leaves(child, path.empty() ? child.key : path + "." + child.key, out);
    return;
  }
  Node line = table_node();
  line.set("v", node);
  std::string text = write_toml(line);
  if (const std::size_t at = text.find("v = "); at != std::string::npos) text.erase(0, at + 4);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (node.is_text()) text = node.text;
  out.emplace_back(path, std::move(text));
}

// What all candidates have to share for these criteria, key by key.
KeyValues conditions_of(const Design& design, const RankOptions& options) {
  bool driven = false, seen = false;
  for (const Criterion& c : options.criteria) {
    const MetricInfo& info = c.info();
    seen = seen || info.appearance;
    driven = driven || info.needs_drive;
  }
  KeyValues out;
  if (options.felt()) {
    Finger finger = scene_of(design).finger;
    // Names and the story of the fit move nothing; the options rule the state.
    finger.name.clear();
    finger.fitted_to.clear();
    finger.uncertainty.clear();
    finger.calibrated_for = {};
    finger.state = FingerState::Clean;
    leaves(to_table(finger), "finger", out);
    if (design.counterface.in_place()) leaves(to_table(design.counterface), "counterface", out);
    leaves(to_table(design.environment), "environment", out);
    leaves(to_table(design.model), "model", out);
    AccuracySettings accuracy = design.accuracy;
    accuracy.target = 0;  // a ranking takes the skins that its order asks for
    accuracy.parameters = false;
    leaves(to_table(accuracy), "accuracy", out);
  }
  if (driven) leaves(to_table(design.drive), "drive", out);
  if (seen) leaves(to_table(design.view), "view", out);
  return out;
}

std::string value_of(const std::string& key, const KeyValues& list) {
  const auto at =
      std::find_if(list.begin(), list.end(), [&](const auto& pair) { return pair.first == key; });
  return at == list.end() ? "nothing" : at->second;
}

std::string name_of(std::size_t i, const std::vector<Regions>& candidates,
                    const RankOptions& options) {
  if (i < options.names.size()) return options.names[i];
  const std::string& title = candidates[i].front().title;
  return title.empty() ? fmt::format("candidate {}", i + 1) : "\"" + title + "\"";
}

}  // namespace

std::string ConditionDifference::text() const {
  const auto cut = [](const std::string& text) {  // lists of fitted numbers are long
    constexpr std::size_t kLongest = 48;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
  };
  return fmt::format("{}: {} in {}, {} in {}", key, cut(value), first, cut(other_value), other);
}

std::vector<ConditionDifference> condition_differences(const std::vector<Regions>& candidates,
                                                       const RankOptions& options) {
  std::vector<ConditionDifference> out;
  const KeyValues first = conditions_of(candidates.front().front(), options);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (const Design& design : candidates[i]) {
      const KeyValues other = conditions_of(design, options);
      const auto add = [&](const std::string& key) {
        const std::string a = value_of(key, first), b = value_of(key, other);
        if (a == b || std::any_of(out.begin(), out.end(),
                                  [&](const ConditionDifference& d) { return d.key == key; }))
          return;
        out.push_back(
            {key, name_of(0, candidates, options), a, b, name_of(i, candidates, options)});
      };
      for (const auto& pair : first) add(pair.first);
      for (const auto& pair : other) add(pair.first);
    }
  }
  return out;
}

void require_same_conditions(const std::vector<ConditionDifference>& differences) {
  if (differences.empty()) return;
  std::vector<std::string> texts, sets;
  for (const ConditionDifference& d : differences) {
    texts.push_back(d.text());
    sets.push_back(fmt::format("--set '{}={}'", d.key, d.value));
  }
  constexpr std::size_t kShown = 6, kSettable = 3;  // other fingers differ in dozens of keys
  const std::size_t more = texts.size() > kShown ? texts.size() - kShown : 0;
  texts.resize(texts.size() - more);
  throw InputError(fmt::format(
      "the candidates are not judged under the same conditions, so that their order would say "
      "nothing about the surfaces:\n  {}{}\nmake them equal: {}; or compare them as they are: "
      "--any-conditions",
      join_names(texts, "\n  "), more ? fmt::format("\n  and {} keys more", more) : "",
      sets.size() > kSettable
          ? std::string("the same [finger] base, environment, drive and accuracy in every file")
          : join_names(sets, " ")));
}

FingerState common_state(const std::vector<Regions>& candidates) {
  std::vector<FingerState> found;
  for (const Regions& regions : candidates) {
    for (const Design& design : regions) {
      if (design.counterface.in_place()) continue;  // of a finger that is not there
      if (std::find(found.begin(), found.end(), design.finger.state) == found.end())
        found.push_back(design.finger.state);
    }
  }
  if (found.empty()) return FingerState::Clean;
  if (found.size() == 1) return found.front();
  std::vector<std::string> names;
  for (const FingerState state : found)
    names.push_back(finger_state_names()[static_cast<std::size_t>(state)]);
  throw InputError("the designs' fingers are in different states (finger.state), " +
                   join_names(names) + ": say in which of them, or in which ones, all are judged");
}

}  // namespace papilla::rank
