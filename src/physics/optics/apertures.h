// Amplitudes that a slit and a disc send beside the axis, over that on it.
#pragma once

#include <cmath>

#include "base/rooms.h"

namespace papilla::optics {

// x: half the slit's width times the wave number across it, of either sign.
inline double sinc(double x) { return std::abs(x) < 1e-6 ? 1 - x * x / 6 : std::sin(x) / x; }
// x >= 0: the disc's radius times the wave number.
inline double airy(double x) { return x < 1e-6 ? 1 - x * x / 8 : 2 * std::cyl_bessel_j(1, x) / x; }

}  // namespace papilla::optics
