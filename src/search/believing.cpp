// The finalists at every member of belief: which of them are on the front, and which to build.
#include "search/stages.h"

namespace papilla::search {
namespace {

// The first task without an answer at the members, and why; "": all have one.
std::string without_members(const StudyProblem& problem, const std::vector<TaskAnswer>& answers) {
  for (std::size_t t = 0; t < answers.size(); ++t) {
    const TaskAnswer& answer = answers[t];
    if (answer.status.ok() && !answer.members.empty()) continue;
    return problem.tasks()[t].name + ": " +
           (answer.status.ok() ? "the answer has no members" : answer.status.text);
  }
  return {};
}

void judge_members(Run& run, FinalDesign& f) {
  std::vector<TaskRequest> requests;
  for (std::size_t t = 0; t < run.problem.nominal_tasks(); ++t)
    requests.push_back({Stage::Belief, t, false, f.unit, run.confirm_seconds});
  const std::vector<TaskAnswer> answers = run.replay.answers(requests);
  f.unjudged = without_members(run.problem, answers);
  if (!f.unjudged.empty()) return;
  run.problem.add_steps(f.confirmed, answers);
  add_members(run.problem, answers, f);
}

}  // namespace

std::size_t believed(const Run& run) { return run.problem.belief() ? run.may_hold() : 0; }

void judge_belief(Run& run) {
  OptimiseResult& result = run.result;
  const std::size_t count = believed(run);
  const auto seconds = [&](std::size_t designs) {
    return run.seconds_of(designs * run.problem.nominal_tasks(), Stage::Belief);
  };
  if (count > 0 && run.begin(RunPart::Belief, Stage::Belief, false, seconds(count))) {
    std::size_t done = 0;
    for (FinalDesign& f : result.finalists) {
      if (!f.feasible) continue;
      judge_members(run, f);
      ++done;
      run.progress("belief", static_cast<int>(done), static_cast<int>(count),
                   seconds(count - done) + run.seconds_from(RunPart::Stability));
    }
    const std::vector<bool> on_front = on_front_of_belief(run.problem, result.finalists);
    for (std::size_t i = 0; i < on_front.size(); ++i) result.finalists[i].on_front = on_front[i];
    order_finalists(run);
  }
  result.decision = decide(run.problem, result.finalists, run.options.pick);
}

}  // namespace papilla::search
