// What belief says of which finalist to build, in words, as a table and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// Texts carry what is behind their numbers (stated_number.h).

// "How sure: it is the best of 9 in the worst modulation with probability 71 %, ...", "What would
// overturn it: ...", "To be surer, measure ...": a line each. Of the design that the decision is
// for; none without a decision.
std::vector<std::string> decision_grounds(const ResultFiles& files);
// "## Which of them, by belief" of summary.md: each design's probabilities, and what would overturn
// the choice; why there is none, where there is none.
std::string decision_text(const ResultFiles& files);
// Of run.json.
nlohmann::ordered_json decision_json(const ResultFiles& files);
// Of the design at a place of the finalists: p(best), expected regret, p(limits); null without a
// decision about it.
nlohmann::ordered_json prospect_json(const ResultFiles& files, std::size_t finalist);

}  // namespace papilla::report
