// How far a drive is from the voltage at which the gap jumps shut.
#pragma once

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "forward/response.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla::forward {

// Of a driven scene at a humidity: mean and standard error over fidelity.equilibrium_skins patches,
// on at most 128 pixels. Along the branch of a patch the load that closes its gap rises step by
// step, and the voltage that attracts with what is beyond the nominal load is found for each gap,
// none where its water alone attracts as much; the fold is the first maximum of that voltage. 0:
// water alone closes the gap. Smooth in every number of the scene, as each step is. Eq.
// coupling.16. Cost: some ten contact solves and forty fields a patch.
PullIn pull_in(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
               double relative_humidity);

}  // namespace papilla::forward
