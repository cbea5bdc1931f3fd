// What is built: the best design of the fab's grid round the recommended one. Eq. search.21
#pragma once

#include <cstddef>

#include "base/rooms.h"
#include "search/stages.h"

namespace papilla::search {

// Designs of the grid that are judged as finalists are: the nearest and the best by a model; more
// where these keep not every limit.
inline constexpr std::size_t kJudgedOnGrid = 3, kMostJudgedOnGrid = 6;

// The recommended design itself without a grid, where it is the study's own surface without a
// texture, and where no design of the grid that was judged keeps every limit while it does.
BuiltDesign built_of(Run& run, const FinalDesign& recommended);

}  // namespace papilla::search
