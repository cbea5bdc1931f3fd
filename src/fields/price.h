// What the prices of the pieces are counted in: seconds on one core, between two machines of which
// one is twice as fast. `papilla evaluate --json` of the published samples on 128 to 512 pixels.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/grid.h"

namespace papilla {

// One transform forth and back over the pixels.
inline double fft_pair_seconds(const Grid& grid) {
  const auto n = static_cast<double>(grid.size());
  return 3.3e-10 * n * std::log2(n);
}

// Decimal digits that a tolerance asks for, one at least: work is linear in them.
inline double digits(double tolerance) { return std::max(1.0, -std::log10(tolerance)); }

}  // namespace papilla
