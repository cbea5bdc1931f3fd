// A Response for people (table) and for programs (JSON, schema 1).
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"
#include "papilla/quantities.h"

namespace papilla::report {

// Humidity table with error bars, summary lines, and what limits trust in it.
std::string response_table(const Response& response);

// What limits trust in it, a line each: choices that no ± holds, the field's limits and its rule,
// loads beside the pull, what the grid does not resolve ("warning: ...").
std::vector<std::string> caveats(const Response& response);

// Whether the state exists that a quantity of a point describes: without it there is no number, and
// the status of the point says why.
bool exists(api::FingerDrive drive, const ResponsePoint& point, bool driven);

// {"schema": 1, "points": [...], "summary": {...}, "plan": {...}, "seconds", "contact_solves",
// "fft_pairs"}: fidelity.grid counts pixels along fidelity.window, plan.grid is the patch as run;
// SI units, fractions for percentages, null never NaN.
// with_time = false leaves the clock out, for files that must be reproducible. indent < 0: one
// line.
std::string response_json(const Response& response, bool with_time = true, int indent = 2);

// Friction (drive off and on) and modulation over humidity with bands of two standard errors.
std::string response_svg(const Response& response, const std::string& title);

// {"schema": 1, "plan": {...}} of the same form.
std::string plan_document(const Plan& plan);

// Unicode bars of the modulation over humidity; "" when undriven.
std::string modulation_sparkline(const Response& response);

}  // namespace papilla::report
