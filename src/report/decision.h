// What belief says of which finalist to build, in words, as a table and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// Texts carry what is behind their numbers (stated_number.h).

// "How sure: of the 9 designs of the front design 06 is the best in the worst modulation with
// probability 71 %, ...", "What would
// overturn it: ...", "To be surer, measure ...": a line each. Of what is recommended; none without
// a decision, and the first alone of what the decision is not for.
std::vector<std::string> decision_grounds(const ResultFiles& files);
// "0.153 on average over belief (0.029 to 0.398 on 95 % of it)": the worst modulation of what is
// shown at the members, where that is what belief decides by; "" otherwise. Eq. search.26
std::string worst_over_belief(const ResultFiles& files);
// " of those that keep every limit with probability 90 % or more": among which designs the choice
// is; "" where all do.
std::string of_the_sure_text(const ResultFiles& files);
// That the recommended design keeps its limits less surely than the study wants, for the lead; ""
// where it does, or there are none.
std::string unsure_limits_text(const ResultFiles& files);
// The design whose measurement beside that of the chosen one settles most; nothing where the choice
// is sure, or costs less than a per cent of what the best design of each member is worth.
std::optional<std::size_t> design_to_measure(const ResultFiles& files);
// "## Which of them, by belief" of summary.md: each design's probabilities, and what would overturn
// the choice; why there is none, where there is none.
std::string decision_text(const ResultFiles& files);
// Of run.json.
nlohmann::ordered_json decision_json(const ResultFiles& files);
// Of the design at a place of the finalists: p(best), expected regret, p(limits); null without a
// decision about it.
nlohmann::ordered_json prospect_json(const ResultFiles& files, std::size_t finalist);

}  // namespace papilla::report
