#include "geometry/textures/flat.h"

namespace papilla::geometry {

void fields(FieldVisitor&, Flat&) {}

Heightmap heights(const Flat&, const Grid& grid) {
  return {grid, std::vector<double>(grid.size(), 0)};
}

TextureProblems problems(const Flat&) { return {}; }

TextureFacts facts(const Flat&) {
  return {.relief = Relief::between(0, 0),
          .cell = std::nullopt,
          .free_patch = FreePatch{0, std::nullopt, false},
          .margins = FabricationMargins::none(),
          .open_share = 0.0,
          .rim_radius = std::nullopt,
          .steepest = 0.0,
          .outline = NoOutline{"the surface is flat, there are no outlines to write"},
          .scans = kNoScans,
          .rough = kNoRoughness,
          .directional = false,
          .quick_look = true};
}

Roles roles(Flat&) { return Roles::none(); }

}  // namespace papilla::geometry
