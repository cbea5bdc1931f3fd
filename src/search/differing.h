// What two studies say otherwise, by their resolved files.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::search {

// "texture.depth \"350 nm\", \"400 nm\"": what two resolved files say otherwise, three at most.
// Without the keys that a run may be continued with.
std::string differing_keys(const std::string& there, const std::string& here);

}  // namespace papilla::search
