#include "geometry/gradual.h"

#include <algorithm>

namespace papilla::geometry {

TextureFacts gradual_facts(const GradualProfile& p) {
  const double smallest = std::min<double>(p.hole, p.land);
  const bool relief = p.relief.present;
  return {.relief = p.relief,
          .cell = relief ? std::optional<UnitCell>(p.cell) : std::nullopt,
          .free_patch = FreePatch{0, std::nullopt, false},
          .margins = relief ? FabricationMargins{p.hole, p.land, *p.relief.height() / smallest}
                            : FabricationMargins::none(),
          .open_share = relief ? static_cast<double>(p.open_share) : 0.0,
          .rim_radius = relief ? std::optional<double>(p.rim_radius) : std::nullopt,
          .steepest = relief ? static_cast<double>(p.steepest) : 0.0,
          .outline = Contours{},
          .scans = kNoScans,
          .rough = kNoRoughness,
          .directional = relief && p.directional,
          .quick_look = false};
}

Heightmap along_x(const Grid& grid, const std::function<double(double, double)>& mean) {
  Heightmap out{grid, std::vector<double>(grid.size())};
  for (int ix = 0; ix < grid.nx; ++ix) {
    const double z = mean(grid.x(ix) - 0.5 * grid.dx(), grid.x(ix) + 0.5 * grid.dx());
    for (int iy = 0; iy < grid.ny; ++iy) out(ix, iy) = z;
  }
  return out;
}

}  // namespace papilla::geometry
