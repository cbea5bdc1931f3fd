// Straight grooves along y with a section of two straight walls that meet at the bottom.
#pragma once

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// Width at the land; grooves as wide as the period leave sharp ridges. Lengths in metres.
struct VGrooves {
  static constexpr std::string_view kName = "v_grooves";
  static constexpr bool kNumbersAlone = true;

  double period = 6e-6, width = 3e-6, depth = 350e-9;

  bool operator==(const VGrooves&) const = default;
};

void fields(FieldVisitor& v, VGrooves& t);
Heightmap heights(const VGrooves& t, const Grid& grid);
TextureProblems problems(const VGrooves& t);
TextureFacts facts(const VGrooves& t);
Roles roles(VGrooves& t);

}  // namespace papilla::geometry
