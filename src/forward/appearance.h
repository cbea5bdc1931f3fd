// Which optical theory fits a texture, and its answer.
#pragma once

#include <optional>

#include "base/rooms.h"
#include "geometry/texture.h"
#include "physics/optics/optics.h"
#include "scene/environment.h"
#include "scene/view.h"

namespace papilla::forward {

// What light meets: the texture's medium and films, by how each was made.
OpticalMedia media_of(const Surface& surface, const View& view);
// How the instruments are set.
Meters meters_of(const Surface& surface, const View& view);

// Why no theory here can say how a texture looks; empty: one can. Free.
std::string optics_refusal(const Texture& texture, const Surface& surface, const View& view);
// The theory that says how it looks, in words, or why none does. Free.
std::string optics_theory(const Texture& texture, const Surface& surface, const View& view);

// An array, or lines with gradual walls, as outlines by height; none of other textures.
std::optional<FeatureArray> sections(const Texture& texture);

// Periods below the shortest wavelength / (index + largest sine): effective medium. Features of two
// wavelengths and more: phase screen. Between: the Fourier modal method along the normal, else
// regime "refused", no numbers. The last answers are kept. Takes milliseconds where
// facts(texture).quick_look, some seconds of a lattice between, else a second at most.
Optics appearance(const Texture& texture, const Surface& surface, const View& view);

}  // namespace papilla::forward
