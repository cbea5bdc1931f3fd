#include "geometry/textures/gaussian_heights.h"

#include <utility>

namespace papilla::geometry {

TextureFacts gaussian_facts(double rms, const std::string& what, std::vector<RoughScale> rough,
                            bool quick_look) {
  return {.relief = Relief{rms > 0, std::nullopt},
          .cell = std::nullopt,
          .free_patch = FreePatch{0, std::nullopt, false},
          .margins = FabricationMargins::none(),
          .open_share = std::nullopt,
          .rim_radius = std::nullopt,
          .steepest = rms > 0 ? std::nullopt : std::optional(0.0),
          .outline = NoOutline{what + " has no outline: its heights vary gradually, none of them "
                                      "parts deep from high"},
          .scans = kNoScans,
          .rough = std::move(rough),
          .directional = false,
          .quick_look = quick_look};
}

Roles gaussian_roles(double& rms) {
  Roles out = Roles::none();
  out.relief = &rms;
  return out;
}

}  // namespace papilla::geometry
