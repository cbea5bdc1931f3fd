// The probability of being ahead, from the interval of the difference beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "base/statistics.h"
#include "rank/rank.h"

namespace papilla {
namespace {

// Two samples whose lead the finger's roughness leaves as open as the skins do.
TEST(Ahead, WhatTheFingerLeavesOpenIsInTheProbability) {
  std::vector<Design> designs;
  for (const char* name : {"a3h350", "a4h350"}) {
    Design d = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + name + ".toml");
    d.accuracy.level = AccuracyLevel::Draft;
    d.finger.uncertainty = {{"skin.rms", 0.3, {}}};
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
  EXPECT_EQ(lead, own.ahead_of_next.value);
  EXPECT_GT(finger, 0.5 * lead);
  // The skins' part: what the probability without the finger says.
  const double skins = lead / normal_quantile(own.p_ahead);
  EXPECT_NEAR(open.p_ahead, normal_cdf(lead / std::hypot(skins, finger)), 1e-6);
  EXPECT_LT(open.p_ahead, own.p_ahead - 0.05);
}

}  // namespace
}  // namespace papilla
