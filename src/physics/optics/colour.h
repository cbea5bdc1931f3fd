// What the eye makes of a spectrum. Eq. optics.6
#pragma once

#include <array>
#include <vector>

#include "base/rooms.h"

namespace papilla::optics {

// CIE 1931 colour matching x, y, z at a wavelength in vacuum [m].
std::array<double, 3> observer(double wavelength);

// 400 to 720 nm in steps of 20 nm.
const std::vector<double>& visible_wavelengths();

// Chromaticity u', v' (CIE 1976) of light of these powers at these wavelengths, equal energy.
std::array<double, 2> chromaticity(const std::vector<double>& wavelengths,
                                   const std::vector<double>& powers);

// Light that went a path [m] further interferes: a fringe each 1/path of 1/wavelength. Those of
// longer paths are not followed.
inline constexpr double kLongestPath = 40e-6;

// Few wavelengths that stand for the photopic mean of what changes gradually over the visible and
// of the fringes of this path and shorter ones, to 4e-3 of their height. Three up to 0.8 um, two
// more a micrometre of it. Eq. optics.20
struct PhotopicNode {
  double wavelength, weight;  // [m]; the weights add up to 1
};
std::vector<PhotopicNode> photopic_nodes(double path);

// The wavelengths whose mean is that of the row of 20 nm around one: itself alone up to 4 um of
// path. Eq. optics.20
std::vector<double> within_row(double wavelength, double path);

}  // namespace papilla::optics
