// Fits the finger to measured friction or to published numbers, with uncertainties and with what
// the data cannot tell apart. Common random numbers (the same skins at every step) keep residuals
// smooth. Equations calibration.N: docs/theory/calibration.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "claims/reproduce.h"
#include "optim/least_squares.h"

namespace papilla {

// One row of measured friction; a line of the user's table.
struct FrictionDatum {
  std::string design;                                                    // file
  double relative_humidity = 0, amplitude = 0, frequency = 0, load = 0;  // SI
  double off = 0, off_sd = 0, on = 0, on_sd = 0;                         // [N]; on_sd 0: not driven
  int line = 0;
};

// `design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,F_on_sd_N`:
// designs beside the table, humidity as "15 %" or 0.15; empty F_on where nothing is driven. Throws
// InputError with every bad cell, each with its line; a friction over ten times the load is one.
std::vector<FrictionDatum> read_friction(const std::string& path);

struct CalibrationParameter {
  std::string path;  // into the finger: "skin.rms"; "water.scale" multiplies every volume
  std::string unit;
  FitParameter fit;  // SI
};

struct Calibration {
  std::string title;
  Finger finger;  // where the fit starts
  std::vector<CalibrationParameter> parameters;
  std::vector<std::string> fit, hold_out;  // ids of claims, written down before the fit
  std::vector<FrictionDatum> data;
  ClaimSampling sampling{"draft", 12, 0};  // of the fit
  ClaimSampling check;                     // of the claims afterwards: other skins
  int iterations = 15;
  bool profiles = false;
  std::string file;
};

// Throws InputError with every problem.
Calibration read_calibration(const std::string& path);

// One residual before and after.
struct FitRow {
  std::string source;  // claim id, or "line 4 F_off"
  std::string what;
  double low = 0, high = 0, sd = 0;  // what the data say; low = high: a value
  double sampling_sd = 0;            // of the model, from its skins; already in the weight
  double before = 0, after = 0;      // the model
};

struct CalibrationResult {
  Finger finger;  // fitted; fitted_to names the claims
  LeastSquaresFit fit;
  std::vector<FitRow> rows;
  double chi2_before = 0;
  std::vector<ClaimResult> claims_before, claims_after;  // fitted and held-out, on other skins
  double gap_before = 0, gap_after = 0;                  // C_gap [m]
  std::vector<double> friction_coefficient;  // after, flat glass, at 15, 35, 55, 75 % RH
  int evaluations = 0;
  double seconds = 0;  // wall clock: in no file
};

struct CalibrationOptions {
  int threads = 0;
  bool check = true;  // judge the claims of the lists afterwards
  std::function<void(const std::string&)> note;
};

CalibrationResult calibrate(const Calibration& calibration, const CalibrationOptions& options = {});

// Why the fitted finger is not to be used, for people: the data are far outside what it explains,
// whether or not the fit converged. "" where they are not.
std::string calibration_warning(const CalibrationResult& result);

// The fit report: parameters with intervals, correlations, what is not identified, every residual,
// fitted and held-out claims apart.
std::string calibration_markdown(const Calibration& calibration, const CalibrationResult& result);
std::string calibration_json(const Calibration& calibration, const CalibrationResult& result);

// The finger with parameters set: the order of `calibration.parameters`.
Finger with_parameters(const Calibration& calibration, std::span<const double> values);

}  // namespace papilla
