// What the prices of the pieces are counted in: seconds on one core, between two machines of which
// one is twice as fast. `papilla evaluate --json` of the published samples on 128 to 512 pixels.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::maps {

// One transform forth and back over the pixels. What no cache holds waits for memory: 640 x 640
// take 2.6 times what their count says.
inline double fft_pair_seconds(const Grid& grid) {
  constexpr double kCached = 2.5e5;  // pixels
  const auto n = static_cast<double>(grid.size());
  return 3.3e-10 * n * std::log2(n) * (1 + n / kCached);
}

// Decimal digits that a tolerance asks for, one at least: work is linear in them.
inline double digits(double tolerance) { return std::max(1.0, -std::log10(tolerance)); }

}  // namespace papilla::maps
