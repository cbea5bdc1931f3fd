#include "search/objectives.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace papilla::search {
namespace {

// The drive is given, or searched above 0 V.
bool always_driven(const Study& study, const std::vector<StudyTask>& tasks) {
  return std::all_of(tasks.begin(), tasks.end(),
                     [&](const StudyTask& t) {
                       return with_settings(study.design, t.settings).drive.driven();
                     }) ||
         std::any_of(study.variables.begin(), study.variables.end(), [](const Variable& v) {
           return (v.path == "drive.amplitude" || v.path == "drive.current") && v.low > 0;
         });
}

StudyObjective aimed_at(const Target& target) {
  return {{Summary::Mean, target.metric},
          false,
          fmt::format("distance({}, {:g})", target.metric, target.value),
          true,
          target.value};
}

StudyObjective wanted(const std::string& text, bool maximise) {
  const MetricExpression expression = parse_metric(text);
  return {expression, maximise, metric_text(expression)};
}

bool has_look(const StudyObjective& o) { return find_metric(o.expression.metric)->appearance; }

}  // namespace

bool on_metric(const Constraint& c) { return c.name.find('(') != std::string::npos; }

bool of_appearance(const Constraint& c) {
  const MetricInfo* info = find_metric(c.name);
  return info && info->appearance;
}

bool StudyGoals::by_points(std::size_t objective) const {
  const StudyObjective& o = objectives[objective];
  return o.aimed || (risk.kind != Risk::Kind::Mean && o.expression.summary == Summary::Mean);
}

StudyGoals study_goals(const Study& study, const std::vector<StudyTask>& tasks) {
  StudyGoals goals;
  const bool driven = always_driven(study, tasks);
  const auto add = [&](std::vector<StudyObjective>& list, StudyObjective objective) {
    const std::string& metric = objective.expression.metric;
    if (const auto modulation = voltage_target(metric)) {
      std::vector<double>& known = goals.voltage_targets;
      if (std::find(known.begin(), known.end(), *modulation) == known.end())
        known.push_back(*modulation);
    }
    if (find_metric(metric)->needs_drive && !driven) {
      throw InputError(
          fmt::format("objective: {} needs a driven design; the drive is at 0", objective.name));
    }
    goals.looks = goals.looks || has_look(objective);
    list.push_back(std::move(objective));
  };
  for (const std::string& text : study.objective.maximise)
    add(goals.objectives, wanted(text, true));
  for (const std::string& text : study.objective.minimise)
    add(goals.objectives, wanted(text, false));
  for (const Target& target : study.objective.targets) add(goals.objectives, aimed_at(target));
  for (const Constraint& c : study.constraints) {
    if (on_metric(c)) add(goals.limited, wanted(c.name, c.at_least));
    goals.looks = goals.looks || of_appearance(c);
  }
  if (goals.objectives.empty() || goals.objectives.size() > 3) {
    throw InputError(fmt::format("objective: one to three objectives are possible, got {}",
                                 goals.objectives.size()));
  }
  goals.risk = parse_risk(study.objective.risk);
  return goals;
}

}  // namespace papilla::search
