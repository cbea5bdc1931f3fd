// One reading of a record: friction without and under the drive, with errors from blocks of steady
// sliding. Eq. lab.13
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/sliding.h"

namespace papilla::lab {

struct TraceReading {
  double off = 0, off_sd = 0;               // [N]
  double on = 0, on_sd = 0;                 // on_sd 0: never driven
  double load = 0;                          // mean normal force in the blocks [N]
  double voltage = 0;                       // peak, while on [V]
  std::optional<double> relative_humidity;  // mean; none: not recorded
  double lag = 0;                           // of the friction behind the drive [s]
  double drift = 0;                         // of the friction over the record, a share
  double zero = 0;                          // of the sensor, in the middle of the record [N]
  double zero_drift = 0;                    // of the sensor's zero over the record [N]
  double peak = 0;                          // mean static friction of the strokes [N]
  int strokes = 0, blocks = 0;
  std::vector<std::string> notes;  // what was found, left out and assumed, for people
};

// Throws InputError where nothing slides steadily, or too little of it to have an error.
TraceReading read_friction_of(const Trace& trace, const Sliding& sliding, const std::string& file);

}  // namespace papilla::lab
