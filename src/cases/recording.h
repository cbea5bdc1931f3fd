// Recordings: tables of numbers over time.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/columns.h"
#include "physics/drive/signal.h"
#include "scene/environment.h"

namespace papilla::cases {

// What a recording has columns of, in SI units and in the order of a file without a head.
struct RecordedColumns {
  std::vector<ColumnKind> kinds;
  bool first_may_lack = false;
  std::string expected;  // for people: "\"time,value\" in s and V"
};

// Rows in SI, in the order of the kinds, and the line of the file that each stands in.
struct Recording {
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;
};

// Numbers between commas, all lines alike. Below a head the columns are in its order and units; a
// name without a unit is in SI. Throws InputError naming `name`, the line and what was expected.
Recording read_recording(const std::string& csv, const std::string& name,
                         const RecordedColumns& columns);

// The even step of a first column of times [s]. Throws InputError where it is uneven.
double even_step(const Recording& recording, const std::string& name);

// "time,value" of what the source holds as one period, straight between the lines: a power of two
// of samples.
Signal recorded_signal(const std::string& csv, const std::string& name, DriveControl control);

}  // namespace papilla::cases
