// What all good designs of a search share: the range of each number over them. Eq. search.22
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

// A number over the good designs that have it.
struct SharedRange {
  std::string name, unit;         // "texture.depth", "min_wall", "depth / period"; for people
  std::size_t designs = 0;        // that have it
  double low = 0, high = 0;       // over them, SI
  double from = 0, to = 0;        // that it may have: its bounds; of no variable over all evaluated
  std::vector<double> choices{};  // of a variable with choices: those that occur

  // Of the range that it may have.
  double share() const { return to > from ? (high - low) / (to - from) : 0; }
};

struct SharedRanges {
  std::size_t good = 0, feasible = 0;  // designs
  std::vector<SharedRange> ranges;     // the variables in their order, then what follows from them
};

// Over the designs that keep every limit and that none of these betters by more than 5 % in every
// objective, at the level of the search.
SharedRanges shared_ranges(const StudyProblem& problem, const JudgedDesigns& history);

}  // namespace papilla::search
