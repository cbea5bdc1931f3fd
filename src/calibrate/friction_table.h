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
  std::string design;  // file
  // SI. frequency: of the drive under a voltage, 0: a constant one.
  double relative_humidity = 0, amplitude = 0, frequency = 0, load = 0;
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
// under a voltage its frequency too. A fit is of one finger, which has numbers of its own for each
// state: rows of others than the named one are left out; without a name, rows of others than the
// first are refused. Throws InputError with every mistake.
FrictionTable read_friction(const std::string& path, const std::string& finger = "");

// A design, driven and pressed as a row says.
Design as_measured(Design design, const FrictionDatum& row);
// Throws InputError for every friction under a voltage that its design does not have: a constant
// one where the design is driven by a wave, one at which its film breaks down (Eq.
// electrostatics.9). path: of the table.
void check_drives(const std::vector<FrictionDatum>& rows, const std::string& path);

}  // namespace papilla::calibrate
