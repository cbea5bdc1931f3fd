// Round holes in a flat land.
#pragma once

#include "geometry/arrays.h"

namespace papilla {

// The diameter is where wall and land would meet without the edge radius. Lengths in metres, angles
// in radians.
struct HoleArray {
  static constexpr std::string_view kName = "hole_array";
  static constexpr bool kNumbersAlone = true;

  Lattice lattice = Lattice::Square;
  double period = 6e-6, diameter = 3e-6, depth = 350e-9;
  double wall_angle = kSteepWall;
  double edge_radius = 0;

  bool operator==(const HoleArray&) const = default;
};

void fields(FieldVisitor& v, HoleArray& t);
Heightmap heights(const HoleArray& t, const Grid& grid);
TextureProblems problems(const HoleArray& t);
TextureFacts facts(const HoleArray& t);
Roles roles(HoleArray& t);

}  // namespace papilla
