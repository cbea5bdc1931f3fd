// Several textures as one surface.
#pragma once

#include "geometry/facts.h"

namespace papilla {

enum class Combine { Sum, Maximum };

struct Stack {
  static constexpr std::string_view kName = "stack";
  static constexpr bool kNumbersAlone = false;

  Combine combine = Combine::Sum;
  std::vector<Texture> parts;

  bool operator==(const Stack&) const;
};

void fields(FieldVisitor& v, Stack& t);
Heightmap heights(const Stack& t, const Grid& grid);
TextureProblems problems(const Stack& t);
TextureFacts facts(const Stack& t);
Roles roles(Stack& t);

}  // namespace papilla
