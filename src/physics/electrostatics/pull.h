// What the local rule and the rule with spreading flux share: columns of air and water, and the sum
// of their pull.
#pragma once

#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "numerics/vector.h"
#include "physics/electrostatics/field.h"

namespace papilla::electrostatics {

constexpr double kNoPull = -1;  // marks a column of air without pull

// Media above the dielectric, per pixel [m].
struct AirColumns {
  std::vector<double> air;    // kNoPull: no pull here
  std::vector<double> water;  // of droplets that do not bridge; empty: none
};
AirColumns columns_above(const Gap& gap, const Wetting& wetting, const FieldProblem& p);

inline constexpr double kPerWater = 1 / kWaterPermittivity;

// d/eps from the film to the skin [m] of a column or of several; of a bare skin in contact not 0.
template <class T>
T to_skin(const T& air, const T& water, double skin_layer) {
  constexpr double kLeast = 1e-10;
  const T sum = air + skin_layer + kPerWater * water;
  return chosen(sum > kLeast, sum, kLeast);
}

// Of each pixel.
struct FluxFactors {
  const std::vector<double>& open;       // 0 in bridges, 1 far from them; empty: 1
  const std::vector<double>& potential;  // on the film, per volt; empty: as the column has it
};
// Eq. electrostatics.1 summed over the pixels, with the peak fields of Eqs. electrostatics.7, 8.
// Not ok: a bare electrode, or a gap that is not finite. Cost: O(pixels).
FieldSolution pull(const Gap& gap, const CoveredSurface* surface, const FieldProblem& p,
                   const AirColumns& columns, const FluxFactors& factors);

}  // namespace papilla::electrostatics
