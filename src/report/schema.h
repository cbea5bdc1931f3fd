// The JSON Schema of design and study files, from the lists of fields that read them.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::report {

// Draft 2020-12; a file as TOML parsers give it to a validator. What needs more than one value is
// not in it: ranges of numbers that are written with a unit, limits across keys.
std::string json_schema();

}  // namespace papilla::report
