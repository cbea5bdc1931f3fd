// Published samples as candidates, and what they are ranked by.
#pragma once

#include <string>

#include "base/rooms.h"
#include "rank/rank.h"

namespace papilla::tests {

inline Design sample(const std::string& name) {
  Design d = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + name + ".toml");
  d.accuracy.level = AccuracyLevel::Draft;
  return d;
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
