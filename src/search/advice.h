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

// The design that the advice is about, as it was searched: the best one or, flat, its surface or
// the study's own without the texture. Of a run with a best design.
FinalDesign recommended_design(const StudyProblem& problem, const OptimiseResult& result);

// What the recommended design is worth with its numbers on the grid of the fab; nothing where they
// were on it as searched, or it was not judged again.
std::optional<Score> worth_on_grid(const StudyProblem& problem, const OptimiseResult& result);

// Where the best design has another finish or drive than the study file: those variables.
std::vector<std::size_t> changed_finish(const StudyProblem& problem, const OptimiseResult& result);

// The limits that the surface of the best design breaks without its texture.
std::vector<LimitValue> broken_without_texture(const StudyProblem& problem,
                                               const OptimiseResult& result);

// Those of the study's own surface without a texture, of a run that asked for it.
std::vector<LimitValue> broken_before(const StudyProblem& problem, const OptimiseResult& result);

// The best flat surface that was confirmed, of the finalists, by the first objective.
std::optional<std::size_t> best_flat(const StudyProblem& problem, const OptimiseResult& result);

}  // namespace papilla::search
