#include "search/objectives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "forward/patch_result.h"

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
          fmt::format("distance({} = {:g})", metric_text(target.metric), target.value),
          true,
          target.value};
}

StudyObjective wanted(const MetricExpression& expression, bool maximise) {
  return {expression, maximise, metric_text(expression)};
}

bool is_amplitude(const StudyObjective& o) {
  return std::holds_alternative<SourceAmplitude>(o.expression.metric);
}

bool feels_drive(const StudyObjective& o) {
  return info_of(o.expression.metric).needs_drive && !is_amplitude(o);
}

bool asks_for_sparkle(const Study& study, const StudyGoals& goals) {
  const auto is = [](const StudyObjective& o) {
    const auto* look = std::get_if<LookMetric>(&o.expression.metric);
    return look && look->number == &Look::sparkle;
  };
  return std::any_of(goals.objectives.begin(), goals.objectives.end(), is) ||
         std::any_of(study.constraints.begin(), study.constraints.end(), [](const Constraint& c) {
           const auto* limit = std::get_if<LookLimit>(&c.on);
           return limit && limit->number == &Look::sparkle;
         });
}

// The amplitude as a wish has to differ between designs, and something has to ask for it.
void check_amplitude(const Study& study, const StudyGoals& goals) {
  const bool searched = std::any_of(study.variables.begin(), study.variables.end(),
                                    [](const Variable& v) { return v.path == "drive.amplitude"; });
  const bool fixed = !searched && study.design.drive.control == DriveControl::Voltage;
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

// The pen is evaluated at the study's own drive.
void check_pen(const Study& study, const StudyObjective& o) {
  const Counterface& c = study.design.counterface;
  if (!c.has_pen())
    throw InputError("objective: " + o.name +
                     " is of a pen, and there is none: describe it under "
                     "[counterface.pen]");
  const Metric& metric = o.expression.metric;
  if (std::holds_alternative<VoltageFor>(metric) || std::holds_alternative<PullInMargin>(metric) ||
      std::holds_alternative<LookMetric>(metric) || std::holds_alternative<SourceAmplitude>(metric))
    throw InputError("objective: " + o.name +
                     " is not asked of a pen: its forces and its contact are");
  if (info_of(metric).needs_drive && !c.pen.conducting)
    throw InputError("objective: " + o.name +
                     " needs a field, and the pen does not conduct: counterface.pen.conducting");
}

}  // namespace

// Eq. search.9
double tolerated_loss(const StudyObjective& o, double value) {
  constexpr double kShare = 0.05;
  // A distance goes to 0 at its target, where 5 % of it would be lost at once.
  const double whole = o.aimed ? std::max(std::abs(value), std::abs(o.target)) : value;
  return std::hypot(kShare * whole, resolution(o.expression));
}

bool StudyGoals::by_points(std::size_t objective) const {
  const StudyObjective& o = objectives[objective];
  return o.aimed || (risk.kind != Risk::Kind::Mean && o.expression.summary == Summary::Mean);
}

std::size_t StudyGoals::place_of(const MetricLimit& limit) const {
  const auto found = std::find_if(limited.begin(), limited.end(), [&](const StudyObjective& o) {
    return o.expression == limit.expression;
  });
  PAPILLA_CHECK(found != limited.end(), "every limited metric is a goal");
  return static_cast<std::size_t>(found - limited.begin());
}

StudyGoals study_goals(const Study& study, const std::vector<StudyTask>& tasks) {
  StudyGoals goals;
  const bool driven = always_driven(study, tasks);
  const auto add = [&](std::vector<StudyObjective>& list, StudyObjective objective) {
    const Metric& metric = objective.expression.metric;
    if (const auto* voltage = std::get_if<VoltageFor>(&metric)) {
      std::vector<double>& known = goals.voltage_targets;
      if (std::find(known.begin(), known.end(), voltage->modulation) == known.end())
        known.push_back(voltage->modulation);
    }
    if (info_of(metric).needs_drive && !driven) {
      throw InputError(
          fmt::format("objective: {} needs a driven design; the drive is at 0", objective.name));
    }
    if (objective.expression.pen) {
      check_pen(study, objective);
      goals.pen = true;
    }
    goals.looks = goals.looks || std::holds_alternative<LookMetric>(metric);
    goals.pull_in = goals.pull_in || std::holds_alternative<PullInMargin>(metric);
    goals.felt = goals.felt || std::holds_alternative<Felt>(metric);
    const auto* quantity = std::get_if<QuantityMetric>(&metric);
    goals.areas = goals.areas ||
                  (quantity && forward::grid_law(quantity->quantity) == forward::GridLaw::Area);
    list.push_back(std::move(objective));
  };
  const auto wish = [&](const char* key, StudyObjective objective) {
    for (const StudyObjective& o : goals.objectives) {
      if (o.name == objective.name)
        throw InputError({Problem{study.file, 0, 0, key,
                                  o.name + " is an objective already: each is named once"}});
    }
    add(goals.objectives, std::move(objective));
  };
  for (const MetricExpression& e : study.objective.maximise)
    wish("objective.maximise", wanted(e, true));
  for (const MetricExpression& e : study.objective.minimise)
    wish("objective.minimise", wanted(e, false));
  for (const Target& target : study.objective.targets) wish("objective.target", aimed_at(target));
  for (const Constraint& c : study.constraints) {
    if (const auto* metric = std::get_if<MetricLimit>(&c.on))
      add(goals.limited, wanted(metric->expression, c.at_least));
    goals.looks = goals.looks || std::holds_alternative<LookLimit>(c.on);
    goals.yield = goals.yield || std::holds_alternative<YieldLimit>(c.on);
    goals.film = goals.film || (std::holds_alternative<FilmLimit>(c.on) && c.limit >= 1);
  }
  if (asks_for_sparkle(study, goals) && !study.design.view.panel.present()) {
    throw InputError(
        "objective: sparkle needs the subpixels of a panel; give view.panel.subpixel_width and "
        "view.panel.subpixel_height");
  }
  if (goals.objectives.empty()) {
    throw InputError(study.file +
                     ": a design and no study; add [design_space] and [objective] (`papilla "
                     "describe study`), or judge it alone with `papilla evaluate`");
  }
  if (goals.objectives.size() > 3) {
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
