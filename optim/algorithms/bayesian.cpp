#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/random.h"
#include "base/statistics.h"
#include "optim/algorithms/searchers.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"

namespace papilla {
namespace {

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
    initial_ = static_cast<int>(std::clamp<std::size_t>(
        3 * n + 4, 6, static_cast<std::size_t>(std::max(6, problem.evaluations / 3))));
  }

  std::vector<Point> ask() override {
    if (problem_.space.single_point()) {
      if (!seen_.empty()) return {};
      return {problem_.space.snapped(Point(problem_.space.size(), 0.5))};
    }
    if (static_cast<int>(seen_.size()) < initial_) return start_points();
    return {next_point()};
  }

  void tell(const std::vector<Evaluation>& evaluations) override {
    for (const Evaluation& e : evaluations) seen_.push_back(e);
  }

 private:
  bool is_new(const Point& u, const std::vector<Point>& others = {}) const {
    const auto same = [&](const Point& v) {
      for (std::size_t k = 0; k < u.size(); ++k) {
        if (std::abs(u[k] - v[k]) > 1e-6) return false;
      }
      return true;
    };
    return std::none_of(seen_.begin(), seen_.end(),
                        [&](const Evaluation& e) { return same(e.unit); }) &&
           std::none_of(others.begin(), others.end(), same);
  }

  // The user's points, then a low-discrepancy set that keeps the cheap constraints.
  std::vector<Point> start_points() {
    std::vector<Point> out;
    if (seen_.empty()) {
      for (const Point& p : problem_.starts) {
        const Point u = problem_.space.snapped(p);
        if (is_new(u, out)) out.push_back(u);
      }
    }
    for (int tries = 0; static_cast<int>(seen_.size() + out.size()) < initial_ && tries < 4000;
         ++tries) {
      const Point u =
          problem_.space.snapped(low_discrepancy(problem_.space.size(), problem_.seed, drawn_++));
      if (is_new(u, out) && (problem_.cheaply_feasible(u) || tries > 3000)) out.push_back(u);
    }
    if (out.empty()) initial_ = static_cast<int>(seen_.size());  // nothing new left
    return out.empty() ? ask_exhausted() : out;
  }

  std::vector<Point> ask_exhausted() {
    if (seen_.size() < 2) return {};
    return {next_point()};
  }

  void fit() {
    std::vector<Point> points;
    std::vector<const Outcome*> outcomes;
    for (const Evaluation& e : seen_) {
      if (!e.outcome.ok) continue;
      points.push_back(e.unit);
      outcomes.push_back(&e.outcome);
    }
    const auto refit = [&](std::vector<GaussianProcess>& models, std::size_t count, auto value) {
      std::vector<GaussianProcess> fresh;
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<double> y;
        for (const Outcome* o : outcomes) y.push_back(value(*o, k));
        fresh.emplace_back(points, y, models.size() == count ? &models[k] : nullptr);
      }
      models = std::move(fresh);
    };
    refit(objectives_, problem_.objectives,
          [](const Outcome& o, std::size_t k) { return o.objectives[k]; });
    refit(constraints_, problem_.constraints,
          [](const Outcome& o, std::size_t k) { return o.constraints[k]; });
    // Chance that an evaluation fails at all, from where others failed.
    failures_.clear();
    if (points.size() < seen_.size() && !points.empty()) {
      std::vector<Point> all;
      std::vector<double> failed;
      for (const Evaluation& e : seen_) {
        all.push_back(e.unit);
        failed.push_back(e.outcome.ok ? 0 : 1);
      }
      failures_.emplace_back(all, failed);
    }
  }

  // Eq. search.3: chance that every constraint holds and the evaluation succeeds.
  double feasibility(const Point& u) const {
    double p = 1;
    for (const GaussianProcess& model : constraints_) {
      const Prediction c = model.predict(u);
      p *= c.sd > 0 ? normal_cdf(-c.mean / c.sd) : (c.mean <= 0 ? 1 : 0);
    }
    for (const GaussianProcess& model : failures_)
      p *= std::clamp(1 - model.predict(u).mean, 0.0, 1.0);
    return p;
  }

  double acquisition(const Point& u) const {
    if (problem_.cheap_constraints) {
      double violation = 0;
      for (double c : problem_.cheap_constraints(u)) violation += std::max(0.0, c);
      if (violation > 0) return -violation;
    }
    const double p = feasibility(u);
    if (!any_feasible_) return p;
    if (problem_.objectives == 1)
      return p * integrated_cdf(front_.front()[0], objectives_[0].predict(u));
    const Prediction a = objectives_[0].predict(u), b = objectives_[1].predict(u);
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

  void set_front() {
    front_.clear();
    any_feasible_ = false;
    const std::vector<std::size_t> indices = pareto_front(seen_);
    for (std::size_t i : indices) {
      any_feasible_ = any_feasible_ || seen_[i].outcome.feasible();
      front_.push_back(seen_[i].outcome.objectives);
    }
    // Reference: the worst of the middle of what was seen, a tenth beyond.
    reference_.assign(problem_.objectives, 0);
    for (std::size_t k = 0; k < problem_.objectives; ++k) {
      std::vector<double> values;
      for (const Evaluation& e : seen_) {
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

  Point next_point() {
    const bool any_ok =
        std::any_of(seen_.begin(), seen_.end(), [](const Evaluation& e) { return e.outcome.ok; });
    RandomStream random(problem_.seed, "acquisition", seen_.size());
    const std::size_t n = problem_.space.size();
    if (!any_ok) {  // nothing to learn from yet
      for (int tries = 0; tries < 2000; ++tries) {
        const Point u = problem_.space.snapped(low_discrepancy(n, problem_.seed, drawn_++));
        if (is_new(u) && problem_.cheaply_feasible(u)) return u;
      }
      return problem_.space.snapped(low_discrepancy(n, problem_.seed, drawn_++));
    }
    fit();
    set_front();
    std::vector<Point> candidates;
    for (int i = 0; i < 1200; ++i) {
      Point u(n);
      for (double& v : u) v = random.uniform();
      candidates.push_back(u);
    }
    for (std::size_t i : pareto_front(seen_)) {
      for (int k = 0; k < 400 / static_cast<int>(std::max<std::size_t>(1, front_.size())) + 4;
           ++k) {
        Point u = seen_[i].unit;
        const double width = std::pow(10.0, random.uniform(-2.5, -0.5));
        for (double& v : u) v = std::clamp(v + width * random.normal(), 0.0, 1.0);
        candidates.push_back(u);
      }
    }
    Point best;
    double value = -std::numeric_limits<double>::infinity();
    const auto consider = [&](const Point& raw) {
      const Point u = problem_.space.snapped(raw);
      const double a = acquisition(u);
      if (a <= value || !is_new(u)) return false;
      value = a;
      best = u;
      return true;
    };
    for (const Point& u : candidates) consider(u);
    if (best.empty()) return candidates.front();
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
  std::vector<Evaluation> seen_;
  int initial_ = 0;
  std::uint64_t drawn_ = 0;
  std::vector<GaussianProcess> objectives_, constraints_, failures_;
  std::vector<std::vector<double>> front_;
  std::vector<double> reference_;
  bool any_feasible_ = false;
};

}  // namespace

std::unique_ptr<Searcher> make_bayesian(const SearchProblem& problem) {
  return std::make_unique<Bayesian>(problem);
}

Point low_discrepancy(std::size_t dimensions, std::uint64_t seed, std::uint64_t i) {
  // Roberts' generalised golden ratio: phi solves x^(d+1) = x + 1; a random shift scrambles.
  double phi = 2;
  for (int k = 0; k < 60; ++k) phi = std::pow(1 + phi, 1.0 / (static_cast<double>(dimensions) + 1));
  Point u(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double step = std::pow(1 / phi, static_cast<double>(k + 1));
    u[k] = std::fmod(hash_uniform(seed, 77, k) + step * static_cast<double>(i + 1), 1.0);
  }
  return u;
}

}  // namespace papilla
