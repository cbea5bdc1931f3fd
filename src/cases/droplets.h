// Sweat in a given gap (`papilla solve droplets`): that of a file, or of a design's dry contact.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "numerics/statistics.h"
#include "physics/capillary/droplets.h"
#include "scene/finger.h"

namespace papilla::cases {

struct DropletCase {
  Gap gap;
  WaterProperties water;
  double volume = 0;  // in the patch [m^3]
  DropletOptions how;
};
// The gap of a design is that of its dry contact at its patch pressure; water, angles, droplets and
// the law of their force (model.preset) are those of its scene; rims pin and corners wick by its
// model, or where asked for. Throws InputError. Cost: one patch.
DropletCase droplets_of_design(const std::string& file, double relative_humidity, int skin,
                               bool rim_pinning, bool corner_wicking);
// The gap of a heightmap file, 0 in contact; width: lateral size [m] where it does not say. The
// rest is the caller's. Throws InputError.
DropletCase droplets_of_file(const std::string& file, double width);

struct DropletResult {
  Wetting wetting;
  SettleReport report;  // of droplets; of the threshold model empty
};
DropletResult solve_droplets(const DropletCase& c, WaterModel model, std::uint64_t seed,
                             std::uint64_t index);
// Where the droplets are before they move.
Wetting unmoved_droplets(const DropletCase& c, std::uint64_t seed, std::uint64_t index);

// The papers' way: a low and a high volume by several placements each; means with standard errors.
struct DropletMeans {
  double volume = 0;  // [m^3]
  Estimate capillary_force, bridges, wetted_fraction;
};
struct DropletEnsemble {
  int placements = 0;  // of each volume
  std::vector<DropletMeans> volumes;
  double mean_capillary_force = 0;  // over all [N]
};
// Volumes (1 - spread) and (1 + spread) of the case's; members `index` and the following.
DropletEnsemble solve_droplet_ensemble(const DropletCase& c, double spread, int placements,
                                       std::uint64_t seed, std::uint64_t index);

}  // namespace papilla::cases
