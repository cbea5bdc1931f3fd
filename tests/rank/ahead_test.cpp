// The probability of being ahead, from the interval of the difference beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "base/statistics.h"
#include "rank/rank.h"

namespace papilla {
namespace {

// Friction is proportional to the shear strength, so a ratio of two designs keeps its sign, and its
// size moves by a known factor: sinh of the deviation.
TEST(Ahead, WhatTheFingerLeavesOpenIsInTheProbability) {
  std::vector<Design> designs;
  for (const char* name : {"flat", "a3h350"}) {
    Design d = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + name + ".toml");
    d.accuracy.level = AccuracyLevel::Draft;
    d.finger.water.hysteresis = 0;
    d.finger.uncertainty = {{"macro.shear_strength", 1.0, {}}};
    designs.push_back(d);
  }
  RankOptions options;
  options.criteria = parse_criteria("friction:low");
  options.states = {FingerState::Clean};
  options.max_skins = 6;
  const RankedCandidate own = rank(designs, options).states.front().candidates.front();
  options.parameters = true;
  const RankedCandidate open = rank(designs, options).states.front().candidates.front();
  const double lead = open.ahead_of_next.value, finger = *open.ahead_of_next.parameters;
  EXPECT_GT(finger, 0.5 * lead);
  // The skins alone: from the interval without the finger.
  const double skins =
      0.5 * (own.ahead_of_next.high - own.ahead_of_next.low) / normal_quantile(0.975);
  EXPECT_NEAR(open.p_ahead, normal_cdf(lead / std::hypot(skins, finger)), 0.01);
  EXPECT_LT(open.p_ahead, own.p_ahead - 0.02);
}

}  // namespace
}  // namespace papilla
