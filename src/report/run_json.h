// run.json: how a run ended, remarks, recommendation, sheet.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

nlohmann::ordered_json run_json(const ResultFiles& files);

}  // namespace papilla::report
