// What all good designs of a run share, as a report says it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// "## What all good designs share" of summary.md; empty where there are too few of them.
std::string shared_text(const ResultFiles& files);
// Null where there are too few.
nlohmann::ordered_json shared_json(const ResultFiles& files);

}  // namespace papilla::report
