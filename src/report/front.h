// The picture of a front.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::report {

// pareto.csv of a folder that `papilla optimize` wrote as an SVG picture: each further objective
// over the first, searched and confirmed designs. Throws InputError where there is no front of two
// objectives.
std::string front_svg(const std::string& folder);

}  // namespace papilla::report
