#include "search/building.h"

#include <algorithm>
#include <cmath>

#include "optim/gaussian_process.h"
#include "search/advice.h"
#include "search/rounding.h"

namespace papilla::search {
namespace {

constexpr std::size_t kMostSought = 4000;   // designs of the grid, the nearest ones
constexpr std::size_t kMostModelled = 100;  // designs of the search, the nearest ones

// The smallest gain over the objectives, each over what it may lose: better in one is not paid with
// another. Eq. search.21
double merit(const std::vector<StudyObjective>& objectives, const std::vector<double>& here,
             const std::vector<double>& before) {
  double out = kInfinity;
  for (std::size_t k = 0; k < here.size(); ++k) {
    const double scale = tolerated_loss(objectives[k], before[k]);
    out = std::min(out, (before[k] - here[k]) / (scale > 0 ? scale : 1));
  }
  return out;
}

// What the search knows of the neighbourhood of a design: Gaussian processes through its nearest
// designs, for the steps from there.
class Neighbourhood {
 public:
  struct Predicted {
    double merit = 0, violation = 0;
  };

  Neighbourhood(const Run& run, const FinalDesign& centre)
      : search_(run.search),
        wanted_(run.problem.objectives()),
        centre_(centre.unit),
        confirmed_(run.problem.outcome(centre.confirmed)) {
    std::vector<const Evaluation*> known;
    for (const Evaluation& e : run.history.evaluations) {
      if (e.outcome.ok) known.push_back(&e);
    }
    const Point here = model_coordinates(search_, centre_);
    std::vector<Point> points;
    std::stable_sort(known.begin(), known.end(), [&](const Evaluation* a, const Evaluation* b) {
      return distance(here, a->unit) < distance(here, b->unit);
    });
    known.resize(std::min(known.size(), kMostModelled));
    if (known.size() < kFewest) return;
    for (const Evaluation* e : known) points.push_back(model_coordinates(search_, e->unit));
    const auto add = [&](std::vector<GaussianProcess>& to, auto number) {
      std::vector<double> values;
      for (const Evaluation* e : known) values.push_back(number(e->outcome));
      to.emplace_back(points, std::move(values));
    };
    for (std::size_t k = 0; k < confirmed_.objectives.size(); ++k)
      add(objectives_, [k](const Outcome& o) { return o.objectives[k]; });
    for (std::size_t k = 0; k < confirmed_.constraints.size(); ++k)
      add(constraints_, [k](const Outcome& o) { return o.constraints[k]; });
  }

  bool known() const { return !objectives_.empty(); }

  // The level is cheaper than the confirmation, and biased against it: only the step counts.
  Predicted at(const Point& unit) const {
    const auto step = [&](const GaussianProcess& of) {
      return of.predict(model_coordinates(search_, unit)).mean -
             of.predict(model_coordinates(search_, centre_)).mean;
    };
    std::vector<double> there;
    for (std::size_t k = 0; k < objectives_.size(); ++k)
      there.push_back(confirmed_.objectives[k] + step(objectives_[k]));
    Predicted out;
    out.merit = merit(wanted_, there, confirmed_.objectives);
    for (std::size_t k = 0; k < constraints_.size(); ++k)
      out.violation += std::max(0.0, confirmed_.constraints[k] + step(constraints_[k]));
    return out;
  }

 private:
  static constexpr std::size_t kFewest = 4;  // designs that say something of a slope

  double distance(const Point& here, const Point& unit) const {
    const Point there = model_coordinates(search_, unit);
    double sum = 0;
    for (std::size_t k = 0; k < here.size(); ++k) sum += square(there[k] - here[k]);
    return sum;
  }

  const SearchProblem& search_;
  const std::vector<StudyObjective>& wanted_;
  Point centre_;
  Outcome confirmed_;
  std::vector<GaussianProcess> objectives_, constraints_;
};

class Building {
 public:
  Building(Run& run, const FinalDesign& recommended) : run_(run), recommended_(recommended) {
    note_film(recommended);
  }

  BuiltDesign find() {
    std::vector<FinalDesign> grid = candidates();
    if (grid.empty()) return {recommended_, widened_, false};  // none keeps the limits of its shape
    BuiltDesign out{grid.front(), widened_};
    // What breaks a limit as it was searched cannot be held to it.
    if (!recommended_.feasible) {
      judge(out.made);
      return out;
    }
    std::optional<FinalDesign> best;
    bool stopped = false;
    for (const FinalDesign& next : in_order(std::move(grid))) {
      const std::size_t wanted = best ? kJudgedOnGrid : kMostJudgedOnGrid;
      if (judged_ >= wanted) break;
      if (!keeps_before_evaluation(next.design, true)) {
        out.widened = out.widened || judged_ == 0;
        continue;
      }
      if (judged_ == 0) out.made = next;  // what is built where there is no time to judge any
      FinalDesign made = next;
      if (stopped = !judge(made); stopped) break;
      note_film(made);
      if (judged_ == 1) out.nearest = made;
      if (made.feasible && (!best || worth(made) > worth(*best))) best = std::move(made);
    }
    out.judged = judged_;
    if (judged_ == 0 && stopped) return out;  // there was no time for it
    out.widened = out.widened || !out.nearest || !out.nearest->feasible;
    out.on_grid = best.has_value();
    out.made = best.value_or(recommended_);
    return out;
  }

 private:
  // Of the grid, the nearest first, that keep what is known of a shape at once.
  std::vector<FinalDesign> candidates() {
    GridDesigns designs(run_.problem, recommended_.unit, recommended_.flat);
    std::vector<FinalDesign> out;
    for (std::size_t k = 0; k < kMostSought; ++k) {
      const auto on_grid = designs.next();
      if (!on_grid) break;
      FinalDesign made = made_of(*on_grid);
      if (recommended_.feasible && !keeps_before_evaluation(made.design, false)) {
        widened_ = widened_ || out.empty();
        continue;
      }
      out.push_back(std::move(made));
      if (!recommended_.feasible) break;
    }
    return out;
  }

  // The nearest, then the best by the model; without one by their distance.
  std::vector<FinalDesign> in_order(std::vector<FinalDesign> grid) const {
    if (recommended_.flat) return grid;
    const Neighbourhood around(run_, recommended_);
    if (!around.known()) return grid;
    std::vector<std::pair<Neighbourhood::Predicted, std::size_t>> order;
    for (std::size_t i = 0; i < grid.size(); ++i) order.emplace_back(around.at(grid[i].unit), i);
    std::stable_sort(order.begin() + 1, order.end(), [](const auto& a, const auto& b) {
      if (a.first.violation != b.first.violation) return a.first.violation < b.first.violation;
      return a.first.merit > b.first.merit;
    });
    std::vector<FinalDesign> out;
    for (const auto& [predicted, i] : order) out.push_back(std::move(grid[i]));
    return out;
  }

  FinalDesign made_of(const GridDesign& on_grid) const {
    FinalDesign out;
    out.unit = on_grid.unit;
    out.flat = recommended_.flat;
    out.design = run_.problem.space().design_of(on_grid.value);
    if (out.flat) out.design.texture = Texture{};
    return out;
  }

  // Shape and film, and the look where it is asked for. The film's margin as much below what is
  // left of the film as it was found to be by the evaluations so far.
  bool keeps_before_evaluation(const Design& design, bool look) const {
    const StudyConstraints& constraints = run_.problem.constraints();
    const auto kept = [](const std::vector<double>& v) {
      return std::all_of(v.begin(), v.end(), [](double one) { return one <= 0; });
    };
    if (!kept(constraints.geometry(design)) || (look && !kept(constraints.look(design))))
      return false;
    const double film = film_share_ * constraints.film_margin(design);
    const std::vector<Constraint>& limits = run_.problem.study().constraints;
    return std::all_of(limits.begin(), limits.end(), [&](const Constraint& limit) {
      return !std::holds_alternative<FilmLimit>(limit.on) || keeps(limit, film);
    });
  }

  void note_film(const FinalDesign& judged) {
    const double left = run_.problem.constraints().film_margin(judged.design);
    if (judged.confirmed.ok && std::isfinite(left) && left > 0)
      film_share_ = std::min(film_share_, judged.confirmed.oxide_margin / left);
  }

  double worth(const FinalDesign& made) const {
    const std::vector<double> before = run_.problem.outcome(recommended_.confirmed).objectives;
    return merit(run_.problem.objectives(), run_.problem.outcome(made.confirmed).objectives,
                 before);
  }

  // At the level of the confirmation; false: there is no time for it.
  bool judge(FinalDesign& made) {
    if (made.unit == recommended_.unit) {
      made.confirmed = recommended_.confirmed;
    } else {
      const double seconds = run_.seconds_of_designs(1, Stage::Rounding);
      const bool goes_on = begun_
                               ? run_.goes_on(Stage::Rounding, made.flat, seconds)
                               : run_.begin(RunPart::Rounding, Stage::Rounding, made.flat, seconds);
      if (!goes_on) return false;
      begun_ = true;
      made.confirmed =
          run_.replay.scores({made.unit}, Stage::Rounding, made.flat, run_.confirm_seconds).front();
    }
    ++judged_;
    made.feasible = run_.problem.feasible(made.confirmed, made.design);
    return true;
  }

  Run& run_;
  const FinalDesign& recommended_;
  double film_share_ = 1;
  bool begun_ = false, widened_ = false;
  std::size_t judged_ = 0;
};

}  // namespace

BuiltDesign built_of(Run& run, const FinalDesign& recommended) {
  // The study's own surface stays as its file says: nothing of it was searched.
  const bool moves =
      run.study.search.rounding > 0 && advice_of(run.problem, run.result) != Advice::LeaveFlat;
  return moves ? Building(run, recommended).find() : BuiltDesign{recommended, false};
}

}  // namespace papilla::search
