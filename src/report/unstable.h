// Why the place of a design on the front does not hold in the checks of the order, and what does.
#pragma once

#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// " Its place holds in 5 of 13 checks only (equilibrium: design 02 is better). The alternative
// ..."; "" where it holds, or was not checked. place: among the finalists.
std::string unstable_text(const ResultFiles& files, std::size_t place);

// "it has no value (pull-in: no equilibrium ...)": of a design without one in a check.
std::string no_value_text(const StabilityVariant& variant, std::size_t place);

}  // namespace papilla::report
