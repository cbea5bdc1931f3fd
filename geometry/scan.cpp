#include "geometry/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/io/files.h"
#include "geometry/plane.h"

namespace papilla::geometry {
namespace {

constexpr double kFarDeviations = 8;    // of the median from the median: outliers
constexpr double kMostOutliers = 0.02;  // of the pixels; more of them are features
constexpr double kMostFilled = 0.2;
constexpr double kMostHigh = 1e100;  // [m] of either sign: sums of their squares stay numbers
constexpr double kNoticedTilt = 0.1 * kPi / 180;  // of a made map: a scan that was saved as one
constexpr double kSmoothest = 0.1e-9;  // [m] rms; of superpolished glass it is 0.1 nm and more

// The pixels that count: those that are numbers, then those that are no outliers either.
using Sound = std::vector<std::uint8_t>;

std::size_t count_unsound(const Sound& sound) {
  return static_cast<std::size_t>(std::count(sound.begin(), sound.end(), std::uint8_t{0}));
}

double mean_of(const Heightmap& h) {
  double sum = 0;
  for (const double z : h.z) sum += z;
  return sum / static_cast<double>(h.z.size());
}

double mean_of(const Heightmap& h, const Sound& sound) {
  double sum = 0;
  for (std::size_t i = 0; i < h.z.size(); ++i) sum += sound[i] ? h.z[i] : 0;
  return sum / static_cast<double>(h.z.size() - count_unsound(sound));
}

double rms_of(const Heightmap& h) {
  const double mean = mean_of(h);
  double sum = 0;
  for (const double z : h.z) sum += square(z - mean);
  return std::sqrt(sum / static_cast<double>(h.z.size()));
}

// Root mean square over the places of a border, of what `step` says of each [m].
template <class Step>
double rms_along(int places, const Step& step) {
  double sum = 0;
  for (int i = 0; i < places; ++i) sum += square(step(i));
  return std::sqrt(sum / places);
}

// Whether the map repeats by itself: from its last column to its first, and from its last row to
// its first, it steps no further than to the neighbours beside them. A tilt steps by all of its
// rise there; rough scans step by their roughness, which is more than that between neighbours
// unless neighbours know nothing of each other.
bool borders_meet(const Heightmap& h) {
  if (h.grid.nx < 4 || h.grid.ny < 4) return false;
  const double rms = rms_of(h);
  const std::array<BorderSteps, 2> steps = border_steps(h);
  return std::all_of(steps.begin(), steps.end(),
                     [&](const BorderSteps& along) { return along.beside < rms && along.alike(); });
}

// To a mean of 0 in any case: bands that are blended keep their variance about it.
void level(Heightmap& h, const Sound& sound, bool asked, ScanChanges& changes) {
  const Grid& g = h.grid;
  changes.repeats = !asked && borders_meet(h);
  changes.made = !asked && changes.made;
  const Plane plane = changes.repeats || changes.made
                          ? Plane{mean_of(h, sound)}
                          : plane_of(h, 0, 0, g.lx, g.ly, changes.filled > 0 ? &sound : nullptr);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) h(ix, iy) -= plane.at(g.x(ix), g.y(iy));
  }
  if (changes.made && !changes.repeats) {
    const Plane left = plane_of(h, 0, 0, g.lx, g.ly, changes.filled > 0 ? &sound : nullptr);
    changes.kept_tilt = std::atan(std::hypot(left.b, left.c));
    changes.kept_rise = std::abs(left.b) * g.lx + std::abs(left.c) * g.ly;
  }
  changes.slope_x = plane.b;
  changes.slope_y = plane.c;
  changes.rise = std::abs(plane.b) * g.lx + std::abs(plane.c) * g.ly;
}

// Marks what is further than the limit from the median; returns the median.
double mark_outliers(const Heightmap& h, Sound& sound, ScanChanges& changes) {
  const Grid& g = h.grid;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < h.z.size(); ++i) {
    if (sound[i]) sorted.push_back(h.z[i]);
  }
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle;
  for (double& z : sorted) z = std::abs(z - median);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = kFarDeviations * *middle;
  const auto far =
      std::count_if(sorted.begin(), sorted.end(), [&](double miss) { return miss > limit; });
  // Many of them are features, not outliers: the holes of a flat land.
  if (limit <= 0 || static_cast<double>(far) > kMostOutliers * static_cast<double>(sorted.size()))
    return median;
  changes.where = {g.lx, 0, g.ly, 0};
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      const double miss = std::abs(h.z[i] - median);
      if (!sound[i] || miss <= limit) continue;
      sound[i] = 0;
      ++changes.replaced;
      changes.furthest = std::max(changes.furthest, miss);
      ScanPlace& w = changes.where;
      w = {std::min(w.x0, g.x(ix)), std::max(w.x1, g.x(ix)), std::min(w.y0, g.y(iy)),
           std::max(w.y1, g.y(iy))};
    }
  }
  return median;
}

// The mean of the nearest square of neighbours that has sound ones.
double mended(const Heightmap& h, const Sound& sound, int ix, int iy, double otherwise) {
  const Grid& g = h.grid;
  for (int reach = 1; reach < std::max(g.nx, g.ny); ++reach) {
    double sum = 0;
    int count = 0;
    const auto take = [&](int jx, int jy) {
      if (jx < 0 || jy < 0 || jx >= g.nx || jy >= g.ny || !sound[g.index(jx, jy)]) return;
      sum += h(jx, jy);
      ++count;
    };
    for (int d = -reach; d <= reach; ++d) {  // nearer ones are all unsound
      take(ix + d, iy - reach);
      take(ix + d, iy + reach);
      if (std::abs(d) == reach) continue;
      take(ix - reach, iy + d);
      take(ix + reach, iy + d);
    }
    if (count > 0) return sum / count;
  }
  return otherwise;
}

void mend(Heightmap& h, const Sound& sound, double median) {
  const Heightmap old = h;
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      if (!sound[h.grid.index(ix, iy)]) h(ix, iy) = mended(old, sound, ix, iy, median);
    }
  }
}

std::string share_text(std::size_t part, std::size_t whole) {
  return fmt::format("{} of {} pixels ({:.2g} %)", part, whole,
                     100 * static_cast<double>(part) / static_cast<double>(whole));
}

}  // namespace

bool BorderSteps::alike() const {
  constexpr double kAlike = 1.5;  // scatter of two rms steps of one surface
  return over <= kAlike * beside;
}

std::array<BorderSteps, 2> border_steps(const Heightmap& h) {
  const auto steps = [](int places, const auto& z, int last) -> BorderSteps {
    return {rms_along(places, [&](int i) { return z(0, i) - z(last, i); }),
            std::hypot(rms_along(places, [&](int i) { return z(1, i) - z(0, i); }),
                       rms_along(places, [&](int i) { return z(last, i) - z(last - 1, i); })) /
                std::sqrt(2.0)};
  };
  return {steps(
              h.grid.ny, [&](int ix, int iy) { return h(ix, iy); }, h.grid.nx - 1),
          steps(
              h.grid.nx, [&](int iy, int ix) { return h(ix, iy); }, h.grid.ny - 1)};
}

std::string impossible(const Heightmap& h) {
  constexpr double kMostSteep = 10;  // heights over the width of their map
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const double span = *high - *low;
  if (!std::isfinite(span) || span <= kMostSteep * h.grid.lx) return {};  // no numbers: for others
  return fmt::format(
      "heights over {:.4g} um on a width of {:.4g} um: no surface is so steep; the heights are "
      "likely in another unit",
      1e6 * span, 1e6 * h.grid.lx);
}

double ScanChanges::tilt() const { return std::atan(std::hypot(slope_x, slope_y)); }

Scan read_scan(const ScanSource& source) {
  MapAnswer read =
      read_map(source.file, source.width, source.fill ? NotNumbers::Kept : NotNumbers::Refused);
  Scan out{std::move(read.map), {}};
  Heightmap& h = out.map;
  ScanChanges& changes = out.changes;
  changes.made = read.made;
  changes.as_is = source.as_is;
  changes.width = h.grid.lx;
  changes.height = h.grid.ly;
  changes.pixels = h.z.size();
  Sound sound(h.z.size());
  for (std::size_t i = 0; i < sound.size(); ++i) sound[i] = std::isfinite(h.z[i]);
  changes.filled = count_unsound(sound);
  if (static_cast<double>(changes.filled) > kMostFilled * static_cast<double>(changes.pixels)) {
    throw InputError(
        fmt::format("{}: {} are no numbers; at most a fifth can be filled: cut the map",
                    source.file, share_text(changes.filled, changes.pixels)));
  }
  for (std::size_t i = 0; i < sound.size(); ++i) {
    if (sound[i] && std::abs(h.z[i]) > kMostHigh)
      throw InputError(
          fmt::format("{}: a height of {:.3g} m is no surface's", source.file, h.z[i]));
  }
  double median = 0;
  if (!source.as_is) {
    level(h, sound, source.level, changes);
    median = mark_outliers(h, sound, changes);
  }
  if (count_unsound(sound) > 0) mend(h, sound, median);
  if (const std::string why = impossible(h); !why.empty())
    throw InputError(source.file + ": " + why + " (NPY holds m, EXR um)");
  changes.highest = *std::max_element(h.z.begin(), h.z.end());
  changes.rms = rms_of(h);
  return out;
}

std::string text(const std::string& file, const ScanChanges& c) {
  std::string out = file + ": ";
  if (c.as_is) {
    out += "taken as it is, neither levelled nor mended";
  } else {
    out +=
        c.repeats ? "its borders meet, it repeats by itself: no plane was taken away; "
        : c.made
            ? fmt::format(
                  "a made map, no instrument's: no plane was taken away{} (--level, "
                  "texture.level = true take it); ",
                  c.kept_tilt > kNoticedTilt
                      ? fmt::format(", though one of {:.3g} deg ({:.4g} nm over the map) is in it",
                                    c.kept_tilt * 180 / kPi, 1e9 * c.kept_rise)
                      : "")
            : fmt::format("a plane of {:.3g} deg ({:.4g} nm over the map) was taken away; ",
                          c.tilt() * 180 / kPi, 1e9 * c.rise);
    out += c.replaced == 0
               ? "no pixel was replaced"
               : fmt::format(
                     "{} replaced by their neighbours, {:.4g} nm from the median at most, "
                     "within x = {:.4g} to {:.4g} um, y = {:.4g} to {:.4g} um",
                     share_text(c.replaced, c.pixels), 1e9 * c.furthest, 1e6 * c.where.x0,
                     1e6 * c.where.x1, 1e6 * c.where.y0, 1e6 * c.where.y1);
  }
  if (c.filled > 0)
    out += fmt::format("; {} were no numbers and were filled", share_text(c.filled, c.pixels));
  if (c.rms > 0 && c.rms < kSmoothest) {
    out += fmt::format(
        "; its heights have an rms of {:.2g} nm, smoother than any polished surface: they are "
        "likely in another unit (NPY holds m, EXR um)",
        1e9 * c.rms);
  }
  return out;
}

}  // namespace papilla::geometry
