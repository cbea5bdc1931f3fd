// From the search's best designs to the confirmed front.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optim/pareto.h"
#include "search/levels.h"
#include "search/stages.h"

namespace papilla::search {
namespace {

// So many designs are confirmed in the confirmation's time, however short; the price of each is cut
// down to this share of what it is in full.
constexpr double kFewConfirmed = 3, kLeastConfirmation = 0.02;
// Where the fingers name a belief so many designs are confirmed at least, if there are as many that
// differ by this share of some variable's range.
constexpr std::size_t kLeastBelieved = 4;
constexpr double kApart = 0.15;

// Which designs of one level to judge at the next.
std::vector<std::size_t> chosen_of(const SearchProblem& search, const JudgedDesigns& designs,
                                   std::size_t most) {
  std::vector<std::size_t> chosen = promising(search, designs.evaluations, most);
  if (chosen.empty()) return chosen;
  // The one with the highest worst modulation is always among them.
  const std::vector<std::size_t> front = pareto_front(designs.evaluations);
  std::size_t steady = front.front();
  for (std::size_t i : front) {
    if (designs.worst[i] > designs.worst[steady]) steady = i;
  }
  if (std::find(chosen.begin(), chosen.end(), steady) == chosen.end()) chosen.push_back(steady);
  return chosen;
}

// The search's evaluations as drafts of the level above.
std::vector<Evaluation> known_drafts(const std::vector<Evaluation>& history) {
  std::vector<std::size_t> drafts;
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i].outcome.ok) drafts.push_back(i);
  }
  if (drafts.size() > kMostModelled) drafts = least_dominated(history, kMostModelled);
  std::vector<Evaluation> out;
  for (std::size_t i : drafts) out.push_back(history[i]);
  return out;
}

bool apart(const Point& a, const Point& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::abs(a[k] - b[k]) > kApart) return true;
  }
  return false;
}

// Of the designs that keep every limit and are unlike the chosen ones, the best in the first
// objective: where belief decides, one design has no rivals.
void add_rivals(const JudgedDesigns& below, std::vector<std::size_t>& chosen) {
  while (chosen.size() < kLeastBelieved) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < below.size(); ++i) {
      const Evaluation& e = below.evaluations[i];
      const bool unlike = std::all_of(chosen.begin(), chosen.end(), [&](std::size_t c) {
        return apart(e.unit, below.evaluations[c].unit);
      });
      if (!unlike || !e.outcome.feasible()) continue;
      if (!best || e.outcome.objectives[0] < below.evaluations[*best].outcome.objectives[0])
        best = i;
    }
    if (!best) return;
    chosen.push_back(*best);
  }
}

// The finalists, and the surface of the first one by the first objective without its texture: a
// texture of a nanometre must not pass for a design because its patch has other skins.
std::vector<Point> to_confirm(const Run& run, const JudgedDesigns& below) {
  std::vector<Point> out;
  const Evaluation* first = nullptr;
  std::vector<std::size_t> chosen = chosen_of(run.search, below, kFinalists);
  if (run.problem.belief()) add_rivals(below, chosen);
  for (std::size_t i : chosen) {
    const Evaluation& e = below.evaluations[i];
    out.push_back(e.unit);
    if (e.outcome.ok && (!first || e.outcome.objectives[0] < first->outcome.objectives[0]))
      first = &e;
  }
  // Second: where time is short, that much is known.
  const auto flat = first ? run.problem.space().flattened(first->unit) : std::nullopt;
  if (flat && run.search.feasible_before_evaluation(*flat) &&
      std::find(out.begin(), out.end(), *flat) == out.end())
    out.insert(out.begin() + 1, *flat);
  return out;
}

// What the search said of a design, the user's sign.
Score searched_score(const Run& run, const Point& unit) {
  Score out;
  for (const Evaluation& e : run.history.evaluations) {
    if (e.unit != unit) continue;
    out.ok = e.outcome.ok;
    for (std::size_t k = 0; k < e.outcome.objectives.size(); ++k) {
      const double v = e.outcome.objectives[k];
      out.values.push_back(run.problem.objectives()[k].maximise ? -v : v);
    }
    break;
  }
  return out;
}

FinalDesign finalist(Run& run, const Point& unit) {
  FinalDesign f;
  f.unit = unit;
  f.design = run.problem.space().design(unit);
  f.searched = searched_score(run, unit);
  std::vector<TaskRequest> requests;
  for (std::size_t t = 0; t < run.problem.tasks().size(); ++t)
    requests.push_back({Stage::Confirm, t, false, unit, run.confirm_seconds});
  f.answers = run.replay.answers(requests);
  f.confirmed = run.problem.score(f.design, f.answers);
  for (TaskAnswer& answer : f.answers) answer.report.clear();
  f.feasible = run.problem.feasible(f.confirmed, f.design);
  return f;
}

Evaluation as_evaluation(const StudyProblem& problem, const FinalDesign& f) {
  Evaluation e{f.unit, problem.outcome(f.confirmed)};
  if (f.confirmed.ok && !f.feasible && e.outcome.violation() <= 0)
    e.outcome.constraints.push_back(1);  // outside the fabrication limits
  return e;
}

// A design on the edge of a constraint holds on fresh skins in half of all cases: where no finalist
// does, the next safer one is confirmed too (Eq. search.13). Where none is left, the confirmation
// searches itself, by the level below with its limits tightened, until it has confirmed as many as
// ever.
class SaferDesigns {
 public:
  SaferDesigns(const Run& run, const JudgedDesigns& below)
      : run_(run), below_(known_drafts(below.evaluations)) {}

  std::optional<Point> next() {
    std::vector<Evaluation> confirmed;
    bool held = false;
    for (const FinalDesign& f : run_.result.finalists) {
      held = held || f.feasible;
      confirmed.push_back(as_evaluation(run_.problem, f));
    }
    if ((held && !searching_) || confirmed.size() > kFinalists) return std::nullopt;
    if (!searching_) {
      if (const auto safer = next_safer(below_, confirmed)) return below_[*safer].unit;
    }
    searching_ = true;
    SearchProblem problem = run_.search;
    problem.residuals = 0;
    problem.known_drafts = known_drafts(run_.history.evaluations);
    if (problem.objectives > 2 || problem.known_drafts.empty()) return std::nullopt;
    const auto searcher = make_searcher({"bayesian", ""}, problem);
    searcher->tell(tightened(below_, confirmed));
    const std::vector<Point> asked = searcher->ask();
    if (asked.empty() || !run_.search.feasible_before_evaluation(asked.front()))
      return std::nullopt;
    return asked.front();
  }

 private:
  const Run& run_;
  std::vector<Evaluation> below_;
  bool searching_ = false;
};

// The confirmed numbers decide the front and its order.
void judge(Run& run) {
  OptimiseResult& result = run.result;
  std::vector<Evaluation> confirmed;
  for (const FinalDesign& f : result.finalists) {
    confirmed.push_back(as_evaluation(run.problem, f));
    result.any_feasible = result.any_feasible || f.feasible;
  }
  if (!result.any_feasible)
    result.never_kept = run.problem.constraints().never_kept(run.history.evaluations);
  for (std::size_t i : pareto_front(confirmed)) {
    FinalDesign& f = result.finalists[i];
    f.on_front = f.feasible;
    if (!f.feasible && f.confirmed.ok) f.folder = "best";
  }
  order_finalists(run);
}

}  // namespace

void order_finalists(Run& run) {
  OptimiseResult& result = run.result;
  const bool maximise = run.problem.objectives()[0].maximise;
  std::stable_sort(result.finalists.begin(), result.finalists.end(),
                   [&](const FinalDesign& a, const FinalDesign& b) {
                     if (a.on_front != b.on_front) return a.on_front;
                     if (a.folder.empty() != b.folder.empty()) return b.folder.empty();
                     if (!a.confirmed.ok || !b.confirmed.ok) return a.confirmed.ok;
                     const double d = a.confirmed.values[0] - b.confirmed.values[0];
                     return maximise ? d > 0 : d < 0;
                   });
  int number = 0;
  for (FinalDesign& f : result.finalists) {
    if (f.on_front) f.folder = fmt::format("front/{:02d}", ++number);
  }
}

void narrow(Run& run) {
  const std::size_t count = narrowings(run.search);
  SearchProblem problem = run.search;
  problem.residuals = 0;
  problem.known_drafts = known_drafts(run.history.evaluations);
  if (count < 2 || problem.known_drafts.empty()) return;
  const auto searcher = make_searcher({"bayesian", ""}, problem);
  std::vector<Point> asked;
  for (std::size_t i : chosen_of(run.search, run.history, count / 2))
    asked.push_back(run.history.evaluations[i].unit);
  run.clock.enter(RunPart::Narrow);
  const bool done_before = run.replay.finished(Stage::Narrow);
  const double from = run.clock.seconds();
  const auto left_for = [&](std::size_t designs) {
    return run.replay.replaying() || run.fits(run.seconds_of_designs(designs, Stage::Narrow));
  };
  bool late = false;
  while (run.narrowed.size() < count) {
    late = !left_for(run.narrowed.size() == 0 ? kFewNarrowed : 1);
    if (late) break;
    if (done_before) {
      asked.clear();
      if (const auto unit = run.replay.next_unit(Stage::Narrow)) asked.push_back(*unit);
      late = asked.empty();  // the earlier run was
    } else if (asked.empty()) {
      asked = searcher->ask();
    }
    if (asked.empty() || !run.search.feasible_before_evaluation(asked.front())) break;
    const JudgedDesigns judged = run.replay.judged({asked.front()}, Stage::Narrow);
    run.narrowed.add(asked.front(), {judged.evaluations[0].outcome, judged.worst[0]});
    searcher->tell({run.narrowed.evaluations.back()});
    asked.erase(asked.begin());
    const auto done = static_cast<double>(run.narrowed.size());
    run.progress("narrow", static_cast<int>(done), static_cast<int>(count),
                 (run.clock.seconds() - from) / done * (static_cast<double>(count) - done) +
                     run.seconds_from(RunPart::Confirm));
  }
  if (late) run.cut(RunPart::Narrow, run.narrowed.size(), count);
}

namespace {

// What the confirmation may cost a task, so that the first designs fit into its time.
double confirm_budget(const Run& run) {
  if (const auto next = run.replay.next(); next && next->stage == Stage::Confirm)
    return next->most_seconds;
  const double full = run.seconds_of_designs(1, Stage::Confirm);
  if (!run.clock.limited() || !(full > 0)) return 0;
  const double each = std::max(0.0, run.clock.left(run.wanted())) / kFewConfirmed;
  const bool any_cost = run.study.design.accuracy.target > 0;  // a target's is known afterwards
  return any_cost || each < full
             ? std::max(kLeastConfirmation, each / full) * run.price(Stage::Confirm, 0)
             : 0;
}

}  // namespace

void confirm(Run& run) {
  run.clock.enter(RunPart::Confirm);
  const JudgedDesigns& below = run.narrowed.size() < kFewNarrowed ? run.history : run.narrowed;
  std::vector<Point> chosen = to_confirm(run, below);
  SaferDesigns safer(run, below);
  run.confirm_seconds = confirm_budget(run);
  run.result.confirmed_with = stage_fidelity(run.problem, Stage::Confirm, run.confirm_seconds);
  const bool done_before = run.replay.finished(Stage::Confirm);
  run.progress("confirm", 0, static_cast<int>(chosen.size()), run.seconds_from(RunPart::Confirm));
  for (std::size_t done = 0; done < chosen.size(); ++done) {
    const auto next = run.replay.next();
    const bool recorded = next && next->stage == Stage::Confirm && !next->flat;
    const bool fits = done == 0 || run.fits(run.seconds_of_designs(1, Stage::Confirm));
    if (!recorded && (done_before || !fits)) break;
    run.result.finalists.push_back(finalist(run, chosen[done]));
    if (done + 1 == chosen.size()) {
      if (const auto unit = safer.next()) chosen.push_back(*unit);
    }
    run.progress("confirm", static_cast<int>(done + 1), static_cast<int>(chosen.size()),
                 run.seconds_of_designs(chosen.size() - done - 1, Stage::Confirm) +
                     run.seconds_from(RunPart::Belief));
  }
  run.cut(RunPart::Confirm, run.result.finalists.size(), chosen.size());
  judge(run);
}

}  // namespace papilla::search
