// What a fit starts from, moves, and is held against: a calibration as a file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibrate/friction_table.h"
#include "optim/least_squares.h"
#include "published/finger_model.h"
#include "scene/finger.h"

namespace papilla {

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
  SkinSampling sampling{"draft", 12, 0, 0};  // of the fit
  SkinSampling check;                        // of the claims afterwards: other skins
  int iterations = 15;
  bool profiles = false;
  std::string file;
};

// `judged`: ids of the claims that are judged afterwards, so may be held out. Throws InputError
// with every problem.
Calibration read_calibration(const std::string& path, const std::vector<std::string>& judged);

// The starting finger with parameters set: the order of `calibration.parameters`.
Finger with_parameters(const Calibration& calibration, std::span<const double> values);

}  // namespace papilla
