// The report of a fit: parameters with intervals, correlations, what is not identified, every
// residual, fitted and held-out claims apart.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "calibrate/calibrate.h"
#include "claims/reproduce.h"

namespace papilla::report {

// The claims of the calibration's lists by the starting and by the fitted finger, on skins that the
// fit has not seen: the same claims in the same order.
struct JudgedFit {
  std::vector<ClaimResult> before, after;
};

// For people: that the fit stopped early, why the fitted finger is not to be used, that stated
// deviations are too large; "" where nothing is wrong.
std::string calibration_warning(const CalibrationResult& result);

std::string calibration_markdown(const Calibration& calibration, const CalibrationResult& result,
                                 const JudgedFit& claims = {});
std::string calibration_json(const Calibration& calibration, const CalibrationResult& result,
                             const JudgedFit& claims = {});

}  // namespace papilla::report
