// Fits the finger to measured friction or to published numbers. docs/theory/calibration.md
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "papilla/error.h"

namespace papilla::api {

struct CalibrateOptions {
  int threads = 0;  // 0: all processors
  // Finger, fit and page are written into this folder, as `papilla calibrate --out`; empty: none.
  std::string folder;
  std::function<void(const std::string&)> progress;  // for people; may be empty
  const std::atomic<bool>* stop = nullptr;  // set by another thread: calibrate() throws Stopped
};

struct FittedParameter {
  std::string path;
  double value = 0, error = 0;  // SI; one standard error
  double low = 0, high = 0;     // 95 % interval
  double data_share = 0;        // of what is known of it: 1 the data alone, 0 the prior alone
};

struct CalibrateResult {
  bool converged = false;
  bool explains_data = false;  // false: the fitted finger is not to be used
  std::string warning;         // for people; empty: none
  std::vector<FittedParameter> parameters;
  double chi2_before = 0, chi2 = 0;
  int degrees_of_freedom = 0;
  std::string finger;       // the fitted finger as TOML
  std::string table, json;  // of the command
};

// file: CALIBRATION.toml; docs/how_to/calibrate.md. Throws InputError, Stopped.
CalibrateResult calibrate(const std::string& file, const CalibrateOptions& options = {});

}  // namespace papilla::api
