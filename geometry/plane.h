// Least-squares planes of maps.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

// a + b x + c y
struct Plane {
  double a = 0, b = 0, c = 0;

  double at(double x, double y) const { return a + b * x + c * y; }
};

// Of the pixels of the map inside a rectangle with its lower corner at (x0, y0) [m]; of those that
// `counts` has alone, where it is given.
Plane plane_of(const Heightmap& h, double x0, double y0, double lx, double ly,
               const std::vector<std::uint8_t>* counts = nullptr);

}  // namespace papilla::geometry
