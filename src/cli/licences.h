#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::cli {

// The libraries that this build has loaded, images included, and their licences: by what the loader
// says, so that no list can be older than the build.
std::string licences();

}  // namespace papilla::cli
