// Published claims beside the model, as tables.
#pragma once

#include <string>
#include <vector>

#include "claims/reproduce.h"

namespace papilla {

// One line per claim and the counts by verdict; for people, Markdown, CSV; JSON as
// {"schema": 1, "claims": [{"id", "paper", "model", "se", "verdict", "reason", ...}], "counts"}.
std::string claims_text(const std::vector<ClaimResult>& results);
std::string claims_markdown(const std::vector<ClaimResult>& results, const std::string& finger);
std::string claims_csv(const std::vector<ClaimResult>& results);
std::string claims_json(const std::vector<ClaimResult>& results);

}  // namespace papilla
