// The grid and method parts of the error: a few skins run again, one choice changed at a time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "base/constants.h"
#include "forward/forward.h"

namespace papilla {
namespace {

using Row = std::array<double, kMeasured.size()>;

constexpr int kSmallestGrid = 16;
// What is missing to the limit over the last halving of the pixel: order 0.65 for contact areas
// (finer grids resolve more of the skin's spectrum), 1.5 for the rest. Grid table of
// docs/accuracy.md
constexpr double kAreaRest = 1.75, kOtherRest = 0.55;
// By the load law the modulation's way to the limit is part of its method error; half of that way
// is taken as not known. Eq. accuracy.2
constexpr double kUnknownRest = 0.5;
constexpr double kNothingLeft = 0.05;  // of the largest over humidity

PatchSet first_skins(const PatchSet& patches, int skins) {
  PatchSet out = patches;
  out.errors.clear();
  for (auto& results : out.results) results.resize(static_cast<std::size_t>(skins));
  return out;
}

std::vector<Row> values(const Scene& scene, const Fidelity& fidelity, const PatchSet& patches,
                        int without) {
  const Response response = respond(scene, fidelity, patches, without);
  std::vector<Row> rows(response.points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t m = 0; m < kMeasured.size(); ++m) {
      rows[i][m] = (response.points[i].*kMeasured[m]).value;
    }
  }
  return rows;
}

// One evaluation of some skins.
struct Run {
  const Scene* scene;
  Fidelity fidelity;
  PatchSet patches;
};

std::vector<Row> values(const Run& run, int without) {
  return values(*run.scene, run.fidelity, run.patches, without);
}

// A relative difference of runs on the same skins, without one of them (-1: of all).
using Difference = std::function<std::vector<Row>(int without)>;

// (b - a) / |of|, quantity by quantity; zero where `of` is.
std::vector<Row> relative(const std::vector<Row>& b, const std::vector<Row>& a,
                          const std::vector<Row>& of) {
  std::vector<Row> out(of.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (std::size_t m = 0; m < kMeasured.size(); ++m)
      out[i][m] = of[i][m] != 0 ? (b[i][m] - a[i][m]) / std::abs(of[i][m]) : 0;
  }
  return out;
}

// Root of its square with `scatter` times its jackknife variance; each humidity is given the larger
// of its own and the root mean square over humidity, as a difference may cross zero between two of
// them. Humidities at which next to nothing of the quantity `of` is left (a flooded patch) say
// nothing about the others: their differences are large for being relative. Eq. accuracy.2,
// accuracy.3
std::vector<Row> size_of(const Difference& difference, int skins, double scatter,
                         const std::vector<Row>& of) {
  const std::vector<Row> all = difference(-1);
  std::vector<std::vector<Row>> rest;
  for (int k = 0; k < skins; ++k) rest.push_back(difference(k));
  std::vector<Row> out(all.size());
  for (std::size_t m = 0; m < kMeasured.size(); ++m) {
    double sum = 0, largest = 0;
    int counted = 0;
    for (const Row& row : of) largest = std::max(largest, std::abs(row[m]));
    for (std::size_t i = 0; i < all.size(); ++i) {
      double mean = 0, variance = 0;
      for (const auto& r : rest) mean += r[i][m] / skins;
      for (const auto& r : rest) variance += square(r[i][m] - mean) * (skins - 1) / skins;
      out[i][m] = std::sqrt(std::max(square(all[i][m]) + scatter * variance, 0.0));
      if (std::abs(of[i][m]) < kNothingLeft * largest) continue;
      sum += square(out[i][m]);
      ++counted;
    }
    for (Row& row : out) row[m] = std::max(row[m], std::sqrt(sum / std::max(counted, 1)));
  }
  return out;
}

// Area error where the grid resolves the cut-off of the skin. Half of it would not, so that halving
// tells how much the area depends on the cut-off, not how well this one is sampled. Measured
// against 2048 pixels: 2.3, 0.8, 0.2 % at 2.1, 4.3, 8.5 pixels a wavelength
// (results/bench/contact_area.csv).
double resolved_area_error(double pixels_per_cutoff) {
  return 0.023 * std::pow(2.13 / pixels_per_cutoff, 1.5);
}

// From the last halving of the pixel to what is missing to the limit. Eq. accuracy.2
void extrapolate(std::vector<Row>& last, const Scene& scene, const Plan& plan, bool load_law) {
  const double cutoff = scene.finger.skin.cutoff;
  const bool resolved = plan.effective_cutoff <= cutoff * (1 + 1e-9);
  const double pixel = std::max(plan.grid.dx(), plan.grid.dy());
  for (std::size_t m = 0; m < kMeasured.size(); ++m) {
    const auto member = kMeasured[m];
    const bool area =
        member == &ResponsePoint::friction_off || member == &ResponsePoint::friction_on ||
        member == &ResponsePoint::area_fraction_off || member == &ResponsePoint::area_fraction_on;
    for (Row& row : last) {
      row[m] = area && resolved ? resolved_area_error(cutoff / pixel)
                                : row[m] * (area ? kAreaRest : kOtherRest);
      if (load_law && member == &ResponsePoint::modulation) row[m] *= kUnknownRest;
    }
  }
}

}  // namespace

std::vector<MeasuredError> measure_errors(const Scene& scene, const Texture& texture,
                                          const Fidelity& fidelity, const PatchSet& patches) {
  std::vector<MeasuredError> errors;
  const int skins = std::min(fidelity.control_skins, patches.skins());
  if (skins < 2) return errors;
  const Run base{&scene, fidelity, first_skins(patches, skins)};
  const auto run = [&](Fidelity changed) {
    changed.skins = skins;
    return Run{&scene, changed, solve_patches(scene, texture, changed)};
  };
  const auto count = [](const Run& done, MeasuredError& error) {
    error.seconds += done.patches.seconds;
    for (const auto& results : done.patches.results) {
      for (const PatchResult& p : results) {
        error.contact_solves += p.contact_solves;
        error.fft_pairs += p.fft_pairs;
      }
    }
  };

  // With the load law, grids are compared by solved areas: its own steps between grids are partly
  // what it lacks against them.
  const bool load_law =
      fidelity.estimator == Estimator::Load && (patches.plan.water || patches.plan.field);
  MeasuredError method{&ErrorParts::method, {}};
  std::optional<Run> areas, coarse;
  Fidelity resolved = fidelity;
  if (load_law) {
    resolved.estimator = Estimator::Area;
    areas = run(resolved);
    count(*areas, method);
  }
  const Run& fine = load_law ? *areas : base;
  if (fidelity.grid / 2 >= kSmallestGrid) {
    Fidelity half = resolved;
    half.grid = fidelity.grid / 2;
    half.most_pixels = fidelity.pixels_a_side() / 2;  // else long patches keep their pixels
    coarse = run(half);
    MeasuredError grid{&ErrorParts::grid, {}};
    count(*coarse, grid);
    grid.size = size_of(
        [&](int without) {
          const std::vector<Row> v = values(fine, without);
          return relative(values(*coarse, without), v, v);
        },
        skins, 1, values(fine, -1));
    extrapolate(grid.size, scene, patches.plan, load_law);
    errors.push_back(std::move(grid));
  }
  if (load_law) {
    // The scatter of the difference between skins is no bias: it is taken off.
    method.size = size_of(
        [&](int without) {
          const std::vector<Row> law = values(base, without), v = values(fine, without);
          std::vector<Row> out = relative(v, law, law);
          if (!coarse) return out;
          const std::vector<Row> last = relative(v, values(*coarse, without), law);
          for (std::size_t i = 0; i < out.size(); ++i) {
            for (std::size_t m = 0; m < kMeasured.size(); ++m) {
              if (kMeasured[m] == &ResponsePoint::modulation) out[i][m] += kOtherRest * last[i][m];
            }
          }
          return out;
        },
        skins, -1, values(base, -1));
    for (const auto& results : areas->patches.results) {
      std::string& status = method.pull_in.emplace_back();
      for (const PatchResult& p : results) {
        if (status.empty() && p.status.starts_with("pull-in")) status = p.status;
      }
    }
    errors.push_back(std::move(method));
  }
  return errors;
}

}  // namespace papilla
