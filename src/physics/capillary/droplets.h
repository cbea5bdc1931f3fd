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
  double first_step = 200e-9;        // [m]; the mobility of droplets: a stated model option
  int halvings = 4;                  // the last step is first_step / 2^halvings
  double gap_floor = 0.3e-9;         // smaller gaps count as this [m]: a water molecule's size
  // From disc to film around this width [m], a third of the paper's window, and all bridges around
  // this wetted area: between 0.8 and 1.25 times the limit (Eq. capillary.22).
  double film_width = 4e-6;
  double film_area = 0.40;
  int max_moves = 1000;  // per droplet; 0: the initial state

  // Edges of the texture below the gap; null: the surface counts as smooth.
  std::shared_ptr<const RimMap> rims;
  bool rim_pinning = false;     // a line does not pass an edge within Gibbs's range
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
  bool converged = true;  // every droplet's last step found nothing lower within max_moves
  bool energy_rose = false;
};

// max(1, round(drops_per_volume * volume)) droplets: places uniform, volumes proportional to
// uniform random numbers (common for every design: stream "droplets" of seed and index).
std::vector<DropletSeed> scatter_droplets(const Grid& grid, double volume,
                                          const DropletOptions& options, std::uint64_t seed,
                                          std::uint64_t index);

// Settles droplets in the patch (Eqs. capillary.4-8). Status: Dry (no water), Discs, Film (a bridge
// or the wetted area too large for discs: those bridges go over into a film of one pressure, Eqs.
// capillary.15, 22; `film` marks it), Flooded (more water than gap: no
// meniscus, no force). Cost: 10-25 us per droplet.
Wetting settle_droplets(const Gap& gap, const std::vector<DropletSeed>& droplets,
                        const WaterProperties& water, const DropletOptions& options,
                        SettleReport* report = nullptr);

// The same for `volume` [m^3] of water, scattered.
Wetting settle_droplets(const Gap& gap, double volume, const WaterProperties& water,
                        const DropletOptions& options, std::uint64_t seed, std::uint64_t index,
                        SettleReport* report = nullptr);

// The same water at the same places on another gap or with other contact angles (electrowetting):
// bridges get their radius, force and energy anew; droplets that do not bridge float and keep their
// shape and side, unless the skin now touches them. Discs that now overlap merge. Water in corners
// stays there.
Wetting rewet(const Wetting& wetting, const Gap& gap, const WaterProperties& water,
              const DropletOptions& options = {});

// How far a mobility or a number of droplets a factor 4 off moves results: half the range,
// relative.
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
