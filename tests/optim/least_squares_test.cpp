// Least squares against what priors, bounds and profiles must give where it can be computed by
// hand. Against certified values: nist_test.cpp.
#include "optim/least_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"

namespace papilla::tests::least_squares_test {
namespace {

using Values = std::vector<double>;

// y = a + b t with unit errors at five times.
LeastSquaresFit line(std::vector<FitParameter> parameters, LeastSquaresOptions options = {}) {
  const Values t{0, 1, 2, 3, 4}, y{1.2, 2.9, 5.1, 7.2, 8.8};
  return least_squares(
      parameters, 5,
      [&](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < 5; ++i) r[i] = y[i] - p[0] - p[1] * t[i];
        return true;
      },
      options);
}

TEST(LeastSquares, APriorAddsItsInformation) {
  // Normal equations by hand: [5 10; 10 30] and [25.2; 69.9], plus 1/sd^2 at the slope.
  LeastSquaresOptions known;
  known.variance = ResidualVariance::Known;
  known.tolerance = 1e-18;
  const LeastSquaresFit free = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, known);
  EXPECT_NEAR(free.parameters[1].value, (5 * 69.9 - 10 * 25.2) / 50, 1e-9);
  EXPECT_NEAR(free.parameters[1].se, std::sqrt(5.0 / 50), 1e-8);
  EXPECT_NEAR(free.correlation[1], -10 / std::sqrt(150.0), 1e-8);
  const LeastSquaresFit prior = line({{"a", 0, -100, 100}, {"b", 1, -100, 100, 1.0, 0.1}}, known);
  const double n = 30 + 100, det = 5 * n - 100;
  EXPECT_NEAR(prior.parameters[1].value, (5 * (69.9 + 100) - 10 * 25.2) / det, 1e-8);
  EXPECT_NEAR(prior.parameters[1].se, std::sqrt(5 / det), 1e-8);
  // With the intercept free the data know 30 - 10^2/5 = 10 of the slope, the prior 100.
  EXPECT_NEAR(prior.parameters[1].data_share, 10.0 / 110, 1e-8);
  // The sum of the squares of each: what is missed of the values, and of the prior.
  const double a = prior.parameters[0].value, b = prior.parameters[1].value;
  const Values missed{1.2 - a, 2.9 - a - b, 5.1 - a - 2 * b, 7.2 - a - 3 * b, 8.8 - a - 4 * b};
  EXPECT_NEAR(prior.chi2, std::inner_product(missed.begin(), missed.end(), missed.begin(), 0.0),
              1e-12);
  EXPECT_NEAR(prior.prior_chi2, std::pow((b - 1) / 0.1, 2), 1e-9);
  EXPECT_EQ(free.degrees_of_freedom, 3);  // five values, two parameters
  EXPECT_EQ(prior.degrees_of_freedom, 4);
  EXPECT_EQ(
      line({{"a", 0, -100, 100, 0.0, 1}, {"b", 1, -100, 100, 1.0, 0.1}}, known).degrees_of_freedom,
      5);
}

TEST(LeastSquares, AtABoundTheIntervalIsTheProfileOfTheLikelihood) {
  LeastSquaresOptions known;
  known.variance = ResidualVariance::Known;
  // The slope wants 1.95; held at 1.5 or below, it sits on the bound.
  const LeastSquaresFit fit = line({{"a", 0, -100, 100}, {"b", 1, -100, 1.5}}, known);
  EXPECT_TRUE(fit.parameters[1].at_bound);
  EXPECT_NEAR(fit.parameters[1].value, 1.5, 1e-6);
  EXPECT_TRUE(fit.parameters[1].high_open);
  // chi2 after a refit of the offset: 10 (b - 1.938)^2 + const; it rises by 1.96^2 from b = 1.5.
  const double best = (5 * 69.9 - 10 * 25.2) / 50, gap = best - 1.5;
  EXPECT_NEAR(fit.parameters[1].low, best - std::sqrt(gap * gap + 1.96 * 1.96 / 10), 2e-3);
}

TEST(LeastSquares, OfALineTheProfileIsTheInterval) {
  LeastSquaresOptions options;
  options.variance = ResidualVariance::Known;
  const auto a = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, options);
  options.profiles = true;
  const auto b = line({{"a", 0, -100, 100}, {"b", 1, -100, 100}}, options);
  EXPECT_LT(b.evaluations, 12 * a.evaluations);  // its rise is a parabola: few refits an end
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(a.parameters[i].low, b.parameters[i].low, 2e-3);
    EXPECT_NEAR(a.parameters[i].high, b.parameters[i].high, 2e-3);
  }
}

TEST(LeastSquares, SingularDirectionsSayWhatTheDataCannotTellApart) {
  // Only the product p q is seen.
  const LeastSquaresFit fit =
      least_squares({{"p", 2, 0.1, 10, 2, 1, true}, {"q", 3, 0.1, 10, 3, 1, true}}, 3,
                    [](std::span<const double> p, std::span<double> r) {
                      for (std::size_t i = 0; i < 3; ++i)
                        r[i] = (p[0] * p[1] - 8) * (1 + double(i));
                      return true;
                    });
  ASSERT_EQ(fit.directions.size(), 2u);
  EXPECT_GT(fit.directions[0].singular_value, 10);
  EXPECT_LT(fit.directions[1].singular_value, 1e-3);
  EXPECT_NEAR(fit.directions[1].weights[0], -fit.directions[1].weights[1], 1e-4);
  EXPECT_LT(fit.correlation[1], -0.99);
  // The priors decide: both grow by the same factor.
  EXPECT_NEAR(fit.parameters[0].value / 2, fit.parameters[1].value / 3, 1e-3);
  EXPECT_NEAR(fit.parameters[0].value * fit.parameters[1].value, 8, 0.02);
}

TEST(LeastSquares, IntervalsHoldTheTruthAsOftenAsTheySay) {
  int inside = 0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(3, "least squares test", static_cast<std::uint64_t>(run));
    Values y;
    for (int i = 0; i < 8; ++i) y.push_back(3 * std::exp(-0.4 * i) + 0.1 * random.normal());
    LeastSquaresOptions options;
    options.variance = ResidualVariance::Known;
    const LeastSquaresFit fit = least_squares(
        {{"amplitude", 1, 0.01, 100, 0, 0, true}, {"rate", 1, 0.01, 10, 0, 0, true}}, 8,
        [&](std::span<const double> p, std::span<double> r) {
          for (std::size_t i = 0; i < 8; ++i)
            r[i] = (y[i] - p[0] * std::exp(-p[1] * static_cast<double>(i))) / 0.1;
          return true;
        },
        options);
    inside += fit.parameters[1].low < 0.4 && 0.4 < fit.parameters[1].high;
  }
  EXPECT_NEAR(inside / double(kRuns), 0.95, 0.03);
}

TEST(LeastSquares, AParameterThatStartsAtZeroIsStepped) {
  // Steps are relative to the parameter: at zero, to its prior's width or its range.
  const FitParameter slope{"b", 0, 0, 100, 1.0, 10, false, 0.05};
  EXPECT_NEAR(line({{"a", 0, -100, 100}, slope}).parameters[1].value, 1.94, 0.02);
  const FitParameter free{"b", 0, 0, 100, 0, 0, false, 0.05};
  EXPECT_NEAR(line({{"a", 0, -100, 100}, free}).parameters[1].value, 1.94, 0.02);
}

TEST(LeastSquares, SenselessParametersAreRefused) {
  const ResidualFunction f = [](std::span<const double>, std::span<double>) { return true; };
  EXPECT_THROW(least_squares({{"p", 0, 1, 0}}, 1, f), InputError);
  EXPECT_THROW(least_squares({{"p", 5, 0, 1}}, 1, f), InputError);
  EXPECT_THROW(least_squares({{"p", 0.5, 0, 1, 0, 0, true}}, 1, f), InputError);
  for (const double sd : {0.1, 2.0}) {  // no logarithm has a prior below zero
    EXPECT_THROW(least_squares({{"p", 0.5, 0.1, 1, -0.5, sd, true}}, 1, f), InputError);
    EXPECT_THROW(least_squares({{"p", 0.5, 0.1, 1, 0.5, -sd}}, 1, f), InputError);
  }
}

// Who asks for the fit sees it before the profiles, and spares them.
TEST(LeastSquares, ProfilesAreWalkedFromAFitThatIsToldFirst) {
  const ResidualFunction f = [](std::span<const double> p, std::span<double> r) {
    for (std::size_t i = 0; i < r.size(); ++i)
      r[i] = 10 * (std::exp(-p[0] * 0.3 * static_cast<double>(i)) -
                   std::exp(-0.15 * static_cast<double>(i)));
    return true;
  };
  const std::vector<FitParameter> parameters{{"p", 1, 0, 5}};
  LeastSquaresOptions options;
  options.profiles = true, options.profile_iterations = 0;
  const LeastSquaresFit by_errors = least_squares(parameters, 6, f, options);
  options.profile_iterations = 30;
  const LeastSquaresFit profiled = least_squares(parameters, 6, f, options);
  ASSERT_GT(profiled.evaluations, by_errors.evaluations);
  for (const bool walked : {false, true}) {
    std::vector<LeastSquaresFit> told;
    options.walks_profiles = [&](const LeastSquaresFit& fit) {
      told.push_back(fit);
      return walked;
    };
    const LeastSquaresFit fit = least_squares(parameters, 6, f, options);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].evaluations, by_errors.evaluations);
    EXPECT_EQ(told[0].parameters[0].high, by_errors.parameters[0].high);
    EXPECT_EQ(fit.evaluations, walked ? profiled.evaluations : by_errors.evaluations);
    EXPECT_EQ(fit.parameters[0].high, (walked ? profiled : by_errors).parameters[0].high);
  }
}

// Where the differences of a step of a twentieth are taken: a logarithm's by factors e^0.05,
// whatever its prior; a number's by that share of itself, next to zero of its prior's width.
TEST(LeastSquares, DifferencesAreTakenAtTheStepOfTheParameter) {
  const auto asked_at = [](const FitParameter& p) {
    std::vector<double> out;
    LeastSquaresOptions once;
    once.iterations = 1;
    once.profile_iterations = 0;
    least_squares(
        {p}, 2,
        [&](std::span<const double> at, std::span<double> r) {
          out.push_back(at[0]);
          r[0] = at[0] - p.start, r[1] = 0.5 * (at[0] - p.start);  // is there already
          return true;
        },
        once);
    return std::pair{*std::min_element(out.begin(), out.end()),
                     *std::max_element(out.begin(), out.end())};
  };
  const auto expect_ends = [&](const FitParameter& p, double low, double high) {
    const auto [from, to] = asked_at(p);
    EXPECT_NEAR(from, low, 1e-9 * std::abs(high));
    EXPECT_NEAR(to, high, 1e-9 * std::abs(high));
  };
  for (const double sd : {0.0, 0.3, 2.0})
    expect_ends({"p", 2, 0.1, 40, sd > 0 ? 2.0 : 0, sd, true, 0.05}, 2 * std::exp(-0.05),
                2 * std::exp(0.05));
  expect_ends({"p", 40, 0, 100, 40, 10, false, 0.05}, 38, 42);
  expect_ends({"p", 0, -100, 100, 0, 10, false, 0.05}, -0.5, 0.5);
  expect_ends({"p", 0, -100, 100, 0, 0, false, 0.05}, -0.01, 0.01);     // a thousandth of the range
  expect_ends({"p", 99, 0, 100, 99, 10, false, 0.05}, 99 * 0.95, 100);  // no further than a bound
}

}  // namespace
}  // namespace papilla::tests::least_squares_test
