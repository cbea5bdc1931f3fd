// Tables of what was measured, as they stand in a file: a user's own, the plan of a lab filled in,
// a wafer's manifest.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"
#include "scene/environment.h"
#include "scene/finger.h"

namespace papilla::scene {

// A line; SI. What its cell is empty of, or the table has no column of, is not there.
struct MeasuredRow {
  std::string experiment, field, design, finger, day;
  std::optional<FingerState> state;
  std::optional<double> load, relative_humidity, voltage, frequency;
  std::optional<double> off, off_sd, on, on_sd;  // [N]
  int repeat = 0;                                // 0: not said
  int line = 0;

  bool measured() const { return off.has_value() || on.has_value(); }
};

struct MeasuredTable {
  std::vector<MeasuredRow> rows;
  std::vector<std::string> notes;            // for people: what was not read
  bool has_friction = false;                 // a column of it
  std::vector<std::string> columns, unread;  // "load", "F_off_sd"; what it has beside them

  bool has(const std::string& column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
};

// Columns by name and unit in any order; further ones are told and not read. Throws InputError with
// every mistake and its line: a unit that is none, a column that nearly has a known name, a number
// that is none or lies outside of what a finger does, a friction beyond ten times the load, F_on
// below F_off on average by more than touches scatter, a line that is cut off.
MeasuredTable read_measured_table(std::string_view text, const std::string& file);

// A table reads its rows by these three; what was measured otherwise is held against them too.
// What no finger does: a friction beyond ten times the load, one under a voltage of 0.
std::vector<Problem> row_problems(const MeasuredRow& row, const std::string& file);
// What is wrong with a relative humidity, from 0 to 1, that was measured: less than 1 % is a share.
// "": nothing.
std::string humidity_problem(double relative_humidity);
// Whether a row with both frictions surely says that the finger rubs less under voltage than
// without it, by more than touches scatter, where a voltage draws the finger to the surface.
bool rubs_less_driven(const MeasuredRow& row);

// What is wrong with a frequency [Hz] that was measured under the voltage of a drive: 0 is a
// constant voltage, and a design that is driven by a wave has another friction. "": nothing.
std::string frequency_problem(const Drive& drive, double frequency);

}  // namespace papilla::scene
