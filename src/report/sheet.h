// The dimensions of what is built, with their tolerances.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// Texts and values of this file carry what is behind their numbers (stated_number.h).

// A number of the design that is built, SI.
struct SheetRow {
  std::string path, unit;  // texture.period, um
  double value = 0;        // as searched
  double build = 0;        // on the grid of the fab
  bool free = false;       // a variable; else fixed by the study
  std::optional<Drift> down, up;
  std::optional<bool> at_bound;  // true: the upper one
};
std::vector<SheetRow> sheet_rows(const ResultFiles& files);
nlohmann::ordered_json row_json(const SheetRow& row);
// How far a number may be off, for people: "12 nm", "9.6 nm, then min_wall is reached".
std::string drift_text(const Drift& drift, const std::string& unit);
// "an objective worsens by 5 % or a limit is reached": what ends a tolerance. Eq. search.9
std::string tolerance_end_text(const ResultFiles& files);
// The searched numbers of what is built that lie off the grid of the fab, as their ranges have no
// value of it: by their paths.
std::vector<std::string> off_the_grid(const ResultFiles& files);
// "500 nm": that grid.
std::string fab_grid_text(const ResultFiles& files);
// Which grid the numbers are on, and what that did; "" where there is none.
std::string grid_text(const ResultFiles& files);

// "## What to build" of summary.md.
std::string sheet_text(const ResultFiles& files);

}  // namespace papilla::report
