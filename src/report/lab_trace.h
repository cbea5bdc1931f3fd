// Pictures of a lab: a record of a tribometer with what was found in it; what readings have done to
// a decision.
#pragma once

#include <string>

#include "base/rooms.h"
#include "lab/lab.h"
#include "lab/sliding.h"
#include "lab/trace_file.h"
#include "lab/trace_reading.h"

namespace papilla::report {

// SVG. Of many samples the lowest and highest of each column of pixels.
std::string trace_svg(const Trace& trace, const Sliding& sliding, const TraceReading& reading,
                      const std::string& title);

// p(best) of each design after each plan and telling; "" where nothing is decided.
std::string decisions_svg(const Lab& lab);

}  // namespace papilla::report
