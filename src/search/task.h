// One task of one design evaluated: what a worker does.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

// A response as the text that reports of confirmed designs are made of.
using ResponseText = std::function<std::string(const Response&)>;

// How a task is evaluated. Confirmed: to the accuracy target of the study, with the samples behind
// the errors and the steps of the parameters, where the study has them.
struct TaskWork {
  Fidelity fidelity;
  bool confirmed = false;
  ResponseText text{};      // of a confirmed task; may be empty
  double most_seconds = 0;  // on the way to the target, as plans price it; 0: any
  bool flat = false;        // the design without its relief
};

// What a design answers under its tasks' counterface and, where a goal is about it, under its pen.
struct Responses {
  Response own;
  std::optional<Response> pen{};

  const Response& of(const StudyObjective& o) const { return o.expression.pen ? *pen : own; }
};

// A response without errors or to those of its fidelity. Where a goal is about contact areas, and
// no control skins say what the pixels leave out of them, a dry contact does (Eq. accuracy.17): at
// the level of a search friction would be half as much again as it is confirmed.
Response evaluate_for(const StudyGoals& goals, const Scene& scene, const Texture& texture,
                      const Fidelity& fidelity);
// What a study wants to know of a response beside the patches: its look, the voltages of
// voltage_for. An answer where the design has none: no theory of its look, no equilibrium.
std::optional<TaskAnswer> complete(Response& response, const StudyGoals& goals, const Scene& scene,
                                   const Design& design, const std::string& task,
                                   const Fidelity& fidelity);
// The numbers of a complete response that a study is about.
TaskAnswer answer_of(const StudyGoals& goals, const Design& design, const std::string& task,
                     const Responses& responses);
// Under its pen; nothing where no goal is about it.
std::optional<Response> pen_response(const StudyGoals& goals, const Design& design,
                                     const Fidelity& fidelity);

TaskAnswer evaluate_task(const StudyProblem& problem, const Design& design, std::size_t task,
                         const TaskWork& work);

// The steps of the parameters alone, for a task as designed whose finger has an `uncertainty`; of a
// belief its answer at each member too. With [accuracy] parameters a confirmed task has the steps.
// work: that of the confirmation. Where a goal is who feels it, the design is evaluated by it
// again: what members and steps say of that takes the errors of its modulation.
TaskAnswer evaluate_steps(const StudyProblem& problem, const Design& design, std::size_t task,
                          const TaskWork& work);

// What a worker does: a request in, an answer out. Refers to the problem.
Work work_function(const StudyProblem& problem, int threads, const ResponseText& text);

}  // namespace papilla::search
