// What papers on single fingers measured of a whole finger under voltage or current: pull, current
// and load, beside the textures of the M3 paper.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "published/targets.h"

namespace papilla::claims {

// Numbers that no fit uses, and trends as ranges with one end. The gap by capacitance (B2) is
// `published::kGapTarget`.
std::vector<PublishedTarget> whole_finger_targets();

}  // namespace papilla::claims
