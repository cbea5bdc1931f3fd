// Two runs beside each other: what was asked differently, what each recommends, their fronts.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::report {

// Both are folders that `papilla optimize` wrote to their end. Differences are of the second less
// the first; the runs are independent, so their errors add in squares. Follows no link within the
// folders. Throws InputError where one is no finished run or they have no objective in common.
std::string comparison_markdown(const std::string& first, const std::string& second);

// The same as one HTML page without scripts, with a picture of both fronts where two objectives are
// common.
std::string comparison_page(const std::string& first, const std::string& second);

}  // namespace papilla::report
