// What the readers of files share (internal to geometry/io).
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::geometry {

std::string lower_ending(const std::string& path);  // ".exr"
// Throws InputError for sizes that cannot be read.
void check_size(const std::string& path, double nx, double ny);

}  // namespace papilla::geometry
