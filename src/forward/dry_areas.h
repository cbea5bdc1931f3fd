// Contact areas of the whole skin where errors are not asked for: without control skins.
#pragma once

#include "base/rooms.h"
#include "forward/patch_set.h"

namespace papilla::forward {

// What the pixels leave out of contact areas hangs on the skin, its moduli and the load, hardly on
// water and field: the dry contact of so many skins says it. Eq. accuracy.17
inline constexpr int kDrySkins = 4, kFewDrySkins = 2;

// As `evaluate` without control skins, with the factor on contact areas of dry_skins.
Response evaluate_resolved(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           int dry_skins);

}  // namespace papilla::forward
