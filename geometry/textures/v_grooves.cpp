#include "geometry/textures/v_grooves.h"

#include <algorithm>
#include <cmath>

#include "geometry/arrays.h"
#include "geometry/gradual.h"

namespace papilla::geometry {
namespace {

// Eq. geometry.8: integral of the height from the middle of a groove to x [m^2].
double section_integral(const VGrooves& t, double x) {
  const auto half_period = [&](double distance) {
    const double inside = std::min(distance, 0.5 * t.width);
    return -t.depth * (inside - inside * inside / t.width);
  };
  const double periods = std::round(x / t.period), rest = x - periods * t.period;
  return 2 * periods * half_period(0.5 * t.period) +
         std::copysign(1.0, rest) * half_period(std::abs(rest));
}

}  // namespace

void fields(FieldVisitor& v, VGrooves& t) {
  v.number({"period", "um", 0.01, 1e3, "distance of neighbouring grooves"}, t.period);
  v.number({"width", "um", 0.001, 1e3, "groove width at the land; the period: sharp ridges"},
           t.width);
  v.number({"depth", "nm", 0, 1e5, "groove depth; 0: flat"}, t.depth);
}

Heightmap heights(const VGrooves& t, const Grid& grid) {
  return along_x(grid, [&](double low, double high) {
    const double middle = 0.5 * t.period;
    return (section_integral(t, high - middle) - section_integral(t, low - middle)) / (high - low);
  });
}

TextureProblems problems(const VGrooves& t) {
  return t.width > t.period ? array_problems(t.period, t.width, "width") : TextureProblems{};
}

TextureFacts facts(const VGrooves& t) {
  return gradual_facts({.relief = Relief::between(-t.depth, 0),
                        .cell = UnitCell{t.period, t.period},
                        .hole = 0.5 * t.width,
                        .land = t.period - 0.5 * t.width,
                        .open_share = 0.5 * t.width / t.period,
                        .rim_radius = 0.0,
                        .steepest = std::atan(2 * t.depth / t.width),
                        .directional = true});
}

Roles roles(VGrooves& t) {
  Roles out = Roles::none();
  out.period = &t.period;
  out.width = &t.width;
  out.depth = &t.depth;
  out.relief = &t.depth;
  return out;
}

}  // namespace papilla::geometry
