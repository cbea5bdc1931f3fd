// What papers on single fingers measured of a whole finger under voltage or current: pull, current
// and load, beside the textures of the M3 paper.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "published/targets.h"

namespace papilla::published {

// Numbers, and a trend as a range with one end. The gap by capacitance (B2) is `kGapTarget`.
std::vector<PublishedTarget> whole_finger_targets();

}  // namespace papilla::published
