#include "search/objectives.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "design/limits.h"

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

bool feels_drive(const StudyObjective& o) {
  return find_metric(o.expression.metric)->needs_drive && o.expression.metric != kAmplitude;
}

// The amplitude as a wish has to differ between designs, and something has to ask for it.
void check_amplitude(const Study& study, const StudyGoals& goals) {
  const bool searched = std::any_of(study.variables.begin(), study.variables.end(),
                                    [](const Variable& v) { return v.path == kAmplitude; });
  const bool fixed = !searched && study.design.drive.control == DriveControl::Voltage;
  const auto is_amplitude = [](const StudyObjective& o) {
    return o.expression.metric == kAmplitude;
  };
  const auto any = [](const std::vector<StudyObjective>& of, const auto& is) {
    return std::any_of(of.begin(), of.end(), is);
  };
  const bool wanted = any(goals.objectives, is_amplitude);
  if ((wanted || any(goals.limited, is_amplitude)) && fixed) {
    throw InputError(
        "objective: drive.amplitude is the same for all designs of this study; give it bounds in "
        "[design_space], \"drive.amplitude\" = [\"20 V\", \"250 V\"], or wish for "
        "\"worst(voltage_for(modulation = 0.3))\"");
  }
  const bool felt = any(goals.objectives, feels_drive) || any(goals.limited, feels_drive);
  if (wanted && !felt) {
    throw InputError(
        "objective: of drive.amplitude alone the lowest is best; say what it has to reach, as a "
        "second objective or in [constraints], e.g. \"worst(modulation)\" = 0.3");
  }
  if (searched && !felt && !goals.voltage_targets.empty()) {
    throw InputError(
        "design_space: drive.amplitude has no effect on voltage_for, which finds its own; leave "
        "the variable out, or minimise drive.amplitude under \"worst(modulation)\" = 0.3");
  }
}

}  // namespace

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
    if (limit_on(c) == LimitOn::Metric) add(goals.limited, wanted(c.name, c.at_least));
    goals.looks = goals.looks || limit_on(c) == LimitOn::Look;
  }
  if (goals.objectives.empty() || goals.objectives.size() > 3) {
    throw InputError(fmt::format("objective: one to three objectives are possible, got {}",
                                 goals.objectives.size()));
  }
  goals.risk = parse_risk(study.objective.risk);
  check_amplitude(study, goals);
  const auto own = [&](const std::vector<StudyObjective>& of) {
    return std::any_of(of.begin(), of.end(), feels_drive);
  };
  goals.own_amplitude =
      goals.voltage_targets.empty() || own(goals.objectives) || own(goals.limited);
  return goals;
}

}  // namespace papilla::search
