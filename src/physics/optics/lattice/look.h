// How an array looks by the Fourier modal method: light along the normal, any period.
#pragma once

#include "base/rooms.h"
#include "physics/optics/optics.h"

namespace papilla::optics {

// Its walls in slices, `array.terraces` between planes that are 40 nm apart at most, of lines down
// to 2.56 um and of discs down to 640 nm; deeper walls are sliced coarser, and the answer warns.
// Haze and colour of light from the plate into the fill, gloss of light from the fill; light along
// the normal alone. beyond: `diffract`. Cost: 17 + 18 diffractions of as many slices, of lines
// twice as many. Eq. optics.17-19
Optics lattice_look(const FeatureArray& array, const OpticalMedia& media, const Meters& meters,
                    int beyond = 4);

// Its stack for light from the plate.
struct LatticeStack;
LatticeStack lattice_stack(const FeatureArray& array, const OpticalMedia& media);

}  // namespace papilla::optics
