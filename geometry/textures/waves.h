// Cosine waves: the smoothest relief of a period.
#pragma once

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// Lengths in metres.
struct Waves {
  static constexpr std::string_view kName = "waves";
  static constexpr bool kNumbersAlone = true;
  enum class Directions { One, Both };

  Directions directions = Directions::One;
  double period = 6e-6, depth = 350e-9;

  bool operator==(const Waves&) const = default;
};

void fields(FieldVisitor& v, Waves& t);
Heightmap heights(const Waves& t, const Grid& grid);
TextureProblems problems(const Waves& t);
TextureFacts facts(const Waves& t);
Roles roles(Waves& t);

}  // namespace papilla::geometry
