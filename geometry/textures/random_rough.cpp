#include "geometry/textures/random_rough.h"

#include <cstdint>

#include "geometry/roughness.h"

namespace papilla::geometry {

void fields(FieldVisitor& v, RandomRough& t) {
  v.number({"rms", "nm", 0, 1e5, "rms height over 12 um"}, t.rms);
  v.number({"roll_off", "um", 0.01, 1e3, "roll-off wavelength"}, t.roll_off);
  v.number({"hurst", "", 0.01, 1, "Hurst exponent"}, t.hurst);
  v.number({"cutoff", "nm", 1, 1e5, "shortest wavelength"}, t.cutoff);
  v.integer({"seed", "which random surface"}, 0, 1000000000, t.seed);
}

Heightmap heights(const RandomRough& t, const Grid& grid) {
  return random_surface({t.rms, t.roll_off, t.hurst, t.cutoff}, grid,
                        static_cast<std::uint64_t>(t.seed), 0);
}

TextureProblems problems(const RandomRough& t) {
  if (t.cutoff < t.roll_off) return {};
  return {{"cutoff", "must be shorter than the roll-off wavelength"}};
}

TextureFacts facts(const RandomRough& t) {
  return {.relief = Relief{t.rms > 0, std::nullopt},
          .cell = std::nullopt,
          .free_patch = FreePatch{0, std::nullopt},
          .margins = FabricationMargins::none(),
          .open_share = std::nullopt,
          .rim_radius = std::nullopt,
          .outline = NoOutline{"a random rough surface has no outline: its heights vary gradually, "
                               "none of them parts deep from high"},
          .scans = kNoScans,
          .rough = kNoRoughness,
          .directional = false,
          .quick_look = false};
}

Roles roles(RandomRough& t) {
  Roles out = Roles::none();
  out.relief = &t.rms;
  return out;
}

}  // namespace papilla::geometry
