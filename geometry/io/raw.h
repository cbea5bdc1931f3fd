// What the readers and writers of files share (internal to geometry/io).
#pragma once

#include <cstdint>
#include <string>

#include "base/rooms.h"

namespace papilla::geometry {

// The lowest bytes of a number, the least first.
std::string little(std::uint64_t value, int bytes);
// Throws InputError for sizes that cannot be read.
void check_size(const std::string& path, double nx, double ny);

}  // namespace papilla::geometry
