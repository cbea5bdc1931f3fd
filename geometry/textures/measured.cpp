#include "geometry/textures/measured.h"

#include "geometry/measured_map.h"

namespace papilla::geometry {
namespace {

ScanSource source_of(const Measured3d& t) { return {t.file, t.width, t.fill, t.as_is, t.level}; }

}  // namespace

void fields(FieldVisitor& v, Measured3d& t) {
  v.path({"file",
          "heightmap to import (.npy .gsf .exr .tif .x3p .gwy .sur .sdf; others where Gwyddion is "
          "installed); of several channels \"scan.gwy::Height\"",
          Source::Choice, "", Presence::Required},
         t.file);
  v.number({"width", "um", 0, 1e6, "lateral size of the map where the file does not say"}, t.width);
  v.flag({"fill", "heights that are no numbers get the mean of those around them; else refused"},
         t.fill);
  v.flag({"as_is",
          "neither levelled, mended nor blended: a surface that is known and repeats by itself"},
         t.as_is);
  v.flag({"level",
          "the plane is taken away of made maps (arrays, exports) and periodic ones too, whose "
          "plane stays without a word"},
         t.level);
  v.number({"top", "nm", -1e5, 1e5,
            "height of the map's highest place over the untouched land, where a planar film is as "
            "thick as said; 0: holes cut into it, above 0: pillars that stand on it"},
           t.top);
  v.number({"patch", "um", 0.1, 1e4, "side of the simulated square"}, t.patch);
  v.number({"at_x", "um", -1e6, 1e6,
            "middle of the square, from the middle of the map; `papilla rank` takes several places "
            "of a map by itself where this and at_y are 0"},
           t.at_x);
  v.number({"at_y", "um", -1e6, 1e6, "the same along y"}, t.at_y);
}

Heightmap heights(const Measured3d& t, const Grid& grid) {
  const ScanSource source = source_of(t);
  Heightmap out = patch_of_map(source, t.patch, {t.at_x, t.at_y}, grid, t.cell);
  // Instruments and arrays have their own zero. Eq. geometry.9
  const double lift = t.top - changes_of_map(source).highest;
  for (double& z : out.z) z += lift;
  return out;
}

TextureProblems problems(const Measured3d& t) {
  if (!t.as_is || !t.level) return {};
  return {{"level", "the plane is taken away, and as_is keeps it: leave one of them out"}};
}

// Told without reading the file: a map counts as having relief.
TextureFacts facts(const Measured3d& t) {
  return {.relief = Relief{true, std::nullopt},
          .cell = t.cell,
          .free_patch = FreePatch{0, t.patch, t.as_is},
          .margins = FabricationMargins::none(),
          .open_share = std::nullopt,
          .rim_radius = std::nullopt,
          .steepest = std::nullopt,
          .outline = Contours{},
          .scans = std::vector{source_of(t)},
          .rough = kNoRoughness,
          .directional = false,
          .quick_look = false};
}

Roles roles(Measured3d&) { return Roles::none(); }

}  // namespace papilla::geometry
