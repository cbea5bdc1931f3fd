// What the local rule and the rule with spreading flux share: columns of air and water, and the sum
// of their pull.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "physics/electrostatics/field.h"

namespace papilla::electrostatics {

constexpr double kNoPull = -1;  // marks a column of air without pull

// Media above the dielectric, per pixel [m].
struct AirColumns {
  std::vector<double> air;    // kNoPull: no pull here
  std::vector<double> water;  // of droplets that do not bridge; empty: none
};
AirColumns columns_above(const Gap& gap, const Wetting& wetting, const FieldProblem& p);

// Of each pixel's series column; empty: 1.
struct FluxFactors {
  const std::vector<double>& open;     // 0 in bridges, 1 far from them
  const std::vector<double>& gain;     // of the squared flux
  const std::vector<double>& voltage;  // share across the dielectric; empty: by the columns
};
// Eq. electrostatics.1 summed over the pixels, with the peak fields of Eqs. electrostatics.7, 8.
// Not ok: a bare electrode, or a gap that is not finite. Cost: O(pixels).
FieldSolution pull(const Gap& gap, const CoveredSurface* surface, const FieldProblem& p,
                   const AirColumns& columns, const FluxFactors& factors);

}  // namespace papilla::electrostatics
