// Scores of known samples: intervals, orders and probabilities against closed forms.
#include "rank/scores.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/statistics.h"

namespace papilla::tests::scores_test {
namespace {

using Order = std::vector<std::size_t>;

// Student's quantile of two degrees of freedom: 0.95 sqrt(2 / (1 - 0.95^2)).
const double kOfTwo = 0.95 * std::sqrt(2 / (1 - 0.95 * 0.95));

TEST(Scores, TheIntervalOfThreeSamplesIsStudentsOfTwoDegrees) {
  const Interval i = interval_of({1, 3, 2}, {});
  EXPECT_DOUBLE_EQ(i.value, 2);
  EXPECT_NEAR(i.low, 2 - kOfTwo / std::sqrt(3), 1e-6);
  EXPECT_NEAR(i.high, 2 + kOfTwo / std::sqrt(3), 1e-6);
  EXPECT_FALSE(i.parameters);
  const Interval moved = i.moved(-5);
  EXPECT_DOUBLE_EQ(moved.value, -3);
  EXPECT_DOUBLE_EQ(moved.low, i.low - 5);
  EXPECT_DOUBLE_EQ(moved.high, i.high - 5);
}

TEST(Scores, OneSampleLeavesAllOpenAndTwoDoNot) {
  EXPECT_EQ(interval_of({4}, {}).high, INFINITY);
  EXPECT_EQ(interval_of({4}, {}).low, -INFINITY);
  EXPECT_TRUE(std::isfinite(interval_of({4, 5}, {}).high));
}

// Steps of 0.3 and 0.4 that all skins agree on: 0.5, one standard error.
TEST(Scores, TheFingersStepsWidenTheIntervalInSquares) {
  const StepSamples steps{{0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}};
  const Interval i = interval_of({1, 3, 2}, steps).moved(1);
  ASSERT_TRUE(i.parameters);
  EXPECT_NEAR(*i.parameters, 0.5, 1e-12);
  EXPECT_NEAR(i.high - i.value, std::hypot(kOfTwo / std::sqrt(3), 1.959964 * 0.5), 1e-6);
  EXPECT_NEAR(i.value - i.low, i.high - i.value, 1e-12);
}

// On the skins that both have met, and over the steps.
TEST(Scores, AreEqualWhereNothingTellsThemApart) {
  Scores s{{{1, 2, 3}, {1, 2}, {1, 3}, {2, 1}}, {}};
  EXPECT_TRUE(s.equal(0, 1));
  EXPECT_FALSE(s.equal(0, 2));
  EXPECT_FALSE(s.equal(1, 3));  // the same mean
  s.steps = {{{1, 1}}, {{1, 1}}, {{1, 1}}, {{1, 1}}};
  EXPECT_TRUE(s.equal(0, 1));
  s.steps[1] = {{1, 1.5}};
  EXPECT_FALSE(s.equal(0, 1));
}

// Two have met four skins, whose last two raise their means by 1.5 and by 0.5.
TEST(Scores, SkinsNotMetMoveAMeanAsTheyMoveThoseThatMetThem) {
  const Scores s{{{1, 2, 3, 6}, {0, 1}, {1, 1, 2, 2}}, {}};
  EXPECT_DOUBLE_EQ(unmet(s.skins, 0), 0);
  EXPECT_DOUBLE_EQ(unmet(s.skins, 1), 1);
  EXPECT_DOUBLE_EQ(s.mean(1), 1.5);
  EXPECT_DOUBLE_EQ(s.mean(0), 3);
}

TEST(Scores, TheOrderIsThatOfMeansAndThenOfPairedDifferences) {
  EXPECT_EQ((Scores{{{1, 2}, {3, 5}, {2, 3}}, {}}.order()), (Order{1, 2, 0}));
  EXPECT_EQ((Scores{{{1, 2}, {1, 2}, {1, 2}}, {}}.order()), (Order{0, 1, 2}));  // as given
  // By their means 10.5, 10 and 4; on the skin that all have met the third is ahead of both.
  const Scores s{{{3, 18}, {4, 4}, {5}}, {}};
  EXPECT_DOUBLE_EQ(s.mean(2), 5 + 0.5 * (7.5 + 0));
  EXPECT_EQ(s.order(), (Order{2, 0, 1}));
}

TEST(Scores, ADifferenceIsOverTheSkinsThatBothHaveMet) {
  const Scores s{{{5, 5, 5, 100}, {4, 2, 3}}, {}};
  const Interval d = s.difference(0, 1), back = s.difference(1, 0);
  EXPECT_DOUBLE_EQ(d.value, 2);
  EXPECT_NEAR(d.low, 2 - kOfTwo / std::sqrt(3), 1e-6);
  EXPECT_DOUBLE_EQ(back.value, -2);
  EXPECT_NEAR(back.high, -d.low, 1e-12);
  EXPECT_FALSE(s.decided(0, 1));  // 2 less 2.48
  const Scores clear{{{6, 6, 6}, {4, 2, 3}}, {}};
  EXPECT_TRUE(clear.decided(0, 1));  // 3 less 2.48
  EXPECT_TRUE(clear.decided(1, 0));
  EXPECT_FALSE(clear.decided(1, 1));
}

// Student's distribution of two degrees of freedom: 1/2 + t / (2 sqrt(2 + t^2)).
TEST(Scores, TheProbabilityOfALeadIsStudents) {
  const Scores s{{{5, 5, 5}, {4, 2, 3}}, {}};
  const double t = 2 * std::sqrt(3), ahead = 0.5 + t / (2 * std::sqrt(2 + t * t));
  EXPECT_NEAR(s.probability_ahead(0, 1), ahead, 1e-6);
  EXPECT_NEAR(s.probability_ahead(1, 0), 1 - ahead, 1e-6);
}

TEST(Scores, ALeadWithoutScatterIsCertainAndATieIsEven) {
  const Scores s{{{5, 6}, {4, 5}, {5, 6}}, {}};
  EXPECT_EQ(s.probability_ahead(0, 1), 1);
  EXPECT_EQ(s.probability_ahead(1, 0), 0);
  EXPECT_EQ(s.probability_ahead(0, 2), 0.5);
}

TEST(Scores, WhatTheFingerAloneLeavesOpenIsNormal) {
  const Scores s{{{5, 6, 5}, {4, 5, 4}}, {{{2.5, 2.5, 2.5}}, {{0.5, 0.5, 0.5}}}};
  EXPECT_NEAR(s.probability_ahead(0, 1), normal_cdf(0.5), 1e-9);
  EXPECT_NEAR(s.probability_ahead(1, 0), normal_cdf(-0.5), 1e-9);
  EXPECT_NEAR(*s.difference(0, 1).parameters, 2, 1e-12);
  const std::vector<double> best = s.probabilities(3);
  EXPECT_NEAR(best[0], normal_cdf(0.5), 0.025);
  EXPECT_NEAR(best[0] + best[1], 1, 1e-9);
}

// Of two, to be the best is to be ahead: draws against the closed form, also where one of them has
// met half of the skins of the other.
TEST(Scores, OfTwoTheDrawsSayWhatStudentSays) {
  for (const Scores& s :
       {Scores{{{1, 2, 3, 4}, {0.5, 2.5, 2, 3}}, {}}, Scores{{{1, 2, 3, 9}, {0.2, 1.8, 2.6}}, {}},
        Scores{{{3, 0, 2}, {2, 4, 1.5, -4, 0}}, {}}}) {
    const std::vector<double> best = s.probabilities(1);
    EXPECT_NEAR(best[0], s.probability_ahead(0, 1), 0.025);
    EXPECT_NEAR(best[0] + best[1], 1, 1e-9);
    EXPECT_NE(s.probabilities(2), best);  // other draws
    EXPECT_EQ(s.probabilities(1), best);
  }
}

// Common skins move both alike and leave nothing open; the same scatter on other skins does.
TEST(Scores, LuckInCommonLeavesNoOrderOpen) {
  EXPECT_NEAR((Scores{{{1, 9, 5}, {0.9, 8.9, 4.9}}, {}}.probabilities(0)[0]), 1, 1e-9);
  EXPECT_LT((Scores{{{1, 9, 5}, {8.9, 0.9, 4.9}}, {}}.probabilities(0)[0]), 0.6);
}

// Two that skins tell apart by one, and whose steps of the finger move them apart by two, which
// two skins know to one.
TEST(Scores, WhatTheSkinsScatterOfTheStepsIsTakenOffTheProbabilities) {
  const Scores s{{{5, 5}, {4, 4}}, {{{1, 3}}, {{0, 0}}}};
  const double ahead = normal_cdf(1 / (2 * std::sqrt(meant_share(4, 1, 2).value)));
  EXPECT_NEAR(s.probability_ahead(0, 1), ahead, 1e-6);
  const std::vector<double> best = s.probabilities(3);
  EXPECT_NEAR(best[0], ahead, 0.02);
  EXPECT_NEAR(best[0] + best[1], 1, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::scores_test
