// Round pillars on a flat floor.
#pragma once

#include "geometry/arrays.h"

namespace papilla {

// The floor is z = 0; diameter at the top. Lengths in metres, angles in radians.
struct PillarArray {
  static constexpr std::string_view kName = "pillar_array";
  static constexpr bool kNumbersAlone = true;

  Lattice lattice = Lattice::Square;
  double period = 6e-6, diameter = 3e-6, height = 350e-9;
  double wall_angle = kSteepWall;
  double edge_radius = 0;

  bool operator==(const PillarArray&) const = default;
};

void fields(FieldVisitor& v, PillarArray& t);
Heightmap heights(const PillarArray& t, const Grid& grid);
TextureProblems problems(const PillarArray& t);
TextureFacts facts(const PillarArray& t);
Roles roles(PillarArray& t);

}  // namespace papilla
