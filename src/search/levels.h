// How accurate each stage of a run is, how many designs it judges and what that costs.
#pragma once

#include <string>

#include "search/problem.h"
#include "search/protocol.h"

namespace papilla {

inline constexpr std::size_t kFinalists = 8;
// Flat surface, sensitivity and parameters cost about as much as confirming so many designs; the
// stability of a design on the front as much as one.
inline constexpr int kOtherChecks = 4;

Fidelity stage_fidelity(const StudyProblem& problem, Stage stage);

// How many designs the level between search and confirmation judges: where there is a model of the
// front.
std::size_t narrowings(const SearchProblem& search);

// Processor time of a design at a stage over that of one of the search.
double relative_cost(const StudyProblem& problem, Stage stage);

// What will run, for plan.txt and people.
std::string search_plan(const Study& study);

}  // namespace papilla
