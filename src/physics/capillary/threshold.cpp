#include "physics/capillary/threshold.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/check.h"
#include "physics/capillary/film.h"

namespace papilla::capillary {
namespace {

// The smallest gaps that hold `wanted` (sum of gaps); the last pixel counts as a fraction.
struct Level {
  double height;  // gap of the last pixel taken
  double pixels;  // how many are wet, with the fraction
};

Level find_level(const std::vector<double>& gaps, double wanted) {
  // One pass sorts into bins by height; only the bin in which the level lies is sorted.
  constexpr int kBins = 4096;
  const double top = *std::max_element(gaps.begin(), gaps.end());
  const double scale = kBins / top;
  const auto bin_of = [&](double h) { return std::min(static_cast<int>(h * scale), kBins - 1); };
  std::vector<double> sum(kBins, 0.0);
  std::vector<int> count(kBins, 0);
  for (double h : gaps) {
    const int b = bin_of(h);
    sum[b] += h;
    ++count[b];
  }
  double below = 0, pixels = 0;
  int bin = 0;
  while (bin + 1 < kBins && below + sum[bin] <= wanted) {
    below += sum[bin];
    pixels += count[bin];
    ++bin;
  }
  std::vector<double> inside;
  for (double h : gaps) {
    if (bin_of(h) == bin) inside.push_back(h);
  }
  std::sort(inside.begin(), inside.end());
  for (double h : inside) {
    if (below + h > wanted) return {h, pixels + (wanted - below) / h};
    below += h;
    pixels += 1;
  }
  return {inside.empty() ? top : inside.back(), pixels};  // rounding: all of it
}

}  // namespace

Wetting fill_threshold(const Gap& gap, double bridge_volume, const WaterProperties& water) {
  PAPILLA_CHECK(bridge_volume >= 0, "negative water volume");
  const Grid& g = gap.grid;
  Wetting out;
  out.grid = g;
  if (bridge_volume == 0) return out;
  out.volume = out.bridge_volume = bridge_volume;
  const double wanted = bridge_volume / g.pixel_area();
  double total = 0;
  for (double h : gap.value) total += h;
  if (wanted >= total) {
    out.status = WettingStatus::Flooded;
    out.bridged.assign(g.size(), 1);
    out.wetted_fraction = 1;
    out.bridges = 1;
    return out;
  }
  const Level level = find_level(gap.value, wanted);
  Film film;
  film.height = level.height;
  film.area = level.pixels * g.pixel_area();
  film.wet.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i) film.wet[i] = gap.value[i] <= level.height ? 1 : 0;
  measure_film(gap, water, film);
  out.status = WettingStatus::Film;
  out.bridged = std::move(film.wet);
  out.film.resize(out.bridged.size());
  for (std::size_t i = 0; i < out.film.size(); ++i) {
    out.film[i] = out.bridged[i] ? FilmPixel::Film : FilmPixel::None;
  }
  out.bridges = film.regions;
  out.wetted_fraction = film.area / g.area();
  out.capillary_force = film.force;
  out.retention = film.retention;
  return out;
}

double threshold_shortfall(double water_per_area) {
  if (!(water_per_area > 0)) return 0;
  return std::clamp(0.60 + 0.05 * std::log(water_per_area / 0.5e-9), 0.0, 0.9);
}

}  // namespace papilla::capillary
