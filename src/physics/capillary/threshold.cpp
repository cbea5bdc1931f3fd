#include "physics/capillary/threshold.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/constants.h"

namespace papilla {
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

// Length of the contour gap = level, by marching squares on the cells between pixel centres.
double contour_length(const Gap& gap, double level) {
  const Grid& g = gap.grid;
  const double dx = g.dx(), dy = g.dy();
  double length = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    const int jy = iy + 1 == g.ny ? 0 : iy + 1;
    for (int ix = 0; ix < g.nx; ++ix) {
      const int jx = ix + 1 == g.nx ? 0 : ix + 1;
      const double a = gap(ix, iy) - level, b = gap(jx, iy) - level, c = gap(jx, jy) - level,
                   d = gap(ix, jy) - level;
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

int count_regions(const Grid& g, const std::vector<std::uint8_t>& mask) {
  std::vector<std::uint8_t> seen(mask.size(), 0);
  std::vector<int> stack;
  int regions = 0;
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (!mask[start] || seen[start]) continue;
    ++regions;
    seen[start] = 1;
    stack.assign(1, static_cast<int>(start));
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      const int ix = at % g.nx, iy = at / g.nx;
      const std::size_t next[4] = {g.index(wrap(ix + 1, g.nx), iy), g.index(wrap(ix - 1, g.nx), iy),
                                   g.index(ix, wrap(iy + 1, g.ny)),
                                   g.index(ix, wrap(iy - 1, g.ny))};
      for (std::size_t k : next) {
        if (mask[k] && !seen[k]) {
          seen[k] = 1;
          stack.push_back(static_cast<int>(k));
        }
      }
    }
  }
  return regions;
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
  out.status = WettingStatus::Film;
  out.bridged.assign(g.size(), 0);
  for (std::size_t i = 0; i < g.size(); ++i) out.bridged[i] = gap.value[i] <= level.height ? 1 : 0;
  out.bridges = count_regions(g, out.bridged);
  out.wetted_fraction = level.pixels / static_cast<double>(g.size());
  const double perimeter = contour_length(gap, level.height);
  const double c = wetting_gain(water.theta_skin, water.theta_substrate);
  const double f = meniscus_factor(water.theta_skin, water.theta_substrate);
  out.capillary_force =
      water.surface_tension * (c * out.wetted_fraction * g.area() / level.height + f * perimeter);
  // A closed line of length P spans the width P / pi.
  out.retention = kPi / 4 * water.surface_tension * (perimeter / kPi) * water.hysteresis;
  return out;
}

}  // namespace papilla
