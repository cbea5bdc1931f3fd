// What each continuous variable does at one design, and how far it may be off there. Eq. search.9
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"

namespace papilla::search {

// How far a number may be off one way, and what ends it there.
struct Drift {
  enum class End {
    Loss,       // an objective is worse by what is tolerated
    Limit,      // a limit of the study is reached
    StepTried,  // nothing within the step that was tried
    RangeEnds,  // not judged: the space ends here
    NoShape,    // not judged: no such shape can be made
    Failed,     // not judged: the evaluation failed
  };
  double most = 0;  // SI; of the first three
  End end = End::RangeEnds;
  std::string limit{};  // that is reached: "min_wall"

  bool judged() const { return end <= End::StepTried; }
};

struct VariableSensitivity {
  std::size_t variable = 0;
  std::vector<double> change;  // of each objective for +`step`, the user's sign
  std::vector<double> share;   // of each objective's variance when all variables scatter by a step
  double step = 0;             // SI
  Drift down, up;
};

// One variable of the design moved by a step, or the largest part of it that the space leaves and
// that makes a shape.
struct SensitivityMove {
  std::size_t variable = 0;
  int sign = 0;
  Point unit;
  double part = 1;  // of the step
};

// A design whose numbers are moved; flat: without its texture, whose numbers then move nothing.
struct MovedDesign {
  Point unit;
  bool flat = false;
};

// Along each continuous variable that does something here, both ways where the space and the shape
// allow; of another kind's numbers and of a texture that is not there none.
std::vector<SensitivityMove> sensitivity_moves(const StudyProblem& problem,
                                               const MovedDesign& centre);

// Limits are judged as confirmed: what a move changes is told apart from what the level of the
// moves is off by. confirmed: of the design, ok; at_centre and moved: at that level, changed.
// Eq. search.9
void set_confirmed_limits(const StudyProblem& problem, const Score& confirmed, Score& at_centre,
                          std::vector<Score>& moved);

// From the scores of the design and of its moves; empty when the design itself has failed.
std::vector<VariableSensitivity> sensitivity(const StudyProblem& problem, const MovedDesign& centre,
                                             const std::vector<SensitivityMove>& moves,
                                             const Score& at_centre,
                                             const std::vector<Score>& moved);

}  // namespace papilla::search
