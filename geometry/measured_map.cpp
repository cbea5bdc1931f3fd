#include "geometry/measured_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>

#include "base/cache.h"
#include "base/error.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/plane.h"
#include "geometry/texture.h"

namespace papilla::geometry {
namespace {

// Bilinear value at (x, y) [m] within the map; beyond its last pixels the border's value.
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

// The file is read and mended once: a search asks for the same map thousands of times, and threads
// that ask together wait for one of them to read it. One that was written anew is another. Those
// that were asked for last are kept: programs draw maps without end.
std::shared_ptr<const Scan> scan_of(const ScanSource& source) {
  constexpr std::size_t kMostMaps = 256;
  constexpr double kMostBytes = 1 << 30;  // of their files
  using Key = std::pair<ScanSource, MapVersion>;
  static std::mutex mutex;
  static Cache<Key, Scan> cache(kMostMaps, kMostBytes);
  const MapVersion version = map_version(source.file);
  const std::lock_guard lock(mutex);
  return cache.get({source, version}, static_cast<double>(version.size),
                   [&] { return std::make_shared<const Scan>(read_scan(source)); });
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

// A map that repeats, over sides that need not be its own: from its corner on, as often as it
// takes.
Heightmap tiled(const Heightmap& source, const Grid& grid) {
  const Grid& g = source.grid;
  const int nx = static_cast<int>(std::ceil(grid.lx / g.lx - 1e-9)),
            ny = static_cast<int>(std::ceil(grid.ly / g.ly - 1e-9));
  if (nx == 1 && ny == 1) return periodic_cut(source, grid, 0, 0, 0, 0, {});
  Heightmap tiles{{nx * g.nx, ny * g.ny, nx * g.lx, ny * g.ly}, {}};
  tiles.z.reserve(tiles.grid.size());
  for (int iy = 0; iy < tiles.grid.ny; ++iy) {
    const auto row = source.z.begin() + static_cast<std::ptrdiff_t>(g.index(0, iy % g.ny));
    for (int tile = 0; tile < nx; ++tile) tiles.z.insert(tiles.z.end(), row, row + g.nx);
  }
  return periodic_cut(tiles, grid, 0, 0, 0, 0, {});
}

bool same_pixels(const Grid& a, const Grid& b) {
  return a.nx == b.nx && a.ny == b.ny && std::abs(a.lx - b.lx) < 1e-12 * b.lx &&
         std::abs(a.ly - b.ly) < 1e-12 * b.ly;
}

constexpr double kSeam = 0.1;  // of a patch's side: the band that is blended

}  // namespace

MapVersion map_version(const std::string& file) {
  std::error_code ignored;  // reading says what is wrong
  const std::string path = map_name(file).file;
  return {std::filesystem::last_write_time(path, ignored),
          std::filesystem::file_size(path, ignored)};
}

std::vector<MapVersion> map_versions(const Texture& texture) {
  const TextureFacts known = facts(texture);
  std::vector<MapVersion> out;
  for (const ScanSource& source : known.scans) out.push_back(map_version(source.file));
  return out;
}

ScanChanges changes_of_map(const ScanSource& source) { return scan_of(source)->changes; }

std::vector<MapPlace> places_of_map(const ScanSource& source, double patch) {
  const auto scan = scan_of(source);
  const Grid& whole = scan->map.grid;
  if (scan->changes.as_is || scan->changes.repeats) return {{}};
  // Each in the middle of its half, a seam from the next.
  const auto along = [&](double side) {
    return side >= 2 * (1 + 2 * kSeam) * patch ? std::vector{-side / 4, side / 4}
                                               : std::vector{0.0};
  };
  std::vector<MapPlace> out;
  for (const double y : along(whole.ly)) {
    for (const double x : along(whole.lx)) out.push_back({x, y});
  }
  return out;
}

Heightmap patch_of_map(const ScanSource& source, double patch, const MapPlace& at,
                       const Grid& grid) {
  const auto scan = scan_of(source);
  const Grid& whole = scan->map.grid;
  if (whole.lx < patch * (1 - 1e-9) || whole.ly < patch * (1 - 1e-9)) {
    throw InputError(fmt::format(
        "{}: {:.4g} x {:.4g} um is smaller than the patch of {:.4g} um; lower texture.patch",
        source.file, 1e6 * whole.lx, 1e6 * whole.ly, 1e6 * patch));
  }
  const double beyond = std::max(std::abs(at.x) - 0.5 * (whole.lx - patch),
                                 std::abs(at.y) - 0.5 * (whole.ly - patch));
  if (beyond > 1e-9 * patch) {
    throw InputError(fmt::format(
        "texture.at_x, texture.at_y: the square of {:.4g} um round ({:.4g}, {:.4g}) um reaches "
        "{:.4g} um beyond the map, {:.4g} x {:.4g} um: {}",
        1e6 * patch, 1e6 * at.x, 1e6 * at.y, 1e6 * beyond, 1e6 * whole.lx, 1e6 * whole.ly,
        source.file));
  }
  if (source.as_is && same_pixels(grid, whole)) return {grid, scan->map.z};  // to the last bit
  const auto other = [&](double side) { return std::abs(side / patch - 1) > 1e-9; };
  if (source.as_is && (other(grid.lx) || other(grid.ly))) {
    if (at != MapPlace{}) {
      throw InputError(source.file +
                       ": texture.at_x, texture.at_y: a map that repeats by itself begins at its "
                       "corner as a part of a stack; leave them out");
    }
    return tiled(scan->map, grid);
  }
  const double x0 = 0.5 * (whole.lx - grid.lx) + at.x, y0 = 0.5 * (whole.ly - grid.ly) + at.y;
  const double seam = source.as_is ? 0 : kSeam;  // what is known repeats by itself
  return periodic_cut(scan->map, grid, x0, y0, std::clamp(x0, 0.0, seam * grid.lx),
                      std::clamp(y0, 0.0, seam * grid.ly), {});
}

double measured_skin_cutoff(const std::string& file, double width) {
  const Grid& g = scan_of({file, width})->map.grid;
  return 2 * std::max(g.dx(), g.dy());
}

Heightmap measured_skin(const std::string& file, double width, const Grid& grid, std::uint64_t seed,
                        std::uint64_t index) {
  const auto scan = scan_of({file, width});
  const Heightmap& source = scan->map;
  const Grid& whole = source.grid;
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
  const Plane plane = plane_of(source, x0, y0, grid.lx, grid.ly);
  const Heightmap cut = periodic_cut(source, grid, x0, y0, bx, by, plane);
  Heightmap out = cut;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      out(ix, iy) = cut(mirror_x ? grid.nx - 1 - ix : ix, mirror_y ? grid.ny - 1 - iy : iy);
    }
  }
  return out;
}

}  // namespace papilla::geometry
