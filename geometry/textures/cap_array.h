// Spherical caps on a lattice, sunk (dimples) or raised (domes).
#pragma once

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// Diameter at the land. Lengths in metres.
struct CapArray {
  static constexpr std::string_view kName = "cap_array";
  static constexpr bool kNumbersAlone = true;
  enum class Form { Dimples, Domes };

  Form form = Form::Dimples;
  Lattice lattice = Lattice::Square;
  double period = 6e-6, diameter = 3e-6, depth = 350e-9;

  bool operator==(const CapArray&) const = default;
};

void fields(FieldVisitor& v, CapArray& t);
Heightmap heights(const CapArray& t, const Grid& grid);
TextureProblems problems(const CapArray& t);
TextureFacts facts(const CapArray& t);
Roles roles(CapArray& t);

}  // namespace papilla::geometry
