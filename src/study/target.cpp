#include "study/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "metrics/metrics.h"

namespace papilla {
namespace {

constexpr int kSmallestGrid = 64, kFewestSkins = 8, kBatch = 8, kMostPlans = 5;
// Share of the target's square that grid, method and solver may take in a plan: the rest is left to
// sampling, whose error is known only within a third.
constexpr double kSystematicShare = 0.6;

struct Parts {
  double sampling = 0, grid = 0, method = 0, solver = 0;  // relative

  double systematic() const { return std::sqrt(square(grid) + square(method) + square(solver)); }
  double total() const { return std::hypot(sampling, systematic()); }
};

class TargetRun {
 public:
  TargetRun(const Scene& scene, const Texture& texture, const TargetOptions& options)
      : scene_(scene), texture_(texture), options_(options) {}

  Response run() {
    fidelity_ = fidelity_level("design");
    fidelity_.level = "target";
    fidelity_.seed = options_.seed;
    fidelity_.threads = options_.threads;
    fidelity_.contact_tolerance = std::clamp(options_.target / 100, 1e-6, 1e-3);
    fidelity_.grid = kSmallestGrid;
    fidelity_.estimator = Estimator::Load;
    Response response = fresh(kFewestSkins, "pilot");
    std::string status = "reached";
    for (int plans = 0; !(parts_.total() <= options_.target);) {
      if (!(value_ > 0)) {
        status = quantity_ + " is zero: no relative error";
        break;
      }
      const Choice choice = cheapest();
      if (choice.grid != fidelity_.grid || choice.estimator != fidelity_.estimator) {
        if (++plans > kMostPlans) {
          status = "not reached: the plan does not settle";
          break;
        }
        fidelity_.grid = choice.grid;
        fidelity_.estimator = choice.estimator;
        response = fresh(std::min(choice.skins, options_.most_skins), "planned");
        continue;
      }
      if (patches_.skins() >= options_.most_skins || parts_.systematic() >= options_.target) {
        status = limit();
        break;
      }
      response = extended(std::clamp(choice.skins - patches_.skins(), kBatch / 4, kBatch));
    }
    response.accuracy = {options_.target, parts_.total(), quantity_, status, steps_};
    response.seconds = seconds_;
    response.fft_pairs = pairs_;
    response.contact_solves = solves_;
    return response;
  }

 private:
  struct Choice {
    int grid = 0;
    Estimator estimator = Estimator::Load;
    int skins = 0;
    double cost = kInfinity;
  };

  Response fresh(int skins, const char* why) {
    fidelity_.skins = std::max(skins, kFewestSkins);
    fidelity_.first_skin = options_.first_skin;
    patches_ = solve_patches(scene_, texture_, fidelity_);
    patches_.errors = measure_errors(scene_, texture_, fidelity_, patches_);
    return measured(why, patches_.seconds, 0);
  }

  Response extended(int skins) {
    Fidelity more = fidelity_;
    more.skins = skins;
    more.first_skin = options_.first_skin + patches_.skins();
    const PatchSet batch = solve_patches(scene_, texture_, more);
    const int before = patches_.skins();
    patches_.add(batch);
    return measured("more skins", batch.seconds, before);
  }

  // Parts of the answer so far; counts the work done since `before` skins.
  Response measured(const char* why, double seconds, int before) {
    Response response = respond(scene_, fidelity_, patches_);
    const auto mean =
        summarise(Summary::Mean, response.driven ? "modulation" : "friction", response);
    quantity_ = response.driven ? "mean(modulation)" : "mean(friction)";
    value_ = mean ? std::abs(mean->value) : 0;
    parts_ = {};
    if (mean && value_ > 0) {
      parts_ = {mean->parts.sampling / value_, mean->parts.grid.value_or(0) / value_,
                mean->parts.method.value_or(0) / value_, mean->parts.solver.value_or(0) / value_};
    }
    seconds_ += seconds;
    for (const auto& results : patches_.results) {
      for (std::size_t k = static_cast<std::size_t>(before); k < results.size(); ++k) {
        pairs_ += results[k].fft_pairs;
        solves_ += results[k].contact_solves;
      }
    }
    if (before == 0) {
      for (const MeasuredError& e : patches_.errors) {
        pairs_ += e.fft_pairs;
        solves_ += e.contact_solves;
        seconds_ += e.seconds;
      }
    }
    steps_.push_back(fmt::format(
        "{}: {} pixels, {}, {} skins: sampling {:.2f} %, grid {:.2f} %, method {:.2f} %, solver "
        "{:.2f} %",
        why, fidelity_.grid, fidelity_.estimator == Estimator::Load ? "load law" : "solved areas",
        patches_.skins(), 100 * parts_.sampling, 100 * parts_.grid, 100 * parts_.method,
        100 * parts_.solver));
    return response;
  }

  // Eq. accuracy.5: the grid part falls with the pixel; one skin's scatter is that seen so far.
  // Eq. accuracy.6: work = skins x solves x n^2 log n. Never coarser than what was measured already
  // and found wanting. Where nothing is inside, the finest grid with areas.
  Choice cheapest() const {
    const double scatter = parts_.sampling * std::sqrt(static_cast<double>(patches_.skins()));
    Choice best;
    for (int grid = fidelity_.grid; grid <= options_.largest_grid; grid *= 2) {
      for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
        if (estimator == Estimator::Load && fidelity_.estimator == Estimator::Area) continue;
        const double grid_part = parts_.grid * fidelity_.grid / grid;
        const double method = estimator == Estimator::Load ? parts_.method : 0;
        const double systematic = square(grid_part) + square(method) + square(parts_.solver);
        const bool here = grid == fidelity_.grid && estimator == fidelity_.estimator;
        if (systematic > (here ? 1 : kSystematicShare) * square(options_.target)) continue;
        const double needed = square(scatter) / (square(options_.target) - systematic);
        const int skins =
            std::max(kFewestSkins, static_cast<int>(std::ceil(std::min(needed, 1e6))));
        if (skins > options_.most_skins && !here) continue;
        const double n = square(static_cast<double>(grid));
        const double cost = (here ? skins - patches_.skins() : skins) *
                            (estimator == Estimator::Area ? 3 : 1) * n * std::log2(n);
        if (cost < best.cost) best = {grid, estimator, skins, cost};
      }
    }
    if (best.grid == 0) {
      best = {options_.largest_grid, Estimator::Area, kFewestSkins, kInfinity};
    }
    return best;
  }

  std::string limit() const {
    if (parts_.systematic() < options_.target)
      return fmt::format("not reached: sampling {:.1f} % at the largest number of skins, {}",
                         100 * parts_.sampling, options_.most_skins);
    return fmt::format("not reached: {} {:.1f} % at the finest grid, {} pixels",
                       parts_.grid > parts_.solver ? "grid" : "solver",
                       100 * std::max(parts_.grid, parts_.solver), fidelity_.grid);
  }

  const Scene& scene_;
  const Texture& texture_;
  const TargetOptions& options_;
  Fidelity fidelity_;
  PatchSet patches_;
  Parts parts_;
  double value_ = 0;
  std::string quantity_;
  std::vector<std::string> steps_;
  double seconds_ = 0, pairs_ = 0;
  int solves_ = 0;
};

}  // namespace

Response evaluate_to_target(const Scene& scene, const Texture& texture,
                            const TargetOptions& options) {
  return TargetRun(scene, texture, options).run();
}

}  // namespace papilla
