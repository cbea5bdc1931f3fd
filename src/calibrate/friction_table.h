// The user's table of measured friction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "scene/finger.h"

namespace papilla::calibrate {

// One row of measured friction; a line of the user's table.
struct FrictionDatum {
  std::string design;                                                    // file
  double relative_humidity = 0, amplitude = 0, frequency = 0, load = 0;  // SI
  double off = 0, off_sd = 0, on = 0, on_sd = 0;  // [N]; a deviation of 0: not measured
  int line = 0;
  std::optional<FingerState> state{};  // none: that of the design
};
struct FrictionTable {
  std::vector<FrictionDatum> rows;
  std::vector<std::string> notes;  // for people: what was not read, and not taken; what looks odd
};

// A table as `scene/measured_table.h` reads it, with what a fit needs of each row: a design beside
// the table or among the shipped ones, load, humidity, a friction with its standard deviation;
// under a voltage its frequency too. Rows of other fingers than the first are refused: a fit is of
// one, which has numbers of its own for each state. Throws InputError with every mistake.
FrictionTable read_friction(const std::string& path);

// A design, driven and pressed as a row says.
Design as_measured(Design design, const FrictionDatum& row);
// Throws InputError for every friction under a voltage at which the design's film breaks down (Eq.
// electrostatics.9). path: of the table.
void check_films(const std::vector<FrictionDatum>& rows, const std::string& path);

}  // namespace papilla::calibrate
