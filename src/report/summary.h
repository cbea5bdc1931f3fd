// A run in words and tables (Markdown).
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

inline constexpr const char* kNoBetter =
    "The best design is no better than its surface without texture: no objective gains more than "
    "the error of the difference.";

// summary.md of a run's folder; its text carries what is behind its numbers (stated_number.h).
std::string run_summary(const ResultFiles& files);

// The finalists as a table for people.
std::string result_table(const Study& study, const OptimiseResult& result);

// Whether a variable says something of a design: of a flat one no measure of a texture does, nor
// another kind's own number.
bool is_shown(const StudyProblem& problem, const Design& design, std::size_t variable);
// The limits of the study and what a confirmed design has of them; empty where that failed.
std::vector<LimitValue> limit_values(const StudyProblem& problem, const FinalDesign& design);

// Why nothing is feasible, as part of a sentence.
std::string infeasible_text(const OptimiseResult& result);

}  // namespace papilla::report
