// Fits as wholes against normal equations, closed forms and counts: every number that a fit says.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "base/constants.h"
#include "base/error.h"
#include "numerics/statistics.h"
#include "optim/least_squares.h"
#include "optim/trust_region.h"

namespace papilla::tests::fits_test {
namespace {

using Values = std::vector<double>;

// y = a + b t at four times, each with a standard deviation of its own.
const Values kTimes{0, 1, 2, 4}, kSeen{1.1, 2.7, 5.4, 8.9}, kDeviation{0.5, 0.25, 0.5, 1};

bool line(std::span<const double> p, std::span<double> r) {
  for (std::size_t i = 0; i < 4; ++i) r[i] = (kSeen[i] - p[0] - p[1] * kTimes[i]) / kDeviation[i];
  return true;
}

LeastSquaresOptions exact() {
  LeastSquaresOptions out;
  out.tolerance = 1e-18;
  return out;
}

// The normal equations of that line by hand.
struct Line {
  double s = 0, st = 0, stt = 0, sy = 0, sty = 0;
  Line() {
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = 1 / square(kDeviation[i]);
      s += w, st += w * kTimes[i], stt += w * square(kTimes[i]);
      sy += w * kSeen[i], sty += w * kTimes[i] * kSeen[i];
    }
  }
  double det() const { return s * stt - st * st; }
  double a() const { return (stt * sy - st * sty) / det(); }
  double b() const { return (s * sty - st * sy) / det(); }
  double chi2() const {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += square((kSeen[i] - a() - b() * kTimes[i]) / kDeviation[i]);
    return sum;
  }
};

TEST(Fits, EveryNumberOfALineIsThatOfTheNormalEquations) {
  const Line n;
  const double student = student_t_quantile(0.95, 2), normal = normal_quantile(0.95);
  for (const auto& [variance, factor] :
       {std::pair{ResidualVariance::Known, 1.0},
        {ResidualVariance::Estimated, n.chi2() / 2},
        {ResidualVariance::Inflated, std::max(1.0, n.chi2() / 2)}}) {
    LeastSquaresOptions options = exact();
    options.variance = variance;
    options.confidence = 0.9;
    const LeastSquaresFit fit =
        least_squares({{"a", 0, -100, 100}, {"b", 0, -50, 150}}, 4, line, options);
    EXPECT_TRUE(fit.converged);
    ASSERT_EQ(fit.parameters.size(), 2u);
    EXPECT_NEAR(fit.values()[0], n.a(), 1e-8);
    EXPECT_NEAR(fit.values()[1], n.b(), 1e-8);
    EXPECT_NEAR(fit.chi2, n.chi2(), 1e-9);
    EXPECT_EQ(fit.prior_chi2, 0);
    ASSERT_EQ(fit.residuals.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(fit.residuals[i], (kSeen[i] - n.a() - n.b() * kTimes[i]) / kDeviation[i], 1e-7);
    EXPECT_EQ(fit.degrees_of_freedom, 2);
    EXPECT_NEAR(fit.variance_factor, factor, 1e-9);
    const Values covariance{n.stt, -n.st, -n.st, n.s};
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(fit.covariance[i], factor * covariance[i] / n.det(), 1e-7) << i;
    const double rho = -n.st / std::sqrt(n.s * n.stt);
    EXPECT_NEAR(fit.correlation[0], 1, 1e-9);
    EXPECT_NEAR(fit.correlation[1], rho, 1e-7);
    EXPECT_NEAR(fit.correlation[2], rho, 1e-7);
    EXPECT_NEAR(fit.correlation[3], 1, 1e-9);
    const double quantile = variance == ResidualVariance::Known ? normal : student;
    const Values errors{std::sqrt(n.stt * factor / n.det()), std::sqrt(n.s * factor / n.det())},
        values{n.a(), n.b()};
    for (std::size_t i = 0; i < 2; ++i) {
      const ParameterFit& p = fit.parameters[i];
      EXPECT_EQ(p.name, i == 0 ? "a" : "b");
      EXPECT_NEAR(p.se, errors[i], 1e-7);
      EXPECT_NEAR(p.low, values[i] - quantile * errors[i], 1e-6);
      EXPECT_NEAR(p.high, values[i] + quantile * errors[i], 1e-6);
      EXPECT_FALSE(p.at_bound || p.low_open || p.high_open);
      EXPECT_EQ(p.data_share, 1);  // no prior
    }
    // Eq. calibration.4 in units of a quarter of each range, 50: 50^2 times the eigenvalues of the
    // information, and their directions.
    ASSERT_EQ(fit.directions.size(), 2u);
    const double middle = (n.s + n.stt) / 2, apart = std::hypot((n.s - n.stt) / 2, n.st);
    EXPECT_NEAR(fit.directions[0].singular_value / (50 * std::sqrt(middle + apart)), 1, 1e-6);
    EXPECT_NEAR(fit.directions[1].singular_value / (50 * std::sqrt(middle - apart)), 1, 1e-6);
    const Values& along = fit.directions[0].weights;
    EXPECT_NEAR(along[1] / along[0], (middle + apart - n.s) / n.st, 1e-6);
    EXPECT_NEAR(std::hypot(along[0], along[1]), 1, 1e-9);
  }
}

// The reduced sum of squares is 1/100 or 100 times as much: only the inflated variance is cut at 1.
TEST(Fits, TheVarianceFactorIsTheReducedSumWhereItIsAskedFor) {
  for (const double size : {0.1, 10.0}) {
    const auto factor = [&](ResidualVariance variance, int residuals) {
      LeastSquaresOptions options = exact();
      options.variance = variance;
      return least_squares(
                 {{"p", 0, -100, 100}}, residuals,
                 [&](std::span<const double> p, std::span<double> r) {
                   // Around 3, on both sides alike.
                   for (std::size_t i = 0; i < r.size(); ++i)
                     r[i] = p[0] - 3 + (i % 2 == 0 ? size : -size);
                   return true;
                 },
                 options)
          .variance_factor;
    };
    const double reduced = 4 * square(size) / 3;
    EXPECT_EQ(factor(ResidualVariance::Known, 4), 1);
    EXPECT_NEAR(factor(ResidualVariance::Estimated, 4), reduced, 1e-6 * reduced);
    EXPECT_NEAR(factor(ResidualVariance::Inflated, 4), std::max(1.0, reduced), 1e-6 * reduced);
    EXPECT_EQ(factor(ResidualVariance::Estimated, 1), 1);  // no degree of freedom is left
  }
}

// Where a prior counts, the reduced sum has it too: one value and one prior, one degree of freedom.
TEST(Fits, APriorIsAResidual) {
  LeastSquaresOptions options = exact();
  options.variance = ResidualVariance::Estimated;
  const LeastSquaresFit fit = least_squares(
      {{"p", 1, -100, 100, 4, 0.5}}, 1,
      [](std::span<const double> p, std::span<double> r) {
        r[0] = (p[0] - 10) / 2;
        return true;
      },
      options);
  // Weights 1/4 and 4: (10/4 + 16) / 4.25.
  const double value = (10.0 / 4 + 4 * 4) / 4.25;
  EXPECT_NEAR(fit.parameters[0].value, value, 1e-7);
  EXPECT_NEAR(fit.chi2, square((value - 10) / 2), 1e-6);
  EXPECT_NEAR(fit.prior_chi2, square((value - 4) / 0.5), 1e-6);
  EXPECT_EQ(fit.degrees_of_freedom, 1);
  EXPECT_NEAR(fit.variance_factor, 36 / 4.25, 1e-6);  // (10 - 4)^2 / (4 + 1/4)
  EXPECT_NEAR(fit.parameters[0].se, std::sqrt(36 / 4.25 / 4.25), 1e-6);
  EXPECT_NEAR(fit.parameters[0].data_share, 0.25 / 4.25, 1e-9);
  // In prior widths the data's own slope is 1/4.
  EXPECT_NEAR(fit.directions[0].singular_value, 0.25, 1e-9);
}

// The data know the sum of two parameters well and neither of them: of the one with the narrow
// prior they know as much as the other's wide prior lets them, 1/(1 + 10^2). Eq. calibration.2
TEST(Fits, TheDatasShareIsThatOfAParameterWhileTheOthersAreFree) {
  const auto sum = [](std::span<const double> p, std::span<double> r) {
    r[0] = 1e4 * (p[0] + p[1] - 1);
    return true;
  };
  LeastSquaresOptions options = exact();
  const LeastSquaresFit fit =
      least_squares({{"a", 0, -100, 100, 0, 1}, {"b", 0, -100, 100, 0, 10}}, 1, sum, options);
  EXPECT_NEAR(fit.parameters[0].data_share, 1 / 101.0, 1e-6);
  EXPECT_NEAR(fit.parameters[1].data_share, 100 / 101.0, 1e-6);
  // The other one at its bound is held there: all that the data say is of the first.
  options.profile_iterations = 0;
  const LeastSquaresFit held =
      least_squares({{"a", 0, -100, 100, 0, 1}, {"b", -5, -100, -5, 0, 10}}, 1, sum, options);
  EXPECT_TRUE(held.parameters[1].at_bound);
  EXPECT_NEAR(held.parameters[0].data_share, 1, 1e-6);
}

// ln p is fitted: p = e^(2 +- 1/3), the standard error as a share.
TEST(Fits, OfALogarithmTheErrorIsAShare) {
  LeastSquaresOptions options = exact();
  options.variance = ResidualVariance::Known;
  const auto f = [](std::span<const double> p, std::span<double> r) {
    r[0] = 3 * (std::log(p[0]) - 2);
    return true;
  };
  const double q = normal_quantile(0.975);
  const LeastSquaresFit free = least_squares({{"p", 1, 1e-3, 1e3, 0, 0, true}}, 1, f, options);
  EXPECT_NEAR(free.parameters[0].value, std::exp(2.0), 1e-7);
  EXPECT_NEAR(free.parameters[0].se, std::exp(2.0) / 3, 1e-6);
  EXPECT_NEAR(free.parameters[0].low, std::exp(2 - q / 3), 1e-5);
  EXPECT_NEAR(free.parameters[0].high, std::exp(2 + q / 3), 1e-5);
  EXPECT_NEAR(free.covariance[0], 1.0 / 9, 1e-8);
  EXPECT_EQ(free.correlation[0], 1);
  // A quarter of ln 1e6, the range.
  EXPECT_NEAR(free.directions[0].singular_value, 3 * std::log(1e6) / 4, 1e-5);
  // A prior of e, a fifth wide: weights 9 and 25 on logarithms 2 and 1.
  const LeastSquaresFit prior =
      least_squares({{"p", 1, 1e-3, 1e3, std::exp(1.0), 0.2, true}}, 1, f, options);
  const double value = std::exp((2.0 * 9 + 25) / 34);
  EXPECT_NEAR(prior.parameters[0].value, value, 1e-7);
  EXPECT_NEAR(prior.parameters[0].se, value / std::sqrt(34.0), 1e-6);
  EXPECT_NEAR(prior.parameters[0].data_share, 9.0 / 34, 1e-9);
  EXPECT_NEAR(prior.prior_chi2, square((std::log(value) - 1) / 0.2), 1e-6);
  EXPECT_NEAR(prior.directions[0].singular_value, 0.6, 1e-9);
}

// Three standard errors away from a bound on one side and one on the other.
TEST(Fits, AnIntervalEndsAtItsBounds) {
  LeastSquaresOptions options = exact();
  options.variance = ResidualVariance::Known;
  const LeastSquaresFit fit = least_squares(
      {{"p", 5, 2, 6}}, 1,
      [](std::span<const double> p, std::span<double> r) {
        r[0] = p[0] - 5;
        return true;
      },
      options);
  const ParameterFit& p = fit.parameters[0];
  EXPECT_NEAR(p.low, 5 - normal_quantile(0.975), 1e-6);
  EXPECT_EQ(p.high, 6);
  EXPECT_FALSE(p.low_open);
  EXPECT_TRUE(p.high_open);
  EXPECT_FALSE(p.at_bound);
}

// At its bound the interval is where the sum has risen by the quantile squared: of (p + 1)^2 from
// p = 0 on, at sqrt(1 + q^2) - 1.
TEST(Fits, AtABoundTheProfileGoesFromIt) {
  LeastSquaresOptions options = exact();
  options.variance = ResidualVariance::Known;
  const double q = normal_quantile(0.975);
  const auto f = [](std::span<const double> p, std::span<double> r) {
    r[0] = p[0] + 1;
    return true;
  };
  const LeastSquaresFit fit = least_squares({{"p", 5, 0, 100}}, 1, f, options);
  const ParameterFit& p = fit.parameters[0];
  EXPECT_TRUE(p.at_bound);
  EXPECT_NEAR(p.value, 0, 1e-4);
  EXPECT_EQ(p.se, 0);
  EXPECT_EQ(p.low, 0);
  EXPECT_TRUE(p.low_open);
  EXPECT_FALSE(p.high_open);
  EXPECT_NEAR(p.high, std::sqrt(1 + q * q) - 1, 3e-3);
  EXPECT_EQ(fit.covariance[0], 0);
  EXPECT_EQ(fit.correlation[0], 0);
  // The other way round, and a bound that comes before the rise.
  const LeastSquaresFit mirrored = least_squares(
      {{"p", -0.5, -1, 0}}, 1,
      [](std::span<const double> at, std::span<double> r) {
        r[0] = at[0] - 0.5;
        return true;
      },
      options);
  EXPECT_TRUE(mirrored.parameters[0].high_open);
  EXPECT_TRUE(mirrored.parameters[0].low_open);
  EXPECT_EQ(mirrored.parameters[0].low, -1);
  EXPECT_EQ(mirrored.parameters[0].high, 0);
  // Without profiles all of the range is open.
  options.profile_iterations = 0;
  const LeastSquaresFit without = least_squares({{"p", 5, 0, 100}}, 1, f, options);
  EXPECT_EQ(without.parameters[0].low, 0);
  EXPECT_EQ(without.parameters[0].high, 100);
  EXPECT_TRUE(without.parameters[0].low_open && without.parameters[0].high_open);
}

// p^3 against 8 with a deviation of 4: the profile is where |p^3 - 8| = 4 q, on both sides its own
// way; the other parameter follows.
TEST(Fits, AProfileIsTheRootOfTheRiseOnBothSides) {
  LeastSquaresOptions options = exact();
  options.variance = ResidualVariance::Known;
  options.confidence = 0.68;
  options.profiles = true;
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const LeastSquaresFit fit = least_squares(
      {{"p", 1.5, -10, 10}, {"q", 1, -10, 10}}, 2,
      [](std::span<const double> p, std::span<double> r) {
        r[0] = (p[0] * p[0] * p[0] - 8) / 4;
        r[1] = p[1] - 2 * p[0];
        return true;
      },
      options);
  const double q = normal_quantile(0.84);
  const double low = std::cbrt(8 - 4 * q), high = std::cbrt(8 + 4 * q);
  EXPECT_NEAR(fit.parameters[0].value, 2, 1e-6);
  EXPECT_NEAR(fit.parameters[0].low, low, 1.5e-3 * (2 - low));
  EXPECT_NEAR(fit.parameters[0].high, high, 1.5e-3 * (high - 2));
  EXPECT_FALSE(fit.parameters[0].low_open || fit.parameters[0].high_open);
  EXPECT_EQ(notes, (std::vector<std::string>{"profile of p", "profile of q"}));
}

// Residuals that no longer depend on the parameter where a Gauss-Newton step leaps to.
TEST(Fits, AFirstStepThatLeapsIntoAPlainIsTakenShorter) {
  const LeastSquaresFit fit = least_squares(
      {{"p", 3, -1e9, 1e9}}, 3,
      [](std::span<const double> p, std::span<double> r) {
        for (std::size_t i = 0; i < 3; ++i)
          r[i] = static_cast<double>(i + 1) * (1 - std::exp(-p[0] * p[0] / 2));
        return true;
      },
      exact());
  EXPECT_NEAR(fit.parameters[0].value, 0, 1e-2);
  EXPECT_NEAR(fit.chi2, 0, 1e-8);
}

TEST(Fits, WhereTheModelHasNoAnswerTheFitSaysSo) {
  const LeastSquaresFit fit = least_squares(
      {{"p", 3, -10, 10}}, 1, [](std::span<const double>, std::span<double>) { return false; });
  EXPECT_FALSE(fit.converged);
  EXPECT_NE(fit.message.find("; no Jacobian at the best values"), std::string::npos);
  EXPECT_EQ(fit.parameters[0].value, 3);
  EXPECT_EQ(fit.parameters[0].se, 0);
  EXPECT_EQ(fit.parameters[0].data_share, 0);
  EXPECT_TRUE(fit.directions.empty());
  EXPECT_EQ(fit.covariance, Values{0});
  // Not finite is no answer either.
  const LeastSquaresFit infinite =
      least_squares({{"p", 3, -10, 10}}, 1, [](std::span<const double>, std::span<double> r) {
        r[0] = INFINITY;
        return true;
      });
  EXPECT_FALSE(infinite.converged);
}

TEST(Coordinates, AreInPriorWidthsOrQuartersOfTheRange) {
  const std::vector<FitParameter> list{{"a", 5, 0, 100, 7, 2},
                                       {"b", 5, -20, 100},
                                       {"c", 5, 1, std::exp(8.0), 0, 0, true},
                                       {"d", 5, 1, 100, 10, 0.5, true},
                                       {"e", -5, -INFINITY, INFINITY},
                                       {"f", 0, -INFINITY, INFINITY}};
  const FitCoordinates c(list);
  const Values scales{2, 30, 2, 0.5, 5, 1e-12};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(c.scale(i) / scales[i], 1, 1e-12) << i;
  EXPECT_EQ(c.to(0, 8), 4);
  EXPECT_EQ(c.from(0, 4), 8);
  EXPECT_EQ(c.from(0, 400), 100);  // within the bounds
  EXPECT_EQ(c.from(1, -400), -20);
  EXPECT_NEAR(c.to(2, std::exp(3.0)), 1.5, 1e-12);
  EXPECT_NEAR(c.from(2, 1.5), std::exp(3.0), 1e-9);
  EXPECT_TRUE(c.has_prior(0) && c.has_prior(3));
  EXPECT_FALSE(c.has_prior(1) || c.has_prior(4));
  EXPECT_NEAR(c.prior_residual(0, c.to(0, 13)), 3, 1e-12);
  EXPECT_NEAR(c.prior_residual(3, c.to(3, 10 * std::exp(-1.0))), -2, 1e-12);
  EXPECT_NEAR(c.prior_slope(0), 1, 1e-12);
  EXPECT_EQ(all_but({false, true, false, true}), (std::vector<std::size_t>{0, 2}));
}

TEST(Coordinates, EachRefusalSaysWhatIsWrong) {
  const auto refusal = [](const FitParameter& p) -> std::string {
    try {
      FitCoordinates({p});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({"p", 1, 1, 1}), "parameter p: expected low < high");
  EXPECT_EQ(refusal({"p", 1, 0, 2, 0, 0, true}),
            "parameter p: a logarithmic parameter needs a bound above 0");
  EXPECT_EQ(refusal({"p", 3, 0, 2}), "parameter p: the start lies outside the bounds");
  EXPECT_EQ(refusal({"p", -1, 0, 2}), "parameter p: the start lies outside the bounds");
  EXPECT_EQ(refusal({"p", 1, 0, 2, 1, -1}), "parameter p: the prior makes no sense");
  EXPECT_EQ(refusal({"p", 1, 0.5, 2, 0, 1, true}), "parameter p: the prior makes no sense");
  for (const FitParameter& sound :
       {FitParameter{"p", 0, 0, 2}, FitParameter{"p", 2, 0, 2}, FitParameter{"p", 1, 0, 2, -5, 1},
        FitParameter{"p", 1, 0.5, 2, 0, 0, true}, FitParameter{"p", 1, 0.5, 2, 1, 1, true}})
    EXPECT_EQ(refusal(sound), "");
}

// Without a step of its own a difference has the one that balances its error with the noise: the
// cube root of that, of the parameter in prior widths or of a thousandth of one.
TEST(TrustRegion, DifferencesAreAsWideAsTheNoiseAsks) {
  for (const auto& [start, width, step] :
       {std::tuple{8.0, 2.0, 0.08}, {-3.0, 0.5, 0.03}, {0.0, 2.0, 2e-5}, {1e-3, 2.0, 2e-5}}) {
    const std::vector<FitParameter> list{{"p", start, -100, 100, 5, width}};
    const FitCoordinates c(list);
    LeastSquaresOptions options;
    options.noise = 1e-6;
    Values asked;
    const ResidualFunction f = [&](std::span<const double> p, std::span<double> r) {
      asked.push_back(p[0]);
      r[0] = 3 * p[0];
      return true;
    };
    TrustRegion solver(c, 1, f, options);
    Eigen::MatrixXd jacobian;
    ASSERT_TRUE(solver.jacobian({c.to(0, start)}, {0}, jacobian));
    EXPECT_NEAR(jacobian(0, 0), 3 * width, 1e-6);
    ASSERT_EQ(asked.size(), 2u);
    EXPECT_NEAR(asked[0] - start, step, 1e-9);
    EXPECT_NEAR(asked[1] - start, -step, 1e-9);
  }
}

// Of fixed parameters nothing moves; of a line one step is enough, and its sums are those there.
TEST(TrustRegion, HoldsWhatIsNotFree) {
  const std::vector<FitParameter> list{{"a", 2, -100, 100, 1, 0.5}, {"b", 0, -100, 100}};
  const FitCoordinates c(list);
  const LeastSquaresOptions options = exact();
  const ResidualFunction f = line;
  TrustRegion solver(c, 4, f, options);
  const FitSolution s = solver.solve({c.to(0, 2), c.to(1, 0)}, {1}, 20);
  const Line n;
  EXPECT_EQ(c.from(0, s.x[0]), 2);
  EXPECT_NEAR(c.from(1, s.x[1]), (n.sty - 2 * n.st) / n.stt, 1e-8);
  EXPECT_NEAR(s.prior_chi2, 4, 1e-12);
  double chi2 = 0;
  for (const double r : s.residuals) chi2 += r * r;
  EXPECT_EQ(s.chi2, chi2);
  EXPECT_EQ(s.sum(), s.chi2 + s.prior_chi2);
  // Slopes per unit of x: prior widths of 1/2 and quarters of 200.
  Eigen::MatrixXd jacobian;
  const int at_best = solver.evaluations();
  ASSERT_TRUE(solver.jacobian(s.x, {0, 1}, jacobian));
  EXPECT_EQ(solver.evaluations(), at_best + 4);  // both ways of each
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(jacobian(i, 0), -0.5 / kDeviation[static_cast<std::size_t>(i)], 1e-6);
    EXPECT_NEAR(jacobian(i, 1),
                -50 * kTimes[static_cast<std::size_t>(i)] / kDeviation[static_cast<std::size_t>(i)],
                1e-4);
  }
  const int before = solver.evaluations();
  const FitSolution none = solver.solve({c.to(0, 2), c.to(1, 3)}, {}, 20);
  EXPECT_EQ(solver.evaluations(), before + 1);
  EXPECT_TRUE(none.converged);
  EXPECT_EQ(c.from(1, none.x[1]), 3);
}

TEST(Fits, EveryEvaluationOfTheDataIsCounted) {
  for (const bool profiles : {false, true}) {
    int asked = 0;
    LeastSquaresOptions options = exact();
    options.profiles = profiles;
    const auto counted = [&](std::span<const double> p, std::span<double> r) {
      ++asked;
      return line(p, r);
    };
    const LeastSquaresFit fit =
        least_squares({{"a", 3, -10, 10}, {"b", 5, -10, 10}}, 4, counted, options);
    EXPECT_EQ(fit.evaluations, asked);
  }
}

}  // namespace
}  // namespace papilla::tests::fits_test
