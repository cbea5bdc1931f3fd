// How an array looks by the Fourier modal method: light along the normal, any period.
#pragma once

#include "base/rooms.h"
#include "physics/optics/optics.h"

namespace papilla::optics {

// Its walls in slices, `array.terraces` between planes that are 40 nm apart at most, of lines down
// to 2.56 um and of discs down to 640 nm; deeper walls are sliced coarser, and the answer warns.
// Haze and colour of light from the plate into the fill, gloss of light from the fill; light along
// the normal alone. beyond: `diffract`. Cost, in diffractions of as
// many slices: 17, and as many more each 2 um of the films' path beyond 4 um; 6 a node of gloss,
// of which there are three up to 0.27 um of relief without films, and 9 more each micrometre of a
// film of 1.5. Of lines twice as many. Eq. optics.17-20
Optics lattice_look(const FeatureArray& array, const OpticalMedia& media, const Meters& meters,
                    int beyond = 4);

// Its stack for light from the plate.
struct LatticeStack;
LatticeStack lattice_stack(const FeatureArray& array, const OpticalMedia& media);

}  // namespace papilla::optics
