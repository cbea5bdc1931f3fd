// Which optical theory fits a texture, and its answer.
#pragma once

#include "geometry/texture.h"
#include "physics/optics/optics.h"

namespace papilla {

// Periods below the shortest wavelength / index: effective medium. Features of two wavelengths and
// more: phase screen. Between: regime "refused", no numbers. A second at most.
Optics appearance(const Texture& texture, const OpticalMedia& media);

}  // namespace papilla
