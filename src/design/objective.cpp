#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/text.h"
#include "design/study_file.h"
#include "metrics/metrics.h"

namespace papilla::design {
namespace {

// A text or a list of texts.
std::vector<std::string> texts(StudyFile& file, const Node& section, const char* key,
                               const std::string& path) {
  const Node* node = section.find(key);
  std::vector<std::string> out;
  if (!node) return out;
  const auto add = [&](const Node& item) {
    if (item.is_text()) {
      out.push_back(item.text);
    } else {
      file.document.problem(item.place, path + "." + key,
                            "expected a text or a list of texts, got " + describe(item));
    }
  };
  if (node->is_array()) {
    for (const Node& item : node->children) add(item);
  } else {
    add(*node);
  }
  return out;
}

std::vector<MetricExpression> metrics(StudyFile& file, const Node& section, const char* key) {
  std::vector<MetricExpression> out;
  for (const std::string& text : texts(file, section, key, "objective")) {
    try {
      out.push_back(parse_metric(text));
    } catch (const InputError& error) {
      file.document.problem(section.find(key)->place, std::string("objective.") + key,
                            error.problems().front().message);
    }
  }
  return out;
}

// What has a value at every humidity; nothing, and a mistake, where the key is no such metric.
std::optional<Metric> target_metric(StudyFile& file, const Node& item) {
  std::string wrong = fmt::format("no metric over humidity is called \"{}\"", item.key);
  try {
    const std::optional<Metric> metric = find_metric(item.key);
    if (metric && !info_of(*metric).appearance) return metric;
  } catch (const InputError& error) {
    wrong = error.problems().front().message;
  }
  file.document.problem(item.key_place, "objective.target", wrong);
  return std::nullopt;
}

// A yield is of something: plates that differ, and limits that they keep or break.
void check_yield(StudyFile& file, const Node& section) {
  const Node* yield = section.find("yield");
  if (!yield) return;
  if (file.study.scatter.empty() && file.document.problems().empty())
    file.document.problem(yield->key_place, "constraints.yield",
                          "no tolerance is stated; name what scatters under [scatter], e.g. "
                          "\"texture.depth\" = \"20 nm\"");
  for (const Constraint& c : file.study.constraints) {
    if (!std::holds_alternative<YieldLimit>(c.on)) continue;
    if (file.study.constraints.size() == 1)
      file.document.problem(yield->key_place, "constraints.yield",
                            "there is no other limit that plates could break; set one, e.g. "
                            "min_wall = \"0.4 um\"");
    if (c.limit > 1)
      file.document.problem(yield->place, "constraints.yield", "expected at most 100 %");
  }
}

void read_targets(StudyFile& file, const Node& section) {
  if (!section.is_table()) {
    file.document.problem(
        section.place, "objective.target",
        "expected { METRIC = value }, e.g. { modulation = 0.8 }, got " + describe(section));
    return;
  }
  for (const Node& item : section.children) {
    const std::optional<Metric> metric = target_metric(file, item);
    if (!metric) continue;
    const MetricInfo& info = info_of(*metric);
    double value = 0;
    if (file.document.number(item, "objective.target." + item.key,
                             {info.name.c_str(), info.unit.c_str(), -1e9, 1e9, ""}, value))
      file.study.objective.targets.push_back({*metric, value});
  }
}

}  // namespace

void read_objective(StudyFile& file) {
  const Node* section = file.section("objective");
  if (!section) return;
  file.only(*section, "objective", {"maximise", "minimise", "target", "risk"});
  file.study.objective.maximise = metrics(file, *section, "maximise");
  file.study.objective.minimise = metrics(file, *section, "minimise");
  if (const Node* target = section->find("target")) read_targets(file, *target);
  const std::vector<std::string> risk = texts(file, *section, "risk", "objective");
  if (risk.size() > 1)
    file.document.problem(section->find("risk")->place, "objective.risk",
                          fmt::format("expected one text, got {}", risk.size()));
  if (!risk.empty()) file.study.objective.risk = risk.front();
}

namespace {

// A limit on a dimension, "max_depth": what the search may change says how far. Whether it is one.
bool refuse_dimension(StudyFile& file, const Node& limit, const std::vector<std::string>& known) {
  if (!nearest_name(limit.key, known).empty()) return false;
  std::string name = limit.key;
  for (const char* end : {"max_", "min_", "maximum_", "minimum_"}) {
    if (name.starts_with(end)) name.erase(0, std::string_view(end).size());
  }
  const std::string path = file.numbers.named(name);
  if (path.empty()) return false;
  file.document.problem(
      limit.key_place, "constraints",
      fmt::format("`{}`: the search changes a dimension between its ends alone; say them in "
                  "[design_space]: \"{}\" = [low, high]",
                  limit.key, path));
  return true;
}

}  // namespace

void read_constraints(StudyFile& file) {
  const Node* section = file.section("constraints");
  if (!section) return;
  std::vector<std::string> keys;
  for (const ConstraintKind& kind : constraint_kinds()) keys.push_back(kind.name);
  Node unknown = *section;
  unknown.children.clear();
  for (const Node& child : section->children) {
    const bool is_metric = child.key.find('(') != std::string::npos;
    if (!is_metric && std::find(keys.begin(), keys.end(), child.key) == keys.end()) {
      if (!refuse_dimension(file, child, keys)) unknown.children.push_back(child);
      continue;
    }
    try {
      const ConstraintKind kind = read_constraint_kind(child.key);
      double limit = 0;
      if (file.document.number(child, "constraints." + child.key,
                               {kind.name.c_str(), kind.unit.c_str(), 0, 1e9, ""}, limit))
        file.study.constraints.push_back({kind.on, limit, kind.at_least});
    } catch (const InputError& error) {
      file.document.problem(child.key_place, "constraints", error.problems().front().message);
    }
  }
  file.only(unknown, "constraints", keys);
  check_yield(file, *section);
}

}  // namespace papilla::design
