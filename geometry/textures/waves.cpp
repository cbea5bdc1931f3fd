#include "geometry/textures/waves.h"

#include <cmath>

#include "base/constants.h"
#include "geometry/gradual.h"

namespace papilla::geometry {
namespace {

double wave_number(const Waves& t) { return 2 * kPi / t.period; }  // [1/m]

}  // namespace

void fields(FieldVisitor& v, Waves& t) {
  v.choice({"directions", "waves along x, or along x and y"}, {"one", "both"}, t.directions);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbouring crests"}, t.period);
  v.number({"depth", "nm", 0, 1e5, "from the crests to the lowest places; 0: flat"}, t.depth);
}

// Eq. geometry.8, averaged over a pixel: a cosine keeps its shape.
Heightmap heights(const Waves& t, const Grid& grid) {
  const double k = wave_number(t);
  const auto mean = [k](double low, double high) {
    return (std::sin(k * high) - std::sin(k * low)) / (k * (high - low));
  };
  Heightmap out = along_x(grid, mean);
  for (int iy = 0; iy < grid.ny; ++iy) {
    const double along_y = mean(grid.y(iy) - 0.5 * grid.dy(), grid.y(iy) + 0.5 * grid.dy());
    for (int ix = 0; ix < grid.nx; ++ix) {
      double& z = out(ix, iy);
      if (t.directions == Waves::Directions::Both) z = 0.5 * (z + along_y);
      z = -0.5 * t.depth * (1 - z);
    }
  }
  return out;
}

TextureProblems problems(const Waves&) { return {}; }

TextureFacts facts(const Waves& t) {
  const bool one = t.directions == Waves::Directions::One;
  const double width = one ? 0.5 * t.period : std::sqrt(0.5) * t.period;  // of stripes, of squares
  // Of both directions half as steep along each.
  const double slope = (one ? 0.5 : std::sqrt(0.125)) * t.depth * wave_number(t);
  const double curvature = (one ? 0.5 : 0.25) * t.depth * square(wave_number(t));  // of a crest
  return gradual_facts({.relief = Relief::between(-t.depth, 0),
                        .cell = UnitCell{t.period, t.period},
                        .hole = width,
                        .land = width,
                        .open_share = 0.5,
                        .rim_radius = 1 / curvature,
                        .steepest = std::atan(slope),
                        .directional = t.directions == Waves::Directions::One});
}

Roles roles(Waves& t) {
  Roles out = Roles::none();
  out.period = &t.period;
  out.depth = &t.depth;
  out.relief = &t.depth;
  return out;
}

}  // namespace papilla::geometry
