// What to build, of a finished run: one recommendation, dimensions with their tolerances, and what
// the finish and the texture do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// What a run says should be built.
enum class Advice {
  Nothing,    // no design keeps every constraint
  Unknown,    // the surface without texture was not computed
  LeaveFlat,  // no texture gains more than the error of the difference; nor does the finish
  Finish,     // the finish (or drive) gains, the texture does not
  Texture,    // the texture gains
};
Advice advice_of(const ResultFiles& files);
// In one sentence.
std::string recommendation(const ResultFiles& files);

// A number of the best design, SI.
struct SheetRow {
  std::string path, unit;  // texture.period, um
  double value = 0;        // as searched
  double build = 0;        // on the grid of the fab
  bool free = false;       // a variable; else fixed by the study
  // Drift that costs no objective more than 5 %: where it is known.
  std::optional<double> down, up;
  bool down_at_least = false, up_at_least = false;
  std::optional<bool> at_bound;  // true: the upper one
};
std::vector<SheetRow> sheet_rows(const ResultFiles& files);

// The best design on the grid of the fab: values as the sheet has them, in every digit.
Design built_design(const ResultFiles& files);

// "## What to build" of summary.md.
std::string sheet_text(const ResultFiles& files);
// run.json: how the run ended, remarks, recommendation, sheet.
std::string run_json(const ResultFiles& files);

}  // namespace papilla::report
