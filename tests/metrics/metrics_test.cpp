#include "metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace papilla::tests {
namespace {

Response response_of(std::vector<double> modulation, std::vector<double> weights = {}) {
  Response response;
  response.driven = true;
  for (std::size_t i = 0; i < modulation.size(); ++i) {
    ResponsePoint point;
    point.modulation.value = modulation[i];
    point.weight = weights.empty() ? 1 : weights[i];
    response.points.push_back(point);
  }
  return response;
}

TEST(Metrics, VariationIsThePopulationStandardDeviationOverTheMean) {
  // mean 3, variance (4 + 1 + 1 + 4)/4 = 2.5
  const Response r = response_of({1, 2, 4, 5});
  EXPECT_DOUBLE_EQ(summarise(Summary::Mean, "modulation", r)->value, 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Variation, "modulation", r)->value, std::sqrt(2.5) / 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Range, "modulation", r)->value, 4.0 / 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Worst, "modulation", r)->value, 1);
}

TEST(Metrics, WeightsCount) {
  const Response r = response_of({1, 3}, {3, 1});
  EXPECT_DOUBLE_EQ(summarise(Summary::Mean, "modulation", r)->value, 1.5);
  EXPECT_DOUBLE_EQ(summarise(Summary::Std, "modulation", r)->value, std::sqrt(0.75));
}

TEST(Metrics, AnUndrivenDesignHasNoModulation) {
  Response r = response_of({0, 0});
  r.driven = false;
  EXPECT_FALSE(summarise(Summary::Mean, "modulation", r));
}

TEST(Metrics, VariationOfAZeroMeanIsUndefined) {
  EXPECT_FALSE(summarise(Summary::Variation, "modulation", response_of({-1, 1})));
}

// What a skin or a grid does to all humidities alike moves the mean and leaves the variation.
TEST(Metrics, WhatHumiditiesShareIsNoErrorOfTheirSpread) {
  const std::vector<double> base{1, 2, 4, 5};
  const auto scaled = [&](double factor) {
    std::vector<double> out = base;
    for (double& v : out) v *= factor;
    return response_of(out).points;
  };
  Response r = response_of(base);
  for (ResponsePoint& p : r.points) {
    p.modulation.parts.sampling = 0.1 * p.modulation.value;
    p.modulation.parts.grid = 0.2 * p.modulation.value;
  }
  const SummaryValue bound = *summarise(Summary::Variation, "modulation", r);
  EXPECT_GT(bound.parts.sampling, 0.05 * bound.value);  // all that the points alone can say
  EXPECT_GT(bound.parts.grid.value(), 0.1 * bound.value);
  for (double factor : {0.9, 1.0, 1.1}) r.without.push_back(scaled(factor));
  r.controls.own.points = scaled(1);
  r.controls.coarse.points = scaled(1.2);
  for (int k = 0; k < 2; ++k) {
    r.controls.own.without.push_back(scaled(1));
    r.controls.coarse.without.push_back(scaled(1.2));
  }
  const SummaryValue variation = *summarise(Summary::Variation, "modulation", r),
                     mean = *summarise(Summary::Mean, "modulation", r);
  EXPECT_NEAR(variation.parts.sampling, 0, 1e-12);
  EXPECT_NEAR(variation.parts.grid.value(), 0, 1e-12);
  EXPECT_NEAR(mean.parts.sampling, 3 * 2 * 0.1 / std::sqrt(3), 1e-12);  // jackknife of 3 skins
  // A skin that matters at one humidity alone does move the spread.
  r.without[0][3].modulation.value += 1;
  EXPECT_NEAR(summarise(Summary::Variation, "modulation", r)->parts.sampling,
              2.0 / 3 * (std::sqrt(3.1125) / 2.95 - std::sqrt(2.5) / 3), 1e-12);
}

TEST(Metrics, TheErrorOfADifferenceIsThatOfItsPairs) {
  const ErrorSamples a{{1, 2, 3}, {0.1, 0.1}, {}}, b{{1.5, 2.5, 3.5}, {0.1, 0.1}, {}};
  EXPECT_NEAR(*difference_error(a, b), 0, 1e-12);  // the same on every skin
  const ErrorSamples c{{3, 2, 1}, {-0.1, -0.1}, {}};
  // Sampling: 2, 0, -2 has the standard error 2 / sqrt(3); the grid moves them apart by 0.2.
  EXPECT_NEAR(*difference_error(a, c), std::sqrt(4.0 / 3 + 0.04), 1e-12);
  EXPECT_FALSE(difference_error(a, {{1, 2}, {0.1, 0.1}, {}}));
  EXPECT_FALSE(difference_error(a, {{1, 2, 3}, {}, {}}));
  EXPECT_FALSE(difference_error({}, {}));
}

TEST(Metrics, ExpressionsAreReadAndMisspellingsAreNamed) {
  EXPECT_EQ(metric_text(parse_metric("variation(modulation)")), "variation(modulation)");
  EXPECT_EQ(metric_text(parse_metric("friction")), "mean(friction)");
  try {
    parse_metric("mean(modulatoin)");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"modulation\""), std::string::npos);
  }
  EXPECT_THROW(parse_metric("median(friction)"), InputError);
}

}  // namespace
}  // namespace papilla::tests
