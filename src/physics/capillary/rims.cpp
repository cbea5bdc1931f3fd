#include "physics/capillary/rims.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/capillary/film.h"
#include "physics/capillary/water.h"

namespace papilla {

AngleRange gibbs_range(double theta, double turn) { return {theta, std::min(theta + turn, kPi)}; }

bool passes_edge(double theta_skin, double theta, double turn, double edge_gap, double local_gap) {
  const double high = gibbs_range(theta, turn).high;
  if (high >= kPi) return false;
  return wetting_gain(theta_skin, theta) * local_gap / edge_gap - std::cos(theta_skin) <
         std::cos(high);
}

bool creeps_along(double theta, double opening) { return theta < kPi / 2 - 0.5 * opening; }

Fillet corner_fillet(double theta, double opening) {
  if (!creeps_along(theta, opening)) return {};
  const double leg = std::cos(theta + 0.5 * opening) / std::sin(0.5 * opening);
  return {leg * std::cos(theta) - (kPi / 2 - theta - 0.5 * opening), leg};
}

RimMap::RimMap(const Heightmap& texture) {
  const Grid& g = texture.grid;
  const auto [low, high] = std::minmax_element(texture.z.begin(), texture.z.end());
  depth_ = *high - *low;
  if (!(depth_ > 0)) return;
  std::vector<std::uint8_t> down(g.size());
  std::size_t between = 0;
  for (std::size_t k = 0; k < g.size(); ++k) {
    const double level = (texture.z[k] - *low) / depth_;
    down[k] = level < 0.5;
    between += level > 0.1 && level < 0.9;
  }
  if (3 * between > g.size()) return;
  holes_.resize(label_regions(g, down, label_));
  edge_.assign(g.size(), 0);
  double walls = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t k = g.index(ix, iy);
      const std::size_t right = g.index(wrap(ix + 1, g.nx), iy),
                        left = g.index(wrap(ix - 1, g.nx), iy),
                        up = g.index(ix, wrap(iy + 1, g.ny)),
                        below = g.index(ix, wrap(iy - 1, g.ny));
      // The steps along x and y of a line in any direction add up to 4 / pi of its length.
      const double length =
          kPi / 4 * ((down[k] != down[right]) + (down[k] != down[left])) * g.dy() +
          kPi / 4 * ((down[k] != down[up]) + (down[k] != down[below])) * g.dx();
      edge_[k] = length > 0;
      if (!down[k]) continue;
      Hole& hole = holes_[label_[k] - 1];
      hole.area += g.pixel_area();
      hole.perimeter += length;
      walls += length;
    }
  }
  const double width = static_cast<double>(between) * g.pixel_area() / walls;
  turn_ = width < 2 * g.dx() ? kPi / 2 : std::atan(0.8 * depth_ / width);
}

double RimMap::capacity(const Hole& hole, double theta) const {
  const Fillet fillet = corner_fillet(theta, kPi - turn_);
  if (fillet.leg <= 0) return 0;
  const double radius = std::min(depth_, 2 * hole.area / hole.perimeter) / fillet.leg;
  return hole.perimeter * fillet.area * square(radius);
}

}  // namespace papilla
