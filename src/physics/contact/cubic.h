// A field of a coarse grid at the pixels of a finer one, inside this folder.
#pragma once

#include <cmath>
#include <span>

#include "base/constants.h"
#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::contact {

// Coordinate of fine pixel i on a grid ratio times coarser: the pixel left of it and cubic weights
// (Catmull-Rom) of four pixels from the one before.
struct Cubic {
  int first;
  double weight[4];
};
inline Cubic cubic(int i, int ratio, int coarse) {
  const double x = (i + 0.5) / ratio - 0.5, left = std::floor(x), t = x - left;
  return {wrap(static_cast<int>(left) - 1, coarse),
          {0.5 * t * (-1 + t * (2 - t)), 1 + 0.5 * t * t * (3 * t - 5),
           0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (t - 1)}};
}

inline double interpolate(std::span<const double> field, const Grid& grid, const Cubic& x,
                          const Cubic& y) {
  double sum = 0;
  for (int dy = 0; dy < 4; ++dy) {
    double row = 0;
    for (int dx = 0; dx < 4; ++dx) {
      row += x.weight[dx] *
             field[grid.index(wrap(x.first + dx, grid.nx), wrap(y.first + dy, grid.ny))];
    }
    sum += y.weight[dy] * row;
  }
  return sum;
}

}  // namespace papilla::contact
