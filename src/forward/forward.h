// The forward model: friction of a finger on a texture, off and on, over humidity.
#pragma once

#include "forward/coupling.h"
#include "forward/fidelity.h"
#include "forward/response.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla {

// Friction, modulation and their causes at each humidity of the scene. Parallel over skins; the
// same bytes for any number of threads. Cost: skins x humidities x (1 or 3) contact solves.
Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// One patch with all its fields, for pictures: skin `index` of the fidelity at one humidity.
struct PatchPicture {
  Heightmap texture, skin;
  PatchFields fields;
};
PatchPicture picture_patch(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index = 0);

}  // namespace papilla
