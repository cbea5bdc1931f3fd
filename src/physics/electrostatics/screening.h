// How a wall of water changes the pull on the skin around it.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"

namespace papilla::electrostatics {

// Planar deficit length of the pull beside a straight water wall [m]: the lost pull is p_inf times
// a strip of this width. gap, dielectric_thickness [m]; fitted for permittivity 3.9 and thickness
// up to 5 gaps (held beyond 10), 3.3 % at most, 1.8 % rms; without dielectric exactly 2/pi gaps.
// Eq. electrostatics.3
double screening_length(double gap, double dielectric_thickness);

// L [m]: a bridge of radius a kills the pull of a disc of radius a + L. Fitted for a >= gap/4 (held
// below). Eq. electrostatics.3
double screening_reach(double gap, double dielectric_thickness, double bridge_radius);

// What the fading by the local rule depends on beside the gap [m].
struct WaterLayers {
  double thickness = 0;   // of the film
  double dielectric = 0;  // its d/eps
  double skin = 0;        // d/eps between water and body; 0: water at the body's potential
};
// Pull that is lost beside a straight wall of water with a potential of its own, over the planar
// deficit length of grounded water for a gap wider by that layer: 1 for grounded water, at most 1.
// Fitted to finite volumes for permittivity 3.9, gaps of 8 to 400 nm, layers of 10 to 60 nm, films
// up to ten of gap and layer: 1.4 % of that length rms, 5.2 % at most. Eq. electrostatics.19
double lost_share(double gap, const WaterLayers& layers);

// Remaining share of the pull per pixel, empty when nothing is screened: 0 in bridges and
// films, 1 - s (1 - tanh^2(x/W)) at a distance x from each bridge, the factors of several
// multiplied; W keeps the lost pull of the disc a + L of grounded water, s is the lost share. A
// film without discs: tanh^2 of the distance to the nearest wet pixel over the planar length.
// wetting.bridged marks wet pixels; fade = false: only those are zeroed. Cost: O(pixels) at most;
// pixels within four W of a bridge for discs. Eqs. electrostatics.3, 19
std::vector<double> screening_factor(const Gap& gap, const Wetting& wetting,
                                     const WaterLayers& layers, bool fade);

// Per pixel, what the pull of air beside water with a potential of its own depends on.
struct WallFields {
  const std::vector<double>& potential;   // on the film; in water that of the water
  const std::vector<double>& dielectric;  // d/eps [m]
  const std::vector<double>& reach;       // d/eps from the film to the body [m]
  double skin = 0;                        // d/eps between water and body [m]
};

// The same from the air alone, for a rule that knows the dielectric's share: t = tanh^2(pi x/2g), x
// the distance to the nearest wet pixel, g the pixel's own gap. Where that water has a potential U,
// not that of the body: what (phi t + U (1 - t))^2 / (t + k (1 - t)) is beyond phi^2 t in the mean
// over the pixel, which may be wider than the field, over phi^2; phi on the film, k = h/G (3.3 +
// 0.8 g / (D + 0.14 h g/G)), D the film's d/eps, G the reach, h the skin. Nothing for U = h = 0. k
// keeps Maxwell's stress on the skin beside a straight wall for a film that is known: 5 % of
// grounded water's lost length for films of .3 gaps and more, gaps of 17 to 300 nm, layers of 10 to
// 60 nm. Empty when nothing is wet. Cost: O(pixels). Eqs. electrostatics.16, 20
std::vector<double> air_screening_factor(const Gap& gap, const Wetting& wetting, bool fade,
                                         const WallFields* wall = nullptr);

}  // namespace papilla::electrostatics
