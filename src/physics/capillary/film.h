// Water of one pressure in a connected region: what bridges become when they outgrow discs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fields/gap.h"
#include "physics/capillary/water.h"

namespace papilla {

struct Film {
  std::vector<std::uint8_t> wet;  // per pixel
  double height = 0;              // h_c: the gap at its edge [m]
  double area = 0;                // [m^2]
  double force = 0;               // [N], Eq. capillary.9
  double retention = 0;           // [N]
  int regions = 0;                // connected ones
};

// Adds force, retention (Eqs. capillary.9, 14) and connected regions to a film whose wet pixels,
// area and edge height are known. Cost: two passes over the patch.
void measure_film(const Gap& gap, const WaterProperties& water, Film& film);

// A bridge on its way from disc to film.
struct FilmSource {
  double x = 0, y = 0, radius = 0, edge_gap = 0;  // of the disc [m]
  double volume = 0;                              // [m^3]
  double share = 1;                               // 0: the disc, 1: a film
};

// The level of a place in the region that grows from a source [m], Eq. capillary.22; rho2: squared
// distance from its centre.
inline double film_level(const FilmSource& s, double rho2, double gap) {
  if (s.share >= 1) return gap;
  return (1 - s.share) * s.edge_gap * rho2 / (s.radius * s.radius) + s.share * gap;
}

// Connected water: one source, or several whose regions met.
struct FilmRegion {
  double height = 0, area = 0, volume = 0;  // gap at the edge [m], [m^2], [m^3]
  double share = 0;                         // of its sources, by volume
  double force = 0, retention = 0;          // [N], Eq. capillary.9
  bool full = false;                        // more water than gap: no meniscus, no force
};

struct FilmRegions {
  std::vector<FilmRegion> regions;
  std::vector<int> of_source;  // region of each source
  std::vector<int> source;     // per pixel: 1 + the source whose water is there, 0: none
};

// Eqs. capillary.15, 22: each source fills from `seeds` outward, always the lowest level next,
// until its volume is placed; regions that meet go on as one with one level. joins(pixel, source)
// returns the volume of other water that a region meets at a pixel (0 for none), which then belongs
// to it; it is asked once for each pixel and growth. Cost: n log n in their pixels for each growth
// (one per source and one more per meeting), plus one pass over the patch.
FilmRegions grow_films(const Gap& gap, const std::vector<FilmSource>& sources,
                       const std::vector<std::size_t>& seeds, const WaterProperties& water,
                       const std::function<double(std::size_t, int)>& joins);

// Labels 1, 2, ... of 4-connected periodic regions of a mask, 0 outside; returns how many.
int label_regions(const Grid& grid, const std::vector<std::uint8_t>& mask, std::vector<int>& label);

}  // namespace papilla
