// Straight grooves along y.
#pragma once

#include "geometry/arrays.h"

namespace papilla {

// Width at the top. Lengths in metres, angles in radians.
struct Grating {
  static constexpr std::string_view kName = "grating";
  static constexpr bool kNumbersAlone = true;

  double period = 6e-6, width = 3e-6, depth = 350e-9;
  double wall_angle = kSteepWall;
  double edge_radius = 0;

  bool operator==(const Grating&) const = default;
};

void fields(FieldVisitor& v, Grating& t);
Heightmap heights(const Grating& t, const Grid& grid);
TextureProblems problems(const Grating& t);
TextureFacts facts(const Grating& t);
Roles roles(Grating& t);

}  // namespace papilla
