// Pictures and arrays of the fields of one patch, beside the numbers of an evaluation.
#pragma once

#include <string>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/forward.h"

namespace papilla::report {

// Gap, pressure, water and pull of the first skin at each humidity: gap_75.png, gap_75.npy, ...,
// in percent, with as many digits as tell the humidities apart.
// Cost: one patch per humidity.
void write_field_pictures(const std::string& folder, const Design& design,
                          const Fidelity& fidelity);

// Those of an earlier run, at humidities or of a drive that this one may not have; of a folder
// without response.json nothing.
void remove_field_pictures(const std::string& folder);

}  // namespace papilla::report
