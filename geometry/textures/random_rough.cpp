#include "geometry/textures/random_rough.h"

#include <fmt/format.h>

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
  constexpr double kReference = Spectrum{}.reference_length;
  TextureProblems out;
  if (t.cutoff >= t.roll_off)
    out.emplace_back("cutoff", "must be shorter than the roll-off wavelength");
  if (t.cutoff > kReference) {
    out.emplace_back("cutoff",
                     fmt::format("{:.4g} um is longer than the {:.4g} um that rms is of; no wave "
                                 "would be left",
                                 1e6 * t.cutoff, 1e6 * kReference));
  }
  return out;
}

TextureFacts facts(const RandomRough& t) {
  return gaussian_facts(t.rms, "a random rough surface", kNoRoughness, false);
}

Roles roles(RandomRough& t) { return gaussian_roles(t.rms); }

}  // namespace papilla::geometry
