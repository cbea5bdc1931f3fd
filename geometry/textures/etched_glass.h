// Glass as an etch leaves it: Gaussian heights of two scales, bumps and what is finer on them.
#pragma once

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

// Of each scale the rms height over `length` and the correlation length, at which the
// autocorrelation has fallen to 1/e. Lengths in metres.
struct EtchedGlass {
  static constexpr std::string_view kName = "etched_glass";
  static constexpr bool kNumbersAlone = true;

  double rms = 150e-9, correlation_length = 10e-6;
  double fine_share = 0.1, fine_correlation_length = 0.5e-6;
  double length = 0.8e-3;
  int seed = 1;

  bool operator==(const EtchedGlass&) const = default;
};

void fields(FieldVisitor& v, EtchedGlass& t);
Heightmap heights(const EtchedGlass& t, const Grid& grid);
TextureProblems problems(const EtchedGlass& t);
TextureFacts facts(const EtchedGlass& t);
Roles roles(EtchedGlass& t);

}  // namespace papilla::geometry
