// Water at one pressure: every gap below one height is full. Smooth and deterministic; it puts all
// its volume into bridges (free droplets put only a part there), so its volume means volume in
// bridges.
#pragma once

#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/capillary/water.h"

namespace papilla {

// Eq. capillary.9: the height h_c with volume(gap < h_c) = bridge_volume [m^3];
// force = gamma C A/h_c + gamma f P with wetted area A and perimeter P (marching squares at h_c).
// Droplet list empty;
// `bridges` counts connected wet regions. Status Film; Dry without water; Flooded when the
// water fills every gap (no meniscus: force 0). Cost: linear in the pixels.
Wetting fill_threshold(const Gap& gap, double bridge_volume, const WaterProperties& water);

// By what share the modulation with threshold water lies below that with droplets of the same
// volume, Eq. capillary.21: the mean over the scenes of results/accuracy/water.csv, good to 0.1.
// water_per_area [m].
double threshold_shortfall(double water_per_area);

}  // namespace papilla
