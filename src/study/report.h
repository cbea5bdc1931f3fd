// The page that a run is judged by: one HTML file with its scripts and numbers inside.
#pragma once

#include <string>

namespace papilla {

// Reads a folder that `papilla optimize` wrote; nothing in the page depends on the clock. The field
// pictures solve one patch of the best design at each humidity (a second or less each). Throws
// InputError where the folder is no finished run.
// `design`: the folder of the design that the page is about, best/ or one of front/.
std::string report_page(const std::string& folder, const std::string& design = "best");

}  // namespace papilla
