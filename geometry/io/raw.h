// Readers of the plain formats (internal to geometry/io).
#pragma once

#include <string>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

Heightmap read_gsf(const std::string& path);
Heightmap read_npy(const std::string& path, double width);
// Throws InputError for sizes that cannot be read.
void check_size(const std::string& path, double nx, double ny);

}  // namespace papilla::geometry
