// Gaps over an oxide, as the tests of the local field take them.
#pragma once

#include <cmath>
#include <vector>

#include "base/rooms.h"
#include "physics/electrostatics/field.h"

namespace papilla::tests {

inline FieldProblem oxide(double v_peak, double thickness = 500e-9) {
  FieldProblem p;
  p.v_rms = v_peak / std::sqrt(2.0);
  p.v_peak = v_peak;
  p.dielectric = thickness / 3.9;
  p.dielectric_thickness = thickness;
  return p;
}

inline Gap uniform_gap(double g, int n = 32, double length = 4e-6) {
  return {{n, n, length, length}, std::vector<double>(static_cast<std::size_t>(n) * n, g)};
}

}  // namespace papilla::tests
