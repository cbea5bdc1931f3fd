#include "physics/capillary/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::capillary {
namespace {

// Length of the zero line of a field in the cell between four pixel centres (marching squares):
// corners a to d in order around it, wet ones negative.
double cell_length(double a, double b, double c, double d, double dx, double dy) {
  const int wet = (a < 0) + (b < 0) + (c < 0) + (d < 0);
  if (wet == 0 || wet == 4) return 0;
  // Crossing points around the cell in order; two (or, at a saddle, four).
  double px[4], py[4], length = 0;
  int n = 0;
  const auto cut = [](double p, double q) { return p / (p - q); };
  if ((a < 0) != (b < 0)) px[n] = cut(a, b) * dx, py[n++] = 0;
  if ((b < 0) != (c < 0)) px[n] = dx, py[n++] = cut(b, c) * dy;
  if ((c < 0) != (d < 0)) px[n] = (1 - cut(c, d)) * dx, py[n++] = dy;
  if ((d < 0) != (a < 0)) px[n] = 0, py[n++] = (1 - cut(d, a)) * dy;
  for (int k = 0; k + 1 < n; k += 2) length += std::hypot(px[k + 1] - px[k], py[k + 1] - py[k]);
  return length;
}

// Above the level, whatever rounding says, if and only if dry.
double excess(bool wet, double height, double level) {
  const double above = height - level;
  return wet ? std::min(above, -1e-9 * level) : std::max(above, 1e-9 * level);
}

// Visits the pixels at the corners of every cell, in order around it.
template <class Visit>
void for_cells(const Grid& g, Visit&& visit) {
  for (int iy = 0; iy < g.ny; ++iy) {
    const int jy = iy + 1 == g.ny ? 0 : iy + 1;
    for (int ix = 0; ix < g.nx; ++ix) {
      const int jx = ix + 1 == g.nx ? 0 : ix + 1;
      visit(std::array{g.index(ix, iy), g.index(jx, iy), g.index(jx, jy), g.index(ix, jy)});
    }
  }
}

std::array<std::size_t, 4> neighbours(const Grid& g, std::size_t at) {
  const auto nx = static_cast<std::uint32_t>(g.nx), ny = static_cast<std::uint32_t>(g.ny),
             pixel = static_cast<std::uint32_t>(at);
  const std::uint32_t iy = pixel / nx, ix = pixel - iy * nx;
  return {ix + 1 == nx ? at - ix : at + 1, ix == 0 ? at + nx - 1 : at - 1,
          iy + 1 == ny ? ix : at + nx, iy == 0 ? at + std::size_t{ny - 1} * nx : at - nx};
}

// Pixels by level, the lowest first; of one level by their number. A level and its pixel are one
// integer, the level rounded down to 28 bits at least: four children a node and no branches on
// their order take a third of the time of std::priority_queue.
class PixelQueue {
 public:
  explicit PixelQueue(std::size_t pixels)
      : pixels_((std::uint64_t{1} << std::bit_width(pixels)) - 1) {}

  bool empty() const { return heap_.empty(); }

  // level >= 0
  void push(double level, std::size_t pixel) {
    const std::uint64_t key = (std::bit_cast<std::uint64_t>(level + 0.0) & ~pixels_) | pixel;
    std::size_t at = heap_.size();
    heap_.push_back(key);
    for (; at > 0; at = (at - 1) / kChildren) {
      const std::uint64_t above = heap_[(at - 1) / kChildren];
      if (above <= key) break;
      heap_[at] = above;
    }
    heap_[at] = key;
  }

  std::size_t pop() {
    const std::uint64_t top = heap_.front(), key = heap_.back();
    heap_.pop_back();
    const std::size_t n = heap_.size();
    std::size_t at = 0;
    for (std::size_t child = 1; child < n; child = kChildren * at + 1) {
      std::size_t least = child;
      for (std::size_t k = child + 1; k < std::min(child + kChildren, n); ++k)
        least = heap_[k] < heap_[least] ? k : least;
      if (heap_[least] >= key) break;
      heap_[at] = heap_[least];
      at = least;
    }
    if (n > 0) heap_[at] = key;
    return static_cast<std::size_t>(top & pixels_);
  }

 private:
  static constexpr std::size_t kChildren = 4;
  std::uint64_t pixels_;  // bits of a pixel's number
  std::vector<std::uint64_t> heap_;
};

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

namespace {

// Eq. capillary.9
double film_force(const WaterProperties& water, double area, double height, double perimeter) {
  if (water.pressure_alone)
    return water.surface_tension * laplace_force(water, area, height, kInfinity);
  const double c = wetting_gain(water.theta_skin, water.theta_substrate);
  const double f = meniscus_factor(water.theta_skin, water.theta_substrate);
  return water.surface_tension * (c * area / height + f * perimeter);
}

// A closed line of length P spans the width P / pi.
double film_retention(const WaterProperties& water, double perimeter) {
  return kPi / 4 * water.surface_tension * (perimeter / kPi) * water.hysteresis;
}

class Growth {
 public:
  Growth(const Gap& gap, const std::vector<FilmSource>& sources,
         const std::vector<std::size_t>& seeds,
         const std::function<double(std::size_t, int)>& joins)
      : gap_(gap),
        sources_(sources),
        seeds_(seeds),
        joins_(joins),
        queued_(gap.grid.size(), 0),
        reached_by_(gap.grid.size()) {
    const std::size_t n = sources.size();
    bodies_.resize(n);
    out_.of_source.resize(n);
    out_.source.assign(gap.grid.size(), 0);
    for (std::size_t i = 0; i < n; ++i) {
      bodies_[i].members.assign(1, static_cast<int>(i));
      bodies_[i].region.volume = sources[i].volume;
      out_.of_source[i] = static_cast<int>(i);
    }
  }

  // In rounds: bodies that meet in one grow as one from the next on, so that a patch of many costs
  // a few fillings and not one for each that joins. A body that has begun anew kMostGrowths times
  // keeps what it has filled and takes in what it meets as it goes: of so many that one more hardly
  // moves its level.
  FilmRegions run(const WaterProperties& water) {
    for (bool met = true; met;) {
      met = false;
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (bodies_[i].grown || bodies_[i].members.empty()) continue;
        bodies_[i].grown = grow(static_cast<int>(i));
        met = met || !bodies_[i].grown;
      }
    }
    measure(water);
    return std::move(out_);
  }

 private:
  // Connected water while it grows; empty once it is part of another.
  struct Body {
    std::vector<int> members;  // sources
    std::vector<std::size_t> pixels;
    FilmRegion region;
    int growths = 0;
    bool grown = false;
  };
  static constexpr int kMostGrowths = 8;

  double level_at(int source, std::size_t pixel) const {
    const FilmSource& s = sources_[source];
    const double h = gap_.value[pixel];
    if (s.share >= 1) return h;
    const Grid& g = gap_.grid;
    const auto nearest = [](double d, double period) {
      return d - period * std::round(d / period);
    };
    const double ex = nearest(g.x(static_cast<int>(pixel % g.nx)) - s.x, g.lx);
    const double ey = nearest(g.y(static_cast<int>(pixel / g.nx)) - s.y, g.ly);
    return film_level(s, square(ex) + square(ey), h);
  }

  void release(Body& body) {
    for (std::size_t k : body.pixels) out_.source[k] = 0;
    body.pixels.clear();
  }

  // False: it met another body, which is now part of it, and has to grow anew. Until then both stay
  // where they are, for others to meet.
  bool grow(int index) {
    Body& body = bodies_[index];
    FilmRegion& region = body.region;
    const bool goes_on = ++body.growths > kMostGrowths;
    release(body);
    region.height = 0;
    const double pixel_area = gap_.grid.pixel_area();
    ++stamp_;
    PixelQueue edge(gap_.grid.size());
    const auto reach = [&](std::size_t pixel, int source) {
      if (queued_[pixel] == stamp_) return;
      queued_[pixel] = stamp_;
      reached_by_[pixel] = source;
      edge.push(level_at(source, pixel), pixel);
    };
    for (int m : body.members) reach(seeds_[m], m);
    double placed = 0, pixels = 0;
    while (!edge.empty()) {
      const std::size_t at = edge.pop();
      const int source = reached_by_[at];
      if (out_.source[at] != 0) {
        const int other = out_.of_source[out_.source[at] - 1];
        if (!goes_on) {
          unite(index, other);
          return false;
        }
        const std::vector<int> joining = bodies_[other].members;
        release(bodies_[other]);
        unite(index, other);
        for (int m : joining) reach(seeds_[m], m);
      }
      out_.source[at] = source + 1;
      body.pixels.push_back(at);
      region.height = std::max(region.height, level_at(source, at));
      region.volume += joins_(at, source);
      const double room = gap_.value[at] * pixel_area;
      if (placed + room >= region.volume) {
        pixels += room > 0 ? (region.volume - placed) / room : 1;
        region.area = pixels * pixel_area;
        return true;
      }
      placed += room;
      pixels += 1;
      for (std::size_t k : neighbours(gap_.grid, at)) reach(k, source);
    }
    region.full = true;
    region.area = gap_.grid.area();
    return true;
  }

  void unite(int index, int other) {
    Body& taken = bodies_[other];
    Body& body = bodies_[index];
    body.pixels.insert(body.pixels.end(), taken.pixels.begin(), taken.pixels.end());
    for (int m : taken.members) out_.of_source[m] = index;
    body.members.insert(body.members.end(), taken.members.begin(), taken.members.end());
    body.region.volume += taken.region.volume;
    body.growths = std::max(body.growths, taken.growths);
    taken = {};
  }

  void measure(const WaterProperties& water) {
    std::vector<double> perimeter(bodies_.size(), 0.0);
    const double dx = gap_.grid.dx(), dy = gap_.grid.dy();
    for_cells(gap_.grid, [&](const std::array<std::size_t, 4>& corner) {
      std::array<int, 4> body;
      for (int c = 0; c < 4; ++c) {
        const int s = out_.source[corner[c]];
        body[c] = s > 0 ? out_.of_source[s - 1] : -1;
      }
      if (body[0] == body[1] && body[0] == body[2] && body[0] == body[3]) return;  // no edge here
      for (int c = 0; c < 4; ++c) {
        const int known = body[c];
        const auto here = body.begin() + c;
        if (known < 0 || std::find(body.begin(), here, known) != here) continue;
        const int source = out_.source[corner[c]] - 1;
        const double level = bodies_[known].region.height;
        std::array<double, 4> above;
        for (int k = 0; k < 4; ++k) {
          const bool wet = body[k] == known;
          const int s = wet ? out_.source[corner[k]] - 1 : source;
          above[k] = excess(wet, level_at(s, corner[k]), level);
        }
        perimeter[known] += cell_length(above[0], above[1], above[2], above[3], dx, dy);
      }
    });
    std::vector<int> place(bodies_.size(), -1);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].members.empty()) continue;
      FilmRegion region = bodies_[i].region;
      double volume = 0;
      for (int m : bodies_[i].members) {
        region.share += sources_[m].share * sources_[m].volume;
        volume += sources_[m].volume;
      }
      region.share = std::min(1.0, region.share / volume);
      if (!region.full) {
        region.force = film_force(water, region.area, region.height, perimeter[i]);
        region.retention = film_retention(water, perimeter[i]);
      }
      place[i] = static_cast<int>(out_.regions.size());
      out_.regions.push_back(region);
    }
    for (int& r : out_.of_source) r = place[r];
  }

  const Gap& gap_;
  const std::vector<FilmSource>& sources_;
  const std::vector<std::size_t>& seeds_;
  const std::function<double(std::size_t, int)>& joins_;
  std::vector<Body> bodies_;
  FilmRegions out_;
  std::vector<std::uint32_t> queued_;  // per pixel: the growth that reached it last
  std::vector<int> reached_by_;        // and the source that did
  std::uint32_t stamp_ = 0;
};

}  // namespace

void measure_film(const Gap& gap, const WaterProperties& water, Film& film) {
  double perimeter = 0;
  for_cells(gap.grid, [&](const std::array<std::size_t, 4>& corner) {
    std::array<double, 4> above;
    for (int k = 0; k < 4; ++k) {
      above[k] = excess(film.wet[corner[k]], gap.value[corner[k]], film.height);
    }
    perimeter += cell_length(above[0], above[1], above[2], above[3], gap.grid.dx(), gap.grid.dy());
  });
  film.force = film_force(water, film.area, film.height, perimeter);
  film.retention = film_retention(water, perimeter);
  std::vector<int> label;
  film.regions = label_regions(gap.grid, film.wet, label);
}

FilmRegions grow_films(const Gap& gap, const std::vector<FilmSource>& sources,
                       const std::vector<std::size_t>& seeds, const WaterProperties& water,
                       const std::function<double(std::size_t, int)>& joins) {
  return Growth(gap, sources, seeds, joins).run(water);
}

}  // namespace papilla::capillary
