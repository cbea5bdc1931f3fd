// Posteriors of many truths and of groups left out: thousands of samples.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/constants.h"
#include "numerics/statistics.h"
#include "optim/posterior.h"
#include "tests/optim/linear_posterior.h"
#include "tests/support/thorough.h"

namespace papilla::tests::posterior_slow_test {
namespace {

// A hundred truths of three numbers each (of all cases), planted: 95 % intervals hold nine or more
// of ten, those of 32 chosen members too.
TEST(PosteriorSlow, IntervalsHoldPlantedTruths) {
  const auto truths = static_cast<std::uint64_t>(cases(40, 100));
  int held = 0, by_members = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= truths; ++seed) {
    const Linear model(seed);
    const Posterior p = sample_posterior(model.parameters, 6, model.misses(), known(40));
    std::vector<std::vector<double>> features;
    for (const PosteriorSample& s : p.samples) features.push_back(s.values);
    const std::vector<double> weights = weights_of(p);
    const ChosenPoints members =
        choose_points(features, weights, std::vector<int>(weights.size(), 0), 32, seed);
    for (std::size_t i = 0; i < 3; ++i) {
      const double truth = model.truth(static_cast<Eigen::Index>(i));
      const std::vector<double> values = values_of(p, i);
      std::vector<double> few;
      for (const std::size_t k : members.index) few.push_back(values[k]);
      ++all;
      held += weighted_quantile(values, weights, 0.025) <= truth &&
              truth <= weighted_quantile(values, weights, 0.975);
      by_members += weighted_quantile(few, members.weight, 0.025) <= truth &&
                    truth <= weighted_quantile(few, members.weight, 0.975);
    }
  }
  EXPECT_GE(held, 0.90 * all);
  EXPECT_LE(held, 0.99 * all);
  EXPECT_GE(by_members, 0.90 * all);
  EXPECT_LE(by_members, 0.99 * all);
}

// Two hundred truths (of all cases), each by 24 answers of the model.
TEST(PosteriorSlow, FewSamplesHoldPlantedTruths) {
  const auto truths = static_cast<std::uint64_t>(cases(70, 200));
  int held = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= truths; ++seed) {
    const Linear model(seed);
    const Posterior p = sample_posterior(model.parameters, 6, model.misses(), known(24));
    std::vector<std::vector<double>> features;
    for (const PosteriorSample& s : p.samples) features.push_back(s.values);
    const ChosenPoints members =
        choose_points(features, weights_of(p), std::vector<int>(features.size(), 0), 24, seed);
    for (std::size_t i = 0; i < 3; ++i) {
      double mean = 0, variance = 0;
      for (std::size_t k = 0; k < members.index.size(); ++k)
        mean += members.weight[k] * features[members.index[k]][i];
      for (std::size_t k = 0; k < members.index.size(); ++k)
        variance += members.weight[k] * square(features[members.index[k]][i] - mean);
      ++all;
      held += std::abs(model.truth(static_cast<Eigen::Index>(i)) - mean) <
              normal_quantile(0.975) * std::sqrt(variance);
    }
  }
  EXPECT_GE(held, 0.90 * all);
  EXPECT_LE(held, 0.99 * all);
}

// The rows 0 and 1 of a linear model, left out together: a normal density in closed form.
TEST(PosteriorSlow, TheScoreOfAGroupLeftOutIsItsPredictiveDensity) {
  const Linear model(5);
  PosteriorOptions options = known(60);
  options.groups = {{0, 1}, {2, 3, 4, 5}};
  const Posterior p = sample_posterior(model.parameters, 6, model.misses(), options);
  const LeftOut left = leave_out(p, {0, 0});
  const Eigen::MatrixXd others = model.a.bottomRows(4), own = model.a.topRows(2);
  const Eigen::MatrixXd c =
      (others.transpose() * others + Eigen::MatrixXd::Identity(3, 3) / 4).inverse();
  const Eigen::VectorXd mean =
      c * (others.transpose() * model.y.tail(4) + Eigen::VectorXd::Constant(3, 0.5 / 4));
  const Eigen::MatrixXd spread = own * c * own.transpose() + Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd miss = model.y.head(2) - own * mean;
  const double expected = -0.5 * miss.dot(spread.inverse() * miss) -
                          0.5 * std::log(spread.determinant()) - std::log(2 * kPi);
  EXPECT_NEAR(left.scores[0], expected, 0.1);
  EXPECT_LT(left.errors[0], 0.3);  // rows that are straight
  EXPECT_GT(left.least_effective, 1000);
}

TEST(PosteriorSlow, AnotherVarianceFactorIsAnotherPosteriorOfTheSameSamples) {
  const Linear model(2);
  Posterior p = sample_posterior(model.parameters, 6, model.misses(), known(60));
  reweigh(p, 2);  // chi squared of data and priors halved: twice the covariance
  const std::vector<double> values = values_of(p, 0), weights = weights_of(p);
  double mean = 0, variance = 0;
  for (std::size_t k = 0; k < values.size(); ++k) mean += weights[k] * values[k];
  for (std::size_t k = 0; k < values.size(); ++k) variance += weights[k] * square(values[k] - mean);
  const double expected = 2 * model.covariance()(0, 0);
  EXPECT_NEAR(variance, expected, 4 * expected * std::sqrt(2 / p.effective));
}

}  // namespace
}  // namespace papilla::tests::posterior_slow_test
