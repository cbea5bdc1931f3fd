// Files that hold several maps: which of them is meant (internal to geometry/io).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::geometry {

struct MapChannel {
  std::string name, unit;  // "" of the unit: no dimension
  int nx = 0, ny = 0;
  bool heights = false;  // its values are lengths
};

// The channel of that name or number (from 1); of none asked for the one that holds heights. Throws
// InputError with all of them where that is none or several.
std::size_t choose_channel(const std::string& path, const std::vector<MapChannel>& channels,
                           const std::string& asked);

}  // namespace papilla::geometry
