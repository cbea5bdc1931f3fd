#include "forward/pull_in.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/parallel.h"
#include "forward/coupling.h"
#include "forward/electric_path.h"
#include "forward/field_ratio.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"

namespace papilla::forward {
namespace {

// The total load over the nominal one, from state to state.
constexpr double kFirstLoad = 1.05, kStep = 1.12;

// The top of a parabola through three points (x, y) with the middle one highest.
double top(const double (&x)[3], const double (&y)[3]) {
  const double d1 = (y[1] - y[0]) / (x[1] - x[0]), d2 = (y[2] - y[1]) / (x[2] - x[1]);
  const double bend = (d2 - d1) / (x[2] - x[0]);
  if (!(bend < 0)) return y[1];
  const double at = std::clamp(0.5 * (x[0] + x[1]) - 0.5 * d1 / bend, x[0], x[2]);
  return y[0] + (at - x[0]) * (d1 + bend * (at - x[1]));
}

// One patch on its way, at voltages over that of the drive.
class Branch {
 public:
  Branch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity)
      : patch_(problem, plan, fidelity),
        driven_(*problem.scene),
        peak_(source_voltage(driven_, problem.relative_humidity).peak) {
    driven_.drive.control = DriveControl::Voltage;
  }

  // The voltage at which the gap that an attraction [Pa] closes attracts so much: 0 where its water
  // alone does, at most kFarthestPullIn.
  double voltage(double attraction) {
    constexpr double kExact = 1e-3;
    constexpr int kBySquares = 12, kMost = 40;
    patch_.close(attraction);
    const double water = attracted(0), wanted = attraction - water;
    if (!(wanted > 0)) return 0;
    double low = 0, high = kFarthestPullIn;
    for (int k = 0;; ++k) {
      const double found = attracted(last_) - water;
      if (std::abs(found - wanted) <= kExact * wanted) break;
      if (found < wanted && last_ >= kFarthestPullIn) break;
      (found < wanted ? low : high) = last_;
      // The field's pull goes with the square of the voltage, or less: air that holds it and
      // droplets that come to bridge leave the rest to halving.
      const bool halves = k >= kBySquares;
      if (halves && (high - low <= kExact * high || k == kMost)) {
        last_ = high;
        break;
      }
      double next = found > 0 ? last_ * std::sqrt(wanted / found) : kFarthestPullIn;
      if (next >= kFarthestPullIn && high == kFarthestPullIn) next = kFarthestPullIn;
      if (halves || !(next > low && next <= high)) next = 0.5 * (low + high);
      last_ = next;
    }
    return last_;
  }

 private:
  double attracted(double times) {
    driven_.drive.amplitude = times * peak_;
    return patch_.attraction(driven_);
  }

  PatchBranch patch_;
  Scene driven_;
  double peak_;
  double last_ = 0.5;
};

struct Fold {
  double voltage = kFarthestPullIn;
  bool found = false;
};

Fold fold_of(Branch& branch, double pressure) {
  constexpr double kPast = 0.97;  // of the highest voltage: the branch has turned
  std::vector<double> loads, voltages;
  double highest = 0;
  // Loads that water alone holds lie before the branch, at no voltage; behind its beginning they
  // are where it has come back to none.
  for (double load = kFirstLoad; load < 1 + kClosingLoad; load *= kStep) {
    const double v = branch.voltage((load - 1) * pressure);
    if (v >= kFarthestPullIn) return {};
    loads.push_back(std::log(load));
    voltages.push_back(v);
    highest = std::max(highest, v);
    if (v < kPast * highest) break;
  }
  const auto at = static_cast<std::size_t>(std::max_element(voltages.begin(), voltages.end()) -
                                           voltages.begin());
  if (at + 1 == voltages.size()) return {highest, false};
  if (at == 0) return {highest, true};
  return {std::min(top({loads[at - 1], loads[at], loads[at + 1]},
                       {voltages[at - 1], voltages[at], voltages[at + 1]}),
                   kFarthestPullIn),
          true};
}

}  // namespace

PullIn pull_in(const Scene& scene, const Texture& texture, const Fidelity& given,
               double relative_humidity) {
  constexpr int kMostPixels = 128;
  Fidelity fidelity = given;
  fidelity.grid = std::min(given.grid, kMostPixels);
  const PatchSetup setup(scene, texture, fidelity);
  const auto kernel =
      contact_kernel(setup.scene(), setup.body(), setup.plan().grid, relative_humidity);
  const double pressure = ScaleBridge(setup.scene(), fidelity, setup.plan().grid, relative_humidity,
                                      setup.body(), setup.levels())
                              .mean_pressure();
  PAPILLA_CHECK(scene.drive.driven(), "a driven scene");
  if (!(pressure > 0)) return {{0, {}}, 1};
  Scene here = scene;
  here.environment.relative_humidity = {relative_humidity};
  here.environment.weights.clear();
  const FieldRatio field = field_ratios(here, texture, given).front();
  const int skins = std::min(std::max(fidelity.equilibrium_skins, 1), fidelity.skins);
  std::vector<Fold> folds(static_cast<std::size_t>(skins));
  parallel_for(
      skins,
      [&](int k) {
        const std::vector<double> height = setup.height(setup.skin(k));
        PatchProblem problem = setup.problem(height, *kernel, relative_humidity, pressure,
                                             {1, water_stream(fidelity.first_skin + k, 0)});
        problem.field_correction = field.correction;
        Branch branch(problem, setup.plan(), fidelity);
        folds[static_cast<std::size_t>(k)] = fold_of(branch, pressure);
      },
      fidelity.threads);
  std::vector<double> margins;
  PullIn out;
  for (const Fold& fold : folds) {
    margins.push_back(fold.voltage);
    out.folds += fold.found ? 1.0 / skins : 0;
  }
  const Estimate mean = mean_estimate(margins);
  out.margin = {mean.value, {.sampling = skins > 1 ? mean.se : 0}};
  // The pull goes with the square of the voltage.
  if (field.error) out.margin.parts.field = 0.5 * *field.error * mean.value;
  return out;
}

}  // namespace papilla::forward
