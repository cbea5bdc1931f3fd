// How a grounded wall of water lowers the pull on the skin around it.
#pragma once

#include <vector>

#include "fields/gap.h"
#include "fields/wetting.h"

namespace papilla {

// Planar deficit length of the pull beside a straight water wall [m]: the lost pull is p_inf times
// a strip of this width. gap, dielectric_thickness [m]; fitted for permittivity 3.9 and thickness
// up to 5 gaps (held beyond 10), 3.3 % at most, 1.8 % rms; without dielectric exactly 2/pi gaps.
// Eq. electrostatics.3
double screening_length(double gap, double dielectric_thickness);

// L [m]: a bridge of radius a kills the pull of a disc of radius a + L. Fitted for a >= gap/4 (held
// below). Eq. electrostatics.3
double screening_reach(double gap, double dielectric_thickness, double bridge_radius);

// Remaining share of the pull per pixel, 0 to 1; empty when nothing is screened: 0 in bridges and
// films, tanh^2(x/W) at a distance x from each bridge, the factors of several multiplied; W keeps
// the lost pull of the disc a + L. A film without discs: tanh^2 of the distance to the nearest wet
// pixel over the planar length. wetting.bridged marks wet pixels; fade = false: only those are
// zeroed. Cost: O(pixels) at most; pixels within four W of a bridge for discs. Eq. electrostatics.3
std::vector<double> screening_factor(const Gap& gap, const Wetting& wetting,
                                     double dielectric_thickness, bool fade);

// The same from the air alone, for a rule that knows the dielectric's share: tanh^2(pi x/2g), x the
// distance to the nearest wet pixel, g the pixel's own gap. Empty when nothing is wet. Cost:
// O(pixels). Eq. electrostatics.16
std::vector<double> air_screening_factor(const Gap& gap, const Wetting& wetting, bool fade);

}  // namespace papilla
