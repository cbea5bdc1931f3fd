// A run in words and tables (Markdown).
#pragma once

#include <string>

#include "search/run.h"

namespace papilla {

inline constexpr const char* kNoBetter =
    "The best design is no better than its surface without texture: no objective gains more than "
    "the error of the difference.";

// summary.md of a run's folder.
std::string run_summary(const ResultFiles& files);

// The finalists as a table for people.
std::string result_table(const Study& study, const OptimiseResult& result);

// Why nothing is feasible, as part of a sentence.
std::string infeasible_text(const OptimiseResult& result);

}  // namespace papilla
