// A surface without relief.
#pragma once

#include "geometry/facts.h"

namespace papilla {

struct Flat {
  static constexpr std::string_view kName = "flat";
  static constexpr bool kNumbersAlone = true;

  bool operator==(const Flat&) const = default;
};

void fields(FieldVisitor& v, Flat& t);
Heightmap heights(const Flat& t, const Grid& grid);
TextureProblems problems(const Flat& t);
TextureFacts facts(const Flat& t);
Roles roles(Flat& t);

}  // namespace papilla
