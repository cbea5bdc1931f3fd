// What to build, of a finished run: one recommendation, dimensions with their tolerances, and what
// the finish and the texture do.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/advice.h"
#include "search/run.h"

namespace papilla::report {

// Texts and values of this file carry what is behind their numbers (stated_number.h).

// What should be built, what it gains and costs, and what speaks against it.
std::string recommendation(const ResultFiles& files);
// What the recommendation rests on, in sentences: fingers and humidities, what is in no ±, a worst
// case that nobody feels, how it looks.
std::vector<std::string> grounds(const ResultFiles& files);

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
// How far a number may be off, for people: "12 nm", "9.6 nm, then min_wall is reached".
std::string drift_text(const Drift& drift, const std::string& unit);

// The recommended design on the grid of the fab: values as the sheet has them, in every digit.
Design built_design(const ResultFiles& files);

// "design 06" of front/06.
std::string design_name(const std::string& folder);
// "grooves 1.2 um wide, 5.41 um apart, 349 nm deep"
std::string shape_text(const Design& design);
// "min_wall is 0.3 um, below your limit of 0.4 um"
std::string limit_broken(const LimitValue& value);
// What a design has of a limit, as a stated number.
std::string limit_stated(const LimitValue& value, const std::string& words);
// The limits of the study and what the design has of them; without what is behind them.
nlohmann::ordered_json limits_json(const std::vector<LimitValue>& limits);

// "## What to build" of summary.md.
std::string sheet_text(const ResultFiles& files);
// run.json: how the run ended, remarks, recommendation, sheet.
nlohmann::ordered_json run_json(const ResultFiles& files);

}  // namespace papilla::report
