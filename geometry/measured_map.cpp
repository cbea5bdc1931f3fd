#include "geometry/measured_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "geometry/io/files.h"

namespace papilla {
namespace {

// A plane a + b x + c y.
struct Plane {
  double a = 0, b = 0, c = 0;
};

// Least squares over the pixels of the map inside a rectangle with its lower corner at (x0, y0).
Plane plane_of(const Heightmap& h, double x0, double y0, double lx, double ly) {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, yy = 0, xz = 0, yz = 0;
  const auto each = [&](const auto& use) {
    for (int iy = 0; iy < h.grid.ny; ++iy) {
      if (h.grid.y(iy) < y0 || h.grid.y(iy) > y0 + ly) continue;
      for (int ix = 0; ix < h.grid.nx; ++ix) {
        if (h.grid.x(ix) >= x0 && h.grid.x(ix) <= x0 + lx)
          use(h.grid.x(ix), h.grid.y(iy), h(ix, iy));
      }
    }
  };
  each([&](double px, double py, double pz) { n += 1, x += px, y += py, z += pz; });
  if (n == 0) return {};
  x /= n, y /= n, z /= n;
  each([&](double px, double py, double pz) {
    xx += (px - x) * (px - x), yy += (py - y) * (py - y);
    xz += (px - x) * (pz - z), yz += (py - y) * (pz - z);
  });
  const double b = xx > 0 ? xz / xx : 0, c = yy > 0 ? yz / yy : 0;
  return {z - b * x - c * y, b, c};
}

// Least-squares plane taken away; values further than 8 median absolute deviations from the median
// count as outliers and get the mean of their neighbours.
void level_and_mend(Heightmap& h) {
  const Grid& g = h.grid;
  const auto n = static_cast<double>(g.size());
  const Plane plane = plane_of(h, 0, 0, g.lx, g.ly);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) h(ix, iy) -= plane.a + plane.b * g.x(ix) + plane.c * g.y(iy);
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
double value_at(const Heightmap& h, double x, double y) {
  const double u = std::clamp(x / h.grid.dx() - 0.5, 0.0, h.grid.nx - 1.0);
  const double v = std::clamp(y / h.grid.dy() - 0.5, 0.0, h.grid.ny - 1.0);
  const int ix = std::min(static_cast<int>(u), h.grid.nx - 1),
            iy = std::min(static_cast<int>(v), h.grid.ny - 1);
  const int jx = std::min(ix + 1, h.grid.nx - 1), jy = std::min(iy + 1, h.grid.ny - 1);
  const double s = u - ix, t = v - iy;
  return (1 - t) * ((1 - s) * h(ix, iy) + s * h(jx, iy)) +
         t * ((1 - s) * h(ix, jy) + s * h(jx, jy));
}

Heightmap load(const std::string& file, double width) {
  Heightmap h = read_heightmap(file, width);
  level_and_mend(h);
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  if (*high - *low > 10 * h.grid.lx) {
    throw InputError(fmt::format(
        "{}: heights over {:.4g} um on a width of {:.4g} um: no surface is so steep; the file's "
        "heights are likely in another unit (NPY holds m, EXR um)",
        file, 1e6 * (*high - *low), 1e6 * h.grid.lx));
  }
  return h;
}

// The file is read and mended once: a search asks for the same map thousands of times.
std::shared_ptr<const Heightmap> map_of(const std::string& file, double width) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, double>, std::shared_ptr<const Heightmap>> cache;
  std::lock_guard lock(mutex);
  auto& known = cache[{file, width}];
  if (!known) known = std::make_shared<const Heightmap>(load(file, width));
  return known;
}

// Cut with its lower corner at (x0, y0) [m], less a plane; the upper bands of width bx, by are
// blended into what lies below the lower border, so that the patch repeats without a step (Eq.
// geometry.4). Variance is kept. A pixel is the mean over its area.
Heightmap periodic_cut(const Heightmap& source, const Grid& grid, double x0, double y0, double bx,
                       double by, const Plane& plane) {
  const int nx = std::max(1, static_cast<int>(std::ceil(grid.dx() / source.grid.dx() - 1e-9))),
            ny = std::max(1, static_cast<int>(std::ceil(grid.dy() / source.grid.dy() - 1e-9)));
  const auto sample = [&](double x, double y) {
    double sum = 0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i)
        sum += value_at(source, x + ((i + 0.5) / nx - 0.5) * grid.dx(),
                        y + ((j + 0.5) / ny - 0.5) * grid.dy());
    }
    return sum / (nx * ny) - plane.a - plane.b * x - plane.c * y;
  };
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
        const double here = sample(x0 + x, y0 + yy);
        if (a == 0) return here;
        return ((1 - a) * here + a * sample(x0 + x - grid.lx, y0 + yy)) / std::hypot(a, 1 - a);
      };
      double z = mixed_x(y);
      if (b > 0) z = ((1 - b) * z + b * mixed_x(y - grid.ly)) / std::hypot(b, 1 - b);
      out(ix, iy) = z;
    }
  }
  return out;
}

constexpr double kSeam = 0.1;  // of a patch's side: the band that is blended

}  // namespace

Heightmap middle_of_map(const std::string& file, double width, double patch, const Grid& grid) {
  const auto source = map_of(file, width);
  const Grid& whole = source->grid;
  if (whole.lx < patch * (1 - 1e-9) || whole.ly < patch * (1 - 1e-9)) {
    throw InputError(fmt::format(
        "{}: {:.4g} x {:.4g} um is smaller than the patch of {:.4g} um; lower texture.patch", file,
        1e6 * whole.lx, 1e6 * whole.ly, 1e6 * patch));
  }
  const double x0 = 0.5 * (whole.lx - grid.lx), y0 = 0.5 * (whole.ly - grid.ly);
  return periodic_cut(*source, grid, x0, y0, std::clamp(x0, 0.0, kSeam * grid.lx),
                      std::clamp(y0, 0.0, kSeam * grid.ly), {});
}

double measured_skin_cutoff(const std::string& file, double width) {
  const Grid& g = map_of(file, width)->grid;
  return 2 * std::max(g.dx(), g.dy());
}

Heightmap measured_skin(const std::string& file, double width, const Grid& grid, std::uint64_t seed,
                        std::uint64_t index) {
  const auto source = map_of(file, width);
  const Grid& whole = source->grid;
  const double bx = kSeam * grid.lx, by = kSeam * grid.ly;
  const double room_x = whole.lx - grid.lx - bx, room_y = whole.ly - grid.ly - by;
  if (room_x < -1e-9 * whole.lx || room_y < -1e-9 * whole.ly) {
    throw InputError(fmt::format(
        "finger.skin.map: {}: {:.4g} x {:.4g} um is smaller than the patch of {:.4g} x {:.4g} um "
        "and its seam of a tenth; give a larger map, or a texture of a shorter period",
        file, 1e6 * whole.lx, 1e6 * whole.ly, 1e6 * grid.lx, 1e6 * grid.ly));
  }
  RandomStream random(seed, "skin map", index);
  const double x0 = bx + random.uniform() * std::max(0.0, room_x),
               y0 = by + random.uniform() * std::max(0.0, room_y);
  const bool mirror_x = random.uniform() < 0.5, mirror_y = random.uniform() < 0.5;
  const Plane plane = plane_of(*source, x0, y0, grid.lx, grid.ly);
  const Heightmap cut = periodic_cut(*source, grid, x0, y0, bx, by, plane);
  Heightmap out = cut;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      out(ix, iy) = cut(mirror_x ? grid.nx - 1 - ix : ix, mirror_y ? grid.ny - 1 - iy : iy);
    }
  }
  return out;
}

}  // namespace papilla
