// The yield of what is built, as a report says it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// "± 20 nm", "sigma 5 nm": a tolerance as a study states it.
std::string tolerance_text(const Study& study, std::size_t scatter, double share = 1);

// For the recommendation: the share of plates that keep every limit; empty where nothing scatters
// or the build was not judged.
std::string yield_sentence(const ResultFiles& files);
// That share, which limit most break and which tolerance costs most; as empty.
std::string yield_text(const ResultFiles& files);
// Null where there is none.
nlohmann::ordered_json yield_json(const ResultFiles& files);

}  // namespace papilla::report
