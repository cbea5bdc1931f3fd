// The limits of a study and what designs have of them, as texts and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// What a design has of a limit, as a stated number.
std::string limit_stated(const LimitValue& value, const std::string& words);
// "min_wall at least 0.4 um"
std::string limit_asked(const Constraint& limit);
// "min_wall is 0.3 um, below your limit of 0.4 um"
std::string limit_broken(const LimitValue& value);
// Of what is built, where that was judged; else as far as they are known before.
std::vector<LimitValue> built_limits(const ResultFiles& files);
// What was asked for and what is built, as a table; "" without limits.
std::string limits_table(const std::vector<LimitValue>& limits);
// What the design has of each limit; without what is behind the numbers.
nlohmann::ordered_json limits_json(const std::vector<LimitValue>& limits);
// The same of what is built, with it: for the page.
nlohmann::ordered_json built_limits_json(const std::vector<LimitValue>& limits);

// Of the folder of a run in which no design keeps every limit: that, and which limits break what it
// shows as the best. "" of any other folder.
std::string none_keeps_text(const std::string& run);

}  // namespace papilla::report
