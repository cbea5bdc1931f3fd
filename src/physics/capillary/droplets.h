// Droplets of sweat between skin and surface: random places and volumes, each on the skin, on the
// substrate or a bridge, whichever has the lowest surface energy; they move downhill and coalesce.
#pragma once

#include <cstdint>

#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/capillary/water.h"

namespace papilla {

struct DropletOptions {
  double drops_per_volume = 100e18;  // initial droplets per water volume [1/m^3]
  double first_step = 200e-9;        // [m]; the mobility of droplets: a stated model option
  int halvings = 4;                  // the last step is first_step / 2^halvings
  double gap_floor = 0.3e-9;         // smaller gaps count as this [m]: a water molecule's size
  double film_width = 4e-6;          // wider bridges are films [m]: a third of the paper's window
  double film_area = 0.40;           // more wetted area than this: all bridges are
  int max_moves = 1000;              // per droplet
};

// How the settling went.
struct SettleReport {
  double initial_energy = 0, final_energy = 0;  // [J], after the initial coalescence and at the end
  int initial_droplets = 0, moves = 0, merges = 0;
  long evaluations = 0;   // of a bridge's energy
  bool converged = true;  // every droplet's last step found nothing lower within max_moves
  bool energy_rose = false;
};

// Settles `volume` [m^3] of water in the patch (Eqs. capillary.4-8). The number of droplets is
// max(1, round(drops_per_volume * volume)); their places are uniform and their volumes proportional
// to uniform random numbers (common for every design: stream "droplets" of seed and index).
// Status: Dry (no water), Discs, Film (a bridge or the wetted area too large for discs: those
// bridges become a film of one pressure, Eq. capillary.15; it is the part of `bridged` outside all
// discs), Flooded (more water than gap: no meniscus, no force). Cost: about 5 us a droplet.
Wetting settle_droplets(const Gap& gap, double volume, const WaterProperties& water,
                        const DropletOptions& options, std::uint64_t seed, std::uint64_t index,
                        SettleReport* report = nullptr);

// The same water at the same places on another gap or with other contact angles (electrowetting):
// bridges get their radius, force and energy anew; droplets that do not bridge float and keep their
// shape, unless the skin now touches them. Discs that now overlap merge.
Wetting rewet(const Wetting& wetting, const Gap& gap, const WaterProperties& water,
              const DropletOptions& options = {});

// Eq. capillary.10: the force of every bridge (or the film) as a pressure over its pixels [Pa]; the
// sum times the pixel area is capillary_force. A bridge smaller than a pixel acts on the nearest.
Traction capillary_traction(const Wetting& wetting, const Gap& gap, const WaterProperties& water);

}  // namespace papilla
