#include "search/stability.h"

#include <algorithm>
#include <functional>

#include "forward/forward.h"
#include "metrics/metrics.h"
#include "search/task.h"

namespace papilla::search {
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
  const ModelOptions& model = problem.study().design.model;
  const Pin* pin = problem.study().design.counterface.in_place();
  // The water of the skin and its friction: what a person's finger has that a degreased one has
  // not.
  const Finger first =
      task_design(problem.study(), problem.study().design, problem.tasks().front()).finger;
  const bool clean = first.state == FingerState::Clean;
  if (!pin)
    out.push_back({clean ? "natural skin, not degreased" : "degreased skin", 0, [clean](Scene& s) {
                     s.finger.state = clean ? FingerState::Natural : FingerState::Clean;
                   }});
  if (!first.water.volume.empty() && !pin) {
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
  for (const auto& [name, law] :
       {std::pair("air insulates", AirLimit::None),
        std::pair("air breaks down at 350 V/um", AirLimit::Emission),
        std::pair("air breaks down, not below 12 V", AirLimit::Ionisation)}) {
    if (law != model.air_limit)
      out.push_back({name, 0, [law = law](Scene& s) { s.model.air_limit = law; }});
  }
  const bool once = model.coupling == Coupling::OnePass;
  out.push_back({once ? "equilibrium" : "one pass", 0, [once](Scene& s) {
                   s.model.coupling = once ? Coupling::Equilibrium : Coupling::OnePass;
                 }});
  return out;
}

// Better in everything that puts designs on the front: in every objective by more than the error of
// the difference, skin by skin where the samples of both are known; where belief decides, in the
// worst modulation too (on_front_of_belief).
bool beats(const StudyProblem& problem, const TaskAnswer& a, const TaskAnswer& b) {
  if (problem.belief() && problem.judged_at_amplitude() && a.worst <= b.worst) return false;
  const std::vector<StudyObjective>& objectives = problem.objectives();
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const TaskObjective &better = a.objectives[k], &worse = b.objectives[k];
    const double gain = (objectives[k].maximise ? 1 : -1) * (better.value - worse.value);
    std::optional<double> paired;
    if (k < a.samples.size() && k < b.samples.size())
      paired = difference_error(a.samples[k].front(), b.samples[k].front());
    if (gain <= paired.value_or(std::max(better.error, worse.error))) return false;
  }
  return true;
}

// What the limits of a study are judged by.
Score score_of_limits(const TaskAnswer& answer) {
  Score out;
  out.ok = true;
  out.oxide_margin = answer.oxide_margin;
  if (answer.look) out.looks = {*answer.look};
  out.limited = answer.limited;
  return out;
}

}  // namespace

std::vector<std::string> stability_variants(const StudyProblem& problem) {
  std::vector<std::string> out;
  for (const Variant& v : variants(problem)) out.push_back(v.name);
  return out;
}

std::optional<std::size_t> skin_variant(const StudyProblem& problem) {
  if (problem.study().design.counterface.in_place()) return std::nullopt;
  return problem.nominal_tasks();
}

TaskAnswer evaluate_variant(const StudyProblem& problem, const Design& design, std::size_t index,
                            const Fidelity& fidelity) {
  const Variant variant = variants(problem).at(index);
  const StudyTask& task = problem.tasks()[variant.task];
  const StudyGoals& goals = problem.goals();
  const Design d = task_design(problem.study(), design, task);
  Scene scene = scene_of(d);
  variant.change(scene);
  Responses both{evaluate_for(goals, scene, d.texture, fidelity), pen_response(goals, d, fidelity)};
  Response& response = both.own;
  if (auto refused = complete(response, goals, scene, d, variant.name, fidelity))
    return *std::move(refused);
  TaskAnswer out = answer_of(goals, d, variant.name, both);
  if (!out.status.ok()) return out;
  // Of the summaries themselves. A distance from a target has no samples of its own.
  for (const StudyObjective& o : goals.objectives) {
    out.samples.push_back(
        {o.aimed ? ErrorSamples{}
                 : error_samples(o.expression.summary, o.expression.metric, both.of(o))});
  }
  return out;
}

void set_confirmed_limits(const StudyProblem& problem, const std::vector<TaskAnswer>& confirmed,
                          std::vector<TaskAnswer>& answers) {
  const std::vector<Variant> all = variants(problem);
  const std::vector<TaskAnswer> own(answers.begin(),
                                    answers.begin() + static_cast<long>(problem.nominal_tasks()));
  for (std::size_t v = 0; v < all.size(); ++v) {
    const TaskAnswer &as_it_is = own.at(all[v].task), &known = confirmed.at(all[v].task);
    if (as_it_is.status.ok() && known.status.ok() && answers[v].status.ok())
      move_limits(problem.goals(), known, as_it_is, answers[v], answers[v]);
  }
}

Stability judge_stability(const StudyProblem& problem, const std::vector<Point>& designs,
                          const std::vector<std::vector<TaskAnswer>>& answers) {
  Stability out;
  out.times_on_front.assign(designs.size(), 0);
  const std::vector<std::string> names = stability_variants(problem);
  for (std::size_t v = 0; v < names.size(); ++v) {
    StabilityVariant result;
    result.name = names[v];
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const TaskAnswer& answer = answers[i][v];
      std::vector<double>& values = result.values.emplace_back();
      std::vector<LimitValue>& broken = result.broken.emplace_back();
      result.worst.push_back(answer.worst);
      result.unanswered.push_back(answer.status.text);
      if (!answer.status.ok()) continue;
      for (const TaskObjective& o : answer.objectives) values.push_back(o.value);
      broken =
          problem.constraints().values(problem.space().design(designs[i]), score_of_limits(answer));
      std::erase_if(broken, [](const LimitValue& limit) { return limit.kept(); });
    }
    // What breaks a limit is no design, and beats none.
    const auto counts = [&](std::size_t i) {
      return !result.values[i].empty() && result.broken[i].empty();
    };
    for (std::size_t i = 0; i < designs.size(); ++i) {
      std::optional<std::size_t>& by = result.beaten_by.emplace_back();
      for (std::size_t j = 0; j < designs.size() && counts(i) && !by; ++j) {
        if (j != i && counts(j) && beats(problem, answers[j][v], answers[i][v])) by = j;
      }
      result.on_front.push_back(counts(i) && !by);
      out.times_on_front[i] += result.on_front.back();
    }
    out.variants.push_back(std::move(result));
  }
  if (names.empty()) return out;
  out.other_skin = skin_variant(problem);
  out.first_choice = problem.nominal_tasks() + (out.other_skin ? 1 : 0);
  return out;
}

}  // namespace papilla::search
