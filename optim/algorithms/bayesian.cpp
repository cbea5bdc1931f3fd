#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "optim/algorithms/searchers.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"

namespace papilla::optim {
namespace {

constexpr std::size_t kCandidatesPerPoint = 50;  // of the first design
// Costly constraints asked for one point to evaluate.
constexpr int kCostlyChecks = 40;
// One point in so many explores, far from all others (docs/theory/search.md).
constexpr std::size_t kExploreEvery = 3;

double normal_density(double t) { return std::exp(-0.5 * t * t) / std::sqrt(2 * kPi); }

// Integral of the normal distribution function of (m, s) from -inf to z.
// Expected improvement below z. Eq. search.1
double integrated_cdf(double z, const Prediction& p) {
  if (p.sd <= 0) return std::max(0.0, z - p.mean);
  const double t = (z - p.mean) / p.sd;
  return p.sd * (normal_density(t) + t * normal_cdf(t));
}

class Bayesian : public Searcher {
 public:
  explicit Bayesian(const SearchProblem& problem) : problem_(problem) {
    const std::size_t n = problem.space.size();
    const auto third = static_cast<std::size_t>(std::max(6, problem.evaluations / 3));
    // Drafts know the landscape already: a few full evaluations fix their ratio.
    initial_ =
        static_cast<int>(std::clamp<std::size_t>(problem.drafts > 0 ? n + 4 : 3 * n + 4, 6, third));
    drafts_left_ = problem.drafts;
    if (!problem.known_drafts.empty()) {
      drafts_ = problem.known_drafts;
      drafts_left_ = initial_ = 0;
    }
  }

  bool asks_drafts() const override { return asking_drafts_; }

  std::vector<Point> ask() override {
    asking_drafts_ = false;
    if (problem_.space.single_point()) {
      if (!seen_.empty()) return {};
      return {problem_.space.snapped(Point(problem_.space.size(), 0.5))};
    }
    if (drafts_left_ > 0) {
      const std::vector<Point> points = draft_points();
      drafts_left_ = std::max(0, drafts_left_ - static_cast<int>(points.size()));
      asking_drafts_ = !points.empty();
      if (asking_drafts_) return points;
      drafts_left_ = 0;
    }
    if (static_cast<int>(seen_.size()) < initial_) return start_points();
    if (problem_.known_drafts.empty() && seen_.size() % kExploreEvery == 0) {
      std::vector<Point> out;
      fill(out, 1, seen_);
      if (!out.empty()) return out;
    }
    return next_or_none();
  }

  void tell(const std::vector<Evaluation>& evaluations) override {
    auto& list = asking_drafts_ ? drafts_ : seen_;
    list.insert(list.end(), evaluations.begin(), evaluations.end());
  }

 private:
  bool is_new(const Point& u, const std::vector<Evaluation>& known,
              const std::vector<Point>& others = {}) const {
    const auto same = [&](const Point& v) {
      for (std::size_t k = 0; k < u.size(); ++k) {
        if (std::abs(u[k] - v[k]) > problem_.apart) return false;
      }
      return true;
    };
    return std::none_of(known.begin(), known.end(),
                        [&](const Evaluation& e) { return same(e.unit); }) &&
           std::none_of(others.begin(), others.end(), same);
  }

  Point encoded(const Point& u) const { return model_coordinates(problem_, u); }

  // Points that keep the cheap constraints, added up to `count`: of a low-discrepancy set always
  // the one farthest from all others as the model sees them, so that the ends of every measure that
  // it sees are among them.
  void fill(std::vector<Point>& out, std::size_t count, const std::vector<Evaluation>& known) {
    if (out.size() >= count) return;
    std::vector<Point> free;
    std::vector<double> nearest;  // squared distance
    for (int tries = 0;
         free.size() < std::max<std::size_t>(200, kCandidatesPerPoint * count) && tries < 20000;
         ++tries) {
      const Point u =
          problem_.space.snapped(low_discrepancy(problem_.space.size(), problem_.seed, drawn_++));
      if (is_new(u, known, out) && (problem_.cheaply_feasible(u) || tries > 19000))
        free.push_back(u);
    }
    std::vector<Point> seen_as;
    for (const Point& u : free) seen_as.push_back(encoded(u));
    nearest.assign(free.size(), std::numeric_limits<double>::infinity());
    const auto near = [&](const Point& u) {
      const Point x = encoded(u);
      for (std::size_t i = 0; i < free.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < x.size(); ++k) sum += square(x[k] - seen_as[i][k]);
        nearest[i] = std::min(nearest[i], sum);
      }
    };
    for (const Evaluation& e : known) near(e.unit);
    for (const Point& u : out) near(u);
    int checks = kCostlyChecks;
    while (out.size() < count && !free.empty()) {
      const auto best = std::max_element(nearest.begin(), nearest.end());
      if (*best <= 0) break;
      const Point& u = free[static_cast<std::size_t>(best - nearest.begin())];
      // After the last check whatever comes: what it lacks is learned from its refusal.
      if (checks > 0 && problem_.costly_constraints && checks-- > 0 &&
          !problem_.feasible_before_evaluation(u)) {
        *best = 0;
        continue;
      }
      out.push_back(u);
      near(out.back());
    }
  }

  // Two thirds of the drafts spread over the space, the rest where they say that the front is: in
  // rounds, each point taking its prediction for an outcome until the round's outcomes are known.
  std::vector<Point> draft_points() {
    std::vector<Point> out;
    if (drafts_.empty()) {
      add_starts(out, drafts_);
      fill(out, std::max<std::size_t>(out.size(), static_cast<std::size_t>(2 * drafts_left_ / 3)),
           drafts_);
      return out;
    }
    constexpr int kRound = 8;
    std::vector<Evaluation> believed = drafts_;
    for (int i = 0; i < std::min(kRound, drafts_left_); ++i) {
      if (std::none_of(believed.begin(), believed.end(),
                       [](const Evaluation& e) { return e.outcome.ok; }))
        return {};
      fit(believed, nullptr, nullptr);
      const std::optional<Point> u = next_point(believed, false);
      if (!u) break;
      Evaluation belief{*u, {}};
      belief.outcome.ok = true;
      for (const auto& model : objectives_)
        belief.outcome.objectives.push_back(model.predict(encoded(*u)).mean);
      for (const auto& model : constraints_)
        belief.outcome.constraints.push_back(model.predict(encoded(*u)).mean);
      believed.push_back(belief);
      out.push_back(*u);
    }
    return out;
  }

  void add_starts(std::vector<Point>& out, const std::vector<Evaluation>& known) const {
    for (const Point& p : problem_.starts) {
      const Point u = problem_.space.snapped(p);
      if (is_new(u, known, out)) out.push_back(u);
    }
  }

  // The user's points, the drafts' front, then a low-discrepancy set.
  std::vector<Point> start_points() {
    std::vector<Point> out;
    if (seen_.empty()) add_starts(out, seen_);
    const auto count = static_cast<std::size_t>(initial_) - seen_.size();
    if (seen_.empty() && !drafts_.empty()) {
      std::vector<Point> front;
      std::vector<std::vector<double>> values;
      for (std::size_t i : pareto_front(drafts_)) {
        if (drafts_[i].outcome.objectives.empty() || !is_new(drafts_[i].unit, seen_, out)) continue;
        front.push_back(drafts_[i].unit);
        values.push_back(drafts_[i].outcome.objectives);
      }
      const std::size_t room = count > out.size() ? (count - out.size() + 1) / 2 : 0;
      for (std::size_t i : spread_points(values, room)) out.push_back(front[i]);
    }
    fill(out, count, seen_);
    if (out.empty()) initial_ = static_cast<int>(seen_.size());  // nothing new left
    if (!out.empty()) return out;
    return seen_.size() < 2 ? out : next_or_none();
  }

  // None: every point that is tried is known.
  std::vector<Point> next_or_none() {
    const std::optional<Point> next = next_point(seen_);
    return next ? std::vector<Point>{*next} : std::vector<Point>{};
  }

  // Models through `known`; drafts below them where given.
  void fit(const std::vector<Evaluation>& known,
           const std::vector<GaussianProcess>* draft_objectives,
           const std::vector<GaussianProcess>* draft_constraints) {
    std::vector<Point> points;
    std::vector<const Outcome*> outcomes;
    for (const Evaluation& e : known) {
      if (!e.outcome.ok) continue;
      points.push_back(encoded(e.unit));
      outcomes.push_back(&e.outcome);
    }
    const auto refit = [&](std::vector<DraftedProcess>& models, std::size_t count,
                           const std::vector<GaussianProcess>* drafts, auto value) {
      std::vector<DraftedProcess> fresh;
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<double> y;
        for (const Outcome* o : outcomes) y.push_back(value(*o, k));
        fresh.emplace_back(points, y, drafts && drafts->size() == count ? &(*drafts)[k] : nullptr,
                           models.size() == count ? &models[k] : nullptr);
      }
      models = std::move(fresh);
    };
    refit(objectives_, problem_.objectives, draft_objectives,
          [](const Outcome& o, std::size_t k) { return o.objectives[k]; });
    refit(constraints_, problem_.constraints, draft_constraints,
          [](const Outcome& o, std::size_t k) { return o.constraints[k]; });
    // Chance that an evaluation fails at all, from where others failed.
    failures_.clear();
    if (points.size() < known.size() && !points.empty()) {
      std::vector<Point> all;
      std::vector<double> failed;
      for (const Evaluation& e : known) {
        all.push_back(encoded(e.unit));
        failed.push_back(e.outcome.ok ? 0 : 1);
      }
      failures_.emplace_back(all, failed);
    }
  }

  // Processes through the drafts, once: no more drafts come after the first full evaluation.
  void fit_drafts() {
    if (!draft_objectives_.empty() || drafts_.empty()) return;
    std::vector<Point> points;
    for (const Evaluation& e : drafts_) {
      if (e.outcome.ok) points.push_back(encoded(e.unit));
    }
    if (points.size() < 4) return;
    const auto model = [&](std::size_t count, auto value) {
      std::vector<GaussianProcess> out;
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<double> y;
        for (const Evaluation& e : drafts_) {
          if (e.outcome.ok) y.push_back(value(e.outcome, k));
        }
        out.emplace_back(points, y);
      }
      return out;
    };
    draft_objectives_ =
        model(problem_.objectives, [](const Outcome& o, std::size_t k) { return o.objectives[k]; });
    draft_constraints_ = model(problem_.constraints,
                               [](const Outcome& o, std::size_t k) { return o.constraints[k]; });
    objectives_.clear();
    constraints_.clear();
  }

  // Eq. search.3: chance that every constraint holds and the evaluation succeeds.
  double feasibility(const Point& x) const {
    double p = 1;
    for (const DraftedProcess& model : constraints_) {
      const Prediction c = model.predict(x);
      p *= c.sd > 0 ? normal_cdf(-c.mean / c.sd) : (c.mean <= 0 ? 1 : 0);
    }
    for (const GaussianProcess& model : failures_)
      p *= std::clamp(1 - model.predict(x).mean, 0.0, 1.0);
    return p;
  }

  double acquisition(const Point& u) const {
    if (problem_.cheap_constraints) {
      double violation = 0;
      for (double c : problem_.cheap_constraints(u)) violation += std::max(0.0, c);
      if (violation > 0) return -violation;
    }
    const Point x = encoded(u);
    const double p = feasibility(x);
    if (!any_feasible_) return p;
    if (problem_.objectives == 1)
      return p * integrated_cdf(front_.front()[0], objectives_[0].predict(x));
    const Prediction a = objectives_[0].predict(x), b = objectives_[1].predict(x);
    // Eq. search.2: expected hypervolume improvement, strip by strip under the front.
    double sum = 0, lower = 0, height = reference_[1];
    for (std::size_t i = 0; i <= front_.size(); ++i) {
      const double upper = integrated_cdf(i < front_.size() ? front_[i][0] : reference_[0], a);
      sum += (upper - lower) * integrated_cdf(height, b);
      lower = upper;
      if (i < front_.size()) height = front_[i][1];
    }
    return p * sum;
  }

  void set_front(const std::vector<Evaluation>& known) {
    front_.clear();
    any_feasible_ = false;
    const std::vector<std::size_t> indices = pareto_front(known);
    for (std::size_t i : indices) {
      any_feasible_ = any_feasible_ || known[i].outcome.feasible();
      front_.push_back(known[i].outcome.objectives);
    }
    // Reference: the worst of the middle of what was seen, a tenth beyond.
    reference_.assign(problem_.objectives, 0);
    for (std::size_t k = 0; k < problem_.objectives; ++k) {
      std::vector<double> values;
      for (const Evaluation& e : known) {
        if (e.outcome.feasible()) values.push_back(e.outcome.objectives[k]);
      }
      if (values.empty()) continue;
      const double low = *std::min_element(values.begin(), values.end());
      const double high = quantile(values, 0.9);
      double end = low;  // the front's own far end must stay inside
      for (const auto& f : front_) end = std::max(end, f[k]);
      reference_[k] = std::max(high, end) + 0.1 * std::max(high - low, 1e-12);
    }
  }

  // Where the acquisition is highest, given what is known; nothing where no new point is found, as
  // of few choices. Models are fitted unless they fit.
  std::optional<Point> next_point(const std::vector<Evaluation>& known, bool fitting = true) {
    const bool any_ok =
        std::any_of(known.begin(), known.end(), [](const Evaluation& e) { return e.outcome.ok; });
    RandomStream random(problem_.seed, "acquisition", known.size());
    const std::size_t n = problem_.space.size();
    if (!any_ok) {  // nothing to learn from yet
      for (int tries = 0; tries < 2000; ++tries) {
        const Point u = problem_.space.snapped(low_discrepancy(n, problem_.seed, drawn_++));
        if (is_new(u, known) && problem_.cheaply_feasible(u)) return u;
      }
      const Point any = problem_.space.snapped(low_discrepancy(n, problem_.seed, drawn_++));
      return is_new(any, known) ? std::optional(any) : std::nullopt;
    }
    if (fitting) {
      fit_drafts();
      fit(known, &draft_objectives_, &draft_constraints_);
    }
    set_front(known);
    std::vector<Point> candidates;
    for (int i = 0; i < 1200; ++i) {
      Point u(n);
      for (double& v : u) v = random.uniform();
      candidates.push_back(u);
    }
    for (std::size_t i : pareto_front(known)) {
      for (int k = 0; k < 400 / static_cast<int>(std::max<std::size_t>(1, front_.size())) + 4;
           ++k) {
        Point u = known[i].unit;
        const double width = std::pow(10.0, random.uniform(-2.5, -0.5));
        for (double& v : u) v = std::clamp(v + width * random.normal(), 0.0, 1.0);
        candidates.push_back(u);
      }
    }
    Point best;
    double value = -std::numeric_limits<double>::infinity();
    int checks = kCostlyChecks;
    double apart = 0.1;  // of points that fail: beside one the next would fail too
    std::vector<Point> failed;
    const auto keeps_costly = [&](const Point& u) {
      if (!problem_.costly_constraints) return true;
      const auto beside = [&](const Point& v) {
        double most = 0;
        for (std::size_t k = 0; k < n; ++k) most = std::max(most, std::abs(u[k] - v[k]));
        return most < apart;
      };
      if (std::any_of(failed.begin(), failed.end(), beside) || checks <= 0) return false;
      --checks;
      if (problem_.feasible_before_evaluation(u)) return true;
      failed.push_back(u);
      return false;
    };
    if (problem_.costly_constraints) {  // the most promising first, to check few
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t i = 0; i < candidates.size(); ++i)
        order.emplace_back(-acquisition(problem_.space.snapped(candidates[i])), i);
      std::sort(order.begin(), order.end());
      std::vector<Point> sorted;
      for (const auto& [negative, i] : order) sorted.push_back(candidates[i]);
      candidates = std::move(sorted);
    }
    const auto consider = [&](const Point& raw) {
      const Point u = problem_.space.snapped(raw);
      const double a = acquisition(u);
      if (a <= value || !is_new(u, known) || !keeps_costly(u)) return false;
      value = a;
      best = u;
      return true;
    };
    for (const Point& u : candidates) consider(u);
    if (best.empty()) {  // the first new one, which breaks a costly limit
      for (const Point& raw : candidates) {
        const Point u = problem_.space.snapped(raw);
        if (is_new(u, known)) return u;
      }
      return std::nullopt;
    }
    checks = kCostlyChecks;
    apart = 1e-3;
    for (double step = 0.1; step > 2e-3; step *= 0.5) {  // pattern search from the best candidate
      bool moved = true;
      for (int round = 0; round < 8 && moved; ++round) {
        moved = false;
        const Point centre = best;
        for (std::size_t k = 0; k < n; ++k) {
          for (double sign : {1.0, -1.0}) {
            Point u = centre;
            u[k] = std::clamp(u[k] + sign * step, 0.0, 1.0);
            moved = consider(u) || moved;
          }
        }
      }
    }
    return best;
  }

  SearchProblem problem_;
  std::vector<Evaluation> seen_, drafts_;
  int initial_ = 0, drafts_left_ = 0;
  bool asking_drafts_ = false;
  std::uint64_t drawn_ = 0;
  std::vector<DraftedProcess> objectives_, constraints_;
  std::vector<GaussianProcess> failures_, draft_objectives_, draft_constraints_;
  std::vector<std::vector<double>> front_;
  std::vector<double> reference_;
  bool any_feasible_ = false;
};

}  // namespace

std::unique_ptr<Searcher> make_bayesian(const SearchProblem& problem) {
  return std::make_unique<Bayesian>(problem);
}

}  // namespace papilla::optim
