// Weights and worth after readings against the formulas of normal distributions.
#include "lab/evidence.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "lab/member_model.h"
#include "tests/lab/ensembles.h"

namespace papilla::tests::evidence_test {
namespace {

TEST(Kernels, KeepMeanAndCovarianceOfTheMembers) {
  const Ensemble e = linear_ensemble(40, {{1, 0.5}, {0.2, -1}}, {{2, 1}});
  const Kernels k = kernels_of(e);
  double mean = 0, middle = 0, variance = 0, within = 0;
  for (std::size_t m = 0; m < 40; ++m) {
    mean += e.responses[0][m] / 40;
    middle += k.responses[0][m] / 40;
  }
  for (std::size_t m = 0; m < 40; ++m) {
    variance += std::pow(e.responses[0][m] - mean, 2) / 40;
    within += std::pow(k.responses[0][m] - middle, 2) / 40;
  }
  EXPECT_NEAR(middle, mean, 1e-12);
  EXPECT_NEAR(within + k.of_responses[0][0], variance, 1e-12);
  // Two directions of unlike size: (1.29 + 1.04)^2 / ... lies between 1 and 2 dimensions.
  EXPECT_GT(k.width, 0.4);
  EXPECT_LT(k.width, 0.65);
}

// Two skins of the own level, then two of the move of each member: its friction is what they are a
// share of.
TEST(MemberNumbers, HaveLogarithmsThatMoveByTheShareOfEachMembersNumber) {
  MemberNumbers friction{{0.05, 0.2}, 0.1, {"a", {0.01, -0.01, 0.01, -0.02, 0.01, -0.02}}, 2};
  const MemberNumbers logs = logarithms(friction);
  EXPECT_EQ(logs.at, (std::vector{std::log(0.05), std::log(0.2)}));
  EXPECT_EQ(logs.own, std::log(0.1));
  EXPECT_EQ(logs.sampling.skins, "a");
  const std::vector<double> expected{0.1, -0.1, 0.2, -0.4, 0.05, -0.1};
  ASSERT_EQ(logs.sampling.deviations.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(logs.sampling.deviations[i], expected[i], 1e-12) << i;
}

TEST(Evidence, GivesTheWeightsOfTheDensityOfAllReadingsTogether) {
  Ensemble e = linear_ensemble(12, {{1, 0.5}, {0.2, -1}, {0.7, 0.1}}, {{2, 1}});
  // Of the model's skins: rows 0 and 1 of the same ones, row 2 of others.
  e.response_sampling = {{"a", {0.02, 0.1}}, {"a", {0.3, -0.1}}, {"b", {0.1, 0.2}}};
  const Kernels k = kernels_of(e);
  const Instrument instrument{0.1, 0.2, 0.3, 0.15};
  Evidence evidence(e, k, instrument);
  std::vector<Observation> all{observation(0, 0.1, 0), observation(1, 0.15, 0),
                               observation(2, 0.1, 1), observation(0, 0.1, 0)};
  all[3].day = "2";
  const std::vector<double> y{0.3, -0.2, 0.1, 0.4};
  Eigen::MatrixXd c(4, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    evidence.add(all[i], y[i]);
    for (std::size_t j = 0; j < 4; ++j)
      c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          covariance(instrument, all[i], all[j], i == j) + k.of_responses[all[i].row][all[j].row];
  }
  const double kernel = k.width * k.width;
  double moves = 0;
  for (std::size_t m = 0; m < 12; ++m) moves += k.response_moves[0][m] * k.response_moves[1][m];
  EXPECT_NEAR(k.of_responses[0][1], kernel * moves + 0.02 * 0.3 - 0.1 * 0.1, 1e-12);
  moves = 0;
  for (std::size_t m = 0; m < 12; ++m) moves += k.response_moves[0][m] * k.response_moves[2][m];
  EXPECT_NEAR(k.of_responses[0][2], kernel * moves, 1e-12);
  std::vector<double> expected;
  double sum = 0;
  for (std::size_t m = 0; m < 12; ++m) {
    Eigen::VectorXd r(4);
    for (std::size_t i = 0; i < 4; ++i)
      r(static_cast<Eigen::Index>(i)) = y[i] - k.responses[all[i].row][m];
    expected.push_back(std::exp(-0.5 * r.dot(c.inverse() * r)));
    sum += expected.back();
  }
  const std::vector<double> weights = evidence.weights();
  for (std::size_t m = 0; m < 12; ++m) EXPECT_NEAR(weights[m], expected[m] / sum, 1e-10);
}

struct MeanAndSpread {
  double mean = 0, spread = 0;
};
// Of the worth of the first design, after the readings.
MeanAndSpread first_worth(const Ensemble& e, const Kernels& k, const Evidence& evidence) {
  const WorthAfter after = worth_after(e, k, evidence);
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < after.weights.size(); ++i) {
    mean += after.weights[i] * after.worth[0][i];
    squares += after.weights[i] * after.worth[0][i] * after.worth[0][i];
  }
  return {mean, std::sqrt(squares - mean * mean)};
}

// Of a linear model the posterior is known: mean and variance of the worth.
TEST(Evidence, MovesWorthAsALinearModelDoes) {
  const Ensemble e = linear_ensemble(3000, {{1.0}}, {{2.0}, {0.0}});
  const Kernels k = kernels_of(e);
  const Instrument instrument = plain_instrument(0.5);
  Evidence evidence(e, k, instrument);
  evidence.add(observation(0, 0.5), 0.8);
  const auto [mean, spread] = first_worth(e, k, evidence);
  // x ~ N(0, 1), y = x + N(0, .25): mean 0.8 / 1.25, variance 0.25 / 1.25; worth 2 x.
  EXPECT_NEAR(mean, 2 * 0.64, 0.03);
  EXPECT_NEAR(spread, 2 * std::sqrt(0.2), 0.03);
}

// Before it a reading is x + N(0, .25) of x ~ N(0, 1); after one of .8 it is N(.64, .2 + .25).
TEST(Evidence, ExpectsOfAReadingWhatThoseBeforeItSay) {
  const Ensemble e = linear_ensemble(3000, {{1.0}}, {{1.0}});
  const Kernels k = kernels_of(e);
  const Instrument instrument = plain_instrument(0.5);
  Evidence evidence(e, k, instrument);
  const Observation reading = observation(0, 0.5);
  const ExpectedReading before = evidence.expected(reading);
  EXPECT_NEAR(before.quantile(0.5), 0, 0.05);
  EXPECT_NEAR(before.quantile(0.975), 1.96 * std::sqrt(1.25), 0.05);
  evidence.add(reading, 0.8);
  const ExpectedReading after = evidence.expected(reading);
  EXPECT_NEAR(after.quantile(0.5), 0.64, 0.03);
  EXPECT_NEAR(after.quantile(0.025), 0.64 - 1.96 * std::sqrt(0.45), 0.05);
  EXPECT_NEAR(after.quantile(0.975), 0.64 + 1.96 * std::sqrt(0.45), 0.05);
}

// Three members half apart; a reading lies beyond all of them, and those to come lie about it.
TEST(Evidence, ExpectsReadingsBeyondItsMembersWhereTheyLieThere) {
  Ensemble e = linear_ensemble(3, {{0.0}}, {{0.0}});
  e.responses[0] = {-0.5, 0, 0.5};
  const Kernels k = kernels_of(e);
  const Instrument instrument{0.01, 0, 0, 0};
  Evidence evidence(e, k, instrument);
  for (int touch = 0; touch < 10; ++touch) evidence.add(observation(0, 0.01), 0.8);
  EXPECT_NEAR(evidence.expected(observation(0, 0.01)).quantile(0.5), 0.8, 0.01);
}

// Members agree on everything; the skins leave friction open, and worth with it: a normal number s
// moves rows by .1 s and .4 s, worth by 2 s.
TEST(Evidence, MovesWorthByWhatSkinsLeaveOpenOfBoth) {
  Ensemble e = linear_ensemble(200, {{1e-9}, {1e-9}}, {{1e-9}, {0}});
  e.response_sampling = {{"a", {0.1}}, {"a", {0.4}}};
  e.worth_sampling = {{"a", {2}}, {"a", {0}}};
  const Kernels k = kernels_of(e);
  // Both readings share the finger, which leaves their ratio: .3 s + N(0, 2 .1^2).
  const Instrument instrument{0.1, 0, 100, 0};
  Evidence evidence(e, k, instrument);
  evidence.add(observation(0, 0.1), 0.0);
  evidence.add(observation(1, 0.1), 0.25);
  const auto [mean, spread] = first_worth(e, k, evidence);
  const double left = 1 / (1 + 0.09 / 0.02);  // of the variance of s
  EXPECT_NEAR(mean, 2 * left * 0.3 * 0.25 / 0.02, 1e-3);
  EXPECT_NEAR(spread, 2 * std::sqrt(left), 0.1);
}

TEST(Evidence, OfTwoReadingsOnADayKnowsTheirRatioBest) {
  const Ensemble e = linear_ensemble(200, {{1.0, 0.0}, {1.0, 0.3}}, {{0.0, 1.0}, {0.0, 0.0}});
  const Kernels k = kernels_of(e);
  const Instrument instrument{0.02, 0.3, 0.3, 0};
  const auto spread = [&](const std::string& second_day) {
    Evidence evidence(e, k, instrument);
    evidence.add(observation(0, 0.02, 0), 0.1);
    Observation second = observation(1, 0.02, 1);
    second.day = second_day;
    evidence.add(second, 0.2);
    return first_worth(e, k, evidence).spread;
  };
  EXPECT_LT(spread("1"), 0.25 * spread("2"));
}

}  // namespace
}  // namespace papilla::tests::evidence_test
