// Measured surfaces as textures.
#pragma once

#include "geometry/texture.h"

namespace papilla {

// The map of the file, levelled, mended and made periodic, resampled on the grid.
Heightmap measured_heights(const Measured3d& map, const Grid& grid);

}  // namespace papilla
