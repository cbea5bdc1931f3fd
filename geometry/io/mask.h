// Pixels as makers see them: which are deep, how narrow holes and walls are, polygons of both.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

// Smallest width of what is deep (holes) and of what is not (walls): by the distance between
// opposite borders across the middle line, and up to six pixels by opening with growing discs, the
// width at which the opening loses more than a corner. Right to a quarter of a pixel from four
// pixels on, up to two too wide below; infinite where there is none of one kind. Below half the
// depth counts as deep. The map is periodic. Cost: some twenty distance transforms.
struct PixelMargins {
  double min_hole = 0, min_wall = 0;  // [m]
  double pixel = 0;                   // [m]
};
PixelMargins measure_margins(const Heightmap& h);

// Distance [m] of each pixel of the periodic grid to the nearest pixel that is not set
// (Felzenszwalb and Huttenlocher); infinite when all are set. 0 outside.
std::vector<double> distance_inside(const Grid& grid, const std::vector<std::uint8_t>& set);

// Convex polygons [nm] that tile the area where h lies below `level` [m], bounded by the
// marching-squares contour through the pixel centres; closed at the border of the map.
struct Polygon {
  std::vector<std::int32_t> x, y;

  bool operator==(const Polygon&) const = default;
};
std::vector<Polygon> polygons_below(const Heightmap& h, double level);

}  // namespace papilla::geometry
