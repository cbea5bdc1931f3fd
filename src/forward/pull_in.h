// How far a drive is from the voltage at which the gap jumps shut.
#pragma once

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla::forward {

// The branch of equilibria is followed to where it turns, or to so many times the voltage.
inline constexpr double kFarthestPullIn = 4;

struct PullIn {
  double margin = kFarthestPullIn;  // voltage at the fold over that of the drive
  bool folds = false;               // false: no fold up to kFarthestPullIn times the voltage
};

// Of the mean patch of fidelity.equilibrium_skins skins at the first humidity of a driven scene.
// Along the branch the load that closes the gap rises step by step, and the voltage that attracts
// with what is beyond the nominal load is found for each gap; the fold is its first maximum. Smooth
// in every number of the scene, as each step is. Eq. coupling.16. Cost: some ten contact solves and
// thirty fields a skin.
PullIn pull_in(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
               double relative_humidity);

}  // namespace papilla::forward
