// What the model says of experiments that no fit has seen: numbers for other laboratories, written
// down before any comparison. They come from one finger file and published samples; there is
// nothing to tune them with.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "numerics/statistics.h"
#include "scene/finger.h"

namespace papilla::claims {

struct Prediction {
  std::string id;         // "F_off over load"
  std::string condition;  // on what, between what
  std::string quantity;   // "exponent", "friction ratio", ...
  std::string unit;       // "", "V", "mN", "%"
  Estimate value;         // se: over skins
  std::string beside;     // the values behind it
  // Standard deviation over the members of the finger's belief; nothing: it has none, or one of
  // them has no number here.
  std::optional<double> model{};
};

struct PredictOptions {
  Finger finger;
  int threads = 0;
  int skins = 16, grid = 128;
  bool few = false;  // as members of a belief are run: the load law, no 3-D field
  std::function<void(const std::string& experiment)> started;
};

// In the order of the experiments: load, voltage, frequency, current, humidity and roughness, wet
// skin, touch time, adhesion, look of etched glass, voltages that are felt. Cost: about two
// minutes.
std::vector<Prediction> predictions(const PredictOptions& options);

// Adds what the finger's belief leaves of each: the same experiments at every member, on few skins
// and pixels, less those of the finger itself on these. Nothing for a finger without belief. Cost:
// about twice that of the predictions. Eq. accuracy.15
void add_model_parts(std::vector<Prediction>& predictions, const PredictOptions& options);

}  // namespace papilla::claims
