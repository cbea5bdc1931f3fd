// Processes through two values, where likelihood and predictions are a line by hand, and drafts
// against the two processes that they are made of.
#include "optim/gaussian_process.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::tests::gaussian_process_test {
namespace {

// Correlation of two points, of what is measured at one, and between them.
struct Pair {
  double own, both;
};
Pair pair_of(const std::vector<double>& parameters, const Point& apart) {
  double sum = 0;
  for (std::size_t k = 0; k < apart.size(); ++k) sum += square(apart[k] / std::exp(parameters[k]));
  const double s = std::sqrt(5 * sum);
  return {1 + std::exp(parameters.back()) + 1e-10, (1 + s + s * s / 3) * std::exp(-s)};
}

// Of two values, -1 and 1 in their own scale, the negative logarithm of the likelihood at the best
// signal and of the priors: lengths near a half within a factor e^1.2, noise near a thousandth
// within e^3.
double loss(const std::vector<double>& parameters, const Point& apart) {
  const auto [own, both] = pair_of(parameters, apart);
  double prior = square((parameters.back() - std::log(1e-3)) / 3);
  for (std::size_t k = 0; k < apart.size(); ++k)
    prior += square((parameters[k] - std::log(0.5)) / 1.2);
  return std::log(1 / (own - both)) + 0.5 * std::log(own * own - both * both) + 0.5 * prior;
}

// No step of the last and finest pattern leads to less.
TEST(Likelihood, OfTwoValuesIsLeastAtTheParametersThatAreFound) {
  for (const Point& apart :
       {Point{0.0}, Point{0.004}, Point{0.01}, Point{0.02}, Point{0.05}, Point{0.2}, Point{0.4},
        Point{1.0}, Point{0.1, 0.9}, Point{0.6, 0.6}, Point{0.3, 0.05, 0.7}}) {
    const GaussianProcess process({Point(apart.size(), 0.0), apart}, {10, 16});
    const std::vector<double>& found = process.parameters();
    ASSERT_EQ(found.size(), apart.size() + 1);
    const double least = loss(found, apart);
    EXPECT_LT(least, loss(
                         [&] {
                           std::vector<double> start(found.size(), std::log(0.5));
                           start.back() = std::log(1e-3);
                           return start;
                         }(),
                         apart));
    for (std::size_t k = 0; k < found.size(); ++k) {
      // Whole steps from the start: tenths of a length, fifths of the noise.
      const double step = k + 1 == found.size() ? 0.2 : 0.1;
      const double steps = (found[k] - std::log(k + 1 == found.size() ? 1e-3 : 0.5)) / step;
      EXPECT_NEAR(steps, std::round(steps), 1e-9);
      for (const double way : {step, -step}) {
        std::vector<double> beside = found;
        beside[k] += way;
        EXPECT_GE(loss(beside, apart), least - 1e-9) << apart.size() << " " << k << " " << way;
      }
    }
  }
}

// Each value is missed by what the other does not tell of it: (own^2 - both^2) alpha / own, with
// alpha = y / (own - both).
TEST(LeaveOneOut, OfTwoValuesIsItsClosedForm) {
  for (const double apart : {0.1, 0.5, 1.0}) {
    const GaussianProcess process({{0.0}, {apart}}, {10, 16});
    const auto [own, both] = pair_of(process.parameters(), {apart});
    EXPECT_NEAR(process.leave_one_out_error(), 3 * (own + both) / own, 1e-6) << apart;
  }
}

// Values that do not differ are predicted as they are.
TEST(GaussianProcess, OfEqualValuesIsTheirValue) {
  const GaussianProcess process({{0.0}, {0.4}, {1.0}}, {7, 7, 7});
  EXPECT_DOUBLE_EQ(process.predict({0.2}).mean, 7);
  EXPECT_LT(process.predict({0.2}).sd, 1e-5);
  EXPECT_DOUBLE_EQ(process.leave_one_out_error(), 0);
}

// Far from all points nothing is known: the mean, and the whole signal, y alpha / n.
TEST(GaussianProcess, FarAwayIsTheMeanAndTheSignal) {
  const GaussianProcess process({{0.0}, {1.0}}, {10, 16});
  const auto [own, both] = pair_of(process.parameters(), {1.0});
  const Prediction far = process.predict({1e4});
  EXPECT_NEAR(far.mean, 13, 1e-12);
  EXPECT_NEAR(far.sd, 3 * std::sqrt(1 / (own - both)), 1e-9);
}

// Each coordinate has its own length: that along which nothing changes is the longer.
TEST(GaussianProcess, ACoordinateThatDoesNothingHasALongLength) {
  std::vector<Point> points;
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 25; ++i) {
    points.push_back(low_discrepancy(2, 4, i));
    values.push_back(std::sin(7 * points.back()[1]));
  }
  const std::vector<double> found = GaussianProcess(points, values).parameters();
  EXPECT_GT(found[0], std::log(2.0));
  EXPECT_LT(found[1], std::log(0.8));
}

// Values that are alike are likelier the longer the length: ten of the unit cube is where it ends.
TEST(GaussianProcess, ALengthEndsAtTenOfTheUnitCube) {
  const std::vector<double> found =
      GaussianProcess({{0.0}, {0.3}, {0.6}, {0.9}}, {5, 5, 5, 5}).parameters();
  EXPECT_NEAR(found[0], std::log(10.0), 1e-12);
}

struct Drafted {
  std::vector<Point> dense, few;
  std::vector<double> drafts, values;

  explicit Drafted(double (*value)(double)) {
    for (int i = 0; i <= 20; ++i) {
      dense.push_back({i / 20.0});
      drafts.push_back(std::sin(9 * i / 20.0));
    }
    for (int i = 0; i < 5; ++i) {
      few.push_back({0.03 + 0.22 * i});
      values.push_back(value(few.back()[0]));
    }
  }
};

// Eq. search.7-8: a line through the drafts by least squares and a process through what is left.
TEST(DraftedProcess, IsALineOfTheDraftAndAProcessOfWhatIsLeft) {
  const Drafted d([](double x) { return 5 - 2 * std::sin(9 * x) + 0.3 * x * x; });
  const GaussianProcess draft(d.dense, d.drafts);
  const DraftedProcess process(d.few, d.values, &draft);
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double at = draft.predict(d.few[i]).mean;
    x += at, y += d.values[i], xx += at * at, xy += at * d.values[i];
  }
  const double ratio = (5 * xy - x * y) / (5 * xx - x * x), offset = (y - ratio * x) / 5;
  EXPECT_NEAR(process.ratio(), ratio, 1e-9);
  std::vector<double> left;
  for (std::size_t i = 0; i < 5; ++i)
    left.push_back(d.values[i] - offset - ratio * draft.predict(d.few[i]).mean);
  const GaussianProcess rest(d.few, left);
  ASSERT_LT(rest.leave_one_out_error(), GaussianProcess(d.few, d.values).leave_one_out_error());
  for (const double at : {0.0, 0.17, 0.5, 0.98}) {
    const Prediction a = draft.predict({at}), b = rest.predict({at}), p = process.predict({at});
    EXPECT_NEAR(p.mean, offset + ratio * a.mean + b.mean, 1e-6) << at;
    EXPECT_NEAR(p.sd, std::hypot(ratio * a.sd, b.sd), 1e-6) << at;
  }
}

TEST(DraftedProcess, StandsAloneWhereDraftsDoNotHelpOrAreFew) {
  const Drafted d([](double x) { return x; });
  const GaussianProcess draft(d.dense, d.drafts), flat({{0.0}, {1.0}}, {3, 3});
  const auto expect_alone = [&](const std::vector<Point>& points, const std::vector<double>& values,
                                const GaussianProcess* from) {
    const DraftedProcess process(points, values, from);
    const GaussianProcess alone(points, values);
    for (const double at : {0.1, 0.6}) {
      EXPECT_EQ(process.predict({at}).mean, alone.predict({at}).mean);
      EXPECT_EQ(process.predict({at}).sd, alone.predict({at}).sd);
    }
    return process.ratio();
  };
  expect_alone(d.few, d.values, &draft);  // a straight line is no sine
  EXPECT_EQ(expect_alone(d.few, d.values, nullptr), 0);
  EXPECT_EQ(expect_alone(d.few, d.values, &flat), 0);
  const Drafted like([](double x) { return 2 * std::sin(9 * x); });
  const std::vector<Point> three(like.few.begin(), like.few.begin() + 3);
  EXPECT_EQ(expect_alone(three, {like.values[0], like.values[1], like.values[2]}, &draft), 0);
  const std::vector<Point> four(like.few.begin(), like.few.begin() + 4);
  const std::vector<double> values(like.values.begin(), like.values.begin() + 4);
  EXPECT_NEAR(DraftedProcess(four, values, &draft).ratio(), 2, 0.01);
}

}  // namespace
}  // namespace papilla::tests::gaussian_process_test
