#include "metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace papilla {
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
}  // namespace papilla
