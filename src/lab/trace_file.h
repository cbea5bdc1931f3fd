// The raw record of a tribometer: forces over time, as it stands in a file.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/rooms.h"

namespace papilla::lab {

// SI; one number a sample. A column that the file has not is empty.
struct Trace {
  std::vector<double> time, tangential, normal, voltage, humidity, position;
  std::map<std::string, std::string> said;  // "# Field: A3" before the header: "field" to "A3"
  std::vector<std::string> notes;           // what was found wrong and how it was taken, for people

  std::size_t size() const { return time.size(); }
};

// Whether a text is such a record: its header has a time and a tangential force.
bool is_trace(std::string_view text);

// Columns by name and unit, "time_s,tangential_mN,normal_N,voltage_V,humidity_percent,position_mm";
// lines of '#' before the header may say which experiment, field, finger, day it is. Samples
// without numbers are left out and told. Throws InputError with every mistake: no time or force, a
// unit that is none, a time that does not rise, more than a twentieth of the lines unreadable.
// Cost: 0.3 s for 10^6 samples of six columns.
Trace read_trace(std::string_view text, const std::string& file);

}  // namespace papilla::lab
