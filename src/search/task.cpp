#include "search/task.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "design/families.h"
#include "estimate/belief.h"
#include "estimate/evaluation.h"
#include "estimate/target.h"
#include "estimate/voltage.h"
#include "forward/dry_areas.h"
#include "search/levels.h"
#include "search/stability.h"

namespace papilla::search {
namespace {

// Root mean square distance from the target over humidity. Eq. search.11
double distance(const StudyObjective& o, const Response& response) {
  double sum = 0, total = 0;
  for (const ResponsePoint& p : response.points) {
    sum += p.weight * square(metric_at(o.expression.metric, p)->value - o.target);
    total += p.weight;
  }
  return std::sqrt(sum / total);
}

// The objective over what is not known of finger and model.
ModelReadings model_of(const StudyObjective& o, const Response& response) {
  Response there;
  there.driven = response.driven;
  there.appearance = response.appearance;
  const auto value = [&](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    there.points = points;
    const auto v = summarise(o.expression.summary, o.expression.metric, there);
    if (!v || !std::isfinite(v->value)) return std::nullopt;
    return o.aimed ? distance(o, there) : v->value;
  };
  return model_readings(response, value);
}

// What moves the finger leaves the pen: its own numbers have no errors stated.
std::vector<ModelReadings> model_of(const StudyGoals& goals, const Response& response) {
  std::vector<ModelReadings> out;
  for (const StudyObjective& o : goals.objectives)
    out.push_back(o.expression.pen ? ModelReadings{} : model_of(o, response));
  return out;
}

// The samples behind each number that each objective is made of, and behind the worst modulation.
void add_samples(const StudyGoals& goals, const Responses& responses, TaskAnswer& answer) {
  for (std::size_t k = 0; k < goals.objectives.size(); ++k) {
    const Response& response = responses.of(goals.objectives[k]);
    const MetricExpression& e = goals.objectives[k].expression;
    std::vector<ErrorSamples>& of = answer.samples.emplace_back();
    if (!goals.by_points(k)) {
      of.push_back(error_samples(e.summary, e.metric, response));
      continue;
    }
    for (std::size_t i = 0; i < response.points.size(); ++i)
      of.push_back(error_samples_at(i, e.metric, response));
  }
  answer.worst_samples = error_samples(Summary::Worst, kModulation, responses.own);
}

// Finalists are worth the target of the study; the search is not.
Response respond(const StudyGoals& goals, const Scene& scene, const Design& d,
                 const TaskWork& work) {
  if (!work.confirmed) return evaluate_for(goals, scene, d.texture, work.fidelity);
  if (d.accuracy.target <= 0) return evaluate(scene, d.texture, work.fidelity);
  return evaluate_to_target(scene, d.texture,
                            {.target = d.accuracy.target,
                             .first_skin = work.fidelity.first_skin,
                             .seed = work.fidelity.seed,
                             .droplet_seeds = work.fidelity.droplet_seeds,
                             .threads = work.fidelity.threads,
                             .most_seconds = work.most_seconds});
}

// A summary of the response; else the answer is that it is not defined.
std::optional<SummaryValue> defined(const StudyObjective& o, const std::string& task,
                                    const Response& response, TaskAnswer& answer) {
  auto value = summarise(o.expression.summary, o.expression.metric, response);
  if (value && std::isfinite(value->value)) return value;
  const std::string why = why_undefined(o.expression.metric, response);
  answer =
      TaskAnswer::refused(TaskStatus::Kind::NotDefined,
                          o.name + " is not defined for " + task + (why.empty() ? "" : ": " + why));
  return std::nullopt;
}

// Without the parameters of the finger.
double own_error(const SummaryValue& value) {
  ErrorParts own = value.parts;
  own.parameters.reset();
  return own.total();
}

TaskObjective objective_of(const StudyObjective& o, const SummaryValue& value,
                           const Response& response) {
  TaskObjective out;
  out.value = o.aimed ? distance(o, response) : value.value;
  out.error = own_error(value);
  const auto mean = summarise(Summary::Mean, o.expression.metric, response);
  for (const ResponsePoint& p : response.points) {
    const auto there = metric_at(o.expression.metric, p);
    out.points.push_back(there ? there->value : mean ? mean->value : 0);
  }
  return out;
}

// What the dielectric holds over what counts: the design's own amplitude, the voltages that
// voltage_for asks for, or both.
double oxide_margin(const StudyGoals& goals, const Design& d, const Response& response) {
  double out = kInfinity;
  for (const ResponsePoint& p : response.points) {
    if (goals.own_amplitude) out = std::min({out, p.oxide_margin, p.bridged_margin});
    for (const VoltageAnswer& v : p.voltages)
      out = std::min(out, breakdown_voltage(d.surface, d.texture, d.drive) / v.amplitude.value);
  }
  return out;
}

// What is not known of finger and model, on few skins; what these are run with.
Fidelity add_model_part(const StudyProblem& problem, const Scene& scene, const Design& d,
                        const Fidelity& fidelity, Response& response) {
  const Fidelity few = steps_fidelity(problem, fidelity);
  add_model_errors(response, scene, d.texture, few, few.skins);
  return few;
}

// Under the study's own amplitude; voltage_for stops below breakdown by itself. A limit on the
// dielectric knows how far beyond it a design is, which leads a search back.
bool breaks_down(const StudyGoals& goals, const Response& response) {
  return goals.own_amplitude && !goals.film &&
         std::any_of(response.points.begin(), response.points.end(),
                     [](const ResponsePoint& p) { return p.said().trouble == Trouble::Breakdown; });
}

// voltage_for stops below pull-in by itself, too.
bool pulled_in(const StudyGoals& goals, const Response& response) {
  return goals.own_amplitude &&
         std::any_of(response.points.begin(), response.points.end(),
                     [](const ResponsePoint& p) { return p.status.pull_in(); });
}

}  // namespace

Response evaluate_for(const StudyGoals& goals, const Scene& scene, const Texture& texture,
                      const Fidelity& fidelity) {
  return goals.areas && fidelity.control_skins < 2
             ? forward::evaluate_resolved(scene, texture, fidelity, forward::kFewDrySkins)
             : evaluate(scene, texture, fidelity);
}

std::optional<TaskAnswer> complete(Response& response, const StudyGoals& goals, const Scene& scene,
                                   const Design& d, const std::string& task,
                                   const Fidelity& fidelity) {
  using Kind = TaskStatus::Kind;
  if (goals.looks) {
    response.appearance = appearance_of(d);
    if (response.appearance->refused())
      return TaskAnswer::refused(Kind::LookRefused, response.appearance->warning);
  }
  if (pulled_in(goals, response) || breaks_down(goals, response))
    return TaskAnswer::refused(Kind::NoEquilibrium, task + ", " + forward::text(response.said()));
  set_bridged_margins(response, scene, d.texture);
  if (goals.pull_in) add_pull_in(response, scene, d.texture, fidelity);
  if (!goals.voltage_targets.empty())
    add_voltages(response, scene, d.texture, fidelity, goals.voltage_targets);
  return std::nullopt;
}

std::optional<Response> pen_response(const StudyGoals& goals, const Design& design,
                                     const Fidelity& fidelity) {
  if (!goals.pen) return std::nullopt;
  return evaluate_for(goals, scene_of(under_pen(design)), design.texture, fidelity);
}

TaskAnswer answer_of(const StudyGoals& goals, const Design& d, const std::string& task,
                     const Responses& responses) {
  const Response& response = responses.own;
  // The film is the same one under both.
  if (responses.pen && breaks_down(goals, *responses.pen))
    return TaskAnswer::refused(TaskStatus::Kind::NoEquilibrium,
                               task + ", pen, " + forward::text(responses.pen->said()));
  TaskAnswer out;
  for (const StudyObjective& o : goals.objectives) {
    const auto value = defined(o, task, responses.of(o), out);
    if (!value) return out;
    out.objectives.push_back(objective_of(o, *value, responses.of(o)));
  }
  for (const StudyObjective& o : goals.limited) {
    const auto value = defined(o, task, responses.of(o), out);
    if (!value) return out;
    out.limited.push_back(value->value);
    out.limited_errors.push_back(own_error(*value));
  }
  if (const auto w = summarise(Summary::Worst, kModulation, response)) out.worst = w->value;
  out.look = response.appearance;
  if (!response.parameters.steps.empty() || !response.belief.members.empty())
    out.model = model_of(goals, response);
  out.oxide_margin = oxide_margin(goals, d, response);
  return out;
}

TaskAnswer evaluate_task(const StudyProblem& problem, const Design& design, std::size_t index,
                         const TaskWork& work) {
  using Kind = TaskStatus::Kind;
  const StudyGoals& goals = problem.goals();
  const StudyTask& task = problem.tasks().at(index);
  const Design d = task_design(problem.study(), design, task, work.flat);
  if (const auto wrong = design_problems(d); !wrong.empty())
    return TaskAnswer::refused(Kind::ShapeRefused,
                               wrong.front().path + ": " + wrong.front().message);
  const Scene scene = scene_of(d);
  Responses both{respond(goals, scene, d, work)};
  Response& response = both.own;
  if (auto refused = complete(response, goals, scene, d, task.name, work.fidelity))
    return *std::move(refused);
  if (work.confirmed && task.nominal() && d.accuracy.parameters &&
      unknown_model(scene.finger).empty())
    add_model_part(problem, scene, d, work.fidelity, response);
  both.pen = pen_response(goals, d, work.fidelity);
  TaskAnswer out = answer_of(goals, d, task.name, both);
  if (!out.status.ok() || !work.confirmed) return out;
  add_samples(goals, both, out);
  if (work.text) out.report = work.text(response);
  return out;
}

namespace {

// What each member of the response's belief says of the goals, last the finger as it is.
std::vector<TaskAnswer> member_answers(const StudyGoals& goals, const Scene& scene, const Design& d,
                                       const std::string& task, const Response& response,
                                       const Fidelity& fidelity) {
  std::vector<Scene> scenes = belief_scenes(belief_of(scene.finger), scene);
  scenes.push_back(scene);
  const std::optional<Response> pen = pen_response(goals, d, fidelity);  // no member moves it
  std::vector<TaskAnswer> out;
  for (std::size_t m = 0; m < scenes.size(); ++m) {
    const bool own = m + 1 == scenes.size();
    Responses both{{}, pen};
    Response& there = both.own;
    static_cast<Resampled&>(there) = own ? response.belief.own : response.belief.members[m].run;
    there.driven = response.driven;
    auto refused = complete(there, goals, scenes[m], d, task, fidelity);
    out.push_back(refused ? *std::move(refused) : answer_of(goals, d, task, both));
    if (out.back().status.ok()) add_samples(goals, both, out.back());
  }
  return out;
}

}  // namespace

TaskAnswer evaluate_steps(const StudyProblem& problem, const Design& design, std::size_t task,
                          const TaskWork& work) {
  const Design d = task_design(problem.study(), design, problem.tasks().at(task), work.flat);
  const Scene scene = scene_of(d);
  Response response;
  if (problem.goals().felt) response = respond(problem.goals(), scene, d, work);
  if (problem.goals().looks) response.appearance = appearance_of(d);
  response.driven = scene.drive.driven();
  const Fidelity few = add_model_part(problem, scene, d, work.fidelity, response);
  TaskAnswer out;
  out.model = model_of(problem.goals(), response);
  if (!response.belief.members.empty())
    out.members = member_answers(problem.goals(), scene, d, problem.tasks()[task].name, response,
                                 belief_fidelity(few, few.skins));
  return out;
}

Work work_function(const StudyProblem& problem, int threads, const ResponseText& text) {
  return [&problem, threads, text](const Bytes& bytes) {
    const auto request = decode_request(bytes);
    PAPILLA_CHECK(request, "a request as it was encoded");
    Fidelity fidelity = stage_fidelity(problem, request->stage, request->most_seconds);
    fidelity.threads = threads;
    const Design design = problem.space().design(request->unit);
    switch (request->stage) {
      case Stage::Steps:
      case Stage::Belief:
        return encode(evaluate_steps(problem, design, request->task,
                                     {fidelity, true, {}, request->most_seconds, request->flat}));
      case Stage::Stability:
        return encode(evaluate_variant(problem, design, request->task, fidelity));
      case Stage::Search:
      case Stage::Draft:
      case Stage::Narrow:
      case Stage::Confirm:
      case Stage::Rounding:
      case Stage::Sensitivity:
      case Stage::Done:
        break;
    }
    const bool confirmed = request->stage == Stage::Confirm || request->stage == Stage::Rounding;
    return encode(evaluate_task(problem, design, request->task,
                                {fidelity, confirmed, text, request->most_seconds, request->flat}));
  };
}

}  // namespace papilla::search
