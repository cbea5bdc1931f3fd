// Fourier coefficients of complex fields on a periodic grid.
#pragma once

#include "base/rooms.h"
#include "geometry/grid.h"
#include "numerics/arrays.h"

namespace papilla::optics {

// F_mn = mean of t exp(-2 pi i (m ix/nx + n iy/ny)); row-major, as the grid, negative orders from
// the end.
SpectrumArray coefficients(const Grid& grid, const SpectrumArray& field);
// The field of these coefficients.
SpectrumArray field_of(const Grid& grid, const SpectrumArray& coefficients);

}  // namespace papilla::optics
