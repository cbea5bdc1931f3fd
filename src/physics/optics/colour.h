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

// Few wavelengths that stand for the photopic mean of what changes gradually over the visible.
struct PhotopicNode {
  double wavelength, weight;  // [m]; the weights add up to 1
};
const std::vector<PhotopicNode>& photopic_nodes();

}  // namespace papilla::optics
