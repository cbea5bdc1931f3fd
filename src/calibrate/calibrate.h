// Fits the finger to measured friction or to published numbers, with uncertainties and with what
// the data cannot tell apart. Common random numbers (the same skins at every step) keep residuals
// smooth. Equations calibration.N: docs/theory/calibration.md.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "calibrate/belief_fit.h"
#include "calibrate/calibration_file.h"
#include "calibrate/residuals.h"
#include "optim/least_squares.h"

namespace papilla::calibrate {

struct CalibrationResult {
  // Before, and fitted: named by the calibration's title; fitted_to names the claims.
  Finger start, finger;
  LeastSquaresFit fit;
  int iterations = 0;  // that the fit had at most
  std::vector<FitRow> rows;
  double chi2_before = 0;
  // What frictions of the descent's level were multiplied by at the fitted finger. Eq.
  // calibration.6
  double least_factor = 1, largest_factor = 1;
  double gap_before = 0, gap_after = 0;      // capacitance_gap [m]
  std::vector<double> friction_coefficient;  // after, flat glass, at 15, 35, 55, 75 % RH
  int evaluations = 0;
  std::optional<BeliefFit> belief;  // where the calibration asks for it
};

struct CalibrationOptions {
  int threads = 0;
  bool check = true;  // also the friction on flat glass, at the level of [check]
  std::function<void(const std::string&)> note;
  std::string folder;  // keeps the model's answers until the fit ends; empty: nothing is kept
};

// WorkStopped out of a Watch leaves what was answered in the folder: the same call goes on.
CalibrationResult fit_finger(const Calibration& calibration,
                             const CalibrationOptions& options = {});

// What Eq. accuracy.11 carries on: relative deviations, at most what a finger file takes; `note` is
// told of those that are more. A number at its bound has none.
std::vector<ParameterDeviation> deviations(
    const LeastSquaresFit& fit, const std::function<void(const std::string&)>& note = {});

// Chi squared per degree of freedom: 1 where the stated deviations are right.
double misfit(const CalibrationResult& result);
// False where the data are so far outside what the fitted finger explains that it is not to be
// used, whether or not the fit converged.
bool explains_data(const CalibrationResult& result);

}  // namespace papilla::calibrate
