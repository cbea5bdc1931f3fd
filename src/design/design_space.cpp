#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/units.h"
#include "design/families.h"
#include "design/study_file.h"

namespace papilla::design {

bool is_built(const std::string& path) {
  // Of the view films and indices are built; the rest is who looks, below what, and how well the
  // texture was made.
  constexpr std::array kOthers{"finger",          "environment",
                               "model",           "accuracy",
                               "view.angles",     "view.cone",
                               "view.panel",      "view.displacement",
                               "view.inner_haze", "view.diameter_scatter"};
  return std::none_of(kOthers.begin(), kOthers.end(), [&](const std::string& other) {
    return path == other || path.starts_with(other + ".");
  });
}

namespace {

// The texture's kind and number of parts; then the numbers of every kind may be varied.
void read_kinds(StudyFile& file, const PathMembers& members) {
  for (const auto& [path, node] : members) {
    if (path != "texture.type" && path != "texture.levels") continue;
    const std::string where = "design_space." + path;
    const Node* choice = node->is_table() ? node->find("choice") : nullptr;
    const bool kind = path == "texture.type";
    const int parts = texture_levels(file.study.design.texture);
    const std::string expected =
        kind ? "expected { choice = [...] } of texture types"
             : fmt::format("expected {{ choice = [...] }} of numbers of parts, 1 to {}", parts);
    if (!choice || !choice->is_array() || choice->children.empty()) {
      file.document.problem(node->place, where, expected + ", got " + describe(*node));
      continue;
    }
    Variable variable{path, "", 0, 0, {}, {}};
    const auto& kinds = texture_kinds();
    for (const Node& item : choice->children) {
      const auto found =
          std::find(kinds.begin(), kinds.end(), item.is_text() ? item.text : std::string());
      if (kind && found != kinds.end() &&
          numbers_alone(static_cast<std::size_t>(found - kinds.begin()))) {
        variable.choices.push_back(static_cast<double>(found - kinds.begin()));
        file.kind_copies.push_back(of_kind(file.study.design.texture, item.text));
        file.numbers.add(number_fields(file.kind_copies.back(), "texture"));
      } else if (!kind && item.kind == Node::Kind::Integer && item.integer >= 1 &&
                 item.integer <= parts) {
        variable.choices.push_back(static_cast<double>(item.integer));
      } else {
        file.document.problem(item.place, where, expected + ", got " + describe(item));
      }
    }
    if (variable.choices.empty()) continue;
    variable.low = *std::min_element(variable.choices.begin(), variable.choices.end());
    variable.high = *std::max_element(variable.choices.begin(), variable.choices.end());
    file.study.variables.push_back(std::move(variable));
  }
}

constexpr const char* kExpected =
    "expected [low, high], { choice = [...] } or { range = [low, high], exclude = [[from, to]] }";

// Numbers of a list; nothing where one of them is none.
std::optional<std::vector<double>> read_list(StudyFile& file, const NumberField& field,
                                             const Node& list, const std::string& where) {
  std::vector<double> out(list.children.size());
  bool good = true;
  for (std::size_t i = 0; i < out.size(); ++i)
    good &= file.numbers.read(field, list.children[i], where, out[i]);
  return good ? std::optional(out) : std::nullopt;
}

// Ranges within the bounds of a variable, merged where they overlap.
void read_excluded(StudyFile& file, const NumberField& field, const Node& list,
                   const std::string& where, Variable& variable) {
  for (const Node& item : list.children) {
    const auto ends = item.is_array() && item.children.size() == 2
                          ? read_list(file, field, item, where)
                          : std::nullopt;
    if (!item.is_array() || item.children.size() != 2) {
      file.document.problem(item.place, where, "expected [from, to], got " + describe(item));
    } else if (ends && !(variable.low < ends->front() && ends->front() < ends->back() &&
                         ends->back() < variable.high)) {
      file.document.problem(item.place, where,
                            "expected low < from < to < high; where nothing is left at an end, "
                            "narrow `range` instead");
    } else if (ends) {
      variable.excluded.push_back({ends->front(), ends->back()});
    }
  }
  auto& all = variable.excluded;
  std::sort(all.begin(), all.end(),
            [](const Excluded& a, const Excluded& b) { return a.from < b.from; });
  for (std::size_t i = 1; i < all.size();) {
    if (all[i].from > all[i - 1].to) {
      ++i;
      continue;
    }
    all[i - 1].to = std::max(all[i - 1].to, all[i].to);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

// Bounds [low, high] of a number, what is excluded between them, or its choices.
void read_variable(StudyFile& file, const std::string& path, const Node& node) {
  const std::string where = "design_space." + path;
  const NumberField* field = file.numbers.find(path, node, "design_space");
  if (!field) return;
  if (!is_built(path)) {
    file.document.problem(node.key_place, where,
                          "is nothing that is built, so that no search chooses it: say which "
                          "fingers count in [population], which states in [[scenarios]], anything "
                          "else in its own section");
    return;
  }
  Variable variable{path, field->unit, 0, 0, {}, {}};
  const Node* choice = node.is_table() ? node.find("choice") : nullptr;
  const Node* range = node.is_table() ? node.find("range") : nullptr;
  const Node* exclude = range ? node.find("exclude") : nullptr;
  const Node& list = choice ? *choice : range ? *range : node;
  if (!list.is_array() || (!choice && list.children.size() != 2) || list.children.empty() ||
      (exclude && !exclude->is_array())) {
    file.document.problem(
        list.place, where,
        fmt::format("{}, got {}", kExpected, describe(exclude ? *exclude : list)));
    return;
  }
  if (node.is_table() && node.children.size() > (exclude ? 2 : 1))
    file.document.problem(node.place, where, kExpected);
  const auto values = read_list(file, *field, list, where);
  if (!values) return;
  variable.low = *std::min_element(values->begin(), values->end());
  variable.high = *std::max_element(values->begin(), values->end());
  if (choice) {
    variable.choices = *values;
  } else if (values->front() >= values->back()) {
    const bool one = values->front() == values->back();
    file.document.problem(
        list.place, where,
        one ? fmt::format(
                  "expected low < high; of one value write {{ choice = [\"{}\"] }}, or state "
                  "it in the design and leave it out here",
                  format_quantity(values->front(), field->unit))
            : "expected low < high");
    return;
  }
  if (exclude) read_excluded(file, *field, *exclude, where + ".exclude", variable);
  file.study.variables.push_back(std::move(variable));
}

// Numbers of the design that a scenario fixes.
void read_settings(StudyFile& file, const std::string& where, const Node& set,
                   std::vector<Setting>& out) {
  if (!set.is_table()) {
    file.document.problem(set.place, where,
                          "expected a section, e.g. { \"surface.contact_angle\" = \"80 deg\" }");
    return;
  }
  for (const auto& [path, node] : file.members(set, where, {})) {
    const NumberField* field = file.numbers.find(path, *node, where);
    double si = 0;
    if (field && file.numbers.read(*field, *node, where + "." + path, si))
      out.push_back({path, si});
  }
}

// "20 nm", anywhere within; { sigma = "20 nm" }, normal.
void read_tolerance(StudyFile& file, const std::string& path, const Node& node) {
  const NumberField* field = file.numbers.find(path, node, "scatter");
  if (!field) return;
  const std::string where = "scatter." + path;
  Scatter scatter{path};
  const Node* sigma = node.is_table() ? node.find("sigma") : nullptr;
  if (sigma) {
    scatter.kind = Scatter::Kind::Normal;
    file.only(node, where, {"sigma"});
  }
  const Node& value = sigma ? *sigma : node;
  if (!file.document.number(value, where, {path.c_str(), field->unit, 0, 1e9, ""},
                            scatter.tolerance))
    return;
  if (scatter.tolerance > 0) {
    file.study.scatter.push_back(std::move(scatter));
  } else {
    file.document.problem(value.place, where, "expected a tolerance above 0");
  }
}

// [{ between = ["texture.depth", "texture.diameter"], value = 0.6 }]
void read_correlations(StudyFile& file, const Node& list) {
  const char* where = "scatter.correlation";
  const char* expected =
      "expected a list of { between = [\"PATH\", \"PATH\"], value = NUMBER } with two paths of "
      "[scatter]";
  if (!list.is_array()) {
    file.document.problem(list.place, where, fmt::format("{}, got {}", expected, describe(list)));
    return;
  }
  for (const Node& item : list.children) {
    const Node* between = item.is_table() ? item.find("between") : nullptr;
    const Node* value = item.is_table() ? item.find("value") : nullptr;
    if (!between || !value || !between->is_array() || between->children.size() != 2 ||
        !between->children[0].is_text() || !between->children[1].is_text()) {
      file.document.problem(item.place, where, fmt::format("{}, got {}", expected, describe(item)));
      continue;
    }
    file.only(item, where, {"between", "value"});
    ScatterCorrelation c{between->children[0].text, between->children[1].text};
    if (file.document.number(*value, where, {"value", "", -1, 1, ""}, c.value))
      file.study.correlations.push_back(std::move(c));
  }
}

// Correlations of what goes with another kind of texture go too.
void drop_fallen_away(Study& study) {
  const auto fell = [&](const std::string& path) {
    return std::count(study.fallen_away.begin(), study.fallen_away.end(), "scatter." + path) > 0;
  };
  std::erase_if(study.correlations,
                [&](const ScatterCorrelation& c) { return fell(c.first) || fell(c.second); });
  Node* kept = study.study_sections.find("scatter");
  Node* list = kept ? kept->find("correlation") : nullptr;
  if (!list) return;
  std::erase_if(list->children, [&](const Node& item) {
    const Node* between = item.find("between");
    return between && std::any_of(between->children.begin(), between->children.end(),
                                  [&](const Node& path) { return fell(path.text); });
  });
}

}  // namespace

void read_design_space(StudyFile& file) {
  const Node* space = file.section("design_space");
  if (!space) return;
  const PathMembers members = file.members(*space, "design_space", {"choice", "range"});
  read_kinds(file, members);
  for (const auto& [path, node] : members) {
    if (path != "texture.type" && path != "texture.levels" &&
        !file.falls_away("design_space", path, *node))
      read_variable(file, path, *node);
  }
}

void read_scatter(StudyFile& file) {
  const Node* section = file.section("scatter");
  if (!section) return;
  const PathMembers members = file.members(*section, "scatter", {"sigma"});
  for (const auto& [path, node] : members) {
    if (path == "correlation") {
      read_correlations(file, *node);
    } else if (!file.falls_away("scatter", path, *node)) {
      read_tolerance(file, path, *node);
    }
  }
  drop_fallen_away(file.study);
  try {
    ScatterLaw(file.study.scatter, file.study.correlations);
  } catch (const InputError& error) {
    if (file.document.problems().empty())
      file.document.problem(section->place, "scatter", error.problems().front().message);
  }
}

void read_scenarios(StudyFile& file) {
  const Node* list = file.document.take("scenarios");
  if (!list) return;
  file.keep("scenarios");
  if (!list->is_array()) {
    file.document.problem(list->place, "scenarios",
                          "expected a list of sections [[scenarios]], got " + describe(*list));
    return;
  }
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    const Node& item = list->children[i];
    const std::string path = fmt::format("scenarios.{}", i);
    if (!item.is_table()) {
      file.document.problem(item.place, path, "expected a section { ... }, got " + describe(item));
      continue;
    }
    file.only(item, path, {"name", "weight", "set"});
    Scenario scenario;
    const Node* name = item.find("name");
    if (!name || !name->is_text()) {
      file.document.problem(name ? name->place : item.place, path, "missing `name` (a text)");
    } else {
      scenario.name = name->text;
    }
    if (const Node* weight = item.find("weight")) {
      file.document.number(*weight, path + ".weight", {"weight", "", 0, 1e6, ""}, scenario.weight);
    }
    if (const Node* set = item.find("set")) read_settings(file, path + ".set", *set, scenario.set);
    file.study.scenarios.push_back(std::move(scenario));
  }
}

}  // namespace papilla::design
