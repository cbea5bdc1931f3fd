#include "search/stability.h"

#include <cmath>
#include <functional>

#include "estimate/voltage.h"

namespace papilla {
namespace {

struct Variant {
  std::string name;
  std::size_t task = 0;
  std::function<void(Scene&)> change;
};

std::vector<Variant> variants(const StudyProblem& problem) {
  std::vector<Variant> out;
  for (std::size_t t = 0; t < problem.nominal_tasks(); ++t) {
    out.push_back({"finger " + problem.tasks()[t].name, t, [](Scene&) {}});
  }
  const Scene first{{}, problem.tasks().front().finger, {}, {}, {}};
  if (!first.finger.water.volume.empty()) {
    out.push_back({"first droplet step 50 nm", 0, [](Scene& s) { s.model.droplet_step = 50e-9; }});
    out.push_back(
        {"first droplet step 800 nm", 0, [](Scene& s) { s.model.droplet_step = 800e-9; }});
    out.push_back(
        {"a quarter of the droplets", 0, [](Scene& s) { s.finger.water.drops_per_um3 *= 0.25; }});
    out.push_back(
        {"three times the droplets", 0, [](Scene& s) { s.finger.water.drops_per_um3 *= 3; }});
    out.push_back({"droplets do not raise the pull", 0,
                   [](Scene& s) { s.model.droplet_enhancement = false; }});
  }
  out.push_back(
      {"breakdown cap", 0, [](Scene& s) { s.model.breakdown_cap = !s.model.breakdown_cap; }});
  out.push_back({"self-consistent coupling", 0, [](Scene& s) {
                   s.model.coupling = s.model.coupling == Coupling::OnePass
                                          ? Coupling::SelfConsistent
                                          : Coupling::OnePass;
                 }});
  return out;
}

// Better by the tolerance in every objective.
bool beats(const std::vector<StudyObjective>& objectives, const std::vector<double>& a,
           const std::vector<double>& b, double tolerance) {
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const double gain = objectives[k].maximise ? a[k] - b[k] : b[k] - a[k];
    if (gain <= tolerance * std::abs(b[k])) return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> stability_variants(const StudyProblem& problem) {
  std::vector<std::string> out;
  for (const Variant& v : variants(problem)) out.push_back(v.name);
  return out;
}

TaskAnswer evaluate_variant(const StudyProblem& problem, const Design& design, std::size_t index,
                            const Fidelity& fidelity) {
  const Variant variant = variants(problem).at(index);
  const StudyTask& task = problem.tasks()[variant.task];
  const StudyGoals& goals = problem.goals();
  const Design d = with_settings(design, task.settings);
  Scene scene{d.surface, task.finger, d.environment, d.drive, d.model};
  variant.change(scene);
  Response response = evaluate(scene, d.texture, fidelity);
  if (!goals.voltage_targets.empty())
    add_voltages(response, scene, d.texture, fidelity, goals.voltage_targets);
  if (goals.looks) response.appearance = appearance_of(d);
  TaskAnswer out;
  for (const StudyObjective& o : goals.objectives) {
    const auto v = summarise(o.expression.summary, o.expression.metric, response);
    if (!v || !std::isfinite(v->value))
      return TaskAnswer::refused(TaskStatus::Kind::NotDefined, o.name + " is not defined");
    out.objectives.push_back({v->value, v->se, {}});
  }
  return out;
}

Stability judge_stability(const StudyProblem& problem,
                          const std::vector<std::vector<TaskAnswer>>& answers, double tolerance) {
  const auto& objectives = problem.objectives();
  const std::size_t designs = answers.size();
  Stability out;
  out.times_on_front.assign(designs, 0);
  const std::vector<std::string> names = stability_variants(problem);
  for (std::size_t v = 0; v < names.size(); ++v) {
    StabilityVariant result;
    result.name = names[v];
    for (const auto& design : answers) {
      std::vector<double>& values = result.values.emplace_back();
      for (const TaskObjective& o : design[v].objectives) values.push_back(o.value);
    }
    for (std::size_t i = 0; i < designs; ++i) {
      bool front = !result.values[i].empty();
      for (std::size_t j = 0; j < designs && front; ++j) {
        if (j != i && !result.values[j].empty())
          front = !beats(objectives, result.values[j], result.values[i], tolerance);
      }
      result.on_front.push_back(front);
      out.times_on_front[i] += front;
    }
    out.variants.push_back(std::move(result));
  }
  return out;
}

}  // namespace papilla
