#include "geometry/textures/pillar_array.h"

#include "geometry/profile.h"

namespace papilla::geometry {
namespace {

FeatureArray array(const PillarArray& t) {
  return {FeatureArray::Shape::Disc, false, t.lattice, t.period, t.diameter, "pillars"};
}
WallSection wall(const PillarArray& t) { return {t.height, t.wall_angle, t.edge_radius}; }

}  // namespace

void fields(FieldVisitor& v, PillarArray& t) {
  lattice_field(v, t.lattice);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbours"}, t.period);
  v.number({"diameter", "um", 0.001, 1e3, "pillar diameter at the top"}, t.diameter);
  v.number({"height", "nm", 0, 1e5, "pillar height; 0: flat"}, t.height);
  wall_fields(v, t.wall_angle, t.edge_radius);
}

Heightmap heights(const PillarArray& t, const Grid& grid) {
  const WallProfile profile(t.height, t.wall_angle, t.edge_radius);
  return round_features(array(t), wall(t), grid, [&](double r, double pixel) {
    return t.height - profile.mean_drop(r - 0.5 * t.diameter, pixel);
  });
}

// A pillar widens towards its floor: its own walls never meet, its rims do, and its feet those of
// its neighbours, which would leave less than its height.
TextureProblems problems(const PillarArray& t) {
  TextureProblems out = array_problems(t.period, t.diameter, "diameter");
  add_wall_problem(wall(t), t.period - t.diameter, "height", out);
  add_rim_problem(wall(t), t.diameter, out);
  return out;
}

TextureFacts facts(const PillarArray& t) { return array_facts(array(t), wall(t)); }

Roles roles(PillarArray& t) {
  return {.lattice = &t.lattice,
          .period = &t.period,
          .width = &t.diameter,
          .depth = &t.height,
          .wall_angle = &t.wall_angle,
          .edge_radius = &t.edge_radius,
          .relief = &t.height,
          .parts = nullptr};
}

}  // namespace papilla::geometry
