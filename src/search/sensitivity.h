// What each continuous variable does at one design. Eq. search.9
#pragma once

#include <vector>

#include "search/problem.h"

namespace papilla {

struct VariableSensitivity {
  std::size_t variable = 0;
  std::vector<double> change;  // of each objective for +`step`, the user's sign
  std::vector<double> share;   // of each objective's variance when all variables scatter by a step
  double step = 0;             // SI
  // Drift that costs no objective more than 5 % of its value, SI; beyond: even a whole step does
  // not.
  double down = 0, up = 0;
  bool down_beyond = false, up_beyond = false;
};

// One variable of the design moved by a step.
struct SensitivityMove {
  std::size_t variable = 0;
  int sign = 0;
  Point unit;
};

// Along each continuous variable, both ways where the space and the shape allow.
std::vector<SensitivityMove> sensitivity_moves(const StudyProblem& problem, const Point& centre);

// From the scores of the design and of its moves; empty when the design itself has failed.
std::vector<VariableSensitivity> sensitivity(const StudyProblem& problem, const Point& centre,
                                             const std::vector<SensitivityMove>& moves,
                                             const Score& at_centre,
                                             const std::vector<Score>& moved);

}  // namespace papilla
