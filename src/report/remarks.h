// What a reader must know of a run before its numbers, in words.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// Sentences: where the clock ended it and what that leaves unsure, first; fewer evaluations than
// were asked for; variables that never moved; bounds that the best design lies on.
std::vector<std::string> run_remarks(const Study& study, const StudyProblem& problem,
                                     const OptimiseResult& result);

}  // namespace papilla::report
