// Drops walk downhill in energy, merge where they meet, and creep into corners.
#pragma once

#include "physics/capillary/drop_population.h"
#include "physics/capillary/droplets.h"

namespace papilla {

// Eqs. capillary.17, 18: drops on the texture that meet the foot of a wall give their water to its
// corner, up to what that holds. Returns the water that went there [m^3].
double wick_into_corners(const Grid& grid, const RimMap& rims, const WaterProperties& water,
                         DropletState cap_state, DropPopulation& drops);

// Eqs. capillary.7, 8: every drop in turn, in steps of options.first_step and its halves, until no
// step of it lowers the energy. Adds to report: moves, whether all came to rest, and whether the
// energy ever rose (it must not).
void settle(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
            DropEnergy& energy, DropPopulation& drops, SettleReport& report);

}  // namespace papilla
