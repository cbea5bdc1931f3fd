// A sampled periodic surface; z [m] is positive toward the counter-body (high touches first).
// For textures the untouched land is z = 0 and holes are negative; pillars and particles are
// positive.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::geometry {

struct Heightmap {
  Grid grid;
  std::vector<double> z;  // grid.size() values [m], row-major

  double& operator()(int ix, int iy) { return z[grid.index(ix, iy)]; }
  double operator()(int ix, int iy) const { return z[grid.index(ix, iy)]; }

  bool operator==(const Heightmap&) const = default;
};

}  // namespace papilla::geometry
