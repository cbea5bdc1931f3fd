// The rules for the pull of the field, and what is known of each: its words, its error, its price.
#pragma once

#include "base/rooms.h"
#include "physics/electrostatics/field.h"
#include "scene/finger.h"

namespace papilla::electrostatics {

struct FieldRule {
  const char* method;    // for people: what is computed
  const char* accuracy;  // for people: how far the pull is off
  double usual_error;    // of the pull, relative, on textures of all kinds
  // Price of one patch on one core of a usual machine [s]; tolerance of the potential.
  double (*seconds)(const Grid& grid, double tolerance);
  FieldSolution (*solve)(const Gap& gap, const CoveredSurface* surface, const Wetting& wetting,
                         const FieldProblem& problem, double tolerance);
};
const FieldRule& field_rule(FieldMethod method);

}  // namespace papilla::electrostatics
