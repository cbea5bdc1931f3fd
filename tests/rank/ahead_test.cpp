// The probability of being ahead, from the interval of the difference beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "numerics/statistics.h"
#include "rank/rank.h"

namespace papilla::tests::ahead_test {
namespace {

// Two samples whose lead the finger's roughness leaves as open as the skins do.
TEST(Ahead, WhatTheFingerLeavesOpenIsInTheProbability) {
  std::vector<Design> designs;
  for (const char* name : {"a3h350", "a4h350"}) {
    Design d = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + name + ".toml");
    d.accuracy.level = AccuracyLevel::Draft;
    d.finger.belief.clear();  // the covariance takes its place
    d.finger.uncertainty = {{"skin.rms", 0.3, {}}};
    designs.push_back(d);
  }
  RankOptions options;
  options.criteria = parse_criteria("friction:low");
  options.states = {FingerState::Clean};
  options.max_skins = 6;
  const RankedCandidate own = ranking_of(designs, options).states.front().candidates.front();
  options.parameters = true;
  const RankedCandidate open = ranking_of(designs, options).states.front().candidates.front();
  const double lead = open.ahead_of_next.value, finger = *open.ahead_of_next.parameters;
  EXPECT_EQ(lead, own.ahead_of_next.value);
  EXPECT_GT(finger, 0.5 * lead);
  // The skins' part: what the probability without the finger says, of six skins.
  double low = 0.01 * lead, high = 100 * lead;
  for (int k = 0; k < 100; ++k) {
    const double middle = std::sqrt(low * high);
    (student_t_cdf(lead / middle, 5) > own.p_ahead ? low : high) = middle;
  }
  const double both = std::hypot(low, finger);
  EXPECT_NEAR(open.p_ahead, student_t_cdf(lead / both, 5 * std::pow(both / low, 4)), 1e-6);
  EXPECT_LT(open.p_ahead, own.p_ahead - 0.05);
}

}  // namespace
}  // namespace papilla::tests::ahead_test
