// The grid and method parts of the error: a few skins run again, one choice changed at a time.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/constants.h"
#include "forward/forward.h"

namespace papilla {
namespace {

using Row = std::array<double, kMeasured.size()>;

constexpr int kSmallestGrid = 16;

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

// Paired relative difference of two runs on the same skins with its jackknife error, per quantity;
// each humidity is given the larger of its own and the root mean square over humidity, as a
// difference may cross zero between two of them. Eq. accuracy.2, accuracy.3
std::vector<Row> difference(const Run& base, const Run& other) {
  const int n = base.patches.skins();
  const auto relative = [&](int without) {
    std::vector<Row> a = values(*base.scene, base.fidelity, base.patches, without);
    const std::vector<Row> b = values(*other.scene, other.fidelity, other.patches, without);
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t m = 0; m < kMeasured.size(); ++m) {
        const double size = std::abs(a[i][m]);
        a[i][m] = size > 0 ? (b[i][m] - a[i][m]) / size : 0;
      }
    }
    return a;
  };
  const std::vector<Row> all = relative(-1);
  std::vector<std::vector<Row>> rest;
  for (int k = 0; k < n; ++k) rest.push_back(relative(k));
  std::vector<Row> out(all.size());
  for (std::size_t m = 0; m < kMeasured.size(); ++m) {
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      double mean = 0, variance = 0;
      for (const auto& r : rest) mean += r[i][m] / n;
      for (const auto& r : rest) variance += square(r[i][m] - mean) * (n - 1) / n;
      out[i][m] = std::sqrt(square(all[i][m]) + variance);
      sum += square(out[i][m]) / static_cast<double>(all.size());
    }
    for (Row& row : out) row[m] = std::max(row[m], std::sqrt(sum));
  }
  return out;
}

}  // namespace

std::vector<MeasuredError> measure_errors(const Scene& scene, const Texture& texture,
                                          const Fidelity& fidelity, const PatchSet& patches) {
  std::vector<MeasuredError> errors;
  const int skins = std::min(fidelity.control_skins, patches.skins());
  if (skins < 2) return errors;
  const Run base{&scene, fidelity, first_skins(patches, skins)};
  const auto add = [&](std::optional<double> ErrorParts::*origin, Fidelity changed) {
    changed.skins = skins;
    const Run other{&scene, changed, solve_patches(scene, texture, changed)};
    MeasuredError error{origin, difference(base, other)};
    error.seconds = other.patches.seconds;
    for (const auto& results : other.patches.results) {
      for (const PatchResult& p : results) {
        error.contact_solves += p.contact_solves;
        error.fft_pairs += p.fft_pairs;
      }
    }
    errors.push_back(std::move(error));
  };

  if (fidelity.grid / 2 >= kSmallestGrid) {
    Fidelity coarse = fidelity;
    coarse.grid = fidelity.grid / 2;
    add(&ErrorParts::grid, coarse);
  }
  if (fidelity.estimator == Estimator::Load && (patches.plan.water || patches.plan.field)) {
    Fidelity resolved = fidelity;
    resolved.estimator = Estimator::Area;
    add(&ErrorParts::method, resolved);
  }
  return errors;
}

}  // namespace papilla
