// Droplets of sweat between skin and surface: random places and volumes, each on the skin, on the
// substrate or a bridge, whichever has the lowest surface energy; they move downhill and coalesce.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/capillary/rims.h"
#include "physics/capillary/water.h"

namespace papilla::capillary {

struct DropletOptions {
  double drops_per_volume = 100e18;  // initial droplets per water volume [1/m^3]
  double first_step = 200e-9;        // [m] length of the first steps; stands for droplet mobility
  int halvings = 4;                  // the last step is first_step / 2^halvings
  double gap_floor = 0.3e-9;         // smaller gaps count as this [m]: a water molecule's size
  // A bridge turns from a disc into a film as its width passes film_width [m], a third of the
  // paper's patch; all bridges do so as the wetted share of the patch passes film_area. Both
  // transitions are gradual, from 0.8 to 1.25 times the limit (Eq. capillary.22).
  double film_width = 4e-6;
  double film_area = 0.40;
  int max_moves = 1000;  // per droplet and step length; 0: droplets stay where they start

  // Edges of the texture below the gap; null: the surface counts as smooth.
  std::shared_ptr<const RimMap> rims;
  bool rim_pinning = false;     // edges pin contact lines (Gibbs's condition, Eq. capillary.16)
  bool corner_wicking = false;  // drops at the foot of a wall creep along it
};

// A droplet before it settles.
struct DropletSeed {
  double x = 0, y = 0;  // [m], inside the patch
  double volume = 0;    // [m^3]
};

// How the settling went.
struct SettleReport {
  double initial_energy = 0, final_energy = 0;  // [J], after the initial coalescence and at the end
  int initial_droplets = 0, moves = 0, merges = 0;
  long evaluations = 0;   // of a bridge's energy
  bool converged = true;  // every droplet came to rest before it had made max_moves moves
  bool energy_rose = false;
};

// max(1, round(drops_per_volume * volume)) droplets: places uniform, volumes proportional to
// uniform random numbers (common for every design: stream "droplets" of seed and index).
std::vector<DropletSeed> scatter_droplets(const Grid& grid, double volume,
                                          const DropletOptions& options, std::uint64_t seed,
                                          std::uint64_t index);

// Settles droplets in the patch (Eqs. capillary.4-8). Status: Dry: there is no water. Discs: every
// bridge is a disc. Film: a bridge or the wetted area is too large for discs, so bridges become
// films, with one pressure in each connected region (Eqs. capillary.15, 22; `Wetting::film` marks
// their pixels). Flooded: the water fills the gap of the patch or of a film's region, so there is
// no meniscus and no force. Cost: 10-25 us per droplet.
Wetting settle_droplets(const Gap& gap, const std::vector<DropletSeed>& droplets,
                        const WaterProperties& water, const DropletOptions& options,
                        SettleReport* report = nullptr);

// The same for `volume` [m^3] of water, scattered.
Wetting settle_droplets(const Gap& gap, double volume, const WaterProperties& water,
                        const DropletOptions& options, std::uint64_t seed, std::uint64_t index,
                        SettleReport* report = nullptr);

// The same water at the same places on another gap or with other contact angles (electrowetting). A
// bridge gets a new radius, force and energy, and stays a bridge until it ruptures. A droplet that
// does not bridge keeps its shape and side, unless the gap is now so narrow that it touches both
// surfaces; it then becomes a bridge. Discs that now overlap merge. Water in corners stays there.
Wetting rewet(const Wetting& wetting, const Gap& gap, const WaterProperties& water,
              const DropletOptions& options = {});

// Half the relative range of the results when the mobility of droplets and their number per volume
// are wrong by a factor of 4 either way.
struct DropletBand {
  double capillary = 0, pull = 0;  // of the capillary force; of pull and modulation
};
// Laws fitted to results/accuracy/water.csv (flat, a3h600, dense_deep at 50 deg, flat at 110 deg,
// 15 to 75 % RH; good to a factor 2). water_per_area and mean_gap [m], bridge_share of the water.
DropletBand droplet_band(double water_per_area, double mean_gap, double bridge_share);

// Eq. capillary.10: the force of every bridge and of every region of a film as a pressure over its
// pixels [Pa]; the sum times the pixel area is capillary_force. A bridge smaller than a pixel acts
// on the nearest.
Traction capillary_traction(const Wetting& wetting, const Gap& gap, const WaterProperties& water);

}  // namespace papilla::capillary
