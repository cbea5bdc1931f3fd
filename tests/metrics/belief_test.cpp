// Numbers over the members of a belief, by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"

namespace papilla::tests::belief_test {
namespace {

std::vector<ResponsePoint> points(const std::vector<double>& modulations) {
  std::vector<ResponsePoint> out;
  for (const double m : modulations) {
    ResponsePoint p;
    p.modulation.value = m;
    p.friction_off.value = 1 + m;
    p.capillary_force.value = m - 0.5;
    out.push_back(p);
  }
  return out;
}

// The runs are half of what the response has, as coarse ones may be.
Response with_members() {
  Response r;
  r.driven = true;
  r.points = points({0.8, 1.2});
  r.belief.own.points = points({0.4, 0.6});
  r.belief.members = {{0.5, "a", {points({0.4, 0.6}), {}}},
                      {0.25, "a", {points({0.2, 0.3}), {}}},
                      {0.25, "b", {points({0.8, 1.2}), {}}}};
  return r;
}

TEST(BeliefValues, AreTheResponsesMovedAsMembersMoveTheRuns) {
  const auto v = *belief_values(Summary::Mean, kModulation, with_members());
  ASSERT_EQ(v.values.size(), 3u);
  EXPECT_NEAR(v.values[0], 1, 1e-12);
  EXPECT_NEAR(v.values[1], 0.5, 1e-12);
  EXPECT_NEAR(v.values[2], 2, 1e-12);
  const double mean = 0.5 + 0.125 + 0.5;
  EXPECT_NEAR(square(v.deviation()),
              0.5 * square(1 - mean) + 0.25 * square(0.5 - mean) + 0.25 * square(2 - mean), 1e-12);
  const auto summary = *summarise(Summary::Mean, kModulation, with_members());
  EXPECT_NEAR(*summary.parts.model, v.deviation(), 1e-12);
  EXPECT_EQ(summary.se, 0);  // told apart from the numerical error
  EXPECT_EQ(summary.parts.numerical(), 0);
  EXPECT_EQ(summary.parts.model_part(), summary.parts.model);
  Response none = with_members();
  none.belief = {};
  EXPECT_FALSE(summarise(Summary::Mean, kModulation, none)->parts.model);
}

// In proportion, by no more than twice the difference: no quotient by next to nothing, nothing
// below zero, no jump, and where both readings agree the member's own number.
TEST(BeliefValues, ANumberIsMovedInProportionWithinTwiceTheDifference) {
  EXPECT_NEAR(moved(1, 2, 3, true), 1.5, 1e-12);
  EXPECT_NEAR(moved(1, 0.5, 0.75, true), 1.5, 1e-12);
  EXPECT_NEAR(moved(0.01, 1e-5, 0.02, true), 0.01 + 2 * (0.02 - 1e-5), 1e-12);
  EXPECT_NEAR(moved(0.01, 0, 0.02, true), 0.05, 1e-12);
  EXPECT_NEAR(moved(0.01, 1, 0.02, true), 2e-4, 1e-12);
  for (const double to : {0.0, 0.1, 0.7, 4.0}) {
    EXPECT_NEAR(moved(1, 1, to, true), to, 1e-12);
    EXPECT_NEAR(moved(1, 0.5 + 1e-9, to, true), moved(1, 0.5 - 1e-9, to, true), 1e-7);
    EXPECT_GE(moved(1, 0.3, to, true), 0);
    EXPECT_NEAR(moved(1, 2, to, false), to - 1, 1e-12);
  }
  EXPECT_EQ(moved(0, 1, 0.2, true), 0);
  EXPECT_EQ(moved(0, 0, 0.2, true), 0.2);
}

// The force may push: half of it says nothing of twice. Runs of -.1 and .1 about a value of .5.
TEST(BeliefValues, OfANumberThatChangesItsSignAreMovedByDifferences) {
  const Response r = with_members();
  const auto v = *belief_values_at(0, QuantityMetric{&PointQuantities::capillary_force}, r);
  EXPECT_NEAR(v.values[1], 0.3 + (-0.3 - -0.1), 1e-12);
  EXPECT_NEAR(v.values[2], 0.3 + (0.3 - -0.1), 1e-12);
  // No member moves the variation, whatever it does to the mean.
  EXPECT_NEAR(belief_values(Summary::Variation, kModulation, r)->deviation(), 0, 1e-12);
}

// Runs that spread more than the response, and a member that hardly spreads: by their difference
// its spread would be below 0. So are spreads of the capillary force, which itself may be.
TEST(BeliefValues, OfASpreadAreMovedInProportion) {
  Response r = with_members();
  r.belief.own.points = points({0.4, 1});
  r.belief.members = {{0.5, "a", {points({0.4, 1}), {}}}, {0.5, "b", {points({0.3, 0.32}), {}}}};
  const QuantityMetric capillary{&PointQuantities::capillary_force};
  for (const Metric& metric : {Metric(kModulation), Metric(capillary)}) {
    const auto v = *belief_values(Summary::Std, metric, r);
    EXPECT_NEAR(v.values[0], 0.2, 1e-12);
    EXPECT_NEAR(v.values[1], 0.2 * 0.01 / 0.3, 1e-12);
    EXPECT_GE(v.quantile(0), 0);
  }
  const auto own = 0.3 / 0.7, there = 0.01 / 0.31, of = 0.2;  // standard deviation over mean
  EXPECT_NEAR(belief_values(Summary::Variation, kModulation, r)->values[1], of * there / own,
              1e-12);
  EXPECT_NEAR(belief_values(Summary::Range, kModulation, r)->values[1], 2 * of * there / own,
              1e-12);
}

TEST(BeliefValues, TheDifferenceOfADesignFromItselfIsNotUncertain) {
  const auto v = *belief_values(Summary::Mean, kModulation, with_members());
  const BeliefDifference none = *belief_difference(v, v);
  EXPECT_EQ(none.deviation, 0);
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0);
  EXPECT_EQ(none.above, 0.5);
}

// Nine weights of 1/9 sum to a last digit above 1.
TEST(BeliefValues, TheProbabilityOfADifferenceIsAtMostOne) {
  BeliefValues more, less;
  more.weights = less.weights = std::vector<double>(9, 1.0 / 9);
  more.values = std::vector<double>(9, 2);
  less.values = std::vector<double>(9, 1);
  more.moves = less.moves = StepSamples(9, std::vector<double>(2, 0));
  EXPECT_EQ(belief_difference(more, less)->above, 1);
  EXPECT_EQ(belief_difference(less, less)->above, 0.5);
}

// Twice the modulation at every member: the difference is uncertain by the value's own deviation;
// of a design that only member b turns over, its weight is what is against it.
TEST(BeliefValues, ADifferenceHasItsOwnDeviationAndProbability) {
  const Response one = with_members();
  Response two = one;
  two.points = points({1.6, 2.4});
  two.belief.own.points = points({0.8, 1.2});
  two.belief.members[0].run.points = points({0.8, 1.2});
  two.belief.members[1].run.points = points({0.4, 0.6});
  two.belief.members[2].run.points = points({1.6, 2.4});
  const auto a = *belief_values(Summary::Mean, kModulation, one),
             b = *belief_values(Summary::Mean, kModulation, two);
  EXPECT_NEAR(belief_difference(b, a)->deviation, a.deviation(), 1e-12);
  EXPECT_EQ(belief_difference(b, a)->above, 1);
  two.belief.members[2].run.points = points({0.2, 0.4});
  const auto turned = *belief_values(Summary::Mean, kModulation, two);
  EXPECT_NEAR(belief_difference(turned, a)->above, 0.75, 1e-12);
  Response other = two;
  other.belief.members.pop_back();
  EXPECT_FALSE(belief_difference(*belief_values(Summary::Mean, kModulation, other), a));
}

// Two skins whose members differ by .1 and .3: what they scatter (.1) is no belief.
TEST(BeliefValues, WhatSkinsScatterIsTakenOff) {
  Response r;
  r.driven = true;
  r.points = points({1});
  r.belief.own = {points({1}), {points({1}), points({1})}};
  const auto member = [&](double w, double both, double first, double second) {
    r.belief.members.push_back({w, "", {points({both}), {points({second}), points({first})}}});
  };
  member(0.5, 1.2, 1.1, 1.3);
  member(0.5, 0.8, 0.9, 0.7);
  const auto v = *belief_values(Summary::Mean, kModulation, r);
  const double share = std::sqrt(meant_share(4, 2, 2).value);
  EXPECT_NEAR(v.deviation(), 0.2 * share, 1e-12);
  EXPECT_NEAR(v.quantile(0) - v.quantile(1), -0.4 * share, 1e-12);
}

// .25 ± .04 of .2: felt with .89. A member of .19, run to ± .006, says .40 with the response's
// error of F_on/F_off, and .05 with its own; what the finger as it is says of its run cancels.
// Where the modulation is next to nothing its error stays what it is.
TEST(BeliefValues, WhatIsFeltAtAMemberTakesTheErrorOfTheResponse) {
  const auto point = [](double modulation, double error) {
    ResponsePoint p;
    p.modulation = {modulation, {.sampling = error}};
    return p;
  };
  const auto run = [&](double modulation) {
    Resampled out{{point(modulation, 0.006)}, {}};
    out.points[0].felt_error = 0.04 / 1.25;
    return out;
  };
  Response r;
  r.driven = true;
  r.points = {point(0.25, 0.04)};
  r.belief.own = run(0.25);
  r.belief.members = {{0.4, "", run(0.25)}, {0.4, "", run(0.19)}, {0.2, "", run(0.01)}};
  const auto v = *belief_values(Summary::Mean, Felt{0.2}, r);
  EXPECT_NEAR(v.values[0], normal_cdf(1.25), 1e-12);
  EXPECT_NEAR(v.values[1], normal_cdf(-0.01 / (0.04 * 1.19 / 1.25)), 1e-12);
  EXPECT_NEAR(v.values[1], 0.40, 5e-3);
  EXPECT_LT(v.values[2], 1e-6);
}

TEST(BeliefValues, QuantilesAreOfTheWeights) {
  BeliefValues v;
  v.values = {3, 1, 2};
  v.weights = {0.25, 0.5, 0.25};
  EXPECT_NEAR(v.quantile(0.25), 1, 1e-12);
  EXPECT_NEAR(v.quantile(0.625), 2, 1e-12);
  EXPECT_NEAR(v.quantile(0.4375), 1.5, 1e-12);
  EXPECT_NEAR(v.quantile(0.999), 3, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::belief_test
