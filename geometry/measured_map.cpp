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

// Sides after which a map begins again [m]; held: it does not, what lies beyond the centres of its
// last pixels has their value.
struct Border {
  double x = kHeld, y = kHeld;

  static constexpr double kHeld = 0;
};

// Two neighbouring pixels along a side, and the share of the second.
struct Between {
  int first, second;
  double share;
};

// The same place of a period that the map holds with its neighbours, where it is shorter than the
// map: whole maps are wrapped by their pixels.
double within_period(double at, double pixel, double whole, double period) {
  if (period >= whole * (1 - 1e-9)) return at;
  constexpr double kRounding = 1e-9;  // the centre of the first pixel stays where it is
  const double first = 0.5 * std::min(pixel, whole - period);
  return at - period * std::floor((at - first) / period + kRounding);
}

Between between(double at, double pixel, int n, double period) {
  if (period > 0) {
    const double place = within_period(at, pixel, n * pixel, period) / pixel - 0.5;
    const int below = static_cast<int>(std::floor(place));
    return {wrap(below, n), wrap(below + 1, n), place - below};
  }
  const double u = std::clamp(at / pixel - 0.5, 0.0, n - 1.0);
  const int i = std::min(static_cast<int>(u), n - 1);
  return {i, std::min(i + 1, n - 1), u - i};
}

// Bilinear value at (x, y) [m].
double value_at(const Heightmap& h, double x, double y, const Border& border) {
  const auto [ix, jx, s] = between(x, h.grid.dx(), h.grid.nx, border.x);
  const auto [iy, jy, t] = between(y, h.grid.dy(), h.grid.ny, border.y);
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
                       double by, const Plane& plane, const Border& border) {
  const int nx = std::max(1, static_cast<int>(std::ceil(grid.dx() / source.grid.dx() - 1e-9))),
            ny = std::max(1, static_cast<int>(std::ceil(grid.dy() / source.grid.dy() - 1e-9)));
  const auto sample = [&](double x, double y) {
    double sum = 0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i)
        sum += value_at(source, x + ((i + 0.5) / nx - 0.5) * grid.dx(),
                        y + ((j + 0.5) / ny - 0.5) * grid.dy(), border);
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

// Side after which a map begins again along a side of the patch that it makes [m]: all of it, where
// so many maps make that; else as many of its periods as it holds.
double repeats_after(double whole, double period, double side) {
  if (divides(whole, side)) return whole;
  constexpr double kRounding = 1e-6;  // of a period, as divides() has it
  return period * std::max(1.0, std::floor(whole / period + kRounding));
}

// Whether so many whole cells make the sides.
bool whole_cells(const Grid& sides, const UnitCell& cell) {
  return divides(cell.x, sides.lx) && divides(cell.y, sides.ly);
}

bool same_pixels(const Grid& a, const Grid& b) {
  return a.nx == b.nx && a.ny == b.ny && std::abs(a.lx - b.lx) < 1e-12 * b.lx &&
         std::abs(a.ly - b.ly) < 1e-12 * b.ly;
}

// By a key of the texture, for a stack to name it by the part that has it.
InputError wrong_key(const std::string& key, std::string message) {
  return InputError({Problem{{}, 0, 0, "texture." + key, std::move(message)}});
}

// A map that does not hold the patch is taken several times where it repeats.
void require_large_enough(const std::string& file, const Grid& map, double patch, bool repeats) {
  if (map.lx >= patch * (1 - 1e-9) && map.ly >= patch * (1 - 1e-9)) return;
  if (repeats && whole_cells({map.nx, map.ny, patch, patch}, {map.lx, map.ly})) return;
  throw wrong_key(
      "patch",
      fmt::format("{}: {:.4g} x {:.4g} um is smaller than the patch of {:.4g} um{}; lower it", file,
                  1e6 * map.lx, 1e6 * map.ly, 1e6 * patch,
                  repeats ? ", which is no whole number of it" : ""));
}

// Of a few pixels a patch has no shape: most likely the map is in another unit of length.
void require_fine_enough(const std::string& file, const Grid& map, double patch) {
  if (!too_coarse(map, patch)) return;
  const double pixel = std::max(map.dx(), map.dy());
  throw wrong_key(
      "patch",
      fmt::format(
          "{}: a pixel is {:.3g} um wide, of a map of {:.4g} x {:.4g} um: the patch of "
          "{:.4g} um holds {:.2g} of them a side, and needs {:g}; give the scale of the map "
          "(texture.width of an array, the sides in the file), or a map with finer pixels",
          file, 1e6 * pixel, 1e6 * map.lx, 1e6 * map.ly, 1e6 * patch, patch / pixel,
          kFewestPixels));
}

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

bool too_coarse(const Grid& map, double patch) {
  return patch < (kFewestPixels - 1e-6) * std::max(map.dx(), map.dy());
}

ScanChanges changes_of_map(const ScanSource& source) { return scan_of(source)->changes; }

double largest_patch(const ScanChanges& map) {
  const double shorter = std::min(map.width, map.height);
  if (map.as_is || map.repeats) return shorter;
  constexpr double kStep = 10e-9;  // [m]: a number to read, no wider than there is room for
  return kStep * std::floor(shorter / (1 + 2 * kSeam) / kStep + 1e-6);
}

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

Heightmap patch_of_map(const ScanSource& source, double patch, const MapPlace& at, const Grid& grid,
                       const std::optional<UnitCell>& cell) {
  const auto scan = scan_of(source);
  const Grid& whole = scan->map.grid;
  const bool repeats = source.as_is || scan->changes.repeats;
  require_large_enough(source.file, whole, patch, repeats);
  require_fine_enough(source.file, whole, patch);
  // As a part of a stack, or as one of several periods, it is asked for other sides.
  const auto other = [&](double side) { return std::abs(side / patch - 1) > 1e-9; };
  const bool part = other(grid.lx) || other(grid.ly);
  const bool larger = grid.lx > whole.lx * (1 + 1e-9) || grid.ly > whole.ly * (1 + 1e-9);
  // Of a map that is taken as it is the patch, or all of it, is said to be a period.
  const UnitCell period =
      cell.value_or(UnitCell{std::min(patch, whole.lx), std::min(patch, whole.ly)});
  const bool fits =
      whole_cells(grid, {whole.lx, whole.ly}) || (source.as_is && whole_cells(grid, period));
  const bool from_corner = source.as_is && (part || cell);
  if (from_corner && !fits) {
    // Rows of hexagons repeat after the root of three periods along y, which no square side does.
    const char* remedy =
        divides(period.x, grid.lx)
            ? "a square patch fits no hexagonal lattice: take a square lattice, or a map whose own "
              "sides are whole cells of it"
            : "give the period of the map as its patch, or the other parts a period that divides "
              "it";
    throw wrong_key(
        "patch",
        fmt::format("{}: as_is says that it repeats after {:.4g} x {:.4g} um, and the {:.4g} x "
                    "{:.4g} um of the stack that it is a part of are no whole number of them: a "
                    "step would be left at the border; {}",
                    source.file, 1e6 * period.x, 1e6 * period.y, 1e6 * grid.lx, 1e6 * grid.ly,
                    remedy));
  }
  const bool tiles = fits && (from_corner || (repeats && larger));
  if (larger && !tiles) {
    throw InputError(fmt::format(
        "{}: {:.4g} x {:.4g} um is smaller than the {:.4g} x {:.4g} um of the stack that it is a "
        "part of{}; give a larger map, or the other parts a shorter period",
        source.file, 1e6 * whole.lx, 1e6 * whole.ly, 1e6 * grid.lx, 1e6 * grid.ly,
        repeats ? ", and they are no whole number of it" : ""));
  }
  const double side_x = tiles ? std::min(patch, whole.lx) : std::max(patch, grid.lx),
               side_y = tiles ? std::min(patch, whole.ly) : std::max(patch, grid.ly);
  const double beyond = std::max(std::abs(at.x) - 0.5 * (whole.lx - side_x),
                                 std::abs(at.y) - 0.5 * (whole.ly - side_y));
  if (beyond > 1e-9 * patch) {
    throw wrong_key(
        "at_x, at_y",
        fmt::format("the patch of {:.4g} x {:.4g} um round ({:.4g}, {:.4g}) um reaches {:.4g} um "
                    "beyond the map, {:.4g} x {:.4g} um: {}",
                    1e6 * side_x, 1e6 * side_y, 1e6 * at.x, 1e6 * at.y, 1e6 * beyond,
                    1e6 * whole.lx, 1e6 * whole.ly, source.file));
  }
  if (source.as_is && same_pixels(grid, whole)) return {grid, scan->map.z};  // to the last bit
  if (tiles) {
    if (at != MapPlace{}) {
      throw wrong_key("at_x, at_y",
                      source.file +
                          ": a map that repeats by itself begins at its corner, in a stack "
                          "and where it is taken several times; leave them out");
    }
    return periodic_cut(
        scan->map, grid, 0, 0, 0, 0, {},
        {repeats_after(whole.lx, period.x, grid.lx), repeats_after(whole.ly, period.y, grid.ly)});
  }
  const double x0 = 0.5 * (whole.lx - grid.lx) + at.x, y0 = 0.5 * (whole.ly - grid.ly) + at.y;
  const double seam = source.as_is ? 0 : kSeam;  // what is known repeats by itself
  return periodic_cut(scan->map, grid, x0, y0, std::clamp(x0, 0.0, seam * grid.lx),
                      std::clamp(y0, 0.0, seam * grid.ly), {},
                      repeats ? Border{whole.lx, whole.ly} : Border{});
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
  const Heightmap cut = periodic_cut(source, grid, x0, y0, bx, by, plane, Border{});
  Heightmap out = cut;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      out(ix, iy) = cut(mirror_x ? grid.nx - 1 - ix : ix, mirror_y ? grid.ny - 1 - iy : iy);
    }
  }
  return out;
}

}  // namespace papilla::geometry
