// A wish for a search as a study file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "design/paths.h"
#include "geometry/texture.h"
#include "metrics/metrics.h"
#include "studio/search_desk.h"

namespace papilla::studio {
namespace {

using Json = nlohmann::ordered_json;

Node texts_node(const std::vector<std::string>& texts) {
  std::vector<Node> items;
  for (const std::string& text : texts) items.push_back(text_node(text));
  return array_node(std::move(items));
}

// As a file has a value of a key: bare where it has no unit.
Node value_node(const std::string& text) {
  const auto q = parse_quantity(text);
  return q && q->unit.empty() ? number_node(q->value) : text_node(text);
}

// "300 to 400 nm, 600 nm to 650 nm" as a list of pairs.
Node excluded_node(const VariableWish& v) {
  std::vector<Node> out;
  for (const std::string& range : split(v.excluding, ',')) {
    const std::size_t at = range.find(" to ");
    const auto from = at == std::string::npos ? std::nullopt : parse_quantity(range.substr(0, at));
    const auto to = at == std::string::npos ? std::nullopt : parse_quantity(range.substr(at + 4));
    if (!from || !to)
      throw InputError({Problem{"", 0, 0, v.path,
                                "expected ranges to exclude such as \"300 to 400 "
                                "nm\", got \"" +
                                    range + "\""}});
    const std::string unit = from->unit.empty() ? to->unit : from->unit;
    const auto end = [](double value, const std::string& of) {
      return value_node(of.empty() ? format_number(value) : format_number(value) + " " + of);
    };
    out.push_back(array_node({end(from->value, unit), end(to->value, to->unit)}));
  }
  return array_node(std::move(out));
}

Node range_node(const VariableWish& v) {
  Node range = array_node({value_node(v.low), value_node(v.high)});
  if (v.excluding.empty()) return range;
  Node out = table_node();
  out.set("range", std::move(range));
  out.set("exclude", excluded_node(v));
  return out;
}

Node choice_node(Node list) {
  Node out = table_node();
  out.set("choice", std::move(list));
  return out;
}

// "200 nm" and "0.2 um" are one value.
bool same_value(const std::string& a, const std::string& b) {
  constexpr double kSame = 1e-12;  // relative: digits of their units' factors
  if (a == b) return true;
  const auto x = parse_quantity(a), y = parse_quantity(b);
  return x && y && find_unit(x->unit)->same_dimension(*find_unit(y->unit)) &&
         std::abs(x->si - y->si) <= kSame * std::abs(x->si);
}

bool has_number(const Study& study, const std::string& path) {
  Design design = study.design;
  const std::vector<NumberField> known = number_fields(design);
  return std::any_of(known.begin(), known.end(),
                     [&](const NumberField& field) { return field.path == path; });
}

// Variables that the form has no row for: values and levels to choose among. One that the wish
// names is as the wish has it, and a number of a kind that competes no more is none.
std::vector<Variable> kept_variables(const Study& study, const SearchWish& wish) {
  std::vector<Variable> out = study.variables;
  std::erase_if(out, [&](const Variable& v) {
    const bool named = std::any_of(wish.variables.begin(), wish.variables.end(),
                                   [&](const VariableWish& own) { return own.path == v.path; });
    const bool there = v.is_levels() || wish.kinds.size() > 1 || has_number(study, v.path);
    return v.choices.empty() || v.is_kind() || named || !there;
  });
  return out;
}

// What the study aims at, until a goal that is none of its own takes the place.
Node kept_targets(const Study& study, const SearchWish& wish) {
  const Node* objective = study.study_sections.find("objective");
  const Node* target = objective ? objective->find("target") : nullptr;
  if (!target) return table_node();
  Node out = *target;
  const auto replace = [&](const std::vector<std::string>& goals,
                           const std::vector<MetricExpression>& own) {
    for (const std::string& goal : goals) {
      const MetricExpression wanted = parse_metric(goal);
      if (wanted.pen || std::find(own.begin(), own.end(), wanted) != own.end()) continue;
      std::erase_if(out.children,
                    [&](const Node& aim) { return find_metric(aim.key) == wanted.metric; });
    }
  };
  replace(wish.maximise, study.objective.maximise);
  replace(wish.minimise, study.objective.minimise);
  return out;
}

Node space_node(const Study& study, const SearchWish& wish) {
  Node space = table_node();
  bool varies = wish.kinds.size() > 1;
  if (varies) space.set("texture.type", choice_node(texts_node(wish.kinds)));
  for (const VariableWish& v : wish.variables) {
    const bool pinned = same_value(v.low, v.high);
    space.set(v.path, pinned ? choice_node(array_node({value_node(v.low)})) : range_node(v));
    varies = varies || !pinned;
  }
  const Node* own = study.study_sections.find("design_space");
  const PathMembers members = own ? members_by_path(*own, {"choice", "range"}) : PathMembers{};
  for (const Variable& v : kept_variables(study, wish)) {
    for (const auto& [path, node] : members) {
      if (path == v.path) space.set(path, *node);
    }
    varies = varies || v.choices.size() > 1;
  }
  if (!varies) throw InputError("a search needs a variable: let one vary that is pinned");
  return space;
}

// Files of the study's people, as it names them.
std::vector<std::string> finger_files(const Study& study) {
  std::vector<std::string> out;
  const Node* population = study.study_sections.find("population");
  const Node* fingers = population ? population->find("fingers") : nullptr;
  if (!fingers) return out;
  for (const Node& finger : fingers->children) {
    if (finger.is_text()) out.push_back(finger.text);
  }
  return out;
}

std::string finger_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

void keep_fingers(Node& sections, const std::vector<std::string>& names) {
  Node* population = sections.find("population");
  Node* fingers = population ? population->find("fingers") : nullptr;
  if (!fingers || names.empty()) return;
  std::erase_if(fingers->children, [&](const Node& finger) {
    return finger.is_text() &&
           std::find(names.begin(), names.end(), finger_name(finger.text)) == names.end();
  });
}

std::string quantity(double si, const std::string& unit) {
  return unit.empty() ? format_number(si) : format_quantity(si, unit);
}

// Three digits: a range is a guess.
std::string rounded(double si, const std::string& unit) {
  const std::string shown = significant(si / find_unit(unit)->to_si, 3);
  return unit.empty() ? shown : shown + " " + unit;
}

// What a design without a study could vary: the measures of its texture.
Json proposed_variables(const Study& study) {
  constexpr double kDown = 0.5, kUp = 2;
  Json out = Json::array();
  for (const Variable& v : study.variables) {
    if (v.is_kind() || v.is_levels() || !v.choices.empty()) continue;
    std::string excluding;
    for (const Excluded& e : v.excluded)
      excluding += fmt::format("{}{} to {}", excluding.empty() ? "" : ", ",
                               quantity(e.from, v.unit), quantity(e.to, v.unit));
    out.push_back({{"path", v.path},
                   {"low", quantity(v.low, v.unit)},
                   {"high", quantity(v.high, v.unit)},
                   {"excluding", excluding},
                   {"vary", true}});
  }
  Design copy = study.design;
  for (const NumberField& field : number_fields(copy)) {
    const bool offered = (field.path.starts_with("texture.") && *field.value > 0) ||
                         field.path == "surface.contact_angle" || field.path == "drive.amplitude";
    const bool listed =
        std::any_of(out.begin(), out.end(), [&](const Json& v) { return v["path"] == field.path; });
    if (!offered || listed || field.path == "texture.width" || field.path == "texture.patch")
      continue;
    const double to_si = find_unit(field.unit)->to_si;
    const double low = std::max(field.low * to_si, kDown * *field.value);
    const double high = std::min(field.high * to_si, kUp * *field.value);
    const bool usual = study.variables.empty() &&
                       (field.path == "texture.depth" || field.path == "texture.diameter" ||
                        field.path == "texture.height" || field.path == "texture.radius");
    out.push_back({{"path", field.path},
                   {"low", rounded(low, field.unit)},
                   {"high", rounded(high, field.unit)},
                   {"excluding", ""},
                   {"vary", usual}});
  }
  return out;
}

}  // namespace

SearchWish search_wish(const Json& json) {
  SearchWish out;
  try {
    constexpr std::size_t kMost = 40;
    const auto texts = [&](const char* key) {
      auto list = json.value(key, std::vector<std::string>{});
      if (list.size() > kMost) throw InputError(std::string(key) + ": too many of them");
      return list;
    };
    for (const Json& v : json.at("variables"))
      out.variables.push_back({v.at("path").get<std::string>(), v.at("low").get<std::string>(),
                               v.at("high").get<std::string>(), v.value("excluding", "")});
    if (json.contains("limits")) {
      for (const Json& v : json.at("limits"))
        out.limits.push_back({v.at("name").get<std::string>(), v.at("limit").get<std::string>()});
    }
    out.kinds = texts("kinds");
    out.fingers = texts("fingers");
    out.maximise = texts("maximise");
    out.minimise = texts("minimise");
    out.evaluations = json.value("evaluations", 0);
  } catch (const Json::exception&) {
    throw InputError("a search needs variables, each with path, low and high, and an objective");
  }
  return out;
}

namespace {

// Without tolerances of numbers that are no part of the design any more, which would be refused;
// correlations of them go too.
void keep_scatter(Node& sections, const Study& study) {
  Node* scatter = sections.find("scatter");
  if (!scatter) return;
  const auto has = [&](const std::string& path) { return has_number(study, path); };
  const std::vector<Scatter>& all = study.scatter;
  for (const Scatter& s : all) {
    if (!has(s.path)) erase_member(*scatter, s.path);
  }
  Node* correlations = scatter->find("correlation");
  if (correlations) {
    std::erase_if(correlations->children, [&](const Node& item) {
      const Node* between = item.find("between");
      return between && !std::all_of(between->children.begin(), between->children.end(),
                                     [&](const Node& path) { return has(path.text); });
    });
  }
  const bool any =
      std::any_of(all.begin(), all.end(), [&](const Scatter& s) { return has(s.path); });
  if (!any) std::erase_if(sections.children, [](const Node& n) { return n.key == "scatter"; });
}

// What a search of the page has from the study without a row for it, for people.
std::vector<std::string> kept_words(const Study& study, const std::vector<std::string>& kinds) {
  SearchWish wish;
  wish.kinds = kinds;
  std::vector<std::string> out;
  for (const Variable& v : kept_variables(study, wish)) {
    std::vector<std::string> values;
    for (const double choice : v.choices) values.push_back(variable_text(v, choice));
    out.push_back(v.path + " " + join_names(values));
  }
  for (const Target& t : study.objective.targets)
    out.push_back(fmt::format("target {} = {}", metric_text(t.metric),
                              quantity(t.value, info_of(t.metric).unit)));
  return out;
}

std::vector<std::string> metric_texts(const std::vector<MetricExpression>& expressions) {
  std::vector<std::string> out;
  for (const MetricExpression& e : expressions) out.push_back(metric_text(e));
  return out;
}

}  // namespace

namespace {

Json limit_json(const ConstraintKind& kind) {
  const auto* metric = std::get_if<MetricLimit>(&kind.on);
  return {{"name", kind.name},
          {"unit", kind.unit},
          {"doc", metric ? info_of(metric->expression.metric).doc : kind.doc},
          {"at_least", kind.at_least}};
}

// Limits that are set on a metric are none of the list: the page is told what each is, too.
void know_set_limits(Json& wish) {
  Json& known = wish["known_limits"];
  for (const Json& limit : wish["limits"]) {
    const Json name = limit.is_object() ? limit.value("name", Json()) : Json();
    const bool listed =
        std::any_of(known.begin(), known.end(), [&](const Json& k) { return k["name"] == name; });
    if (listed || !name.is_string()) continue;
    try {
      known.push_back(limit_json(read_constraint_kind(name.get<std::string>())));
    } catch (const InputError&) {  // of a page: the search will refuse it
    }
  }
}

// The page's own words over what is proposed; of variables that both know.
void write_over(Json& proposed, const Json& kept) {
  for (const char* key : {"kinds", "fingers", "maximise", "minimise", "limits", "evaluations"}) {
    if (kept.contains(key)) proposed[key] = kept.at(key);
  }
  for (Json& variable : proposed["variables"]) {
    for (const Json& own : kept.value("variables", Json::array())) {
      if (own.value("path", "") != variable["path"]) continue;
      for (const char* key : {"low", "high", "excluding", "vary"}) {
        if (own.contains(key)) variable[key] = own.at(key);
      }
    }
  }
}

}  // namespace

Json proposed_wish(const Study& study, const std::string& kept) {
  Json limits = Json::array(), kinds = Json::array(), known = Json::array(),
       metrics = Json::array();
  for (const Constraint& c : study.constraints) {
    const std::string name = limit_name(c.on);
    limits.push_back(
        {{"name", name}, {"limit", quantity(c.limit, read_constraint_kind(name).unit)}});
  }
  for (const ConstraintKind& kind : constraint_kinds()) known.push_back(limit_json(kind));
  for (const MetricInfo& metric : metric_list()) {
    if (!metric.appearance)
      metrics.push_back(
          {{"name", metric.name}, {"doc", metric.doc}, {"at_modulation", metric.takes_modulation}});
  }
  for (const Variable& v : study.variables) {
    if (!v.is_kind()) continue;
    for (const double choice : v.choices) kinds.push_back(variable_text(v, choice));
  }
  Json known_kinds = Json::array(), fingers = Json::array();
  for (std::size_t k = 0; k < texture_kinds().size(); ++k) {
    if (numbers_alone(k)) known_kinds.push_back(texture_kinds()[k]);
  }
  for (const std::string& file : finger_files(study)) fingers.push_back(finger_name(file));
  const Objective& own = study.objective;
  std::vector<MetricExpression> maximise = own.maximise, minimise = own.minimise;
  if (maximise.empty() && minimise.empty() && own.targets.empty()) {
    const bool driven = study.design.drive.driven();
    maximise = {{Summary::Mean, driven ? kModulation : kFriction}};
    if (driven) minimise = {{Summary::Variation, kModulation}};
  }
  Json out{{"variables", proposed_variables(study)},
           {"kinds", kinds},
           {"known_kinds", known_kinds},
           {"fingers", fingers},
           {"known_fingers", fingers},
           {"maximise", metric_texts(maximise)},
           {"minimise", metric_texts(minimise)},
           {"limits", limits},
           {"known_limits", known},
           {"metrics", metrics},
           {"kept", kept_words(study, kinds)},
           {"evaluations", study.search.evaluations}};
  const Json page = Json::parse(kept, nullptr, false);
  if (page.is_object()) write_over(out, page);
  know_set_limits(out);
  return out;
}

std::string study_text(const Study& study, const SearchWish& wish) {
  Node target = kept_targets(study, wish);
  if (wish.maximise.empty() && wish.minimise.empty() && target.children.empty())
    throw InputError("a search needs something to maximise or to minimise");
  const std::string own(texture_kinds()[study.design.texture.kind.index()]);
  if (wish.kinds.size() == 1 && wish.kinds.front() != own)
    throw InputError(fmt::format(
        "{} alone is another kind than the design at hand ({}): let both compete, or make it the "
        "design at hand",
        wish.kinds.front(), own));
  Study out = study;
  Node& sections = out.study_sections;
  sections.set("design_space", space_node(study, wish));
  Node objective = table_node();
  if (!wish.maximise.empty()) objective.set("maximise", texts_node(wish.maximise));
  if (!wish.minimise.empty()) objective.set("minimise", texts_node(wish.minimise));
  if (!target.children.empty()) objective.set("target", std::move(target));
  if (const Node* old = sections.find("objective"); old && old->find("risk"))
    objective.set("risk", *old->find("risk"));
  sections.set("objective", std::move(objective));
  Node limits = table_node();
  for (const LimitWish& limit : wish.limits) {
    if (limits.find(limit.name))
      throw InputError(
          {Problem{"", 0, 0, "constraints." + limit.name, "stands twice: remove one"}});
    limits.set(limit.name, value_node(limit.limit));
  }
  sections.set("constraints", std::move(limits));
  Node search = sections.find("search") ? *sections.find("search") : table_node();
  if (wish.evaluations > 0) search.set("evaluations", integer_node(wish.evaluations));
  sections.set("search", std::move(search));
  keep_fingers(sections, wish.fingers);
  keep_scatter(sections, out);
  return resolved_toml(out);
}

}  // namespace papilla::studio
