// Accuracy by request: grid, estimator and skins chosen from measured errors while running.
#pragma once

#include "base/rooms.h"
#include "forward/forward.h"

namespace papilla::estimate {

struct TargetOptions {
  double target = 0.05;  // relative standard error of the mean modulation; of the mean friction
                         // when undriven. Humidity is left out: its nodes are the user's.
  int largest_grid = 512;
  int most_skins = 192;
  int first_skin = 0;
  std::uint64_t seed = 1;
  int droplet_seeds = 1;  // placements of the droplets on each skin
  int threads = 0;
  double most_seconds = 0;  // as plans price them (forward/plan.h), never by the clock; 0: any
};

// What the pilot runs.
Fidelity pilot_fidelity(const TargetOptions& options);

// A pilot measures sampling scatter, grid part and load-law part; of all grids and both estimators
// the cheapest is run whose predicted error is inside (Eq. accuracy.5, accuracy.6); its parts are
// measured again, skins are added in batches where sampling is too large, and the plan is made anew
// where grid or method are. Ends inside the target, or at a limit with a status that says which
// part is left. The same answer on any machine: decisions depend on counts, not on seconds.
Response evaluate_to_target(const Scene& scene, const Texture& texture,
                            const TargetOptions& options);

}  // namespace papilla::estimate
