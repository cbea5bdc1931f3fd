// What the local rule and the rule with spreading flux share: columns of air and water, and the sum
// of their pull.
#pragma once

#include <vector>

#include "physics/electrostatics/field.h"

namespace papilla {

constexpr double kNoPull = -1;  // marks a column of air without pull

// Above the dielectric, a pixel each [m].
struct AirColumns {
  std::vector<double> air;    // kNoPull: no pull here
  std::vector<double> water;  // of droplets that do not bridge; empty: none
};
AirColumns columns_above(const Gap& gap, const Wetting& wetting, const FieldProblem& p);

// Factors on the pull of the series column a pixel; empty: 1.
struct FluxFactors {
  const std::vector<double>& open;  // 0 in bridges, 1 far from them
  const std::vector<double>& gain;  // of the squared flux
  double most_voltage = 0;  // largest share of the voltage across the dielectric; 0: by the columns
};
FieldSolution pull(const Gap& gap, const CoveredSurface* surface, const FieldProblem& p,
                   const AirColumns& columns, const FluxFactors& factors);

}  // namespace papilla
