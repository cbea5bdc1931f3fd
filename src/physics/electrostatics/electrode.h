// Where the electrode lies below a textured dielectric.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::electrostatics {

// Height of an electrode that a dielectric of a thickness [m] covers conformally with square
// corners, below the finished surface: z - thickness on flats; behind a wall (a drop steeper than
// 45 degrees between neighbouring pixels) the side of the wall is covered as thick, so that within
// one thickness of its foot the electrode lies one thickness below the foot. Cost: wall pixels
// times pixels in a disc of the thickness. Eq. electrostatics.2
Heightmap electrode_below(const Heightmap& surface, double thickness);

// A rigid finished surface and the dielectric below it: what the field rules know of a texture, the
// same for every gap above it.
struct CoveredSurface {
  // thickness: of the dielectric on flats [m]; 0: none.
  CoveredSurface(Heightmap surface, double thickness);

  Heightmap height;  // [m]
  // Dielectric [m] that a column behind a wall holds beyond the thickness; empty without walls.
  std::vector<double> behind_walls;
};

}  // namespace papilla::electrostatics
