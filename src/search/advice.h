// What a run recommends: its best design, or the surface without a texture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::search {

enum class Advice {
  Nothing,    // no design keeps every constraint
  Unknown,    // the surface without texture was not asked, or has no answer
  LeaveFlat,  // no texture gains more than the error of the difference; nor does the finish
  Finish,     // the finish (or drive) gains, the texture does not
  Texture,    // the texture gains, or the surface without it is pulled in
};
Advice advice_of(const StudyProblem& problem, const OptimiseResult& result);

// The design that the advice is about, as it was searched: the best one or its surface without the
// texture, with its own finish or that of the study. Of a run with a best design.
FinalDesign recommended_design(const StudyProblem& problem, const OptimiseResult& result);

// What the recommended design is worth with its numbers on the grid of the fab; nothing where they
// were on it as searched, or it was not judged again.
std::optional<Score> worth_on_grid(const StudyProblem& problem, const OptimiseResult& result);

// Variables beside the texture that two designs have otherwise: of finish and drive.
std::vector<std::size_t> finish_apart(const StudyProblem& problem, const Point& a, const Point& b);

// Where the best design has another finish or drive than the study file: those variables.
std::vector<std::size_t> changed_finish(const StudyProblem& problem, const OptimiseResult& result);

// The limits that the surface of the best design breaks without its texture.
std::vector<LimitValue> broken_without_texture(const StudyProblem& problem,
                                               const OptimiseResult& result);

// Those of the study's own surface without a texture, of a run that asked for it.
std::vector<LimitValue> broken_before(const StudyProblem& problem, const OptimiseResult& result);

// The best flat surface that was confirmed and keeps every limit, by the first objective: of the
// finalists and of those that the best design is compared with. Nothing where that is the best
// design's own finish and drive.
std::optional<FinalDesign> best_flat(const StudyProblem& problem, const OptimiseResult& result);

}  // namespace papilla::search
