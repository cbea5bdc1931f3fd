#include "physics/capillary/threshold.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/check.h"
#include "physics/capillary/film.h"

namespace papilla::capillary {
namespace {

// Water that fills the smallest gaps: how many it takes for a volume.
class Filling {
 public:
  // One pass sorts into bins by height; only bins in which a level lies are sorted.
  explicit Filling(const std::vector<double>& gaps) : gaps_(gaps), sum_(kBins), count_(kBins) {
    scale_ = kBins / *std::max_element(gaps.begin(), gaps.end());
    for (double h : gaps) {
      const int b = bin_of(h);
      sum_[b] += h;
      ++count_[b];
    }
  }

  struct Level {
    double height = 0;  // gap of the last pixel taken
    double pixels = 0;  // how many are wet; the last one counts as a fraction
  };
  // volume: sum of gaps, below that of all.
  Level level(double volume) const {
    double below = 0, pixels = 0;
    int bin = 0;
    while (bin + 1 < kBins && below + sum_[bin] <= volume) {
      below += sum_[bin];
      pixels += count_[bin];
      ++bin;
    }
    std::vector<double> inside;
    for (double h : gaps_) {
      if (bin_of(h) == bin) inside.push_back(h);
    }
    std::sort(inside.begin(), inside.end());
    for (double h : inside) {
      if (below + h > volume) return {h, pixels + (volume - below) / h};
      below += h;
      pixels += 1;
    }
    return {inside.empty() ? kBins / scale_ : inside.back(), pixels};  // rounding: all of it
  }

 private:
  static constexpr int kBins = 4096;
  int bin_of(double h) const { return std::min(static_cast<int>(h * scale_), kBins - 1); }

  const std::vector<double>& gaps_;
  std::vector<double> sum_;
  std::vector<int> count_;
  double scale_ = 0;
};

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
  const Filling filling(gap.value);
  const Filling::Level level = filling.level(wanted);
  // The pull of the film closes the gap inside its edge and not outside: on the pixels of a grid no
  // gap lies between, and the gap of the last pixel taken would step from one side to the other.
  constexpr double kWindow = 0.1;  // of the volume, either way
  const double less = (1 - kWindow) * wanted, more = std::min((1 + kWindow) * wanted, total);
  Film film;
  film.height = (more - less) / (filling.level(more).pixels - filling.level(less).pixels);
  film.area = level.pixels * g.pixel_area();
  film.wet.resize(g.size());
  // Of equal gaps at the level those with the lowest numbers, as many as hold the rest.
  double rest = std::ceil(level.pixels);
  for (double h : gap.value) rest -= h < level.height;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const bool last = gap.value[i] == level.height && rest > 0;
    rest -= last;
    film.wet[i] = gap.value[i] < level.height || last;
  }
  measure_film(gap, water, film);
  out.status = WettingStatus::Film;
  out.bridged = std::move(film.wet);
  out.film.resize(out.bridged.size());
  double pixels = 0;
  for (std::size_t i = 0; i < out.film.size(); ++i) {
    out.film[i] = out.bridged[i] ? FilmPixel::Film : FilmPixel::None;
    pixels += out.bridged[i];
  }
  out.film_region.assign(out.bridged.begin(), out.bridged.end());  // of one pressure
  out.film_pressure = {film.force / (pixels * g.pixel_area())};
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
