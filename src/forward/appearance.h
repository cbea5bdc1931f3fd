// Which optical theory fits a texture, and its answer.
#pragma once

#include "geometry/texture.h"
#include "physics/optics/optics.h"
#include "scene/view.h"

namespace papilla {

// Why no theory here can say how a texture looks; empty: one can. Free.
std::string optics_refusal(const Texture& texture, double index, const View& view);

// Periods below the shortest wavelength / (index + largest sine): effective medium. Features of two
// wavelengths and more: phase screen. Between: regime "refused", no numbers. The last answers are
// kept. Takes about a millisecond where facts(texture).quick_look, else a second at most.
Optics appearance(const Texture& texture, double index, const View& view);

}  // namespace papilla
