// A fit from its file to the folder of results: the fitted finger, the report and its page.
#pragma once

#include <functional>
#include <string>

#include "base/rooms.h"
#include "report/fit.h"

namespace papilla::report {

struct FitOptions {
  int threads = 0;
  std::string folder;                            // which is made; empty: nothing is written
  std::function<void(const std::string&)> note;  // progress for people; may be empty
};

struct FitReport {
  Calibration calibration;
  CalibrationResult result;
  std::string markdown, json;
};
// Fits, and judges the claims of both lists before and after on other skins. Throws InputError.
FitReport fit_to_folder(const std::string& file, const FitOptions& options);

}  // namespace papilla::report
