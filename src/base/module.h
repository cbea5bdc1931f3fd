// Modules: parts of the library that stand on large libraries of others (OpenImageIO, pagmo, Ceres,
// MPI), which take longer to load than most commands run. Each is a shared object behind an
// interface, papilla_<name>.so beside the library, and is loaded when it is first used.
#pragma once

#include <array>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

// All of them. A build without MPI lacks that one.
inline constexpr std::array kModules{"images", "evolution", "descent", "mpi"};

// What the module's function `const void* papilla_<name>(int version)` returns: its implementation
// of the interface, null where the module belongs to another version of it. A module is never
// unloaded: its threads and statics live as long as the program. `purpose`: "cannot ..." of the
// error. Throws std::runtime_error where the module is missing, does not load or does not fit.
const void* load_module(const std::string& name, int version, const std::string& purpose);

// Loads a module without asking it for anything; false where it does not load.
bool module_loads(const std::string& name);

}  // namespace papilla::base
