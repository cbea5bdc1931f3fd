#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "design/study_file.h"
#include "metrics/metrics.h"

namespace papilla {
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

std::vector<std::string> metrics(StudyFile& file, const Node& section, const char* key) {
  std::vector<std::string> out = texts(file, section, key, "objective");
  for (const std::string& text : out) {
    try {
      parse_metric(text);
    } catch (const InputError& error) {
      file.document.problem(section.find(key)->place, std::string("objective.") + key,
                            error.problems().front().message);
    }
  }
  return out;
}

// A key such as "worst(modulation)", limited on its bad side.
std::optional<ConstraintKind> metric_constraint(StudyFile& file, const Node& child) {
  if (child.key.find('(') == std::string::npos) return std::nullopt;
  try {
    const MetricExpression expression = parse_metric(child.key);
    const Better better = better_direction(expression);
    if (better != Better::Neither) {
      const bool relative =
          expression.summary == Summary::Variation || expression.summary == Summary::Range;
      return ConstraintKind{metric_text(expression),
                            relative ? "" : find_metric(expression.metric)->unit,
                            better == Better::Higher, ""};
    }
    file.document.problem(child.key_place, "constraints",
                          "\"" + child.key + "\" has no better direction to be limited in");
  } catch (const InputError& error) {
    file.document.problem(child.key_place, "constraints", error.problems().front().message);
  }
  return ConstraintKind{child.key, "", true, ""};
}

void read_targets(StudyFile& file, const Node& section) {
  if (!section.is_table()) {
    file.document.problem(
        section.place, "objective.target",
        "expected { METRIC = value }, e.g. { modulation = 0.8 }, got " + describe(section));
    return;
  }
  for (const Node& item : section.children) {
    const MetricInfo* metric = find_metric(item.key);
    if (!metric || metric->appearance) {
      file.document.problem(item.key_place, "objective.target",
                            fmt::format("no metric over humidity is called \"{}\"", item.key));
      continue;
    }
    double value = 0;
    if (file.document.number(item, "objective.target." + item.key,
                             {metric->name.c_str(), metric->unit.c_str(), -1e9, 1e9, ""}, value))
      file.study.objective.targets.push_back({metric->name, value});
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
  if (!risk.empty()) file.study.objective.risk = risk.front();
}

void read_constraints(StudyFile& file) {
  const Node* section = file.section("constraints");
  if (!section) return;
  std::vector<std::string> names;
  for (const ConstraintKind& kind : constraint_kinds()) names.push_back(kind.name);
  std::vector<std::string> keys = names;
  for (const Node& child : section->children) {
    std::optional<ConstraintKind> kind = metric_constraint(file, child);
    if (kind) {
      keys.push_back(child.key);
    } else if (const auto at = std::find(names.begin(), names.end(), child.key);
               at != names.end()) {
      kind = constraint_kinds()[static_cast<std::size_t>(at - names.begin())];
    } else {
      continue;
    }
    double limit = 0;
    if (file.document.number(child, "constraints." + child.key,
                             {kind->name.c_str(), kind->unit.c_str(), 0, 1e9, ""}, limit)) {
      file.study.constraints.push_back({kind->name, limit, kind->at_least});
    }
  }
  file.only(*section, "constraints", keys);
}

}  // namespace papilla
