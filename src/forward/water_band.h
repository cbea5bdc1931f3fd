// What the free choices of the water model leave open in the answer of a humidity.
#pragma once

#include <span>

#include "base/rooms.h"
#include "forward/response.h"

namespace papilla::forward {

// Fills the water part of each error (WaterBand of kPointQuantities) from means over the patches:
// Eq. capillary.19, 20, 23 for droplets, capillary.21 for the threshold.
void add_water_band(ResponsePoint& point, std::span<const PatchResult> patches, WaterModel model,
                    const Grid& grid, const LoadExponents& exponents);

}  // namespace papilla::forward
