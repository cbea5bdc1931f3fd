#include "geometry/textures/cap_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "geometry/arrays.h"
#include "geometry/gradual.h"

namespace papilla::geometry {
namespace {

FeatureArray discs(const CapArray& t, double width) {
  return {FeatureArray::Shape::Disc,
          t.form == CapArray::Form::Dimples,
          t.lattice,
          t.period,
          width,
          "caps"};
}

double sphere_radius(const CapArray& t) {
  return (square(0.5 * t.diameter) + square(t.depth)) / (2 * t.depth);
}

// Where the cap meets the land [rad].
double rim_slope(const CapArray& t) {
  return t.depth > 0 ? std::asin(std::min(0.5 * t.diameter / sphere_radius(t), 1.0)) : 0;
}

// Eq. geometry.8: between the plane of the rims and the sphere, at a distance from the axis [m].
double cap(const CapArray& t, double distance) {
  const double radius = sphere_radius(t);
  if (distance >= 0.5 * t.diameter) return 0;
  return std::sqrt(square(radius) - square(distance)) - (radius - t.depth);
}

}  // namespace

void fields(FieldVisitor& v, CapArray& t) {
  v.choice({"form", "caps of spheres sunk into the land or standing on it"}, {"dimples", "domes"},
           t.form);
  lattice_field(v, t.lattice);
  v.number({"period", "um", 0.01, 1e3, "distance of neighbours"}, t.period);
  v.number({"diameter", "um", 0.001, 1e3, "of the caps at the land"}, t.diameter);
  v.number({"depth", "nm", 0, 1e5, "of dimples, or height of domes; 0: flat"}, t.depth);
}

Heightmap heights(const CapArray& t, const Grid& grid) {
  if (t.depth == 0) return {grid, std::vector<double>(grid.size())};
  const double sign = t.form == CapArray::Form::Dimples ? -1 : 1;
  return round_features(discs(t, t.diameter), {t.depth, rim_slope(t), 0}, grid,
                        [&](double r, double) { return sign * cap(t, r); });
}

TextureProblems problems(const CapArray& t) {
  TextureProblems out = array_problems(t.period, t.diameter, "diameter");
  if (t.depth > 0.5 * t.diameter) {
    out.emplace_back("depth", fmt::format("{:.4g} nm is more than half the diameter: a cap is a "
                                          "half sphere at most",
                                          1e9 * t.depth));
  }
  return out;
}

TextureFacts facts(const CapArray& t) {
  const bool dimples = t.form == CapArray::Form::Dimples;
  const double radius = t.depth > 0 ? sphere_radius(t) : 0;
  const double chord = 2 * std::sqrt(std::max(t.depth * (radius - 0.25 * t.depth), 0.0));
  const double share = feature_share(discs(t, chord));
  const double row = t.lattice == Lattice::Square ? t.period : std::sqrt(3.0) * t.period;
  return gradual_facts(
      {.relief = dimples ? Relief::between(-t.depth, 0) : Relief::between(0, t.depth),
       .cell = UnitCell{t.period, row},
       .hole = dimples ? chord : t.period - chord,
       .land = dimples ? t.period - chord : chord,
       .open_share = dimples ? share : 1 - share,
       .rim_radius = dimples ? 0.0 : radius,
       .steepest = rim_slope(t),
       .directional = false});
}

Roles roles(CapArray& t) {
  Roles out = Roles::none();
  out.lattice = &t.lattice;
  out.period = &t.period;
  out.width = &t.diameter;
  out.depth = &t.depth;
  out.relief = &t.depth;
  return out;
}

}  // namespace papilla::geometry
