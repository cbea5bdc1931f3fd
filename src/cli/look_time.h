// How long the look of a study's own design takes on this machine.
#pragma once

#include "base/rooms.h"
#include "cli/context.h"
#include "search/problem.h"

namespace papilla::cli {

// look_price, with a note before it where that may take long.
double timed_look(const Context& context, const StudyProblem& problem);

}  // namespace papilla::cli
