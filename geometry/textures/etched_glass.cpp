#include "geometry/textures/etched_glass.h"

#include <cstdint>

#include "geometry/roughness.h"
#include "geometry/textures/gaussian_heights.h"

namespace papilla::geometry {
namespace {

std::vector<RoughScale> scales_of(const EtchedGlass& t) {
  std::vector<RoughScale> out{endless_scale(t.rms, t.correlation_length, t.length)};
  if (t.fine_share > 0) {
    out.push_back(endless_scale(t.fine_share * t.rms, t.fine_correlation_length, t.length));
  }
  return out;
}

}  // namespace

void fields(FieldVisitor& v, EtchedGlass& t) {
  v.number({"rms", "nm", 0, 1e4, "rms height of the bumps over `length` (Rq; 1.25 Ra)"}, t.rms);
  v.number({"correlation_length", "um", 0.1, 1e3,
            "distance at which the bumps' autocorrelation has fallen to 1/e (RSm/4.4)",
            Source::Estimate, "anti-glare sheets: 2 to 25 um"},
           t.correlation_length);
  v.number({"fine_share", "", 0, 1, "rms height of the finer scale over that of the bumps; 0: none",
            Source::Estimate, "the tail of measured spectra"},
           t.fine_share);
  v.number({"fine_correlation_length", "um", 0.05, 1e2, "correlation length of the finer scale",
            Source::Estimate, "the tail of measured spectra"},
           t.fine_correlation_length);
  v.number({"length", "um", 1, 1e5,
            "side of the square over which rms heights are stated; longer waves do not count",
            Source::Choice, "the cut-off 0.8 mm of profilometers (ISO 4288)"},
           t.length);
  v.integer({"seed", "which random surface"}, 0, 1000000000, t.seed);
}

Heightmap heights(const EtchedGlass& t, const Grid& grid) {
  return random_surface(scales_of(t), grid, static_cast<std::uint64_t>(t.seed));
}

TextureProblems problems(const EtchedGlass& t) {
  TextureProblems out;
  if (t.fine_share > 0 && t.fine_correlation_length >= t.correlation_length)
    out.emplace_back("fine_correlation_length", "must be shorter than correlation_length");
  if (t.length < 2 * t.correlation_length) {
    out.emplace_back("length",
                     "must be at least twice correlation_length: a shorter one does not "
                     "hold the bumps whose height it states");
  }
  return out;
}

TextureFacts facts(const EtchedGlass& t) {
  return gaussian_facts(t.rms, "etched glass", t.rms > 0 ? scales_of(t) : kNoRoughness, true);
}

Roles roles(EtchedGlass& t) { return gaussian_roles(t.rms); }

}  // namespace papilla::geometry
