// Summaries over humidity with every part of their error, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/constants.h"
#include "forward/errors.h"
#include "metrics/metrics.h"
#include "metrics/series.h"
#include "numerics/statistics.h"

namespace papilla::tests::summaries_test {
namespace {

using Values = std::vector<double>;

std::vector<ResponsePoint> points_of(const Values& modulation, const Values& weights = {},
                                     const Values& humidity = {}) {
  std::vector<ResponsePoint> out(modulation.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].modulation.value = modulation[i];
    if (!weights.empty()) out[i].weight = weights[i];
    if (!humidity.empty()) out[i].relative_humidity = humidity[i];
  }
  return out;
}

Response response_of(const Values& modulation, const Values& weights = {},
                     const Values& humidity = {}) {
  Response r;
  r.driven = true;
  r.points = points_of(modulation, weights, humidity);
  return r;
}

SummaryValue of(Summary summary, const Response& r, const Metric& metric = kModulation) {
  return *summarise(summary, metric, r);
}

// Weights 1, 2 and 1: mean 3, variance (4 + 0 + 4)/4.
TEST(Summaries, OfThreeHumiditiesAreTheirClosedForms) {
  const Response r = response_of({1, 3, 5}, {2, 4, 2});
  for (const auto& [summary, value] : {std::pair{Summary::Mean, 3.0},
                                       {Summary::Std, std::sqrt(2.0)},
                                       {Summary::Variation, std::sqrt(2.0) / 3},
                                       {Summary::Range, 4.0 / 3},
                                       {Summary::Worst, 1.0},
                                       {Summary::Best, 5.0},
                                       {Summary::First, 1.0},
                                       {Summary::Last, 5.0}})
    EXPECT_DOUBLE_EQ(of(summary, r).value, value);
  // A mean below zero has a spread of its size.
  const Response below = response_of({-1, -3, -5}, {2, 4, 2});
  EXPECT_DOUBLE_EQ(of(Summary::Variation, below).value, std::sqrt(2.0) / 3);
  EXPECT_DOUBLE_EQ(of(Summary::Range, below).value, 4.0 / 3);
  // Where less is better the largest is the worst.
  Response friction = r;
  for (ResponsePoint& p : friction.points) p.friction_off.value = p.modulation.value;
  EXPECT_DOUBLE_EQ(of(Summary::Worst, friction, kFriction).value, 5);
  EXPECT_DOUBLE_EQ(of(Summary::Best, friction, kFriction).value, 1);
  for (ResponsePoint& p : friction.points) p.bridges.value = p.modulation.value;
  EXPECT_DOUBLE_EQ(of(Summary::Worst, friction, QuantityMetric{&PointQuantities::bridges}).value,
                   1);  // of no better direction
}

TEST(Summaries, OfWhatIsNotKnownAreNone) {
  Response r = response_of({1, 3});
  EXPECT_TRUE(summarise(Summary::Mean, kModulation, r));
  EXPECT_FALSE(summarise(Summary::Mean, kModulation, response_of({})));
  EXPECT_FALSE(summarise(Summary::Mean, kModulation, response_of({1, 3}, {0, 0})));
  EXPECT_TRUE(summarise(Summary::Mean, kModulation, response_of({1, 3}, {0, 1})));
  EXPECT_FALSE(summarise(Summary::Mean, VoltageFor{0.2}, r));
  r.points[1].modulation.value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(summarise(Summary::First, kModulation, r));
  EXPECT_FALSE(summarise(Summary::Mean, LookMetric{&Look::haze}, r));
  // One look at all humidities has no spread and no error; one that is refused has no value.
  r.appearance.emplace();
  r.appearance->haze = 0.25;
  for (const Summary summary : {Summary::Mean, Summary::Worst, Summary::First})
    EXPECT_EQ(of(summary, r, LookMetric{&Look::haze}).value, 0.25);
  for (const Summary summary : {Summary::Variation, Summary::Range, Summary::Std})
    EXPECT_EQ(of(summary, r, LookMetric{&Look::haze}).value, 0);
  EXPECT_EQ(of(Summary::Mean, r, LookMetric{&Look::haze}).se, 0);
}

// In the mean a part adds up over humidities, each by its weight; one that a humidity lacks is not
// known. The total is all but the band of the water, in squares.
TEST(Summaries, EachPartOfTheErrorOfAMeanIsItsOwn) {
  Response r = response_of({1, 3}, {1, 3});
  r.points[0].modulation.parts = {.sampling = 0.4, .grid = 0.8, .solver = 0.2, .method = 1.2};
  r.points[1].modulation.parts = {.sampling = 0.8, .grid = 0.4, .solver = 0.6};
  for (ResponsePoint& p : r.points) {
    p.modulation.parts.field = 2;
    p.modulation.parts.parameters = 3;
    p.modulation.parts.water = 50;
  }
  const SummaryValue mean = of(Summary::Mean, r);
  EXPECT_DOUBLE_EQ(mean.parts.sampling, 0.7);
  EXPECT_DOUBLE_EQ(mean.parts.grid.value(), 0.5);
  EXPECT_DOUBLE_EQ(mean.parts.solver.value(), 0.5);
  EXPECT_FALSE(mean.parts.method);
  EXPECT_FALSE(mean.parts.humidity);
  EXPECT_DOUBLE_EQ(mean.parts.field.value(), 2);
  EXPECT_DOUBLE_EQ(mean.parts.parameters.value(), 3);
  EXPECT_DOUBLE_EQ(mean.parts.water.value(), 50);
  EXPECT_NEAR(mean.se, std::sqrt(0.49 + 0.25 + 0.25 + 4 + 9), 1e-12);
}

// The field is off the same way at all humidities: what the spread changes by, and three tenths of
// what it would if they were independent. Spread 1 of 1 and 3; 1.2 of 1.1 and 3.5.
TEST(Summaries, TheFieldMovesASpreadAsAWholeAndThreeTenthsApart) {
  Response r = response_of({1, 3});
  r.points[0].modulation.parts.field = 0.1;
  r.points[1].modulation.parts.field = 0.5;
  const double apart = std::hypot(0.5 * 0.1, 0.5 * 0.5);
  EXPECT_NEAR(of(Summary::Std, r).parts.field.value(), std::hypot(0.2, 0.3 * apart), 1e-12);
  // Of the range over the mean: 2/2 and 2.4/2.3.
  EXPECT_NEAR(of(Summary::Range, r).parts.field.value(),
              std::hypot(2.4 / 2.3 - 1, 0.3 * std::hypot(0.1, 0.5) / 2), 1e-12);
  EXPECT_NEAR(of(Summary::Mean, r).parts.field.value(), 0.3, 1e-12);
  EXPECT_NEAR(of(Summary::Worst, r).parts.field.value(), 0.1, 1e-12);
}

// A single value is no distance from itself, whatever it is off by.
TEST(Summaries, ASpreadOfOneHumidityHasNoError) {
  Response r = response_of({0.5});
  r.points[0].modulation.parts.sampling = 0.1;
  r.points[0].modulation.parts.grid = 0.2;
  r.points[0].modulation.parts.solver = 0.3;
  r.points[0].modulation.parts.field = 0.4;
  for (const Summary summary : {Summary::Range, Summary::Std, Summary::Variation}) {
    EXPECT_EQ(of(summary, r).value, 0);
    EXPECT_EQ(of(summary, r).se, 0);
  }
}

// Eq. accuracy.4 at uneven humidities: the second and fourth from their neighbours, then the third;
// the larger change of the summary over three.
TEST(Summaries, TheHumidityPartIsWhatLeavingEverySecondOutDoes) {
  const Values humidity{0.15, 0.25, 0.45, 0.55, 0.95}, weights{1, 2, 3, 2, 1};
  const Values values{1, 4, 2, 3, 11};
  // 1 + (2 - 1)/3, 2 + (11 - 2)/5; then 4 - 2/3.
  const Values odd{1, 4.0 / 3, 2, 3.8, 11}, even{1, 4, 4 - 2.0 / 3, 3, 11};
  const Response r = response_of(values, weights, humidity);
  for (const Summary summary : {Summary::Mean, Summary::Std, Summary::Variation}) {
    const double full = Series(values, weights, Better::Higher).value(summary),
                 a = Series(odd, weights, Better::Higher).value(summary),
                 b = Series(even, weights, Better::Higher).value(summary);
    EXPECT_NEAR(of(summary, r).parts.humidity.value(),
                std::max(std::abs(a - full), std::abs(b - full)) / 3, 1e-12);
  }
  // The mean by hand: of 32/9 the first takes 3.73/9, the second adds 4/9.
  EXPECT_NEAR(of(Summary::Mean, r).parts.humidity.value(),
              std::max(2 * (4 - 4.0 / 3) - 2 * 0.8, 3 * (4.0 / 3)) / 9 / 3, 1e-12);
  for (const Summary summary : {Summary::Range, Summary::Worst, Summary::First})
    EXPECT_FALSE(of(summary, r).parts.humidity);
  EXPECT_FALSE(of(Summary::Mean, response_of({1, 2}, {}, {0.1, 0.2})).parts.humidity);
  EXPECT_TRUE(of(Summary::Mean, response_of({1, 2, 4}, {}, {0.1, 0.2, 0.3})).parts.humidity);
  EXPECT_FALSE(of(Summary::Mean, response_of({1, 2, 4}, {}, {0.1, 0.2, 0.1})).parts.humidity);
  // Three: the one in the middle, once.
  EXPECT_NEAR(of(Summary::Mean, response_of({1, 2, 4}, {}, {0.1, 0.2, 0.3})).parts.humidity.value(),
              0.5 / 3 / 3, 1e-12);
}

// Skins left out one by one: samples 2 a - (without), two skins, of the mean and of the spread.
TEST(Summaries, SamplingFollowsTheSummaryThroughTheSkins) {
  Response r = response_of({1, 3});
  for (ResponsePoint& p : r.points) p.modulation.parts.sampling = 9;  // of the points alone
  r.without = {points_of({1.2, 2.8}), points_of({0.8, 3.4})};
  // Means 2, 2 and 2.1: samples 2.05 and 1.95; spreads 1, 0.8 and 1.3: samples 1.25 and 0.75.
  EXPECT_NEAR(of(Summary::Mean, r).parts.sampling, 0.05, 1e-12);
  EXPECT_NEAR(of(Summary::Std, r).parts.sampling, 0.25, 1e-12);
  const ErrorSamples mean = error_samples(Summary::Mean, kModulation, r),
                     spread = error_samples(Summary::Std, kModulation, r),
                     second = error_samples_at(1, kModulation, r);
  ASSERT_EQ(mean.sampling.size(), 2u);
  EXPECT_NEAR(mean.sampling[0], 2.05, 1e-12);
  EXPECT_NEAR(mean.sampling[1], 1.95, 1e-12);
  EXPECT_NEAR(spread.sampling[0], 1.25, 1e-12);
  EXPECT_NEAR(second.sampling[0], 3.3, 1e-12);
  EXPECT_NEAR(second.sampling[1], 2.7, 1e-12);
  EXPECT_TRUE(error_samples(Summary::Mean, SourceAmplitude{}, r).sampling.empty());
  // A skin without which the number is not known leaves the points' own.
  r.without[0][1].modulation.value = INFINITY;
  EXPECT_NEAR(of(Summary::Mean, r).parts.sampling, 9, 1e-12);
}

VoltageAnswer answer(double volts, const Values& without) {
  VoltageAnswer out;
  out.target = 0.3;
  out.amplitude = {volts, {.sampling = 9}};
  out.without = without;
  return out;
}

// A voltage is sought on skins of its own, whatever the response has. Means 80, 82.5 and 77.5.
TEST(Summaries, AVoltageFollowsItsOwnSkins) {
  const VoltageFor metric{0.3};
  Response r = response_of({0.5, 0.6});
  r.without = {r.points, r.points, r.points};
  r.points[0].voltages = {answer(100, {104, 96})};
  r.points[1].voltages = {answer(60, {61, 59})};
  EXPECT_NEAR(of(Summary::Mean, r, metric).parts.sampling, 2.5, 1e-12);
  const ErrorSamples mean = error_samples(Summary::Mean, metric, r),
                     worst = error_samples(Summary::Worst, metric, r),
                     second = error_samples_at(1, metric, r);
  ASSERT_EQ(mean.sampling.size(), 2u);
  EXPECT_NEAR(mean.sampling[0], 77.5, 1e-12);
  EXPECT_NEAR(mean.sampling[1], 82.5, 1e-12);
  EXPECT_NEAR(worst.sampling.at(0), 96, 1e-12);
  EXPECT_NEAR(second.sampling.at(0), 59, 1e-12);
  EXPECT_TRUE(mean.grid.empty() && mean.method.empty());
  // A design that skins move alike is told from it by all of their distance. Eq. accuracy.14
  Response other = r;
  other.points[0].voltages = {answer(110, {114, 106})};
  EXPECT_NEAR(difference_error(error_samples(Summary::Mean, metric, other), mean).value(), 0,
              1e-12);
  // A humidity that lacks a skin leaves the points' own error, and its neighbour's samples.
  r.points[1].voltages[0].without.pop_back();
  EXPECT_TRUE(error_samples(Summary::Mean, metric, r).sampling.empty());
  EXPECT_NEAR(of(Summary::Mean, r, metric).parts.sampling, 9, 1e-12);
  EXPECT_EQ(error_samples_at(0, metric, r).sampling.size(), 2u);
}

// The control runs through the summary: of a spread by itself, of others as a share of the value.
TEST(Summaries, GridAndMethodFollowASpreadThroughTheControls) {
  Response r = response_of({1, 3});
  for (ResponsePoint& p : r.points) p.modulation.parts.grid = p.modulation.parts.method = 9;
  r.controls.own = {points_of({1, 3}), {points_of({1.1, 3}), points_of({0.9, 3.1})}};
  r.controls.coarse = {points_of({1.2, 3.5}), {points_of({1.2, 3.6}), points_of({1.1, 3.3})}};
  r.controls.areas = {points_of({0.9, 2.7}), {points_of({0.9, 2.6}), points_of({1.0, 2.7})}};
  const GridLaw law = grid_law(&PointQuantities::modulation);
  const auto reading = [](Summary summary) {
    return [=](const std::vector<ResponsePoint>& points) -> std::optional<double> {
      return Series({points[0].modulation.value, points[1].modulation.value}, {1, 1},
                    Better::Higher)
          .value(summary);
    };
  };
  const ControlledChange spread =
      controlled_change(r.controls, law, reading(Summary::Std), Change::Absolute);
  ASSERT_EQ(spread.grid.size(), 2u);
  ASSERT_EQ(spread.method.size(), 2u);
  EXPECT_NEAR(*of(Summary::Std, r).parts.grid, grid_error(spread.grid), 1e-12);
  EXPECT_NEAR(*of(Summary::Std, r).parts.method, method_error(spread.method), 1e-12);
  EXPECT_NEAR(*of(Summary::Mean, r).parts.grid, 9, 1e-12);  // its points have it
  const ControlledChange mean = controlled_change(r.controls, law, reading(Summary::Mean));
  const ErrorSamples samples = error_samples(Summary::Mean, kModulation, r),
                     of_spread = error_samples(Summary::Std, kModulation, r);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(samples.grid[k], 2 * mean.grid[k], 1e-12);
    EXPECT_NEAR(samples.method[k], 2 * mean.method[k], 1e-12);
    EXPECT_NEAR(of_spread.grid[k], spread.grid[k], 1e-12);
    EXPECT_NEAR(of_spread.method[k], spread.method[k], 1e-12);
  }
  const ControlledChange last = controlled_change(r.controls, law, reading(Summary::Last));
  EXPECT_NEAR(error_samples_at(1, kModulation, r).grid[0], 3 * last.grid[0], 1e-12);
}

// Eq. accuracy.11 by hand: half of up less down, of all and without each of two skins.
TEST(Summaries, StepsAreHalvedAndJackknifed) {
  ParameterStep one{{points_of({5}), {points_of({6}), points_of({5})}},
                    {points_of({1}), {points_of({1}), points_of({2})}}};
  const auto value = [](const std::vector<ResponsePoint>& points) -> std::optional<double> {
    const double v = points[0].modulation.value;
    return v < 0 ? std::nullopt : std::optional(v);
  };
  // 2, without each 2.5 and 1.5: samples 2 - 0.5 and 2 + 0.5.
  const StepSamples samples = step_samples({one, one}, value).value();
  EXPECT_EQ(samples, (StepSamples{{1.5, 2.5}, {1.5, 2.5}}));
  EXPECT_NEAR(step_error(samples), std::sqrt(2 * 4 * meant_share(4 / 0.25, 2, 2).value), 1e-12);
  EXPECT_EQ(step_error({{1, -1}}), 0);    // nothing moves
  EXPECT_GT(step_error({{1, -0.9}}), 0);  // scatters by more than it is: not known, not 0
  EXPECT_LT(step_error({{1, -0.9}}), 0.05);
  EXPECT_EQ(step_error({{-3}}), 3);
  EXPECT_EQ(step_error({}), 0);
  EXPECT_TRUE(step_samples({}, value)->empty());
  for (const auto place : {0, 1, 2}) {
    ParameterStep unknown = one;
    (place == 0   ? unknown.up.points
     : place == 1 ? unknown.down.points
                  : unknown.down.without[1])[0]
        .modulation.value = -1;
    EXPECT_FALSE(step_samples({one, unknown}, value)) << place;
  }
}

// Of the field part what its own pixels leave is that of the 3-D field itself, the rest is the
// design's own; a humidity without a pull has no correction.
TEST(Summaries, TheFieldPartIsSplitIntoWhatAllDesignsShareAndTheRest) {
  Response r = response_of({0.8, 0.6, 0});
  // By pixels 2 % and r²/R: 1.1 % at 0.9, 5.6 % at 0.79.
  const Values field{0.04, 0.03, 0}, corrections{0.9, 0.79, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    r.points[i].modulation.parts.field = field[i];
    r.points[i].field_correction = corrections[i];
    r.points[i].field_error = 0.1;
  }
  const FieldPart mean = error_samples(Summary::Mean, kModulation, r).field,
                  range = error_samples(Summary::Range, kModulation, r).field,
                  second = error_samples_at(1, kModulation, r).field;
  const Values share{std::hypot(0.02, 0.01 / 0.9) / 0.1, std::hypot(0.02, 0.0441 / 0.79) / 0.1};
  const Values rest{std::sqrt(1 - square(share[0])), std::sqrt(1 - square(share[1]))};
  EXPECT_NEAR(mean.common, (share[0] * 0.04 + share[1] * 0.03) / 3, 1e-12);
  EXPECT_NEAR(mean.own, (rest[0] * 0.04 + rest[1] * 0.03) / 3, 1e-12);
  EXPECT_NEAR(mean.error(), of(Summary::Mean, r).parts.field.value(), 0.03 * mean.error());
  ASSERT_EQ(mean.corrections.size(), 2u);
  EXPECT_NEAR(mean.corrections[1], std::log(0.79), 1e-12);
  EXPECT_NEAR(mean.of_skins, 0.1 * std::sqrt((square(rest[0]) + square(rest[1])) / 2), 1e-12);
  EXPECT_GT(range.own, 0);  // humidities differ by a part of it
  EXPECT_NEAR(second.own, rest[1] * 0.03, 1e-12);
  EXPECT_EQ(second.corrections.size(), 1u);
  EXPECT_TRUE(
      error_samples(Summary::Mean, parse_metric("friction").metric, r).field.corrections.empty());
}

// A stronger pull lowers the amplitude; how much stronger is that of the amplitude's own field,
// which a design without a drive has nowhere else.
TEST(Summaries, TheFieldPartOfAVoltageIsThatOfItsAmplitude) {
  Response r = response_of({0});
  VoltageAnswer there = answer(100, {});
  there.amplitude.parts.field = 2;
  there.field_correction = 0.8;
  there.field_error = std::hypot(0.02, 0.05) / 0.4;
  r.points[0].voltages = {there};
  const FieldPart part = error_samples(Summary::Mean, VoltageFor{0.3}, r).field;
  EXPECT_NEAR(part.common, -0.4 * 2, 1e-12);
  EXPECT_NEAR(part.own, -std::sqrt(1 - 0.16) * 2, 1e-12);
  EXPECT_NEAR(part.error(), of(Summary::Mean, r, VoltageFor{0.3}).parts.field.value(), 1e-12);
  ASSERT_EQ(part.corrections.size(), 1u);
  EXPECT_NEAR(part.corrections[0], std::log(0.8), 1e-12);
}

// Of fields that are alike nothing is left but what all corrections share of the difference; of
// others both parts, and between them it rises evenly.
TEST(Summaries, TheFieldPartOfADifferenceFallsAsTheFieldsAreAlike) {
  const auto part = [](double common, double own, double correction) {
    return FieldPart{common, own, {correction, correction}, 0.03};
  };
  const FieldPart a = part(0.016, 0.03, -0.3);
  EXPECT_NEAR(field_difference_error(a, part(0.01, 0.02, -0.3)), 0.006, 1e-12);
  EXPECT_NEAR(field_difference_error(a, part(0.016, 0.04, -0.2)), 0.05, 1e-12);
  // Half of what two skins scatter by apart: a quarter of the squares.
  const double half = 0.5 * 0.03 * std::sqrt(2);
  EXPECT_NEAR(field_difference_error(a, part(0.016, 0.04, -0.3 + half)), 0.025, 1e-12);
  FieldPart fewer = part(0.016, 0.04, -0.3);
  fewer.corrections.pop_back();  // not known of the same humidities
  EXPECT_NEAR(field_difference_error(a, fewer), 0.05, 1e-12);
  EXPECT_EQ(field_difference_error(a, a), 0);
  ErrorSamples one{{1, 2}, {}, {}, a}, other{{1, 2}, {}, {}, part(0.016, 0.04, -0.2)};
  EXPECT_NEAR(difference_error(one, other).value(), 0.05, 1e-12);
}

// Parts in squares, each from its pairs; of other skins none.
TEST(Summaries, ADifferenceHasItsPartsInSquares) {
  const ErrorSamples a{{1, 2, 6}, {0.5, 0.7}, {0.2, 0.4}}, b{{1, 1, 1}, {0.1, 0.1}, {0.1, 0.1}};
  const Values sampling{0, 1, 5}, grid{0.4, 0.6}, method{0.1, 0.3};
  EXPECT_NEAR(difference_error(a, b).value(),
              std::sqrt(square(mean_estimate(sampling).se) + square(grid_error(grid)) +
                        square(method_error(method))),
              1e-12);
  EXPECT_NEAR(difference_error(b, a).value(), difference_error(a, b).value(), 1e-12);
  EXPECT_FALSE(difference_error(a, {{1, 1, 1}, {0.1, 0.1}, {0.1}}));
  EXPECT_FALSE(difference_error({{1}, {}, {}}, {{1}, {}, {}}));  // one skin has no scatter
  EXPECT_TRUE(difference_error({{1, 2}, {}, {}}, {{1, 4}, {}, {}}));
}

}  // namespace
}  // namespace papilla::tests::summaries_test
