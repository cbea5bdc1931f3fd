// What the model says of experiments that no fit has seen: numbers for other laboratories, written
// down before any comparison. They come from one finger file and published samples; there is
// nothing to tune them with.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "numerics/statistics.h"
#include "scene/belief.h"
#include "scene/finger.h"

namespace papilla::claims {

struct Prediction {
  std::string id;         // "F_off over load"
  std::string condition;  // on what, between what
  std::string quantity;   // "exponent", "friction ratio", ...
  std::string unit;       // "", "V", "mN", "%"
  Estimate value;         // se: over skins
  std::string beside;     // the values behind it
  bool of_finger = true;  // false: a look, which hangs on none
  // Standard deviation over the members of the finger's belief that have an answer here, without
  // what skins scatter it by; nothing: it names no belief, too few have one, or the number hangs on
  // no finger.
  std::optional<double> model{};
  int members = 0, silent = 0;    // of the belief; and those of them without an answer
  std::vector<double> samples{};  // of the value, whose mean is it: one a skin; empty: not known
};

struct PredictOptions {
  Finger finger;
  int threads = 0;
  int skins = 16, grid = 128;
  bool few = false;  // as members of a belief are run: the load law, no 3-D field, no looks
  std::function<void(const std::string& experiment)> started;
};

// In the order of the experiments: load, voltage, frequency, current, humidity and roughness, wet
// skin, touch time, adhesion, look of etched glass, voltages that are felt. Cost: about two
// minutes.
std::vector<Prediction> predictions(const PredictOptions& options);

// A published sample with keys of its design, under that finger: how it is touched (load, state,
// touch time) is the sample's.
Design predicted_design(const Finger& finger, const std::string& sample,
                        const std::vector<std::string>& keys);

// Adds what the finger's belief leaves of each: the spread of the same experiments over its
// members, on few skins and pixels that are common to them (u_input of Eq. accuracy.16), as much of
// it as is meant and not the scatter of the skins (Eq. accuracy.18). Nothing for a finger without
// belief. Cost: about twice that of the predictions.
void add_model_parts(std::vector<Prediction>& predictions, const PredictOptions& options);
// The same of what each member predicts, in the order of the belief.
void take_model_parts(std::vector<Prediction>& predictions, const Belief& belief,
                      const std::vector<std::vector<Prediction>>& members);

}  // namespace papilla::claims
