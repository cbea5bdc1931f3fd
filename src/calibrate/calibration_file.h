// What a fit starts from, moves, and is held against: a calibration as a file.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "calibrate/friction_table.h"
#include "optim/least_squares.h"
#include "published/finger_model.h"
#include "scene/belief.h"
#include "scene/finger.h"

namespace papilla::calibrate {

inline constexpr const char* kWaterScale = "water.scale";  // multiplies every volume

struct CalibrationParameter {
  std::string path;  // into the finger: "skin.rms"; kWaterScale
  std::string unit;
  FitParameter fit;  // SI
};

// How a belief is made of the fit: the section [belief] of the file.
struct BeliefSettings {
  std::string name = "as fitted";  // of the finger's own model options
  int starts = 3;                  // fits of each hypothesis
  int iterations = 15;             // of each of these fits
  int samples = 200;               // evaluated of each
  int members = 32;
  int seed = 1;

  bool operator==(const BeliefSettings&) const = default;
};
void fields(FieldVisitor& v, BeliefSettings& s);

// A choice of the model beside the finger's own: an item of [[hypothesis]].
struct Hypothesis {
  std::string name;
  std::vector<BeliefValue> set;    // "model.closure"; a value of the finger that no fit moves
  std::vector<BeliefValue> start;  // of fitted parameters: where its fit begins, else the finger's
};

struct Calibration {
  std::string title;
  Finger finger;  // where the fit starts
  std::vector<CalibrationParameter> parameters;
  std::vector<std::string> fit, hold_out;  // ids of claims, written down before the fit
  std::vector<FrictionDatum> data;
  std::vector<std::string> data_notes;       // for people: what of the table was not read
  SkinSampling sampling{"draft", 12, 0, 0};  // of the fit
  SkinSampling check;                        // of the claims afterwards: other skins
  int iterations = 15;
  bool profiles = false;
  std::optional<BeliefSettings> belief;  // none is made without
  std::vector<Hypothesis> hypotheses;    // beside the finger's own
  std::string file;
};

// `judged`: ids of the claims that are judged afterwards, so may be held out. Throws InputError
// with every problem.
Calibration read_calibration(const std::string& path, const std::vector<std::string>& judged);

// The same fit under a hypothesis: another finger to start from, with its model options. Throws
// InputError for a value that belief cannot set.
Calibration under(const Calibration& calibration, const Hypothesis& hypothesis);

std::vector<FitParameter> fit_parameters(const Calibration& calibration);

// The starting finger with parameters set: the order of `calibration.parameters`.
Finger with_parameters(const Calibration& calibration, std::span<const double> values);

}  // namespace papilla::calibrate
