#include "physics/electrostatics/water_bodies.h"

#include <algorithm>

namespace papilla::electrostatics {

WaterBodies::WaterBodies(const Grid& grid, const std::vector<std::uint8_t>& wet, bool grounded)
    : grounded_(grounded) {
  if (std::find_if(wet.begin(), wet.end(), [](auto w) { return w != 0; }) == wet.end()) return;
  std::vector<std::uint8_t> left(wet);
  for (std::size_t first = 0; first < left.size(); ++first) {
    if (!left[first]) continue;
    left[first] = 0;
    pixels_.push_back(first);
    const auto take = [&](int ix, int iy) {
      const std::size_t i = grid.index(ix, iy);
      if (!left[i]) return;
      left[i] = 0;
      pixels_.push_back(i);
    };
    for (std::size_t k = pixels_.size() - 1; k < pixels_.size(); ++k) {
      const int ix = static_cast<int>(pixels_[k] % static_cast<std::size_t>(grid.nx)),
                iy = static_cast<int>(pixels_[k] / static_cast<std::size_t>(grid.nx));
      take(ix + 1 < grid.nx ? ix + 1 : 0, iy);
      take(ix > 0 ? ix - 1 : grid.nx - 1, iy);
      take(ix, iy + 1 < grid.ny ? iy + 1 : 0);
      take(ix, iy > 0 ? iy - 1 : grid.ny - 1);
    }
    end_.push_back(pixels_.size());
  }
}

}  // namespace papilla::electrostatics
