// Settled drops as the wetting that other physics sees.
#pragma once

#include "physics/capillary/drop_population.h"
#include "physics/capillary/droplets.h"

namespace papilla {

// What there is now, as discs; wide bridges (or all, above the wetted area's limit) as film, Eqs.
// capillary.15, 22. volume, wicked: all water and that in corners [m^3]. Marks in `drops` what is
// film. Cost: a force for each bridge, one pass over the patch for films.
Wetting wetting_of(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
                   const DropEnergy& energy, std::vector<Drop>& drops, double volume,
                   double wicked);

}  // namespace papilla
