#include "geometry/textures/random_rough.h"

#include <cstdint>

#include "geometry/roughness.h"
#include "geometry/textures/gaussian_heights.h"

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
  return gaussian_facts(t.rms, "a random rough surface", kNoRoughness, false);
}

Roles roles(RandomRough& t) { return gaussian_roles(t.rms); }

}  // namespace papilla::geometry
