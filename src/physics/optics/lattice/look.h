// How an array looks by the Fourier modal method: light along the normal, any period.
#pragma once

#include "base/rooms.h"
#include "physics/optics/optics.h"

namespace papilla::optics {

// Its walls in slices, `array.terraces` between planes that are some 40 nm apart. Haze and colour
// of light from the plate into the fill, gloss of light from the fill; light along the normal
// alone. beyond: `diffract`. Cost: 17 + 18 diffractions of as many slices. Eq. optics.17-19
Optics lattice_look(const FeatureArray& array, const OpticalMedia& media, const Meters& meters,
                    int beyond = 4);

// Its stack for light from the plate.
struct LatticeStack;
LatticeStack lattice_stack(const FeatureArray& array, const OpticalMedia& media);

}  // namespace papilla::optics
