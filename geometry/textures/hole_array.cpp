#include "geometry/textures/hole_array.h"

#include "geometry/profile.h"

namespace papilla::geometry {
namespace {

FeatureArray array(const HoleArray& t) {
  return {FeatureArray::Shape::Disc, true, t.lattice, t.period, t.diameter, "holes"};
}
WallSection wall(const HoleArray& t) { return {t.depth, t.wall_angle, t.edge_radius}; }

}  // namespace

void fields(FieldVisitor& v, HoleArray& t) {
  lattice_field(v, t.lattice);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbours", Source::Paper, "M3: 6 um"},
           t.period);
  v.number(
      {"diameter", "um", 0.001, 1e3, "hole diameter at the land", Source::Paper, "M3: 3 or 4 um"},
      t.diameter);
  v.number({"depth", "nm", 0, 1e5, "hole depth; 0: flat", Source::Paper, "M3: 350, 600, 900 nm"},
           t.depth);
  wall_fields(v, t.wall_angle, t.edge_radius);
}

Heightmap heights(const HoleArray& t, const Grid& grid) {
  const WallProfile profile(t.depth, t.wall_angle, t.edge_radius);
  return round_features(array(t), wall(t), grid, [&](double r, double pixel) {
    return -profile.mean_drop(0.5 * t.diameter - r, pixel);
  });
}

TextureProblems problems(const HoleArray& t) {
  TextureProblems out = array_problems(t.period, t.diameter, "diameter");
  add_wall_problem(wall(t), t.diameter, "depth", out);
  add_rim_problem(wall(t), t.period - t.diameter, out);
  return out;
}

TextureFacts facts(const HoleArray& t) { return array_facts(array(t), wall(t)); }

Roles roles(HoleArray& t) {
  return {.lattice = &t.lattice,
          .period = &t.period,
          .width = &t.diameter,
          .depth = &t.depth,
          .wall_angle = &t.wall_angle,
          .edge_radius = &t.edge_radius,
          .relief = &t.depth,
          .parts = nullptr};
}

}  // namespace papilla::geometry
