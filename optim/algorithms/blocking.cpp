// NLopt and others own their loops; each runs in a thread of its own that waits in the objective
// function until the searcher is told the outcome.
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <nlopt.hpp>
#include <optional>
#include <span>
#include <thread>

#include "optim/algorithms/searchers.h"
#include "optim/descent.h"
#include "optim/least_squares.h"

namespace papilla::optim {
namespace {

struct SearchEnded {};

class Blocking : public Searcher {
 public:
  explicit Blocking(std::function<void(const BlockingObjective&)> run) {
    thread_ = std::thread([this, run = std::move(run)] {
      try {
        run([this](const std::vector<Point>& u) { return wait_for(u); });
      } catch (...) {
        // The end of the search, or an optimiser that gave up (roundoff): both end the asking.
      }
      std::lock_guard lock(mutex_);
      finished_ = true;
      changed_.notify_all();
    });
  }

  ~Blocking() override {
    {
      std::lock_guard lock(mutex_);
      ended_ = true;
      changed_.notify_all();
    }
    thread_.join();
  }

  std::vector<Point> ask() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return question_.has_value() || finished_; });
    if (!question_) return {};
    return *question_;
  }

  void tell(const std::vector<Evaluation>& evaluations) override {
    if (evaluations.empty()) return;
    std::lock_guard lock(mutex_);
    answer_.emplace();
    for (const Evaluation& e : evaluations) answer_->push_back(e.outcome);
    question_.reset();
    changed_.notify_all();
  }

 private:
  std::vector<Outcome> wait_for(const std::vector<Point>& points) {
    std::unique_lock lock(mutex_);
    if (ended_) throw SearchEnded{};
    question_ = points;
    answer_.reset();
    changed_.notify_all();
    changed_.wait(lock, [&] { return answer_.has_value() || ended_; });
    if (!answer_ || answer_->size() < points.size()) throw SearchEnded{};  // a last, cut batch
    return *answer_;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::vector<Point>> question_;
  std::optional<std::vector<Outcome>> answer_;
  bool finished_ = false, ended_ = false;
  std::thread thread_;
};

}  // namespace

namespace {

// From 0, without a violation, to 1, of one that is not known.
double share_of_violation(const Outcome& outcome) {
  const bool known = outcome.ok || !outcome.constraints.empty();
  const double violation = known ? outcome.violation() : std::numeric_limits<double>::infinity();
  return std::isfinite(violation) ? violation / (1 + violation) : 1;
}

}  // namespace

std::vector<double> Penalty::finite(const Outcome& outcome, std::size_t objectives) {
  if (outcome.ok) {
    scale_.resize(objectives, 0);
    for (std::size_t k = 0; k < objectives && first_.empty(); ++k)
      scale_[k] = std::max(scale_[k], std::abs(outcome.objectives[k]));
  }
  if (outcome.feasible()) {
    if (first_.empty()) first_ = worst_ = best_ = outcome.objectives;
    for (std::size_t k = 0; k < objectives; ++k) {
      worst_[k] = std::max(worst_[k], outcome.objectives[k]);
      best_[k] = std::min(best_[k], outcome.objectives[k]);
    }
    return began_infeasible_ ? below_violations(outcome.objectives) : outcome.objectives;
  }
  if (first_.empty()) began_infeasible_ = true;
  const double share = share_of_violation(outcome);
  std::vector<double> out(objectives, share);
  for (std::size_t k = 0; k < objectives && !began_infeasible_; ++k) {
    const double span = std::max(worst_[k] - best_[k], 1e-6 * std::max(1.0, std::abs(worst_[k])));
    // Bounded: worst + 10 % for the smallest violation, at most one more span for the largest.
    out[k] = worst_[k] + span * (0.1 + share);
  }
  return out;
}

// From the first feasible values, in units of the largest known then; what is worse is bent so that
// it stays below 0, where the violations begin.
std::vector<double> Penalty::below_violations(const std::vector<double>& objectives) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const double x = (objectives[k] - first_[k]) / (scale_[k] > 0 ? scale_[k] : 1);
    out.push_back((x > 0 ? x / (1 + x) : x) - 1);
  }
  return out;
}

std::unique_ptr<Searcher> make_blocking(std::function<void(const BlockingObjective&)> run) {
  return std::make_unique<Blocking>(std::move(run));
}

std::unique_ptr<Searcher> make_least_squares(const SearchProblem& problem) {
  descent();  // here, where somebody catches what is thrown
  return make_blocking([problem](const BlockingObjective& objective) {
    const std::size_t n = problem.space.size();
    std::map<Point, Outcome> known;  // differences are taken twice where a step was refused
    std::vector<Point> starts = problem.starts;
    if (starts.empty()) starts.emplace_back(n, 0.5);
    for (std::uint64_t drawn = 0; drawn < 5000; ++drawn) {
      Point start;
      if (!starts.empty()) {
        start = starts.front();
        starts.erase(starts.begin());
      } else {
        start = low_discrepancy(n, problem.seed, drawn);
        if (!problem.cheaply_feasible(problem.space.snapped(start))) continue;
      }
      std::vector<FitParameter> parameters(n);
      for (std::size_t k = 0; k < n; ++k) {
        // One beyond the unit cube: steps relative to the parameter are then absolute ones.
        parameters[k].start = 1 + start[k];
        parameters[k].low = 1;
        parameters[k].high = 2;
        parameters[k].step = 0.02;
      }
      LeastSquaresOptions options;
      options.iterations = 20;
      options.noise = 1e-3;
      options.tolerance = 1e-4;
      options.profile_iterations = 0;
      least_squares(
          parameters, static_cast<int>(problem.residuals),
          [&](std::span<const double> p, std::span<double> r) {
            Point u(n);
            for (std::size_t k = 0; k < n; ++k) u[k] = std::clamp(p[k] - 1, 0.0, 1.0);
            u = problem.space.snapped(u);
            if (!known.contains(u)) known[u] = objective({u})[0];
            const Outcome& o = known[u];
            if (!o.feasible()) return false;
            std::copy_n(o.residuals.begin(), r.size(), r.begin());
            return true;
          },
          options);
    }
  });
}

namespace {

std::unique_ptr<Searcher> make_nlopt(nlopt::algorithm algorithm, const SearchProblem& problem) {
  return make_blocking([algorithm, problem](const BlockingObjective& objective) {
    Penalty penalty;
    const auto n = static_cast<unsigned>(problem.space.size());
    nlopt::srand(static_cast<unsigned long>(problem.seed));  // the generator is per thread
    std::vector<double> start =
        problem.starts.empty() ? std::vector<double>(n, 0.5)
                               : problem.space.unit(problem.space.value(problem.starts.front()));
    struct Call {
      const SearchProblem* problem;
      const BlockingObjective* objective;
      Penalty* penalty;
      std::vector<double> best;
      double value = std::numeric_limits<double>::infinity();
    } call{&problem, &objective, &penalty, start};
    const auto function = [](const std::vector<double>& u, std::vector<double>&, void* data) {
      auto& c = *static_cast<Call*>(data);
      const double f = c.penalty->finite((*c.objective)({c.problem->space.snapped(u)})[0], 1)[0];
      if (f < c.value) {
        c.value = f;
        c.best = u;
      }
      return f;
    };
    const auto minimise = [&](nlopt::algorithm which, double step, int budget) {
      nlopt::opt opt(which, n);
      opt.set_lower_bounds(0.0);
      opt.set_upper_bounds(1.0);
      opt.set_min_objective(function, &call);
      opt.set_xtol_abs(1e-4);
      opt.set_maxeval(budget);
      opt.set_initial_step(step);
      std::vector<double> x = call.best;
      double f = 0;
      opt.optimize(x, f);
    };
    const bool global = algorithm == nlopt::GN_DIRECT_L;
    minimise(algorithm, 0.2,
             global ? std::max(10, 2 * problem.evaluations / 3) : problem.evaluations);
    // A global search is polished; a local one that stopped early is started again, smaller.
    for (double step = 0.1; step > 1e-3; step *= 0.5)
      minimise(nlopt::LN_SBPLX, step, problem.evaluations);
  });
}

}  // namespace

std::unique_ptr<Searcher> make_bobyqa(const SearchProblem& problem) {
  return make_nlopt(nlopt::LN_BOBYQA, problem);
}
std::unique_ptr<Searcher> make_sbplx(const SearchProblem& problem) {
  return make_nlopt(nlopt::LN_SBPLX, problem);
}
std::unique_ptr<Searcher> make_direct(const SearchProblem& problem) {
  return make_nlopt(nlopt::GN_DIRECT_L, problem);
}

}  // namespace papilla::optim
