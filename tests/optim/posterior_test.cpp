// Posteriors by mixtures and importance weights, against closed forms and quadrature.
#include "optim/posterior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "tests/optim/linear_posterior.h"

namespace papilla::tests::posterior_test {
namespace {

TEST(Posterior, OfALinearModelMeanAndCovarianceAreTheClosedForm) {
  const Linear model(1);
  const Posterior p = sample_posterior(model.parameters, 6, model.misses(), known(60));
  EXPECT_GT(p.effective,
            8000);  // 20000 of a Student distribution of 7 freedoms in three dimensions
  ASSERT_EQ(p.valleys.size(), 1u);
  EXPECT_NEAR(p.valleys[0].share, 1, 1e-12);
  const Eigen::VectorXd expected = model.mean();
  const Eigen::MatrixXd c = model.covariance();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(3);
  for (const PosteriorSample& s : p.samples)
    mean += s.weight * Eigen::Map<const Eigen::VectorXd>(s.values.data(), 3);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3, 3);
  for (const PosteriorSample& s : p.samples) {
    const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(s.values.data(), 3) - mean;
    covariance += s.weight * d * d.transpose();
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean(i), expected(i), 4 * std::sqrt(c(i, i) / p.effective));
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double scatter = std::sqrt((c(i, i) * c(j, j) + c(i, j) * c(i, j)) / p.effective);
      EXPECT_NEAR(covariance(i, j), c(i, j), 4 * scatter) << i << j;
    }
  }
}

// r = (x^2 - 1)/0.4 and a pull of (x - 0.3)/2: two valleys of unlike weight.
TEST(Posterior, OfTwoValleysBothAreKeptWithTheirShares) {
  const std::vector<FitParameter> parameters{
      {.name = "x", .start = 1.2, .low = -3, .high = 3, .step = 1e-3}};
  const auto misses = [](std::span<const double> p, std::span<double> r) {
    r[0] = (p[0] * p[0] - 1) / 0.4;
    r[1] = (p[0] - 0.3) / 2;
    return true;
  };
  double right = 0, all = 0;  // by quadrature
  for (int k = 0; k < 60000; ++k) {
    const double x = -3 + 6 * (k + 0.5) / 60000;
    const double density = std::exp(-0.5 * (square((x * x - 1) / 0.4) + square((x - 0.3) / 2)));
    all += density;
    right += x > 0 ? density : 0;
  }
  const Posterior p = sample_posterior(parameters, 2, misses, known(60, 8));
  ASSERT_EQ(p.valleys.size(), 2u);
  EXPECT_NEAR(p.valleys[0].values[0], 1, 0.05);
  EXPECT_NEAR(p.valleys[1].values[0], -1, 0.05);
  double found = 0;
  for (const PosteriorSample& s : p.samples) found += s.values[0] > 0 ? s.weight : 0;
  EXPECT_NEAR(found, right / all, 4 * 0.5 / std::sqrt(p.effective));
  EXPECT_NEAR(p.valleys[0].share, right / all, 0.05);
  EXPECT_NEAR(p.valleys[0].share + p.valleys[1].share, 1, 1e-9);
}

// Thirteen numbers and six curved rows: 120 answers are enough for what exact rows say.
TEST(Posterior, OfManyNumbersIsThatOfTheRowsThemselves) {
  constexpr int kNumbers = 13;
  std::vector<FitParameter> parameters;
  for (int i = 0; i < kNumbers; ++i) {
    parameters.push_back({.name = "p" + std::to_string(i),
                          .start = 0,
                          .low = -10,
                          .high = 10,
                          .prior = 0,
                          .prior_sd = 1,
                          .step = 1e-3});
  }
  const auto misses = [](std::span<const double> p, std::span<double> r) {
    for (std::size_t i = 0; i < 6; ++i)
      r[i] = 2 * (p[i] + p[i + 1] + square(p[i + 2])) - 0.3 * static_cast<double>(i);
    return true;
  };
  const Posterior p = sample_posterior(parameters, 6, misses, known(120));
  EXPECT_GT(p.effective, 200);
  std::vector<double> logs;
  for (const PosteriorSample& s : p.samples) {
    std::vector<double> r(6);
    misses(s.values, r);
    double sum = s.prior_sum;
    for (const double v : r) sum += square(v);
    logs.push_back(-sum / 2 - s.log_proposal);
  }
  const std::vector<double> exact = normalised(logs), guessed = weights_of(p);
  EXPECT_GT(effective_number(exact), 100);
  const auto moments = [](const std::vector<double>& values, const std::vector<double>& weights) {
    double mean = 0, squares = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      mean += weights[k] * values[k];
      squares += weights[k] * square(values[k]);
    }
    return std::pair(mean, std::sqrt(squares - square(mean)));
  };
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const std::vector<double> values = values_of(p, i);
    const auto [mean, spread] = moments(values, exact);
    const auto [by_guess, spread_by_guess] = moments(values, guessed);
    EXPECT_NEAR(by_guess, mean, 0.25 * spread) << i;
    EXPECT_NEAR(spread_by_guess / spread, 1, 0.25) << i;
  }
}

// A row that jitters by twice its datum's error, as droplets do that merge or not: the exact
// answers are worth nothing as weights, and what they leave open is counted.
TEST(Posterior, OfARowThatJittersKnowsThatItDoes) {
  const std::vector<FitParameter> parameters{
      {.name = "x", .start = 0, .low = -20, .high = 20, .prior = 0, .prior_sd = 3, .step = 1e-2}};
  const auto misses = [](std::span<const double> p, std::span<double> r) {
    RandomStream random(static_cast<std::uint64_t>(1e6 * (p[0] + 30)), "jitter");
    r[0] = p[0] - 1 + 2 * random.normal();
    return true;
  };
  PosteriorOptions options = known(200);
  options.fit.iterations = 1;  // a descent would end in one trough of the jitter
  const Posterior p = sample_posterior(parameters, 1, misses, options);
  // The datum with its error of 1 and that of 2, beside the prior: mean 9/14, variance 45/14.
  const std::vector<double> values = values_of(p, 0), weights = weights_of(p);
  double mean = 0, squares = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    mean += weights[k] * values[k];
    squares += weights[k] * square(values[k]);
  }
  EXPECT_NEAR(mean, 9.0 / 14, 0.5);
  EXPECT_NEAR(std::sqrt(squares - square(mean)), std::sqrt(45.0 / 14), 0.3);
}

// Only the band's outside is missed; inside of it the prior is what is left.
TEST(Posterior, OfABandIsThePriorInsideOfIt) {
  const std::vector<FitParameter> parameters{
      {.name = "x", .start = 0, .low = -20, .high = 20, .prior = 0, .prior_sd = 1, .step = 1e-3}};
  const auto answers = [](std::span<const double> p, std::span<double> r) {
    r[0] = 10 * p[0];
    return true;
  };
  PosteriorOptions options = known(60);
  options.bands = {{0, kInfinity}};  // x above 0
  const Posterior p = sample_posterior(parameters, 1, answers, options);
  const std::vector<double> values = values_of(p, 0), weights = weights_of(p);
  double mean = 0, below = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    mean += weights[k] * values[k];
    below += values[k] < -0.3 ? weights[k] : 0;
  }
  // Half a normal distribution, its edge smoothed by 0.1: by quadrature.
  double sum = 0, all = 0;
  for (double x = -2; x < 6; x += 1e-3) {
    const double density = std::exp(-square(x) / 2 - square(std::min(10 * x, 0.0)) / 2);
    sum += x * density, all += density;
  }
  EXPECT_NEAR(mean, sum / all, 0.03);
  EXPECT_LT(below, 0.01);
}

TEST(Posterior, IsTheSameTwiceAndMovesWithItsSeed) {
  const Linear model(3);
  const auto of = [&](std::uint64_t seed) {
    PosteriorOptions options = known(50, 2);
    options.seed = seed;
    return weights_of(sample_posterior(model.parameters, 6, model.misses(), options));
  };
  EXPECT_EQ(of(1), of(1));
  EXPECT_NE(of(1), of(2));
}

// No sample lies outside of the bounds, which cut a posterior that is flat in between.
TEST(Posterior, OfNoDataIsTheRange) {
  const std::vector<FitParameter> parameters{
      {.name = "x", .start = 0, .low = -1, .high = 1, .step = 1e-3}};
  const auto misses = [](std::span<const double> p, std::span<double> r) {
    r[0] = 1e-3 * p[0];
    return true;
  };
  const Posterior p = sample_posterior(parameters, 1, misses, known(60));
  const std::vector<double> values = values_of(p, 0), weights = weights_of(p);
  double mean = 0, squares = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    EXPECT_LE(std::abs(values[k]), 1);
    mean += weights[k] * values[k];
    squares += weights[k] * square(values[k]);
  }
  EXPECT_NEAR(mean, 0, 4 * std::sqrt(1.0 / 3 / p.effective));
  EXPECT_NEAR(squares, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / p.effective));
}

LeftOut scored(std::vector<double> scores, double error = 0) {
  std::vector<double> errors(scores.size(), error);
  return {std::move(scores), std::move(errors), 0};
}

TEST(HypothesisWeights, AreTheScoresWhereGroupsSayTheSameAndNeverCertainWhereTheyDoNot) {
  const std::vector<double> same =
      hypothesis_weights({scored({-1, -2, -3}), scored({-1, -2, -3})}, 1);
  EXPECT_NEAR(same[0], 0.5, 1e-12);
  // One ahead by 1 in each of four groups: e^4 whatever their shares.
  const std::vector<double> ahead =
      hypothesis_weights({scored({0, 0, 0, 0}), scored({-1, -1, -1, -1})}, 1);
  EXPECT_NEAR(ahead[0], 1 / (1 + std::exp(-4)), 1e-9);
  // The same lead from one group alone: less sure.
  const std::vector<double> one =
      hypothesis_weights({scored({0, 0, 0, 0}), scored({-4, 0, 0, 0})}, 1);
  EXPECT_LT(one[0], ahead[0] - 0.05);
  EXPECT_GT(one[0], 0.5);
}

// The lead of one group is 1; what the scores may be off is added to it, and the mean of the
// logistic function over that normal by quadrature.
TEST(HypothesisWeights, KnowWhatTheScoresMayBeOff) {
  constexpr double kError = 3;
  const std::vector<double> w = hypothesis_weights({scored({0}, kError), scored({-1})}, 1);
  double expected = 0;
  constexpr int kNodes = 4000;
  for (int k = 0; k < kNodes; ++k) {
    const double z = normal_quantile((k + 0.5) / kNodes);
    expected += 1 / (1 + std::exp(-1 - kError * z)) / kNodes;
  }
  EXPECT_NEAR(w[0], expected, 4 * 0.5 / std::sqrt(20000.0));
  EXPECT_LT(w[0], 1 / (1 + std::exp(-1.0)) - 0.05);
}

TEST(ChosenPoints, HaveTheMeansAndSpreadsOfAll) {
  RandomStream random(1, "points");
  std::vector<std::vector<double>> features;
  std::vector<double> weights;
  std::vector<int> stratum;
  double sum = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> f;
    for (int i = 0; i < 5; ++i) f.push_back(random.normal());
    f.push_back(f[0] * f[1]);
    features.push_back(f);
    weights.push_back(-std::log(1 - random.uniform()));
    stratum.push_back(k % 10 == 0);
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  double second = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) second += stratum[k] * weights[k];
  const ChosenPoints chosen = choose_points(features, weights, stratum, 32, 1);
  EXPECT_LE(chosen.index.size(), 32u);
  EXPECT_GE(chosen.index.size(), 25u);
  EXPECT_LT(chosen.largest_mean, 0.05);
  EXPECT_GT(chosen.least_spread, 0.95);
  EXPECT_LT(chosen.largest_spread, 1.05);
  double own = 0, all = 0;
  for (std::size_t k = 0; k < chosen.index.size(); ++k) {
    own += stratum[chosen.index[k]] * chosen.weight[k];
    all += chosen.weight[k];
  }
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_NEAR(own, second, 1e-12);
}

// Eight draws know their own mean and deviation by themselves alone: 1.96 of their deviation would
// hold 87 % of what else is drawn.
TEST(ChosenPoints, OfFewDrawsHoldWhatElseIsDrawn) {
  constexpr int kTruths = 1000;
  int held = 0;
  for (std::uint64_t seed = 1; seed <= kTruths; ++seed) {
    RandomStream random(seed, "few draws");
    std::vector<std::vector<double>> draws;
    for (int k = 0; k < 8; ++k) draws.push_back({random.normal()});
    const ChosenPoints chosen =
        choose_points(draws, std::vector<double>(8, 0.125), std::vector<int>(8, 0), 12, seed);
    double mean = 0, variance = 0;
    for (std::size_t k = 0; k < chosen.index.size(); ++k)
      mean += chosen.weight[k] * draws[chosen.index[k]][0];
    for (std::size_t k = 0; k < chosen.index.size(); ++k)
      variance += chosen.weight[k] * square(draws[chosen.index[k]][0] - mean);
    held += std::abs(random.normal() - mean) < normal_quantile(0.975) * std::sqrt(variance);
  }
  EXPECT_GE(held, 0.93 * kTruths);
  EXPECT_LE(held, 0.97 * kTruths);
}

TEST(ChosenPoints, OfOnePointAreThatPoint) {
  const ChosenPoints chosen = choose_points({{1, 2}}, {1}, {0}, 8, 1);
  ASSERT_EQ(chosen.index.size(), 1u);
  EXPECT_NEAR(chosen.weight[0], 1, 1e-15);
  EXPECT_EQ(chosen.least_spread, 1);
}

}  // namespace
}  // namespace papilla::tests::posterior_test
