// The best design as a fab draws it: lengths on its grid.
#pragma once

#include "base/rooms.h"
#include "search/problem.h"

namespace papilla::search {

// A number of a design on a fab's grid [m]: lengths to multiples of it, or of a tenth, a hundredth
// ... of it where that is more than a fiftieth of the length; angles to degrees; the rest to three
// digits. Within low and high where the grid has such a value.
double on_grid(const Variable& variable, double value, double grid);

// Choices stay as they are, and so do numbers of a texture that is not there.
Point rounded(const StudyProblem& problem, const Point& unit);

}  // namespace papilla::search
