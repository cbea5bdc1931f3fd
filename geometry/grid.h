// A periodic rectangular sampling: pixel (ix, iy) has its centre at ((ix + 1/2) dx, (iy + 1/2) dy).
#pragma once

#include <cstddef>

#include "base/rooms.h"

namespace papilla::geometry {

struct Grid {
  int nx = 0, ny = 0;
  double lx = 0, ly = 0;  // periods [m]

  double dx() const { return lx / nx; }
  double dy() const { return ly / ny; }
  double area() const { return lx * ly; }
  double pixel_area() const { return dx() * dy(); }
  std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  std::size_t index(int ix, int iy) const {  // row-major, x fastest
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(ix);
  }
  double x(int ix) const { return (ix + 0.5) * dx(); }
  double y(int iy) const { return (iy + 0.5) * dy(); }

  bool operator==(const Grid&) const = default;
};

// i modulo n into [0, n), for periodic neighbours.
constexpr int wrap(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

}  // namespace papilla::geometry
