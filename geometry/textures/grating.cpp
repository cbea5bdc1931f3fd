#include "geometry/textures/grating.h"

#include <cmath>

#include "geometry/profile.h"

namespace papilla::geometry {
namespace {

FeatureArray array(const Grating& t) {
  return {FeatureArray::Shape::Line, true, Lattice::Square, t.period, t.width, "grooves"};
}
WallSection wall(const Grating& t) { return {t.depth, t.wall_angle, t.edge_radius}; }

}  // namespace

void fields(FieldVisitor& v, Grating& t) {
  v.number({"period", "um", 0.01, 1e3, "distance of neighbouring grooves"}, t.period);
  v.number({"width", "um", 0.001, 1e3, "groove width at the land"}, t.width);
  v.number({"depth", "nm", 0, 1e5, "groove depth; 0: flat"}, t.depth);
  wall_fields(v, t.wall_angle, t.edge_radius);
}

Heightmap heights(const Grating& t, const Grid& grid) {
  Heightmap out{grid, std::vector<double>(grid.size())};
  const WallProfile profile(t.depth, t.wall_angle, t.edge_radius);
  for (int ix = 0; ix < grid.nx; ++ix) {
    const double x = grid.x(ix) - 0.5 * t.period;
    const double r = std::abs(x - t.period * std::round(x / t.period));
    const double z = -profile.mean_drop(0.5 * t.width - r, grid.dx());
    for (int iy = 0; iy < grid.ny; ++iy) out(ix, iy) = z;
  }
  return out;
}

TextureProblems problems(const Grating& t) {
  TextureProblems out = array_problems(t.period, t.width, "width");
  add_wall_problem(wall(t), t.width, "depth", out);
  add_rim_problem(wall(t), t.period - t.width, out);
  return out;
}

TextureFacts facts(const Grating& t) { return array_facts(array(t), wall(t)); }

Roles roles(Grating& t) {
  return {.lattice = nullptr,
          .period = &t.period,
          .width = &t.width,
          .depth = &t.depth,
          .wall_angle = &t.wall_angle,
          .edge_radius = &t.edge_radius,
          .relief = &t.depth,
          .parts = nullptr};
}

}  // namespace papilla::geometry
