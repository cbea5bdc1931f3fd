// What the physics pieces exchange: the gap between skin and surface.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::maps {

struct Gap {
  Grid grid;
  std::vector<double> value;  // [m] >= 0, zero in contact

  double operator()(int ix, int iy) const { return value[grid.index(ix, iy)]; }
};

// A pressure on the skin [Pa], positive = pulls the skin toward the surface.
struct Traction {
  Grid grid;
  std::vector<double> value;

  double mean() const {
    double sum = 0;
    for (double t : value) sum += t;
    return value.empty() ? 0 : sum / static_cast<double>(value.size());
  }
};

}  // namespace papilla::maps
