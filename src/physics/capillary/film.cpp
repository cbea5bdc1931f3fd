#include "physics/capillary/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

#include "base/constants.h"

namespace papilla {
namespace {

// Length of the edge of the wet region: the contour gap = level by marching squares on the cells
// between pixel centres; dry pixels count as above the level.
double edge_length(const Gap& gap, const std::vector<std::uint8_t>& wet_pixels, double level) {
  const Grid& g = gap.grid;
  const auto above = [&](int ix, int iy) {
    const std::size_t k = g.index(ix, iy);
    const double excess = gap.value[k] - level;
    return wet_pixels[k] ? std::min(excess, -1e-9 * level) : std::max(excess, 1e-9 * level);
  };
  const double dx = g.dx(), dy = g.dy();
  double length = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    const int jy = iy + 1 == g.ny ? 0 : iy + 1;
    for (int ix = 0; ix < g.nx; ++ix) {
      const int jx = ix + 1 == g.nx ? 0 : ix + 1;
      const double a = above(ix, iy), b = above(jx, iy), c = above(jx, jy), d = above(ix, jy);
      const int wet = (a < 0) + (b < 0) + (c < 0) + (d < 0);
      if (wet == 0 || wet == 4) continue;
      // Crossing points around the cell in order; two (or, at a saddle, four).
      double px[4], py[4];
      int n = 0;
      const auto cut = [](double p, double q) { return p / (p - q); };
      if ((a < 0) != (b < 0)) px[n] = cut(a, b) * dx, py[n++] = 0;
      if ((b < 0) != (c < 0)) px[n] = dx, py[n++] = cut(b, c) * dy;
      if ((c < 0) != (d < 0)) px[n] = (1 - cut(c, d)) * dx, py[n++] = dy;
      if ((d < 0) != (a < 0)) px[n] = 0, py[n++] = (1 - cut(d, a)) * dy;
      for (int k = 0; k + 1 < n; k += 2) length += std::hypot(px[k + 1] - px[k], py[k + 1] - py[k]);
    }
  }
  return length;
}

std::array<std::size_t, 4> neighbours(const Grid& g, std::size_t at) {
  const int ix = static_cast<int>(at % g.nx), iy = static_cast<int>(at / g.nx);
  return {g.index(wrap(ix + 1, g.nx), iy), g.index(wrap(ix - 1, g.nx), iy),
          g.index(ix, wrap(iy + 1, g.ny)), g.index(ix, wrap(iy - 1, g.ny))};
}

}  // namespace

int label_regions(const Grid& grid, const std::vector<std::uint8_t>& mask,
                  std::vector<int>& label) {
  label.assign(mask.size(), 0);
  std::vector<std::size_t> stack;
  int regions = 0;
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (!mask[start] || label[start]) continue;
    label[start] = ++regions;
    stack.assign(1, start);
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      for (std::size_t k : neighbours(grid, at)) {
        if (mask[k] && !label[k]) {
          label[k] = regions;
          stack.push_back(k);
        }
      }
    }
  }
  return regions;
}

void measure_film(const Gap& gap, const WaterProperties& water, Film& film) {
  const double perimeter = edge_length(gap, film.wet, film.height);
  const double c = wetting_gain(water.theta_skin, water.theta_substrate);
  const double f = meniscus_factor(water.theta_skin, water.theta_substrate);
  film.force = water.surface_tension * (c * film.area / film.height + f * perimeter);
  // A closed line of length P spans the width P / pi.
  film.retention = kPi / 4 * water.surface_tension * (perimeter / kPi) * water.hysteresis;
  std::vector<int> label;
  film.regions = label_regions(gap.grid, film.wet, label);
}

Film grow_film(const Gap& gap, const std::vector<std::size_t>& seeds, double volume,
               const WaterProperties& water, const std::function<double(std::size_t)>& joins) {
  const Grid& g = gap.grid;
  const double pixel = g.pixel_area();
  Film film;
  film.wet.assign(g.size(), 0);
  film.volume = volume;
  std::vector<std::uint8_t> queued(g.size(), 0);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> edge;
  for (std::size_t s : seeds) {
    if (!queued[s]) edge.emplace(gap.value[s], s);
    queued[s] = 1;
  }
  double placed = 0, pixels = 0;
  while (!edge.empty()) {
    const auto [h, at] = edge.top();
    edge.pop();
    film.wet[at] = 1;
    film.height = std::max(film.height, h);
    film.volume += joins(at);
    const double room = h * pixel;
    if (placed + room >= film.volume) {
      pixels += room > 0 ? (film.volume - placed) / room : 1;
      film.area = pixels * pixel;
      measure_film(gap, water, film);
      return film;
    }
    placed += room;
    pixels += 1;
    for (std::size_t k : neighbours(g, at)) {
      if (!queued[k]) edge.emplace(gap.value[k], k);
      queued[k] = 1;
    }
  }
  film.full = true;  // no meniscus, no force
  film.area = g.area();
  film.regions = 1;
  return film;
}

}  // namespace papilla
