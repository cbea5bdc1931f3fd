// From the search's best designs to the confirmed front.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/statistics.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"
#include "search/levels.h"
#include "search/rounding.h"
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
// The level between asks no design that differs from a judged one by less of every range, and the
// confirmation none beside one that failed, where no other holds.
constexpr double kAnotherDesign = 0.03;

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

// The numbers of a design as the fab would draw it; in full where it has no grid.
std::vector<double> as_drawn(const Run& run, const Point& unit) {
  std::vector<double> out = run.problem.space().value(unit);
  const double grid = run.study.search.rounding;
  for (std::size_t k = 0; k < out.size() && grid > 0; ++k)
    out[k] = on_grid(run.study.variables[k], out[k], grid);
  return out;
}

// Those of one level that are predicted to be the best; of two that the fab draws alike the first.
std::vector<std::size_t> predicted_best(const Run& run, const JudgedDesigns& below) {
  std::vector<std::size_t> out;
  std::vector<std::vector<double>> drawn;
  for (std::size_t i : chosen_of(run.search, below, kFinalists)) {
    std::vector<double> numbers = as_drawn(run, below.evaluations[i].unit);
    if (std::find(drawn.begin(), drawn.end(), numbers) != drawn.end()) continue;
    drawn.push_back(std::move(numbers));
    out.push_back(i);
  }
  return out;
}

// By more than this of some variable's range.
bool apart(const Point& a, const Point& b, double by) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::abs(a[k] - b[k]) > by) return true;
  }
  return false;
}

// Of the designs that keep every limit and are unlike the chosen ones, the best in each objective
// in turn: where belief decides, one design has no rivals, nor have several that are alike in one.
void add_rivals(const JudgedDesigns& below, std::vector<std::size_t>& chosen) {
  for (std::size_t turn = 0; chosen.size() < kLeastBelieved; ++turn) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < below.size(); ++i) {
      const Evaluation& e = below.evaluations[i];
      const bool unlike = std::all_of(chosen.begin(), chosen.end(), [&](std::size_t c) {
        return apart(e.unit, below.evaluations[c].unit, kApart);
      });
      if (!unlike || !e.outcome.feasible()) continue;
      const std::size_t k = turn % e.outcome.objectives.size();
      if (!best || e.outcome.objectives[k] < below.evaluations[*best].outcome.objectives[k])
        best = i;
    }
    if (!best) return;
    chosen.push_back(*best);
  }
}

// The best, their rivals, and the surface of the first one by the first objective without its
// texture: a texture of a nanometre must not pass for a design because its patch has other skins.
std::vector<Point> to_confirm(const Run& run, const JudgedDesigns& below,
                              std::vector<std::size_t> chosen) {
  std::vector<Point> out;
  const Evaluation* first = nullptr;
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

// What designs are predicted to gain beside those that held, times their chance to keep every
// limit, by models through what is known of the confirmation. Eq. search.3
class Promises {
 public:
  Promises(const Run& run, const std::vector<Evaluation>& known,
           const std::vector<Evaluation>& held)
      : run_(run), held_(held) {
    std::vector<Point> points;
    std::vector<const Outcome*> outcomes;
    for (const Evaluation& e : known) {
      if (!e.outcome.ok) continue;
      points.push_back(model_coordinates(run.search, e.unit));
      outcomes.push_back(&e.outcome);
    }
    const auto models = [&](std::vector<double> Outcome::*numbers, std::size_t count) {
      std::vector<GaussianProcess> out;
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<double> values;
        for (const Outcome* o : outcomes) values.push_back((o->*numbers)[k]);
        out.emplace_back(points, values);
      }
      return out;
    };
    objectives_ = models(&Outcome::objectives, run.search.objectives);
    limits_ = models(&Outcome::constraints, run.search.constraints);
  }

  // Over what may be lost, of the objective that gains most, beside the held one that leaves least.
  double of(const Point& unit) const {
    const Point at = model_coordinates(run_.search, unit);
    double chance = 1;
    for (const GaussianProcess& limit : limits_) {
      const Prediction c = limit.predict(at);
      chance *= c.sd > 0 ? normal_cdf(-c.mean / c.sd) : (c.mean <= 0 ? 1 : 0);
    }
    std::vector<double> there;
    for (const GaussianProcess& objective : objectives_)
      there.push_back(objective.predict(at).mean);
    double least = kInfinity;
    for (const Evaluation& h : held_) {
      double most = 0;
      for (std::size_t k = 0; k < there.size(); ++k) {
        const double here = h.outcome.objectives[k];
        most =
            std::max(most, (here - there[k]) / tolerated_loss(run_.problem.objectives()[k], here));
      }
      least = std::min(least, most);
    }
    return chance * least;
  }

 private:
  const Run& run_;
  const std::vector<Evaluation>& held_;
  std::vector<GaussianProcess> objectives_, limits_;
};

// A design on the edge of a constraint holds on fresh skins in half of all cases: where none of the
// best does, the next safer one of the levels below is confirmed too. What then holds may be far
// from the edge, and where nothing is left nothing does: the confirmation searches itself, by the
// level below with its limits tightened, while that promises more than may be lost of a design, or
// until it has confirmed as many as ever. Eq. search.13
class SaferDesigns {
 public:
  SaferDesigns(const Run& run, const JudgedDesigns& below, const std::vector<std::size_t>& best)
      : run_(run), below_(known_drafts(below.evaluations)) {
    for (std::size_t i : best) best_.push_back(below.evaluations[i].unit);
  }

  std::optional<Point> next() {
    std::vector<Evaluation> confirmed, held;
    for (const FinalDesign& f : run_.result.finalists) {
      confirmed.push_back(as_evaluation(run_.problem, f));
      if (!f.feasible) continue;
      if (std::find(best_.begin(), best_.end(), f.unit) != best_.end()) return std::nullopt;
      held.push_back(confirmed.back());
    }
    if (confirmed.size() > kFinalists) return std::nullopt;
    if (held.empty()) {
      // Those of the search as the level between says of them.
      const std::vector<Evaluation> all = tightened(run_.history.evaluations, below_);
      if (const auto safer = next_safer(all, confirmed)) return all[*safer].unit;
    }
    SearchProblem problem = run_.search;
    problem.residuals = 0;
    problem.known_drafts = known_drafts(run_.history.evaluations);
    if (problem.objectives > 2 || problem.known_drafts.empty()) return std::nullopt;
    if (held.empty()) {
      // Beside one that failed the next would hold by the luck of its patch alone.
      problem.cheap_constraints = [&confirmed,
                                   cheap = run_.search.cheap_constraints](const Point& u) {
        std::vector<double> out = cheap ? cheap(u) : std::vector<double>{};
        const bool beside =
            std::any_of(confirmed.begin(), confirmed.end(),
                        [&](const Evaluation& e) { return !apart(e.unit, u, kAnotherDesign); });
        out.push_back(beside ? 1 : -1);
        return out;
      };
    }
    const auto searcher = make_searcher({"bayesian", ""}, problem);
    const std::vector<Evaluation> known = tightened(below_, confirmed);
    searcher->tell(known);
    const std::vector<Point> asked = searcher->ask();
    if (held.empty()) {
      if (asked.empty() || !problem.feasible_before_evaluation(asked.front())) return std::nullopt;
      return asked.front();
    }
    return most_promising(asked, known, held);
  }

 private:
  // Of what the search asks of and the ways from what held to what is known of the levels below the
  // design that promises most, where that is more than may be lost.
  std::optional<Point> most_promising(std::vector<Point> candidates,
                                      const std::vector<Evaluation>& known,
                                      const std::vector<Evaluation>& held) const {
    constexpr int kSteps = 16;  // of a way
    for (const Evaluation& h : held) {
      for (const Evaluation& b : below_) {
        for (int step = 1; step < kSteps; ++step) {
          Point u = h.unit;
          for (std::size_t k = 0; k < u.size(); ++k) u[k] += (b.unit[k] - u[k]) * step / kSteps;
          candidates.push_back(run_.search.space.snapped(u));
        }
      }
    }
    const Promises promises(run_, known, held);
    std::optional<Point> out;
    double most = 1;
    for (const Point& u : candidates) {
      const bool confirmed = std::any_of(run_.result.finalists.begin(), run_.result.finalists.end(),
                                         [&](const FinalDesign& f) { return f.unit == u; });
      const double promise = promises.of(u);
      if (confirmed || !(promise > most) || !run_.search.feasible_before_evaluation(u)) continue;
      most = promise;
      out = u;
    }
    return out;
  }

  const Run& run_;
  std::vector<Evaluation> below_;
  std::vector<Point> best_;
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
  problem.apart = kAnotherDesign;
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
  const std::vector<std::size_t> best = predicted_best(run, below);
  std::vector<Point> chosen = to_confirm(run, below, best);
  SaferDesigns safer(run, below, best);
  run.chosen = chosen.size();
  run.confirm_seconds = confirm_budget(run);
  run.result.confirmed_with = stage_fidelity(run.problem, Stage::Confirm, run.confirm_seconds);
  const bool done_before = run.replay.finished(Stage::Confirm);
  run.progress("confirm", 0, static_cast<int>(chosen.size()), run.seconds_from(RunPart::Confirm));
  const auto recorded = [&]() -> std::optional<Point> {
    const auto next = run.replay.next();
    if (!next || next->stage != Stage::Confirm || next->flat) return std::nullopt;
    return next->unit;
  };
  for (std::size_t done = 0; done < chosen.size(); ++done) {
    const auto known = recorded();
    const bool fits = done == 0 || run.fits(run.seconds_of_designs(1, Stage::Confirm));
    if (!known && (done_before || !fits)) break;
    // A run that went on has confirmed these, whichever this version would choose.
    if (known && done_before) chosen[done] = *known;
    run.result.finalists.push_back(finalist(run, chosen[done]));
    if (done + 1 == chosen.size()) {
      const auto known_more = done_before ? recorded() : std::nullopt;
      if (const auto more = known_more ? known_more : safer.next()) chosen.push_back(*more);
      run.chosen = chosen.size();
    }
    run.progress("confirm", static_cast<int>(done + 1), static_cast<int>(chosen.size()),
                 run.seconds_of_designs(chosen.size() - done - 1, Stage::Confirm) +
                     run.seconds_from(RunPart::Belief));
  }
  run.cut(RunPart::Confirm, run.result.finalists.size(), chosen.size());
  run.chosen = run.result.finalists.size();
  judge(run);
}

}  // namespace papilla::search
