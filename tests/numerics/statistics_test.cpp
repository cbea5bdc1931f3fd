// Means, ratios, jackknife and quantiles against numbers worked out by hand and printed in tables.
#include "numerics/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"

namespace papilla::tests::statistics_test {
namespace {

TEST(Statistics, AMeanHasTheErrorOfItsSamples) {
  const Estimate e = mean_estimate(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(e.value, 2.5);
  EXPECT_DOUBLE_EQ(e.se, std::sqrt(5.0 / 3 / 4));  // variance 5/3, of four
  EXPECT_EQ(mean_estimate(std::vector<double>{7}), (Estimate{7, 0}));
  EXPECT_EQ(mean_estimate({}), (Estimate{0, 0}));
}

// Over a constant a ratio is a mean, and it has the mean's error.
TEST(Statistics, ARatioToAConstantIsAMean) {
  const std::vector<double> a{1, 2, 3, 4, 9}, b(5, 10.0), c(5, -10.0);
  const Estimate mean = mean_estimate(a), ratio = ratio_estimate(a, b);
  EXPECT_DOUBLE_EQ(ratio.value, mean.value / 10);
  EXPECT_DOUBLE_EQ(ratio.se, mean.se / 10);
  EXPECT_DOUBLE_EQ(ratio_estimate(a, c).value, -ratio.value);
  EXPECT_DOUBLE_EQ(ratio_estimate(a, c).se, ratio.se);
  const Estimate exact =
      ratio_estimate(std::vector<double>{2, 6, 10}, std::vector<double>{1, 3, 5});
  EXPECT_DOUBLE_EQ(exact.value, 2);  // numbers that scatter alike leave nothing open
  EXPECT_DOUBLE_EQ(exact.se, 0);
}

// Two samples are enough for an error, one is not.
TEST(Statistics, TwoSamplesHaveAnError) {
  EXPECT_DOUBLE_EQ(mean_estimate(std::vector<double>{1, 3}).se, 1);
  const std::vector<double> a{2, 4}, b{2, 2};
  EXPECT_DOUBLE_EQ(ratio_estimate(a, b).value, 1.5);
  EXPECT_DOUBLE_EQ(ratio_estimate(a, b).se, 0.5);
  EXPECT_EQ(ratio_estimate(std::vector<double>{3}, std::vector<double>{2}), (Estimate{1.5, 0}));
}

// The series over 1/n against the distribution itself, by bisection: its first term left out is of
// order 1/n^5.
TEST(Statistics, StudentQuantilesInvertTheirDistribution) {
  for (const double p : {0.6, 0.9, 0.975, 0.995}) {
    for (const auto& [degrees, error] : {std::pair{10, 2e-3}, {20, 6e-5}, {40, 2e-6}, {80, 6e-8}}) {
      double low = 0, high = 20;
      for (int i = 0; i < 70; ++i) {
        const double t = 0.5 * (low + high);
        (student_t_cdf(t, degrees) < p ? low : high) = t;
      }
      EXPECT_NEAR(student_t_quantile(p, degrees), low, error) << p << " " << degrees;
      EXPECT_NEAR(student_t_quantile(1 - p, degrees), -low, error) << p << " " << degrees;
      EXPECT_NEAR(student_t_cdf(-low, degrees), 1 - p, 1e-12) << p << " " << degrees;
      // Near the middle the series is good to its fifth term.
      if (p < 0.7 && degrees == 20) {
        EXPECT_NEAR(student_t_quantile(p, degrees), low, 1e-8);
      }
    }
  }
}

// The jackknife of a mean gives the samples back.
TEST(Statistics, TheJackknifeOfAMeanIsItsSamples) {
  const std::vector<double> samples{1, 2, 4, 9};
  std::vector<double> without;
  for (double x : samples) without.push_back((16 - x) / 3);
  const std::vector<double> back = jackknife_samples(4, without);
  ASSERT_EQ(back.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(back[i], samples[i], 1e-14);
  EXPECT_EQ(jackknife_samples(3, {}), std::vector<double>{3});
}

// Closed forms of two degrees of freedom: of a known scatter, and of one that two samples know.
TEST(Statistics, TheMeantShareIsTheMeanOfItsPosterior) {
  const double e = std::exp(1.0);
  EXPECT_NEAR(meant_share(1, 2).value, 1 - (2 - 5 / e) / (1 - 2 / e), 1e-6);
  EXPECT_NEAR(meant_share(1, 2, 2).value, 1 - (1.5 - 2 * std::log(2)) / (std::log(2) - 0.5), 1e-6);
  // Nothing but scatter leaves a part of it, by its degrees of freedom; no scatter takes nothing.
  EXPECT_NEAR(meant_share(1e-9, 4).value, 0.25, 1e-6);
  EXPECT_NEAR(meant_share(1e12, 4, 2).value, 1, 1e-9);
  EXPECT_EQ(meant_share(0, 4).value, 0);
}

TEST(Statistics, QuantilesInterpolateBetweenSortedValues) {
  const std::vector<double> values{4, 1, 3, 2};
  for (const auto& [p, expected] : {std::pair{0.0, 1.0},
                                    {0.1, 1.3},
                                    {1.0 / 3, 2.0},
                                    {0.5, 2.5},
                                    {0.9, 3.7},
                                    {1.0, 4.0},
                                    {-1.0, 1.0},
                                    {2.0, 4.0}})
    EXPECT_NEAR(quantile(values, p), expected, 1e-14) << p;
  EXPECT_EQ(quantile({5}, 0.3), 5);
}

// The half normal distribution; far below zero an exponential one, far above the normal one.
TEST(Statistics, ANumberKnownNotToBeBelowZeroHasTheMomentsOfItsUpperPart) {
  const Estimate half = not_below_zero({0, 2});
  EXPECT_NEAR(half.value, 2 * std::sqrt(2 / kPi), 1e-12);
  EXPECT_NEAR(half.se, 2 * std::sqrt(1 - 2 / kPi), 1e-12);
  EXPECT_EQ(not_below_zero({3, 0.1}), (Estimate{3, 0.1}));
  EXPECT_EQ(not_below_zero({-3, 0}), (Estimate{0, 0}));
  for (const double below : {-29.999, -30.001, -200.0}) {
    const Estimate far = not_below_zero({below, 1});
    EXPECT_NEAR(far.value, -1 / below, 3e-3 / -below) << below;
    EXPECT_NEAR(far.se, -1 / below, 4e-3 / -below) << below;
  }
}

TEST(Statistics, NormalQuantilesInvertTheDistribution) {
  EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-15);
  EXPECT_NEAR(normal_cdf(-1), 0.158655253931457, 1e-15);
  for (double x : {-6.0, -1.0, 0.0, 0.3, 2.0, 5.0})
    EXPECT_NEAR(normal_quantile(normal_cdf(x)), x, 1e-9) << x;
}

TEST(Statistics, StudentQuantilesMatchTables) {
  for (const auto& [degrees, at_975, at_90, error] : {std::tuple{1, 12.7062, 3.07768, 1e-4},
                                                      {2, 4.30265, 1.88562, 1e-5},
                                                      {3, 3.18245, 1.63774, 4e-3},
                                                      {5, 2.57058, 1.47588, 3e-4},
                                                      {10, 2.22814, 1.37218, 2e-5},
                                                      {30, 2.04227, 1.31042, 1e-5}}) {
    EXPECT_NEAR(student_t_quantile(0.975, degrees), at_975, error) << degrees;
    EXPECT_NEAR(student_t_quantile(0.9, degrees), at_90, error) << degrees;
    EXPECT_NEAR(student_t_quantile(0.025, degrees), -at_975, error) << degrees;
  }
  EXPECT_TRUE(std::isinf(student_t_quantile(0.975, 0)));
}

// Tables of Student's distribution (Abramowitz & Stegun 26.10), and its closed forms at 1 and 2.
TEST(Statistics, StudentsDistributionHasItsTabulatedValues) {
  EXPECT_NEAR(student_t_cdf(2.571, 5), 0.975, 2e-5);
  EXPECT_NEAR(student_t_cdf(4.032, 5), 0.995, 2e-5);
  EXPECT_NEAR(student_t_cdf(1.812, 10), 0.95, 5e-5);
  EXPECT_NEAR(student_t_cdf(3.385, 30), 0.999, 2e-6);
  for (double t : {-30.0, -1.7, -0.01, 0.0, 0.3, 2.5, 400.0}) {
    EXPECT_NEAR(student_t_cdf(t, 1), 0.5 + std::atan(t) / std::acos(-1.0), 1e-10) << t;
    EXPECT_NEAR(student_t_cdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-10) << t;
    EXPECT_NEAR(student_t_cdf(t, 1e9), normal_cdf(t), 1e-9) << t;
    EXPECT_NEAR(student_t_cdf(t, 0.9999e5), student_t_cdf(t, 1.0001e5), 1e-9) << t;
  }
}

}  // namespace
}  // namespace papilla::tests::statistics_test
