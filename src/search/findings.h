// What a run did not try: variables that never moved, bounds that the best design lies on.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"
#include "search/protocol.h"
#include "search/sensitivity.h"

namespace papilla::search {

// A variable that had the same value in all evaluated designs.
struct OneValue {
  std::size_t variable = 0;
  double value = 0;  // SI
};

// A variable that the best design has at an end of its interval.
struct AtBound {
  std::size_t variable = 0;
  bool upper = false;
  double bound = 0;   // SI
  bool last = false;  // of all values that the model takes: no study can widen it
  double step = 0;    // what a widening is told for, SI; 0: not known
  // Of each objective for a step beyond the bound, the user's sign, as it goes inside the bound.
  std::vector<double> change;
};

// Of evaluated designs; empty where there are fewer than two, or one design only in the space.
std::vector<OneValue> one_value_variables(const StudyProblem& problem,
                                          const std::vector<Evaluation>& history);

// What a search tried of textures: surfaces with a relief.
struct TexturesTried {
  std::size_t tried = 0, evaluated = 0;  // evaluated: with numbers
  std::size_t kept = 0;                  // of those: keep every limit at the search's level
  std::size_t refused = 0;               // by limits that need no evaluation
  std::size_t impossible = 0;            // of those: no such shape, or none that can be judged
  std::vector<std::size_t> breaking;     // refused by each limit, as the study lists them
  std::string reason;                    // of the first that is impossible
  std::string failure;                   // of the first that was asked and has no answer
};
TexturesTried textures_tried(const StudyProblem& problem, const std::vector<Evaluation>& history);

std::vector<AtBound> variables_at_bound(const StudyProblem& problem, const Point& best,
                                        const std::vector<VariableSensitivity>& sensitivity);

}  // namespace papilla::search
