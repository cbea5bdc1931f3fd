// Sparkle: how unequally the subpixels of a panel are seen through a textured face. The pupil of
// the eye and a subpixel change places (reciprocity): a wave from the pupil passes the face and
// makes a pattern of light in the plane of the subpixels, whose share on each of them is what the
// eye gets from it. Eq. optics.13-16
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "physics/optics/meters.h"

namespace papilla::optics {

// Standard deviation over mean of the light of equal subpixels. step: refractive index below the
// face less that above it. All are thin screens in Fresnel's approximation, of one wavelength.

// Of a heightmap, a period or a patch much longer than a subpixel: its own pattern, over all places
// of a subpixel. Cost: four transforms.
double map_sparkle(const Heightmap& map, double step, const Panel& panel);

// Of Gaussian heights, every strength of the phase. Cost: some 1e5 to 1e7 exponentials.
double rough_sparkle(const std::vector<RoughScale>& scales, double step, const Panel& panel);

// The same where the phase is weak: spectrum of the heights against subpixel and pupil.
double weak_sparkle(const std::vector<RoughScale>& scales, double step, const Panel& panel);

}  // namespace papilla::optics
