#include "estimate/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "forward/plan.h"
#include "metrics/metrics.h"

namespace papilla::estimate {
namespace {

constexpr double kSmallestTarget = 1e-4;
constexpr int kSmallestGrid = 64, kFewestSkins = 8;  // of the pilot; no plan has fewer
constexpr int kBatch = 8;                            // skins that are added at a time, at most
constexpr int kMostPlans = 5;  // changes of grid or estimator before the run ends unsettled
// Share of the target's square that grid, method and solver may take in a plan: the rest is left to
// sampling, whose error is known only within a third.
constexpr double kSystematicShare = 0.6;
// Where a target is out of reach: how near to the least error within the limits is near enough.
constexpr double kNearEnough = 1.1;

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
    fidelity_ = pilot_fidelity(options_);
    Response response = fresh(kFewestSkins, "pilot"), best = response;
    Parts best_parts = parts_;
    report_.target = options_.target;
    for (int plans = 0;;) {
      if (!(value_ > 0)) {
        report_.end = TargetEnd::NoRelativeError;
        break;
      }
      if (parts_.total() <= options_.target) break;
      const Choice choice = cheapest();
      if (!(choice.cost < kInfinity)) {
        report_.end = TargetEnd::TimeSpent;
        break;
      }
      if (choice.grid != fidelity_.grid || choice.estimator != fidelity_.estimator) {
        if (++plans > kMostPlans) {
          report_.end = TargetEnd::PlanUnsettled;
          break;
        }
        fidelity_.grid = choice.grid;
        fidelity_.estimator = choice.estimator;
        response = fresh(choice.skins, "planned");
      } else if (patches_.skins() >= choice.skins) {
        limits_reached(best_parts.total() < parts_.total() ? best_parts : parts_);
        break;
      } else {
        const int most = std::min(kBatch, options_.most_skins - patches_.skins());
        response = extended(std::min(most, std::max(choice.skins - patches_.skins(), kBatch / 4)));
      }
      // A new plan may come out worse than the last one, as errors are known within a third.
      if (parts_.total() <= best_parts.total() || !(best_parts.total() > 0)) {
        best = response;
        best_parts = parts_;
      }
    }
    if (best_parts.total() < parts_.total() && best_parts.total() > 0) {
      response = best;
      parts_ = best_parts;
    }
    report_.reached = parts_.total();
    response.accuracy = report_;
    response.seconds = seconds_;
    response.fft_pairs = costs_.fft_pairs;
    response.contact_solves = costs_.contact_solves;
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
    measure_errors(scene_, texture_, fidelity_, patches_);
    return measured(why, patches_.seconds, 0);
  }

  Response extended(int skins) {
    Fidelity more = fidelity_;
    more.skins = skins;
    more.first_skin = options_.first_skin + patches_.skins();
    const PatchSet batch = solve_patches(scene_, texture_, more, patches_.field, patches_.laws);
    const int before = patches_.skins();
    patches_.add(batch);
    return measured("more skins", batch.seconds, before);
  }

  // Parts of the answer so far; counts the work done since `before` skins.
  Response measured(const char* why, double seconds, int before) {
    Response response = respond(scene_, fidelity_, patches_);
    const auto mean = summarise(Summary::Mean, response.driven ? kModulation : kFriction, response);
    report_.quantity = response.driven ? "mean(modulation)" : "mean(friction)";
    value_ = mean ? std::abs(mean->value) : 0;
    parts_ = {};
    if (mean && value_ > 0) {
      parts_ = {mean->parts.sampling / value_, mean->parts.grid.value_or(0) / value_,
                mean->parts.method.value_or(0) / value_, mean->parts.solver.value_or(0) / value_};
    }
    seconds_ += seconds;
    spent_ += price(fidelity_.grid, fidelity_.estimator, patches_.skins() - before, before == 0);
    costs_ += patches_.costs(before);
    if (before == 0) {
      for (const MeasuredError& e : patches_.errors) {
        costs_ += e.costs;
        seconds_ += e.seconds;
      }
    }
    report_.steps.push_back(fmt::format(
        "{}: {} pixels, {}, {} skins: sampling {:.2f} %, grid {:.2f} %, method {:.2f} %, solver "
        "{:.2f} %",
        why, fidelity_.grid, fidelity_.estimator == Estimator::Load ? "load law" : "solved areas",
        patches_.skins(), 100 * parts_.sampling, 100 * parts_.grid, 100 * parts_.method,
        100 * parts_.solver));
    return response;
  }

  // Pixel of a plan: beyond a number of pixels per side, a finer grid is none.
  Grid patch(int grid) const {
    Fidelity at = fidelity_;
    at.grid = grid;
    return simulated_patch(texture_, grid, at.pixels_per_side());
  }

  // Error parts of a plan but for sampling, in squares. Eq. accuracy.5: the grid part falls with
  // the pixel.
  double systematic(int grid, Estimator estimator) const {
    const double grid_part = parts_.grid * patch(grid).dx() / patch(fidelity_.grid).dx();
    const double method = estimator == Estimator::Load ? parts_.method : 0;
    return square(grid_part) + square(method) + square(parts_.solver);
  }

  // Every plan within the limits that is no coarser than what was measured already and found
  // wanting: use(grid, estimator).
  template <class Use>
  void each_plan(const Use& use) const {
    for (int grid = fidelity_.grid; grid <= options_.largest_grid; grid *= 2) {
      for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
        if (estimator == Estimator::Load && fidelity_.estimator == Estimator::Area) continue;
        use(grid, estimator);
      }
    }
  }

  // One skin's scatter is that seen so far. Eq. accuracy.5
  double scatter() const {
    return parts_.sampling * std::sqrt(static_cast<double>(patches_.skins()));
  }

  // Expected of so many skins [s]; first: with the controls that measure the errors.
  double price(int grid, Estimator estimator, int skins, bool first) const {
    Fidelity f = fidelity_;
    if (!first) f.control_skins = 0;
    f.grid = grid;
    f.estimator = estimator;
    f.skins = skins;
    return make_plan(scene_, texture_, f).seconds();
  }
  bool affordable(int grid, Estimator estimator, int skins, bool first) const {
    return !(options_.most_seconds > 0) ||
           spent_ + price(grid, estimator, skins, first) <= options_.most_seconds;
  }

  // The cheapest plan inside a target; cost infinite: none. share: of its square that all but
  // sampling may take in a plan other than the present one. Eq. accuracy.6: work = skins x solves x
  // n^2 log n.
  Choice inside(double target, double share) const {
    Choice best;
    each_plan([&](int grid, Estimator estimator) {
      const double known = systematic(grid, estimator);
      const bool here = grid == fidelity_.grid && estimator == fidelity_.estimator;
      if (known >= (here ? 1 : share) * square(target)) return;
      const double needed = square(scatter()) / (square(target) - known);
      const int skins = std::max(kFewestSkins, static_cast<int>(std::ceil(std::min(needed, 1e6))));
      if (skins > std::max(options_.most_skins, kFewestSkins)) return;
      const int more = here ? skins - patches_.skins() : skins;
      if (more > 0 && !affordable(grid, estimator, more, !here)) return;
      const auto n = static_cast<double>(patch(grid).size());
      const double cost =
          std::max(more, 0) * (estimator == Estimator::Area ? 3 : 1) * n * std::log2(n);
      if (cost < best.cost) best = {grid, estimator, skins, cost};
    });
    return best;
  }

  // Where the target is out of reach, the cheapest plan next to the least error within the limits:
  // who asks for more than can be had gets no less than who asks for that. Where time is short the
  // nearest plan to the target that it is enough for and that gains something; or none.
  Choice cheapest() const {
    const Choice asked = inside(options_.target, kSystematicShare);
    if (asked.cost < kInfinity) return asked;
    double least = kInfinity;
    each_plan([&](int grid, Estimator estimator) {
      least = std::min(least, systematic(grid, estimator) +
                                  square(scatter()) / std::max(options_.most_skins, kFewestSkins));
    });
    const double reachable = std::max(kNearEnough * std::sqrt(least), options_.target);
    Choice near = inside(reachable, 1);
    for (double error = reachable; near.cost == kInfinity && options_.most_seconds > 0;) {
      error *= kNearEnough;
      if (error >= parts_.total()) break;
      near = inside(error, 1);
    }
    return near;
  }

  void limits_reached(const Parts& parts) {
    const std::array<std::pair<const char*, double>, 4> all{{{"sampling", parts.sampling},
                                                             {"grid", parts.grid},
                                                             {"method", parts.method},
                                                             {"solver", parts.solver}}};
    const auto largest = std::max_element(
        all.begin(), all.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    report_.end = TargetEnd::LimitsReached;
    report_.largest_part = largest->first;
    report_.largest_share = largest->second;
    report_.largest_grid = options_.largest_grid;
    report_.most_skins = options_.most_skins;
  }

  const Scene& scene_;
  const Texture& texture_;
  const TargetOptions& options_;
  Fidelity fidelity_;
  PatchSet patches_;
  Parts parts_;
  double value_ = 0;
  TargetReport report_;
  PatchCosts costs_;
  double seconds_ = 0;
  double spent_ = 0;  // as plans price it [s]
};

}  // namespace

Fidelity pilot_fidelity(const TargetOptions& options) {
  Fidelity f = fidelity_level("design");
  f.level = "target";
  f.seed = options.seed;
  f.droplet_seeds = options.droplet_seeds;
  f.threads = options.threads;
  f.contact_tolerance = std::clamp(options.target / 100, 1e-6, 1e-3);
  f.grid = kSmallestGrid;
  f.skins = kFewestSkins;
  f.estimator = Estimator::Load;
  return f;
}

Response evaluate_to_target(const Scene& scene, const Texture& texture,
                            const TargetOptions& options) {
  if (!(options.target >= kSmallestTarget))
    throw InputError({Problem{"", 0, 0, "accuracy.target",
                              fmt::format("expected {}% at least: grid and method leave more open "
                                          "at any cost",
                                          100 * kSmallestTarget)}});
  return TargetRun(scene, texture, options).run();
}

}  // namespace papilla::estimate
