#include "forward/errors.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "numerics/statistics.h"

namespace papilla::forward {
namespace {

constexpr int kSmallestGrid = 16;  // of the control run on half the pixels; below it there is none
// What is missing to the limit over the last halving of the pixel: order 1.3 for the pull, 1.5 for
// other quantities. Training scenes of docs/theory/accuracy.md
constexpr double kPullToLimit = 0.7, kOtherToLimit = 0.55;
// What they are too large by through octaves that are left out is taken off; so much of it, one
// standard deviation, is not known.
constexpr double kNotKnown = 0.14;
// Features of so many pixels are resolved, of so many not at all: the last halving of the pixel
// then says what is missing, whole (lands and holes are off by a share of a pixel: first order).
constexpr double kResolvedFeature = 24, kCoarseFeature = 12;
// Below so many, half the pixels show next to nothing of them: more than the step is missing, in
// proportion (100 nm holes every 200 nm at 2.1 pixels: 10 % from half the pixels, 21 % to the
// limit).
constexpr double kLostFeature = 4;
// Of a step that drops an octave of the skin as well, so much is the features' own: the rest is the
// skin's, and taken off.
constexpr double kOfFeatures = 0.2;
// By the load law the modulation's way to the limit is part of its method error; half of that way
// is taken as not known. Eq. accuracy.2
constexpr double kUnknownShare = 0.5;

// of(k): the difference without skin k, -1: of all; no samples where it is not defined.
std::vector<double> samples_of(std::size_t skins,
                               const std::function<std::optional<double>(int)>& of) {
  const std::optional<double> all = of(-1);
  std::vector<double> without;
  for (std::size_t k = 0; k < skins; ++k) {
    const std::optional<double> one = of(static_cast<int>(k));
    if (!all || !one) return {};
    without.push_back(*one);
  }
  return jackknife_samples(*all, without);
}

// The number of a run without skin k, -1: of all.
std::optional<double> read(const Reading& number, const Resampled& run, int without) {
  return number(without < 0 ? run.points : run.without[static_cast<std::size_t>(without)]);
}

// b - a, relative to `of` (zero where that is) or by itself.
std::optional<double> change_of(Change kind, std::optional<double> b, std::optional<double> a,
                                std::optional<double> of) {
  if (!a || !b || !of) return std::nullopt;
  if (kind == Change::Absolute) return *b - *a;
  return *of != 0 ? (*b - *a) / std::abs(*of) : 0;
}

// Contact areas fall by the same factor with every octave of the skin's spectrum that is resolved,
// down to its cut-off: what they are too large by after `octaves` that are not. step: of the last
// octave. Relative to the area. Eq. accuracy.2
double left_out(double step, double octaves) { return 1 - std::pow(1 + step, -octaves); }

// What contact areas are too large by through octaves left out, of a step over the last of those
// that the grid resolves: as a factor on that step.
double left_out_of(double step, double octaves) {
  return step != 0 ? left_out(step, octaves) / step : octaves;
}

// Area error of the wavelengths that the grid resolves. Measured against 2048 pixels: 2.3, 0.8,
// 0.2 % at 2.1, 4.3, 8.5 pixels for the shortest (results/bench/contact_area.csv).
double resolved_area_error(double pixels_per_cutoff) {
  return 0.023 * std::pow(2.13 / pixels_per_cutoff, 1.5);
}

// What of the step from half the pixels is missing to the limit for features of so many pixels: 0
// where they are resolved. Eq. accuracy.2
double missing_of_features(double pixels) {
  return std::clamp((kResolvedFeature - pixels) / (kResolvedFeature - kCoarseFeature), 0.0, 1.0) *
         std::max(1.0, kLostFeature / std::max(pixels, 1.0));  // walls that meet leave no floor
}

// Of a step between two grids, what is the features' own: all where both resolve the skin alike.
// It is the step that drops waves of the skin, whether or not the finer grid has all of them.
double own_step(const Plan& fine, const Plan& coarse) {
  const double dropped = std::log2(coarse.effective_cutoff / fine.effective_cutoff);
  return 1 - (1 - kOfFeatures) * std::clamp(dropped, 0.0, 1.0);
}

// What a relative error at a humidity with `there` of a quantity says of another with `here`: small
// ones are alike over humidity; one as large as what is left is an absolute one, of less where more
// is left. Eq. accuracy.2
double alike(double error, double there, double here) {
  const double left = here != 0 ? std::min(std::abs(there / here), 1.0) : 1;
  if (left == 1 || error == 0) return 1;
  return square(left) / (square(left) + square(error) * (1 - square(left)));
}

}  // namespace

void level_out(std::vector<double>& size, const std::vector<double>& of) {
  const std::vector<double> own = size;
  for (std::size_t i = 0; i < size.size(); ++i) {
    double sum = 0, counted = 0;
    for (std::size_t j = 0; j < size.size(); ++j) {
      const double weight = alike(own[j], of[j], of[i]);
      sum += weight * square(own[j]);
      counted += weight;
    }
    size[i] = std::max(own[i], std::sqrt(sum / counted));  // its own counts whole
  }
}

double grid_error(const std::vector<double>& samples) {
  const Estimate e = mean_estimate(samples);
  return std::hypot(e.value, e.se);
}

double method_error(const std::vector<double>& samples) {
  const Estimate e = mean_estimate(samples);
  return std::sqrt(std::max(square(e.value) - square(e.se), 0.0));
}

ControlledChange controlled_change(const ControlRuns& runs, GridLaw quantity, const Reading& number,
                                   Change kind) {
  const bool load_law = !runs.areas.points.empty();
  const Resampled& fine = load_law ? runs.areas : runs.own;
  const bool to_limit = load_law && quantity == GridLaw::Modulation;
  const auto halving = [&](int k, const Resampled& of) {
    return change_of(kind, read(number, runs.coarse, k), read(number, fine, k),
                     read(number, of, k));
  };
  ControlledChange out;
  // With the load law, grids are compared by solved areas: its own steps between grids are partly
  // what it lacks against them. Eq. accuracy.2
  if (!runs.coarse.points.empty()) {
    out.halving = samples_of(fine.without.size(), [&](int k) { return halving(k, fine); });
    double missing = kOtherToLimit, scatter = 0;
    if (to_limit) missing *= kUnknownShare;
    // In equilibrium the pull falls by as much with every octave of the skin, and a modulation with
    // it.
    if (quantity == GridLaw::Pull) missing = std::max(kPullToLimit, runs.octaves);
    if (quantity == GridLaw::Modulation) missing *= std::max(runs.octaves, 1.0);
    // The step says how much the area depends on the cut-off, not how well that is resolved; that
    // of coarse features counts on any grid.
    if (quantity == GridLaw::Area) {
      const double all = left_out_of(grid_error(out.halving), runs.octaves);
      missing = std::max(kNotKnown * all, runs.coarse_features);
      scatter = std::max(0.0, all - missing);
    }
    // What is taken off is known as well as the control skins agree on it.
    const double mean = out.halving.empty() ? 0 : mean_estimate(out.halving).value;
    for (const double change : out.halving)
      out.grid.push_back(missing * change + scatter * (change - mean));
  }
  // Eq. accuracy.3
  if (load_law) {
    out.method = samples_of(fine.without.size(), [&](int k) {
      auto m = change_of(kind, read(number, fine, k), read(number, runs.own, k),
                         read(number, runs.own, k));
      if (!m || !to_limit || runs.coarse.points.empty()) return m;
      const auto last = halving(k, runs.own);
      return last ? std::optional(*m - kOtherToLimit * *last) : std::nullopt;
    });
  }
  return out;
}

ControlFidelities control_fidelities(const Fidelity& fidelity, const Plan& plan) {
  ControlFidelities out;
  out.skins = std::min(fidelity.control_skins, fidelity.skins);
  if (out.skins < 2) return {};
  Fidelity resolved = fidelity;
  resolved.skins = out.skins;
  if (fidelity.estimator == Estimator::Load && (plan.water || plan.field)) {
    resolved.estimator = Estimator::Area;
    out.areas = resolved;
  }
  if (fidelity.grid / 2 >= kSmallestGrid) {
    out.coarse = resolved;
    out.coarse->grid = fidelity.grid / 2;
    out.coarse->most_pixels =
        fidelity.pixels_per_side() / 2;  // else long patches keep their pixels
  }
  return out;
}

double resolved_areas(const ControlRuns& runs) {
  if (runs.coarse.points.empty() || runs.octaves <= 0) return 1;
  std::vector<double> steps;
  for (std::size_t i = 0; i < runs.own.points.size(); ++i) {
    const ControlledChange change =
        controlled_change(runs, GridLaw::Area, [&](const std::vector<ResponsePoint>& points) {
          return std::optional(points[i].area_fraction_off.value);
        });
    if (!change.halving.empty()) steps.push_back(mean_estimate(change.halving).value);
  }
  if (steps.empty()) return 1;
  const double step = mean_estimate(steps).value;
  return 1 - left_out(std::max(step, 0.0), runs.octaves);
}

namespace {

// The control skins of a set of patches, run again.
class Controls {
 public:
  Controls(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
           const FieldRatios& field, const ControlFidelities& by)
      : scene_(scene), texture_(texture), fidelity_(fidelity), field_(field), by_(by) {}

  // As it was, by solved areas where it was by the load law, and on half the pixels.
  void run(PatchSet& patches) {
    ControlRuns& out = patches.controls;
    PatchSet first = patches;
    for (auto& results : first.results) results.resize(static_cast<std::size_t>(by_.skins));
    first.solved.clear();  // by the law as it is, which its skins' areas are compared with
    out.own = respond(scene_, fidelity_, first);
    out.friction_by_load = scene_.touch.coefficient > 0;
    out.octaves =
        std::max(0.0, std::log2(patches.plan.effective_cutoff / patches.plan.skin_cutoff));
    if (by_.areas) {
      const PatchSet areas = again(*by_.areas, method);
      out.areas = respond(scene_, *by_.areas, areas);
      for (const auto& results : areas.results) {
        ModelStatus& status = method.pull_in.emplace_back();
        for (const PatchResult& p : results) {
          if (p.status.pull_in()) status.note(p.status);
        }
      }
    }
    if (by_.coarse) {
      const PatchSet coarse = again(*by_.coarse, grid);
      out.coarse = respond(scene_, *by_.coarse, coarse);
      out.coarse_features =
          missing_of_features(patches.plan.feature_pixels) * own_step(patches.plan, coarse.plan);
    }
  }

  MeasuredError grid{&ErrorParts::grid, {}}, method{&ErrorParts::method, {}};

 private:
  PatchSet again(const Fidelity& changed, MeasuredError& error) const {
    PatchSet set = solve_patches(scene_, texture_, changed, field_);
    error.seconds += set.seconds;
    error.costs += set.costs();
    return set;
  }

  const Scene& scene_;
  const Texture& texture_;
  const Fidelity& fidelity_;
  const FieldRatios field_;
  const ControlFidelities& by_;
};

// The two errors of quantity m at each humidity; resolved: that of areas on these pixels.
void state_errors(const ControlRuns& controls, std::size_t m, double resolved, MeasuredError& grid,
                  MeasuredError& method) {
  const std::vector<ResponsePoint>& own = controls.own.points;
  const bool load_law = !controls.areas.points.empty();
  const PointQuantity& quantity = kPointQuantities[m];
  const GridLaw grid_goes = grid_law(quantity.value, controls.friction_by_load);
  std::vector<double> of_grid, of_method, fine, law;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto number = [&](const std::vector<ResponsePoint>& points) {
      return std::optional((points[i].*quantity.value).value);
    };
    const ControlledChange change = controlled_change(controls, grid_goes, number);
    of_grid.push_back(grid_error(change.grid));
    // Few control skins may agree with the load law by chance: no less than they leave open.
    of_method.push_back(std::max(method_error(change.method), mean_estimate(change.method).se));
    law.push_back((own[i].*quantity.value).value);
    fine.push_back(load_law ? (controls.areas.points[i].*quantity.value).value : law.back());
  }
  level_out(of_grid, fine);
  level_out(of_method, law);
  for (std::size_t i = 0; i < own.size(); ++i) {
    grid.size[i][m] = of_grid[i];
    if (grid_goes == GridLaw::Area) grid.size[i][m] = std::hypot(of_grid[i], resolved);
    method.size[i][m] = of_method[i];
  }
}

}  // namespace

void measure_errors(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                    PatchSet& patches) {
  patches.errors.clear();
  patches.controls = {};
  patches.area_factor = 1;
  const ControlFidelities by = control_fidelities(fidelity, patches.plan);
  if (by.skins == 0) return;
  Controls again(scene, texture, fidelity, patches.field, by);
  again.run(patches);
  const ControlRuns& controls = patches.controls;
  patches.area_factor = resolved_areas(controls);
  const Grid& pixels = patches.plan.grid;
  const double resolved =
      resolved_area_error(patches.plan.effective_cutoff / std::max(pixels.dx(), pixels.dy()));
  again.grid.size.resize(controls.own.points.size());
  again.method.size.resize(controls.own.points.size());
  for (std::size_t m = 0; m < kPointQuantities.size(); ++m)
    state_errors(controls, m, resolved, again.grid, again.method);
  if (!controls.coarse.points.empty()) patches.errors.push_back(std::move(again.grid));
  if (!controls.areas.points.empty()) patches.errors.push_back(std::move(again.method));
}

}  // namespace papilla::forward
