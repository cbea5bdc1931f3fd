// The last stage of a run: what is said of the front and the best beside their numbers.
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "search/advice.h"
#include "search/building.h"
#include "search/levels.h"
#include "search/pick.h"
#include "search/stages.h"

namespace papilla::search {
namespace {

// Steps of the progress bar beside the designs of the front.
constexpr int kOtherChecks = 4;

std::size_t on_front(const OptimiseResult& result) {
  return static_cast<std::size_t>(std::count_if(result.finalists.begin(), result.finalists.end(),
                                                [](const auto& f) { return !f.folder.empty(); }));
}

// step: after each design, with the expected seconds of the others.
void check_stability(Run& run, const std::function<void(double)>& step) {
  const std::size_t variants = stability_variants(run.problem).size();
  const double seconds = run.seconds_of(on_front(run.result) * variants, Stage::Stability);
  if (!run.begin(RunPart::Stability, Stage::Stability, false, seconds)) return;
  std::vector<Point> designs;
  std::vector<std::vector<TaskAnswer>> answers;
  // The front comes first.
  for (const FinalDesign& f : run.result.finalists) {
    if (f.folder.empty()) break;
    std::vector<TaskRequest> requests;
    for (std::size_t v = 0; v < variants; ++v)
      requests.push_back({Stage::Stability, v, false, f.unit});
    designs.push_back(f.unit);
    answers.push_back(run.replay.answers(requests));
    set_confirmed_limits(run.problem, f.answers, answers.back());
    step(run.seconds_of((on_front(run.result) - answers.size()) * variants, Stage::Stability));
  }
  run.result.stability = judge_stability(run.problem, designs, answers);
}

// The best of the front by the rule asked for: over belief where there is one.
void pick(Run& run) {
  std::vector<PickCandidate> front;  // the first ones; none: the first finalist is best
  for (const FinalDesign& f : run.result.finalists) {
    if (f.on_front) front.push_back(pick_candidate(run.problem, f.confirmed));
  }
  run.replay.picked();
  if (front.empty()) return;
  const bool by_number =
      read_pick_rule(run.options.pick, front[0].names, run.problem.judged_at_amplitude()).kind ==
      PickRule::Kind::Number;
  if (run.result.decision.made() && !by_number) {
    run.result.best = run.result.decision.best;
    return;
  }
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
// where there is one, and that with the finish and drive of the study where the search changed
// them. Both keep the patch and skins of the best texture: flat glass on another patch differs by
// what its skins scatter.
void compare_with_flat(Run& run) {
  const auto keep = [&](std::optional<Score>& answered, std::optional<Score>& unanswered,
                        const Point& unit) {
    Score score = run.replay.scores({unit}, Stage::Confirm, true, run.confirm_seconds).front();
    (score.ok ? answered : unanswered) = std::move(score);
  };
  const FinalDesign& best = run.result.finalists[run.result.best];
  const bool textured = facts(run.study.design.texture).relief.present ||
                        facts(best.design.texture).relief.present,
             finish_differs = !changed_finish(run.problem, run.result).empty();
  const double seconds = run.seconds_of_designs(1, Stage::Confirm);
  if ((!textured && !finish_differs) || !run.begin(RunPart::Flat, Stage::Confirm, true, seconds))
    return;
  if (textured) keep(run.result.flat, run.result.flat_unanswered, best.unit);
  if (!finish_differs) return;
  if (!textured || run.goes_on(Stage::Confirm, true, seconds))
    keep(run.result.flat_before, run.result.flat_before_unanswered,
         run.problem.space().with_own_finish(best.unit));
  else
    run.cut(RunPart::Flat, 1, 2);
}

// What is built, moved by a step along each continuous variable.
void find_sensitivity(Run& run, const FinalDesign& made) {
  const MovedDesign centre{made.unit, made.flat};
  const std::vector<SensitivityMove> moves = sensitivity_moves(run.problem, centre);
  if (moves.empty() || !run.begin(RunPart::Sensitivity, Stage::Sensitivity, made.flat,
                                  run.seconds_of_designs(moves.size() + 1, Stage::Sensitivity)))
    return;
  std::vector<Point> points{made.unit};
  for (const SensitivityMove& move : moves) points.push_back(move.unit);
  std::vector<Score> moved = run.replay.scores(points, Stage::Sensitivity, made.flat);
  Score at_centre = std::move(moved.front());
  moved.erase(moved.begin());
  if (made.confirmed.ok) set_confirmed_limits(run.problem, made.confirmed, at_centre, moved);
  run.result.sensitivity = sensitivity(run.problem, centre, moves, at_centre, moved);
}

// What is not known of fingers and model, of the best, its surface without texture and, where the
// fingers name beliefs, of all of the front: few runs a design. Eq. accuracy.12, accuracy.15
void find_parameters(Run& run) {
  if (!run.problem.parameters_unknown().empty()) return;
  struct Unstated {
    Score* score;
    const Point* unit;
    bool flat;
  };
  OptimiseResult& result = run.result;
  FinalDesign& best = result.finalists[result.best];
  std::vector<Unstated> unstated;
  const auto add = [&](Score& score, const Point& unit, bool flat) {
    if (score.ok && score.parameter_steps.empty()) unstated.push_back({&score, &unit, flat});
  };
  add(best.confirmed, best.unit, false);
  if (result.flat) add(*result.flat, best.unit, true);
  for (FinalDesign& f : result.finalists) {
    if (run.problem.has_belief() && f.on_front && &f != &best) add(f.confirmed, f.unit, false);
  }
  std::size_t done = 0;
  for (const Unstated& of : unstated) {
    std::vector<TaskRequest> requests;
    for (std::size_t t = 0; t < run.problem.nominal_tasks(); ++t)
      requests.push_back({Stage::Steps, t, of.flat, *of.unit, run.confirm_seconds});
    const double seconds = run.seconds_of(requests.size(), Stage::Steps);
    const bool fits = done > 0 ? run.goes_on(Stage::Steps, of.flat, seconds)
                               : run.begin(RunPart::Parameters, Stage::Steps, of.flat, seconds);
    if (!fits) break;
    run.problem.add_steps(*of.score, run.replay.answers(requests));
    ++done;
  }
  if (done > 0) run.cut(RunPart::Parameters, done, unstated.size());
}

}  // namespace

void check(Run& run) {
  OptimiseResult& result = run.result;
  if (result.finalists.empty()) return;
  judge_belief(run);
  int done = 0;
  const int total = kOtherChecks + static_cast<int>(on_front(result));
  // left: of the part that is worked on; next: the parts that follow.
  const auto step = [&](int by, double left, RunPart next) {
    done += by;
    run.progress("check", done, total, left + run.seconds_from(next));
  };
  check_stability(run, [&](double left) { step(1, left, RunPart::Flat); });
  pick(run);
  FinalDesign& best = result.finalists[result.best];
  compare_with_flat(run);
  step(1, 0, RunPart::Rounding);
  if (best.confirmed.ok) {
    const FinalDesign recommended = recommended_design(run.problem, result);
    result.build = built_of(run, recommended);
    result.yield = run.problem.yield(result.build->made.design, result.build->made.confirmed);
    find_sensitivity(run, result.build->made);
    result.at_bound = variables_at_bound(run.problem, recommended.unit, result.sensitivity);
    std::erase_if(result.at_bound, [&](const AtBound& at) {
      return recommended.flat && run.study.variables[at.variable].path.starts_with("texture.");
    });
  }
  step(2, 0, RunPart::Parameters);
  find_parameters(run);
  step(1, 0, RunPart::Files);
}

}  // namespace papilla::search
