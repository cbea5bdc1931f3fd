// Published samples as candidates, and what they are ranked by.
#pragma once

#include <string>

#include "base/rooms.h"
#include "rank/rank.h"
#include "tests/support/one_pass.h"

namespace papilla::tests {

// By the finger of one pass: how skins are shared out among candidates is judged, not the model.
inline Design in_one_pass(Design d) {
  d.finger = one_pass_finger();
  d.model = d.finger.calibrated_for;
  d.accuracy.level = AccuracyLevel::Draft;
  return d;
}
inline Design sample(const std::string& name) {
  return in_one_pass(
      read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + name + ".toml"));
}

inline RankOptions by(const std::string& criteria) {
  RankOptions options;
  options.criteria = parse_criteria(criteria);
  options.states = {FingerState::Clean};
  options.max_skins = 24;
  return options;
}

// At two humidities: where no number is compared, half the work.
inline Design quick_sample(const std::string& name) {
  Design d = sample(name);
  d.environment.relative_humidity = {0.35, 0.75};
  return d;
}

// On few pixels besides, at one humidity: where numbers are compared with their own.
inline Design small_sample(const std::string& name) {
  Design d = sample(name);
  d.environment.relative_humidity = {0.35};
  d.accuracy.grid = 32;
  return d;
}

}  // namespace papilla::tests
