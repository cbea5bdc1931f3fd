// Probabilities of being best where they are known in closed form, for three and on skins that some
// have not met, and draw by draw.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "rank/scores.h"

namespace papilla::tests::draws_test {
namespace {

constexpr double kOfDraws = 0.025;  // three standard errors of 4000 draws

// Three that have as much on each skin, and are moved by the finger by 0, 1 and 2: lines over one
// normal number z, whose upper envelope changes at z = a and z = b.
TEST(Draws, OfThreeThatTheFingerMovesTheUpperEnvelopeIsBest) {
  const double a = -0.4, b = 0.7;
  const StepSamples none{{0, 0}}, one{{1, 1}}, two{{2, 2}};
  const Scores s{{{a, a}, {0, 0}, {-b, -b}}, {none, one, two}};
  for (const std::uint64_t stream : {0u, 16u}) {
    const std::vector<double> p = s.probabilities(stream);
    EXPECT_NEAR(p[0], normal_cdf(a), kOfDraws);
    EXPECT_NEAR(p[1], normal_cdf(b) - normal_cdf(a), kOfDraws);
    EXPECT_NEAR(p[2], 1 - normal_cdf(b), kOfDraws);
  }
}

// Two directions of three and four: the finger's part of a difference is five.
TEST(Draws, DirectionsOfTheFingerAddInSquares) {
  const Scores s{{{2, 2}, {0, 0}}, {{{3, 3}, {-4, -4}}, {{0, 0}, {0, 0}}}};
  EXPECT_NEAR(s.probabilities(1)[0], normal_cdf(2.0 / 5), kOfDraws);
  EXPECT_NEAR(s.probability_ahead(0, 1), normal_cdf(2.0 / 5), 1e-9);
}

// The third is the mean of the others less or more a constant on every skin that it has met, and
// what it has not met is carried by them: so it is in every draw. It is best where the others
// differ by less than twice the constant, by Student's distribution.
TEST(Draws, OneThatFollowsTheOthersIsCarriedByThemThroughSkinsThatItHasNotMet) {
  const std::vector<double> first{1.0, 9.0, 5.0, 3.0, 2.0}, second{1.5, 7.0, 6.5, 2.0, 1.6};
  const auto with_third = [&](double above) {
    Scores s{{first, second, {}}, {}};
    for (std::size_t k = 0; k < 3; ++k) s.skins[2].push_back((first[k] + second[k]) / 2 + above);
    return s;
  };
  EXPECT_EQ(with_third(-0.01).probabilities(5)[2], 0);
  std::vector<double> apart;
  for (std::size_t k = 0; k < 5; ++k) apart.push_back(first[k] - second[k]);
  const Estimate d = mean_estimate(apart);
  for (const double above : {0.1, 0.3}) {
    const Scores s = with_third(above);
    // The two in front decide how badly scatter is known: the third, of three skins, is one.
    ASSERT_EQ(std::min(s.skins[s.order()[0]].size(), s.skins[s.order()[1]].size()), 3u);
    const auto below = [&](double x) { return student_t_cdf((x - d.value) / d.se, 2); };
    const std::vector<double> p = s.probabilities(5);
    EXPECT_NEAR(p[2], below(2 * above) - below(-2 * above), kOfDraws) << above;
    EXPECT_NEAR(p[0], 1 - below(2 * above), kOfDraws) << above;
    EXPECT_NEAR(p[1], below(-2 * above), kOfDraws) << above;
  }
}

TEST(Draws, WhoIsAheadOnEverySkinByAsMuchIsBestWhoeverMetMore) {
  const Scores fewer{{{1, 9, 5, 30}, {1.1, 9.1, 5.1}}, {}};
  EXPECT_EQ(fewer.probabilities(0)[0], 0);
  EXPECT_NEAR(fewer.probabilities(0)[1], 1, 1e-9);
  const Scores more{{{1.1, 9.1, 5.1, -30}, {1, 9, 5}}, {}};
  EXPECT_EQ(more.probabilities(0)[1], 0);
  EXPECT_NEAR(more.probabilities(0)[0], 1, 1e-9);
}

TEST(Draws, EqualsShareEveryWin) {
  const std::vector<double> a{1, 3, 2}, low{0.5, 2.5, 1.5};
  const std::vector<double> p = (Scores{{a, low, a, a}, {}}.probabilities(7));
  for (const std::size_t i : {0u, 2u, 3u}) EXPECT_NEAR(p[i], 1.0 / 3, 1e-9);
  EXPECT_EQ(p[1], 0);
  EXPECT_NEAR((Scores{{a}, {}}.probabilities(7)[0]), 1, 1e-9);
  EXPECT_NEAR((Scores{{{1}, {2}}, {}}.probabilities(7)[1]), 1, 1e-9);  // a skin has no scatter
}

// Of each draw a number per skin, one per direction of the finger, and as many as there are degrees
// of freedom: the share of 4000 that the first wins.
TEST(Draws, AreFourThousandOfTheStreamSkinsFirst) {
  const std::vector<double> a{1, 2.4, 4.5}, b{2, 2.2, 2.6};
  const double move = 0.6;
  const Scores s{{a, b}, {{{move, move}}, {{0, 0}}}};
  const double lead = (1 + 2.4 + 4.5 - 2 - 2.2 - 2.6) / 3;
  RandomStream random(1, "ranking", 9);
  int wins = 0;
  for (int draw = 0; draw < 4000; ++draw) {
    double scatter = 0;
    for (std::size_t k = 0; k < 3; ++k)
      scatter += random.normal() * (a[k] - b[k] - lead) / std::sqrt(3.0 * 2);
    const double finger = move * random.normal();
    const double one = random.normal(), other = random.normal();
    wins += lead + std::sqrt(2 / (one * one + other * other)) * scatter + finger > 0;
  }
  EXPECT_NEAR(s.probabilities(9)[0], wins / 4000.0, 1e-9);
  EXPECT_NEAR(s.probabilities(9)[1], 1 - wins / 4000.0, 1e-9);
}

// An interval of a mean: Student's quantile of 4 degrees, 2.776445 in every table.
TEST(Draws, AnIntervalOfFiveSamplesIsThatOfTheTables) {
  const Interval i = interval_of({2, 4, 4, 4, 6}, {});
  const double se = std::sqrt(2.0) / std::sqrt(5.0);  // variance 8 / 4
  EXPECT_NEAR(i.high - i.value, 2.776445 * se, 2e-3 * se);
  EXPECT_NEAR(i.value - i.low, 2.776445 * se, 2e-3 * se);
  const Interval none = {};
  EXPECT_EQ(none.value, 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0);
  EXPECT_FALSE(none.parameters);
}

// A step that skins scatter by more than it is leaves nothing of the finger's.
TEST(Draws, StepsThatOnlyScatterMoveNothing) {
  const Scores s{{{1, 1}, {0.5, 0.5}}, {{{3, -3}}, {{0, 0}}}};
  EXPECT_EQ(*s.difference(0, 1).parameters, 0);
  EXPECT_EQ(s.probabilities(2)[1], 0);
  EXPECT_TRUE(s.decided(0, 1));
}

}  // namespace
}  // namespace papilla::tests::draws_test
