// The last stage of a run: what is said of the front and the best beside their numbers.
#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/error.h"
#include "search/levels.h"
#include "search/pick.h"
#include "search/rounding.h"
#include "search/stages.h"

namespace papilla::search {
namespace {

// Steps of the progress bar beside the designs of the front.
constexpr int kOtherChecks = 4;

std::size_t on_front(const OptimiseResult& result) {
  return static_cast<std::size_t>(std::count_if(result.finalists.begin(), result.finalists.end(),
                                                [](const auto& f) { return !f.folder.empty(); }));
}

// step: after each design; false: interrupted.
bool check_stability(Run& run, const std::function<void()>& step) {
  const std::size_t variants = stability_variants(run.problem).size();
  const double seconds = run.seconds_of(on_front(run.result) * variants, Stage::Stability);
  if (!run.begin(RunPart::Stability, Stage::Stability, false, seconds)) return true;
  std::vector<std::vector<TaskAnswer>> answers;
  // The front comes first.
  for (const FinalDesign& f : run.result.finalists) {
    if (f.folder.empty()) break;
    if (run.stopped()) return false;
    std::vector<TaskRequest> requests;
    for (std::size_t v = 0; v < variants; ++v)
      requests.push_back({Stage::Stability, v, false, f.unit});
    answers.push_back(run.replay.answers(requests));
    step();
  }
  run.result.stability = judge_stability(run.problem, answers);
  return true;
}

// The best of the front by the rule asked for.
void pick(Run& run) {
  std::vector<PickCandidate> front;  // the first ones; none: the first finalist is best
  for (const FinalDesign& f : run.result.finalists) {
    if (!f.on_front) continue;
    PickCandidate c;
    for (const StudyObjective& o : run.problem.objectives()) c.names.push_back(o.name);
    c.objectives = run.problem.outcome(f.confirmed).objectives;
    if (run.problem.driven()) c.worst = f.confirmed.worst;
    front.push_back(std::move(c));
  }
  run.replay.picked();
  if (front.empty()) return;
  try {
    run.result.best = pick_design(run.options.pick, front);
  } catch (const InputError& e) {
    // The results of a first run are worth more than the rule that fits none of them.
    if (run.folder.has("best/design.toml")) throw;
    run.result.best = pick_design("", front);
    run.unmet_pick = e.what();
  }
}

// What of the gain is the texture's and what the finish's: the best surface without its texture,
// and the study's own surface without texture where the search changed more than the texture.
void compare_with_flat(Run& run) {
  const auto keep = [&](std::optional<Score>& to, const Point& unit) {
    Score score = run.replay.scores({unit}, Stage::Confirm, true, run.confirm_seconds).front();
    if (score.ok) to = std::move(score);
  };
  const Point own = run.problem.space().unit_of_study();
  const Point& best = run.result.finalists[run.result.best].unit;
  bool finish_differs = false;
  for (std::size_t k = 0; k < own.size(); ++k) {
    finish_differs = finish_differs ||
                     (!run.study.variables[k].path.starts_with("texture.") && own[k] != best[k]);
  }
  const double seconds = run.seconds_of_designs(1, Stage::Confirm);
  if (!run.begin(RunPart::Flat, Stage::Confirm, true, seconds)) return;
  keep(run.result.flat, best);
  if (!finish_differs) return;
  const auto next = run.replay.next();
  const bool recorded = next && next->stage == Stage::Confirm && next->flat;
  if (recorded || (!run.replay.finished(Stage::Confirm, true) && run.fits(seconds)))
    keep(run.result.flat_before, own);
  else
    run.cut(RunPart::Flat, 1, 2);
}

// The best design as the fab draws it, at the level of the confirmation.
void round_best(Run& run) {
  const FinalDesign& best = run.result.finalists[run.result.best];
  if (!(run.study.search.rounding > 0) || !best.confirmed.ok) return;
  FinalDesign r;
  r.unit = rounded(run.problem, best.unit);
  if (r.unit == best.unit || !run.begin(RunPart::Rounding, Stage::Rounding, false,
                                        run.seconds_of_designs(1, Stage::Rounding)))
    return;
  r.design = run.problem.space().design(r.unit);
  r.confirmed = run.replay.scores({r.unit}, Stage::Rounding, false, run.confirm_seconds).front();
  r.feasible = r.confirmed.ok && run.problem.feasible(r.confirmed, r.unit);
  run.result.rounded = std::move(r);
}

// The best design moved by a step along each continuous variable.
void find_sensitivity(Run& run) {
  const FinalDesign& best = run.result.finalists[run.result.best];
  if (!best.confirmed.ok) return;
  const std::vector<SensitivityMove> moves = sensitivity_moves(run.problem, best.unit);
  if (moves.empty() || !run.begin(RunPart::Sensitivity, Stage::Sensitivity, false,
                                  run.seconds_of_designs(moves.size() + 1, Stage::Sensitivity)))
    return;
  std::vector<Point> points{best.unit};
  for (const SensitivityMove& move : moves) points.push_back(move.unit);
  const std::vector<Score> scores = run.replay.scores(points, Stage::Sensitivity);
  run.result.sensitivity = sensitivity(run.problem, best.unit, moves, scores.front(),
                                       {scores.begin() + 1, scores.end()});
}

// What the fit of the fingers leaves open. Eq. accuracy.12
void find_parameters(Run& run, Score& score, const Point& unit, bool flat) {
  if (!score.ok || !score.parameter_steps.empty() || !run.problem.parameters_unknown().empty())
    return;
  std::vector<TaskRequest> requests;
  for (std::size_t t = 0; t < run.problem.nominal_tasks(); ++t)
    requests.push_back({Stage::Steps, t, flat, unit, run.confirm_seconds});
  if (!run.begin(RunPart::Parameters, Stage::Steps, flat,
                 run.seconds_of(requests.size(), Stage::Steps)))
    return;
  run.problem.add_steps(score, run.replay.answers(requests));
}

}  // namespace

bool check(Run& run) {
  OptimiseResult& result = run.result;
  if (result.finalists.empty()) return true;
  int done = 0;
  const int total = kOtherChecks + static_cast<int>(on_front(result));
  const double from = run.clock.seconds();
  const auto step = [&](int by = 1) {
    done += by;
    run.progress("check", done, total, (run.clock.seconds() - from) / done * (total - done));
  };
  if (!check_stability(run, [&] { step(); }) || run.stopped()) return false;
  pick(run);
  if (facts(run.study.design.texture).relief.present) compare_with_flat(run);
  step();
  round_best(run);
  find_sensitivity(run);
  step(2);
  result.at_bound =
      variables_at_bound(run.problem, result.finalists[result.best].unit, result.sensitivity);
  FinalDesign& best = result.finalists[result.best];
  find_parameters(run, best.confirmed, best.unit, false);
  if (result.flat) find_parameters(run, *result.flat, best.unit, true);
  step();
  return true;
}

}  // namespace papilla::search
