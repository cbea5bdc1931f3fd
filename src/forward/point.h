// From the solved patches of one humidity to the friction of the finger and its causes there.
#pragma once

#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"
#include "forward/scale_bridge.h"
#include "scene/scene.h"

namespace papilla::forward {

// Everything that the patches of a humidity are solved and judged by; scene: the finger in its
// state.
struct PointSetting {
  const Scene& scene;
  const Plan& plan;
  const Fidelity& fidelity;
  double area_factor = 1;  // on contact areas: `resolved_areas`
};

// Means over the patches (one per skin) with what sampling, the solver's tolerance and the choices
// of the water leave open (kPointQuantities); Eq. friction.1-3. The status is that of the first
// patch in trouble, or full contact. Cost: linear in the patches.
ResponsePoint response_point(const PointSetting& setting, double relative_humidity, double weight,
                             const ScaleBridge& bridge, std::span<const PatchResult> patches);

// The point of all skins, and with each of them left out (none of a single one; `samples` empty).
struct SkinPoints {
  ResponsePoint all;
  std::vector<ResponsePoint> without;
};
// by_own_laws: the results without each skin by load laws that are refitted (`without_each`); then
// the sampling parts are of those, as the skins of a law are common to all patches, which the
// patches' scatter does not show. Empty: the results less one.
SkinPoints skin_points(const PointSetting& setting, double relative_humidity, double weight,
                       const ScaleBridge& bridge, const std::vector<PatchResult>& patches,
                       std::vector<std::vector<PatchResult>> by_own_laws);

// The state of the water where nothing else is wrong: next to no open gap left, so that the pull
// hangs on single pixels; a humidity beyond those of the volumes, which are continued.
void note_water(ResponsePoint& point, const SkinWater& water);

}  // namespace papilla::forward
