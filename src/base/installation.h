// Where the parts of Papilla lie that are not in the library: found from the library's own place,
// so that an installed tree works wherever it is moved, in whatever program the library is loaded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

// The file of a module that is loaded when it is needed; the bare name where it is not found beside
// the library, so that the system looks for it.
std::filesystem::path find_module(const std::string& name);

// The folders of designs that belong to the library: of the installed tree, or of the build tree,
// which has a link to those of the source; links followed, those that exist.
std::vector<std::string> own_designs();

}  // namespace papilla::base
