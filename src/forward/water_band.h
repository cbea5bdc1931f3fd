// What the free choices of the water model leave open in the answer of a humidity.
#pragma once

#include <span>

#include "forward/response.h"

namespace papilla {

// Fills the water part of each error (WaterBand of kQuantities) from means over the patches: Eq.
// capillary.19, 20, 23 for droplets, capillary.21 for the threshold. load_exponent: Eq. friction.3
void add_water_band(ResponsePoint& point, std::span<const PatchResult> patches, WaterModel model,
                    const Grid& grid, double load_exponent);

}  // namespace papilla
