#include "design/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "base/units.h"
#include "config/writer.h"
#include "design/families.h"
#include "optim/search.h"

namespace papilla::design {

void fields(FieldVisitor& v, StudyRisk& s) {
  v.text({"belief",
          "how belief about finger and model decides among the finalists: \"regret\" (the least "
          "expected one), \"mean\", \"worst 10 %\""},
         s.belief);
  v.number({"limits", "%", 0, 100,
            "of belief: what is recommended keeps every limit with this probability"},
           s.limits);
}

void fields(FieldVisitor& v, Search& s) {
  const std::vector<std::string>& names = searcher_names();
  int method = static_cast<int>(std::find(names.begin(), names.end(), s.method) - names.begin());
  v.choice({"method", "search method"}, names, method);
  s.method = names[static_cast<std::size_t>(method)];
  v.integer({"seed", "of the search's random numbers"}, 0, 1 << 30, s.seed);
  v.integer({"evaluations", "largest number of evaluated designs; 0: the method's default"}, 0,
            100000000, s.evaluations);
  v.integer({"drafts", "cheap evaluations that steer the bayesian search"}, 0, 10000, s.drafts);
  v.number({"time", "min", 0, 1e6, "largest wall-clock time; 0: no limit"}, s.time);
  v.integer({"jobs", "evaluations at a time; 0: one per processor"}, 0, 4096, s.jobs);
  v.number({"rounding", "nm", 0, 1e5,
            "grid of the fab: the best design is judged again with its periods and widths on it, "
            "other lengths on finer steps; 0: not"},
           s.rounding);
}

std::string variable_text(const Variable& variable, double value, bool plain) {
  if (variable.is_kind()) return texture_kinds()[static_cast<std::size_t>(value)];
  const double shown = value / find_unit(variable.unit)->to_si;
  if (plain) return fmt::format("{:.6g}", shown);
  return significant(shown, 3) + (variable.unit.empty() ? "" : " " + variable.unit);
}

std::vector<std::string> scenarios_setting(const Study& study, const std::string& path) {
  Design design = study.design;
  const std::vector<NumberField> known = number_fields(design);
  const std::string own = path_in(known, path);
  const auto is_it = [&](const Setting& s) {
    return s.path == path || (!own.empty() && path_in(known, s.path) == own);
  };
  std::vector<std::string> out;
  for (const Scenario& s : study.scenarios) {
    if (s.weight > 0 && std::any_of(s.set.begin(), s.set.end(), is_it))
      out.push_back("\"" + s.name + "\"");
  }
  return out;
}

namespace {

// Spreads over humidity that a study asks for, where it has one humidity: 0 of every design.
std::vector<std::string> spreads_of_one(const Study& study) {
  std::vector<std::string> out;
  if (study.design.environment.relative_humidity.size() != 1) return out;
  const auto add = [&](const MetricExpression& e) {
    const std::string name = metric_text(e);
    if (is_spread(e.summary) && std::find(out.begin(), out.end(), name) == out.end())
      out.push_back(name);
  };
  for (const auto* list : {&study.objective.maximise, &study.objective.minimise})
    std::for_each(list->begin(), list->end(), add);
  for (const Constraint& c : study.constraints) {
    if (const auto* metric = std::get_if<MetricLimit>(&c.on)) add(metric->expression);
  }
  return out;
}

}  // namespace

std::vector<std::string> unused_of(const Study& study) {
  std::vector<std::string> out;
  if (const std::vector<std::string> spreads = spreads_of_one(study); !spreads.empty())
    out.push_back(join_names(spreads) +
                  ": 0 for every design, as a spread over humidity of the one humidity that the "
                  "study has; add another to environment.relative_humidity, or leave the spread "
                  "out");
  for (const std::string& path : study.fallen_away)
    out.push_back(path + " is left out: this kind of texture has no such number");
  for (const Variable& v : study.variables) {
    const std::vector<std::string> setting = scenarios_setting(study, v.path);
    if (!setting.empty())
      out.push_back(v.path + " of the design space counts for nothing where a scenario sets it: " +
                    join_names(setting));
  }
  constexpr std::size_t kMostTold = 4;
  const std::size_t told = std::min(kMostTold, study.unheard.size());
  if (told == 0) return out;
  std::vector<std::string> keys(study.unheard.begin(),
                                study.unheard.begin() + static_cast<std::ptrdiff_t>(told));
  if (study.unheard.size() > told)
    keys.push_back(fmt::format("{} more", study.unheard.size() - told));
  out.push_back(join_names(keys) +
                ": a search does not use what the study says there, as its fingers are those of "
                "`[population]`; say it in their files");
  return out;
}

std::string resolved_toml(const Study& study) {
  Node table = to_table(study.design, &study.origins);
  for (const Node& section : study.study_sections.children) table.set(section.key, section);
  return std::string(kResolvedHead) + write_toml(table);
}

}  // namespace papilla::design
