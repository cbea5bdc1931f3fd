// The page that a run is judged by: one HTML file with its scripts and numbers inside.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/rooms.h"

namespace papilla::report {

// Of a folder of results.
inline constexpr const char* kPageName = "report.html";

// Reads a folder that `papilla optimize`, `papilla rank --out` or `papilla calibrate` wrote;
// nothing in the page depends on the clock. For `optimize` the field pictures solve one patch of
// the design at each humidity (a second or less each), and `pick` says which of the front the page
// is about (empty: best/). Follows no link within the folder. Throws InputError where it is no
// finished run.
std::string report_page(const std::string& folder, const std::string& pick = "");

// The page of a search that is not finished, of the folder that holds its study.toml; search: what
// the studio tells of it.
std::string unfinished_page(const std::string& folder, const nlohmann::ordered_json& search);

}  // namespace papilla::report
