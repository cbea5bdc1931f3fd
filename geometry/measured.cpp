#include "geometry/measured.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "base/error.h"
#include "geometry/io/files.h"

namespace papilla {
namespace {

// Least-squares plane taken away; values further than 8 median absolute deviations from the median
// count as outliers and get the mean of their neighbours.
void level_and_mend(Heightmap& h) {
  const Grid& g = h.grid;
  const auto n = static_cast<double>(g.size());
  double mean = 0, sx = 0, sy = 0, xx = 0, yy = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const double x = g.x(ix) - 0.5 * g.lx, y = g.y(iy) - 0.5 * g.ly, z = h(ix, iy);
      mean += z / n;
      sx += x * z;
      sy += y * z;
      xx += x * x;
      yy += y * y;
    }
  }
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      h(ix, iy) -= mean + (xx > 0 ? sx / xx * (g.x(ix) - 0.5 * g.lx) : 0) +
                   (yy > 0 ? sy / yy * (g.y(iy) - 0.5 * g.ly) : 0);
    }
  }
  std::vector<double> sorted = h.z;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle;
  for (double& z : sorted) z = std::abs(z - median);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = 8 * *middle;
  if (limit <= 0) return;
  // Many of them are features, not outliers: the holes of a flat land.
  const auto far =
      std::count_if(h.z.begin(), h.z.end(), [&](double z) { return std::abs(z - median) > limit; });
  if (static_cast<double>(far) > 0.02 * n) return;
  const Heightmap old = h;
  const auto sound = [&](int ix, int iy) { return std::abs(old(ix, iy) - median) <= limit; };
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      if (sound(ix, iy)) continue;
      double sum = 0;
      int count = 0;
      for (int reach = 1; count == 0 && reach < std::max(g.nx, g.ny); ++reach) {
        for (int dy = -reach; dy <= reach; ++dy) {
          for (int dx = -reach; dx <= reach; ++dx) {
            const int jx = ix + dx, jy = iy + dy;
            if (jx < 0 || jy < 0 || jx >= g.nx || jy >= g.ny || !sound(jx, jy)) continue;
            sum += old(jx, jy);
            ++count;
          }
        }
      }
      h(ix, iy) = count > 0 ? sum / count : median;
    }
  }
}

// Bilinear value at (x, y) [m]; beyond the border the border's value.
double sample(const Heightmap& h, double x, double y) {
  const double u = std::clamp(x / h.grid.dx() - 0.5, 0.0, h.grid.nx - 1.0);
  const double v = std::clamp(y / h.grid.dy() - 0.5, 0.0, h.grid.ny - 1.0);
  const int ix = std::min(static_cast<int>(u), h.grid.nx - 1),
            iy = std::min(static_cast<int>(v), h.grid.ny - 1);
  const int jx = std::min(ix + 1, h.grid.nx - 1), jy = std::min(iy + 1, h.grid.ny - 1);
  const double s = u - ix, t = v - iy;
  return (1 - t) * ((1 - s) * h(ix, iy) + s * h(jx, iy)) +
         t * ((1 - s) * h(ix, jy) + s * h(jx, jy));
}

Heightmap load(const Measured3d& map) {
  Heightmap h = read_heightmap(map.file, map.width);
  if (h.grid.lx < map.patch * (1 - 1e-9) || h.grid.ly < map.patch * (1 - 1e-9)) {
    throw InputError(fmt::format(
        "{}: {:.4g} x {:.4g} um is smaller than the patch of {:.4g} um; lower texture.patch",
        map.file, 1e6 * h.grid.lx, 1e6 * h.grid.ly, 1e6 * map.patch));
  }
  level_and_mend(h);
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  if (*high - *low > 10 * h.grid.lx) {
    throw InputError(fmt::format(
        "{}: heights over {:.4g} um on a width of {:.4g} um: no surface is so steep; the file's "
        "heights are likely in another unit (NPY holds m, EXR um)",
        map.file, 1e6 * (*high - *low), 1e6 * h.grid.lx));
  }
  return h;
}

}  // namespace

Heightmap measured_heights(const Measured3d& map, const Grid& grid) {
  // The file is read and mended once: a search asks for the same map thousands of times.
  static std::mutex mutex;
  static std::map<std::tuple<std::string, double, double>, Heightmap> cache;
  Heightmap source;
  {
    std::lock_guard lock(mutex);
    auto [it, fresh] = cache.try_emplace({map.file, map.width, map.patch});
    if (fresh) {
      try {
        it->second = load(map);
      } catch (...) {
        cache.erase(it);
        throw;
      }
    }
    source = it->second;
  }
  // Cut from the middle; the outer tenth is blended into its periodic neighbour, so that the patch
  // repeats without a step (Eq. geometry.4). Variance is kept: weights cos, sin.
  const double x0 = 0.5 * (source.grid.lx - grid.lx), y0 = 0.5 * (source.grid.ly - grid.ly);
  const double bx = std::min(0.1 * grid.lx, std::max(0.0, x0)),
               by = std::min(0.1 * grid.ly, std::max(0.0, y0));
  Heightmap out{grid, std::vector<double>(grid.size())};
  const auto blend = [](double position, double length, double band) {
    // weight of the value one period further, within `band` of the upper end
    if (band <= 0 || position < length - band) return 0.0;
    return (position - (length - band)) / band;
  };
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double x = grid.x(ix), y = grid.y(iy);
      const double a = blend(x, grid.lx, bx), b = blend(y, grid.ly, by);
      const auto mixed_x = [&](double yy) {
        const double here = sample(source, x0 + x, y0 + yy);
        if (a == 0) return here;
        return ((1 - a) * here + a * sample(source, x0 + x - grid.lx, y0 + yy)) /
               std::hypot(a, 1 - a);
      };
      double z = mixed_x(y);
      if (b > 0) z = ((1 - b) * z + b * mixed_x(y - grid.ly)) / std::hypot(b, 1 - b);
      out(ix, iy) = z;
    }
  }
  return out;
}

}  // namespace papilla
