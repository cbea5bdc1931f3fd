// The belief of a fit, for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/rooms.h"
#include "calibrate/belief_fit.h"

namespace papilla::report {

std::string belief_section(const Calibration& calibration, const BeliefFit& fit);  // Markdown
nlohmann::ordered_json belief_fit_json(const BeliefFit& fit);

}  // namespace papilla::report
