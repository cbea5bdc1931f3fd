#include "physics/electrostatics/electrode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::electrostatics {
namespace {

// The foot of a wall: a neighbour stands higher by more than the distance to it.
bool is_foot(const Heightmap& h, int ix, int iy) {
  const Grid& g = h.grid;
  const double z = h(ix, iy);
  return std::max(h(ix + 1 < g.nx ? ix + 1 : 0, iy), h(ix > 0 ? ix - 1 : g.nx - 1, iy)) >
             z + g.dx() ||
         std::max(h(ix, iy + 1 < g.ny ? iy + 1 : 0), h(ix, iy > 0 ? iy - 1 : g.ny - 1)) >
             z + g.dy();
}

}  // namespace

Heightmap electrode_below(const Heightmap& surface, double thickness) {
  const Grid& g = surface.grid;
  Heightmap electrode{g, surface.z};
  for (double& z : electrode.z) z -= thickness;
  if (thickness <= 0) return electrode;
  // Distances count from the wall, half a pixel beyond the centre of its foot.
  const double radius = thickness + 0.5 * std::min(g.dx(), g.dy());
  const int nx = std::min(static_cast<int>(radius / g.dx()), (g.nx - 1) / 2);
  const int ny = std::min(static_cast<int>(radius / g.dy()), (g.ny - 1) / 2);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      if (!is_foot(surface, ix, iy)) continue;
      const double level = surface(ix, iy) - thickness;
      for (int j = -ny; j <= ny; ++j) {
        const double across2 = square(radius) - square(j * g.dy());
        const int width = std::min(static_cast<int>(std::sqrt(across2) / g.dx()), nx);
        double* row = electrode.z.data() + g.index(0, wrap(iy + j, g.ny));
        const auto lower = [&](int from, int to) {
          for (int i = from; i < to; ++i) row[i] = std::min(row[i], level);
        };
        const int first = wrap(ix - width, g.nx), end = first + 2 * width + 1;
        lower(first, std::min(end, g.nx));
        lower(0, end - g.nx);
      }
    }
  }
  return electrode;
}

CoveredSurface::CoveredSurface(Heightmap surface, double thickness) : height(std::move(surface)) {
  if (thickness <= 0) return;
  behind_walls = electrode_below(height, thickness).z;
  bool any = false;
  for (std::size_t i = 0; i < behind_walls.size(); ++i) {
    behind_walls[i] = height.z[i] - behind_walls[i] - thickness;
    any = any || behind_walls[i] > 1e-12;
  }
  if (!any) behind_walls.clear();
}

}  // namespace papilla::electrostatics
