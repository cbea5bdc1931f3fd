// A self-affine random surface.
#pragma once

#include "geometry/facts.h"

namespace papilla {

// rms height over 12 um; wavelengths of the roll-off and of the cut-off. Lengths in metres.
struct RandomRough {
  static constexpr std::string_view kName = "random_rough";
  static constexpr bool kNumbersAlone = true;

  double rms = 50e-9, roll_off = 3e-6, hurst = 0.8, cutoff = 200e-9;
  int seed = 1;

  bool operator==(const RandomRough&) const = default;
};

void fields(FieldVisitor& v, RandomRough& t);
Heightmap heights(const RandomRough& t, const Grid& grid);
TextureProblems problems(const RandomRough& t);
TextureFacts facts(const RandomRough& t);
Roles roles(RandomRough& t);

}  // namespace papilla
