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
  double volume = 0;              // [m^3], with all that joined
  double force = 0;               // [N], Eq. capillary.9
  double retention = 0;           // [N]
  int regions = 0;                // connected ones
  bool full = false;              // more water than gap
};

// Eq. capillary.15: fills from the seed pixels outward, always the lowest gap next, until `volume`
// is placed: the region's edge is at one gap, its pressure one. joins(pixel) returns the volume of
// other water that the film meets at a pixel (0 for none), which then belongs to it. Cost: n log n
// in its pixels, plus one pass over the patch.
Film grow_film(const Gap& gap, const std::vector<std::size_t>& seeds, double volume,
               const WaterProperties& water, const std::function<double(std::size_t)>& joins);

// Force, retention and regions of a film whose wet pixels, area and edge height are known.
void measure_film(const Gap& gap, const WaterProperties& water, Film& film);

// Labels 1, 2, ... of 4-connected periodic regions of a mask, 0 outside; returns how many.
int label_regions(const Grid& grid, const std::vector<std::uint8_t>& mask, std::vector<int>& label);

}  // namespace papilla
