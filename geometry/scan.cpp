#include "geometry/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "geometry/io/files.h"
#include "geometry/plane.h"

namespace papilla::geometry {
namespace {

constexpr double kFarDeviations = 8;    // of the median from the median: outliers
constexpr double kMostOutliers = 0.02;  // of the pixels; more of them are features
constexpr int kMostPasses = 8;  // of the plane and of the outliers about it: two do as a rule
constexpr double kMostFilled = 0.2;
constexpr double kMostHigh = 1e100;  // [m] of either sign: sums of their squares stay numbers
constexpr double kNoticedTilt = 0.1 * kPi / 180;  // of a made map: a scan that was saved as one
constexpr double kSmoothest = 0.1e-9;  // [m] rms; of superpolished glass it is 0.1 nm and more

// The pixels that count: those that are numbers, or those of them that are no outliers.
using Sound = std::vector<std::uint8_t>;

bool can_be_filled(std::size_t filled, std::size_t pixels) {
  return static_cast<double>(filled) <= kMostFilled * static_cast<double>(pixels);
}

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

// Takes away the plane of the pixels that count: of maps that repeat and of made ones the mean
// alone. To a mean of 0 in any case: bands that are blended keep their variance about it.
void level(Heightmap& h, const Sound& counts, ScanChanges& changes) {
  const Grid& g = h.grid;
  const Sound* some = count_unsound(counts) > 0 ? &counts : nullptr;
  const bool keeps_plane = changes.repeats || changes.made;
  const Plane plane = keeps_plane ? Plane{mean_of(h, counts)} : plane_of(h, 0, 0, g.lx, g.ly, some);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) h(ix, iy) -= plane.at(g.x(ix), g.y(iy));
  }
  if (changes.made && !changes.repeats) {
    const Plane left = plane_of(h, 0, 0, g.lx, g.ly, some);
    changes.kept_tilt = std::atan(std::hypot(left.b, left.c));
    changes.kept_rise = std::abs(left.b) * g.lx + std::abs(left.c) * g.ly;
  }
  changes.slope_x += plane.b;
  changes.slope_y += plane.c;
  changes.rise = std::abs(changes.slope_x) * g.lx + std::abs(changes.slope_y) * g.ly;
}

double median_of(std::vector<double>& z) {
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2);
  std::nth_element(z.begin(), middle, z.end());
  return *middle;
}

// What is further from the median of the numbers than the limit is none of the sound pixels.
struct Judged {
  Sound sound;
  double median;  // [m]
};

Judged judge(const Heightmap& h, const Sound& numbers) {
  std::vector<double> sorted;
  for (std::size_t i = 0; i < h.z.size(); ++i) {
    if (numbers[i]) sorted.push_back(h.z[i]);
  }
  Judged out{numbers, median_of(sorted)};
  for (double& z : sorted) z = std::abs(z - out.median);
  const double limit = kFarDeviations * median_of(sorted);
  const auto far =
      std::count_if(sorted.begin(), sorted.end(), [&](double miss) { return miss > limit; });
  // Many of them are features, not outliers: the holes of a flat land.
  if (limit <= 0 || static_cast<double>(far) > kMostOutliers * static_cast<double>(sorted.size()))
    return out;
  for (std::size_t i = 0; i < h.z.size(); ++i)
    out.sound[i] = numbers[i] && std::abs(h.z[i] - out.median) <= limit;
  return out;
}

// Outliers stand out of the plane of the others: a grain of dust in a corner tilts that of all
// pixels, and a tilted map hides and makes outliers. So the plane and what counts for it are found
// in turn, until no pixel changes sides. Eq. geometry.4
Judged level_and_judge(Heightmap& h, const Sound& numbers, ScanChanges& changes) {
  Judged out{numbers, 0};
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Sound counts = std::move(out.sound);
    level(h, counts, changes);
    out = judge(h, numbers);
    if (out.sound == counts) break;
  }
  return out;
}

// How many were replaced, how far they lay from the median, and where.
void note_outliers(const Heightmap& h, const Sound& numbers, const Judged& judged,
                   ScanChanges& changes) {
  const Grid& g = h.grid;
  changes.where = {g.lx, 0, g.ly, 0};
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      if (!numbers[i] || judged.sound[i]) continue;
      ++changes.replaced;
      changes.furthest = std::max(changes.furthest, std::abs(h.z[i] - judged.median));
      ScanPlace& w = changes.where;
      w = {std::min(w.x0, g.x(ix)), std::max(w.x1, g.x(ix)), std::min(w.y0, g.y(iy)),
           std::max(w.y1, g.y(iy))};
    }
  }
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
  const double share = static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{} of {} pixels ({} %)", part, whole, significant(100 * share, 2));
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
  changes.marked = read.marked;
  changes.width = h.grid.lx;
  changes.height = h.grid.ly;
  changes.pixels = h.z.size();
  Sound numbers(h.z.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::isfinite(h.z[i]);
  changes.filled = count_unsound(numbers);
  if (!can_be_filled(changes.filled, changes.pixels)) {
    throw InputError(
        fmt::format("{}: {} are no numbers{}; at most a fifth can be filled: cut the map{}",
                    source.file, share_text(changes.filled, changes.pixels),
                    changes.marked > 0 ? " or marked by the mask of the file" : "",
                    changes.marked > 0 ? ", or leave --fill (texture.fill) out to take what is "
                                         "marked as heights, as for a mask of grains"
                                       : ""));
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] && std::abs(h.z[i]) > kMostHigh)
      throw InputError(
          fmt::format("{}: a height of {:.3g} m is no surface's", source.file, h.z[i]));
  }
  Judged judged{numbers, 0};
  if (!source.as_is) {
    changes.repeats = !source.level && borders_meet(h);
    changes.made = !source.level && changes.made;
    judged = level_and_judge(h, numbers, changes);
    note_outliers(h, numbers, judged, changes);
  }
  if (count_unsound(judged.sound) > 0) mend(h, judged.sound, judged.median);
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
    out += fmt::format("; {} were no numbers{} and were filled", share_text(c.filled, c.pixels),
                       c.marked > 0 ? " or marked by the mask of the file" : "");
  else if (c.marked > 0)
    out +=
        fmt::format("; the mask of the file marks {}, which are taken as heights{}",
                    share_text(c.marked, c.pixels),
                    can_be_filled(c.marked, c.pixels)
                        ? " (--fill, texture.fill = true take them as not measured and fill them)"
                        : "");
  if (c.rms > 0 && c.rms < kSmoothest) {
    out += fmt::format(
        "; its heights have an rms of {:.2g} nm, smoother than any polished surface: they are "
        "likely in another unit (NPY holds m, EXR um)",
        1e9 * c.rms);
  }
  return out;
}

}  // namespace papilla::geometry
