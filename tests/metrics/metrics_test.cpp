#include "metrics/metrics.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "metrics/series.h"
#include "metrics/shown.h"

namespace papilla::tests::metrics_test {
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
  EXPECT_DOUBLE_EQ(summarise(Summary::Mean, kModulation, r)->value, 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Variation, kModulation, r)->value, std::sqrt(2.5) / 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Range, kModulation, r)->value, 4.0 / 3);
  EXPECT_DOUBLE_EQ(summarise(Summary::Worst, kModulation, r)->value, 1);
}

TEST(Metrics, ASummaryShiftsByWhatItsValuesChangeBy) {
  const Series series({1, 2, 4, 5}, {1, 1, 1, 1}, Better::Higher);
  EXPECT_NEAR(series.shift(Summary::Mean, {0.4, -0.2, 0.4, -0.2}), 0.1, 1e-15);
  EXPECT_NEAR(series.shift(Summary::Worst, {-3, 0, 0, 0}), -3, 1e-15);
  // Twice all values: as much variation, and twice the spread.
  EXPECT_NEAR(series.shift(Summary::Variation, {1, 2, 4, 5}), 0, 1e-15);
  EXPECT_NEAR(series.shift(Summary::Std, {1, 2, 4, 5}), std::sqrt(2.5), 1e-15);
  EXPECT_EQ(series.shift(Summary::Variation, {-1, -2, -4, -5}), 0);  // of nothing: not defined
}

TEST(Metrics, WeightsCount) {
  const Response r = response_of({1, 3}, {3, 1});
  EXPECT_DOUBLE_EQ(summarise(Summary::Mean, kModulation, r)->value, 1.5);
  EXPECT_DOUBLE_EQ(summarise(Summary::Std, kModulation, r)->value, std::sqrt(0.75));
}

TEST(Metrics, AnUndrivenDesignHasNoModulation) {
  Response r = response_of({0, 0});
  r.driven = false;
  EXPECT_FALSE(summarise(Summary::Mean, kModulation, r));
  EXPECT_EQ(why_undefined(kModulation, r), "not driven (0 V)");
  EXPECT_EQ(why_undefined(kFriction, r), "");
  r.driven = true;
  EXPECT_EQ(why_undefined(kModulation, r), "");
}

TEST(Metrics, AreKnownWhereTheirStateExists) {
  const auto known = [](const ResponsePoint& point) {
    std::vector<std::string> out;
    for (const char* name : {"friction", "contact_area", "modulation", "friction_on", "mean_gap",
                             "felt(modulation = 0.2)", "drive.amplitude", "pull_in_margin"})
      if (is_known(parse_metric(fmt::format("mean({})", name)).metric, point)) out.push_back(name);
    return out;
  };
  const std::vector<std::string> of_no_state{"mean_gap", "drive.amplitude", "pull_in_margin"};
  ResponsePoint p;
  EXPECT_EQ(known(p).size(), 8u);
  p.oxide_margin = 0.5;
  std::vector<std::string> undriven{"friction", "contact_area"};
  undriven.insert(undriven.end(), of_no_state.begin(), of_no_state.end());
  EXPECT_EQ(known(p), undriven);
  p.area_fraction_off.value = 1.5;
  EXPECT_EQ(known(p), of_no_state);
}

TEST(Metrics, VariationOfAZeroMeanIsUndefined) {
  EXPECT_FALSE(summarise(Summary::Variation, kModulation, response_of({-1, 1})));
}

// What a skin or a grid does to all humidities alike moves the mean and leaves the variation.
// What a small change of each value does to the summary, taken from its own differences.
TEST(Metrics, ErrorsOfASummaryAreThoseOfItsDerivatives) {
  const std::vector<double> values{1, 2.5, 4, 5}, weights{1, 2, 3, 2},
      errors{0.02, 0.01, 0.03, 0.04};
  const auto value = [&](Summary summary, std::size_t moved, double by) {
    std::vector<double> v = values;
    v[moved] += by;
    return summarise(summary, kModulation, response_of(v, weights))->value;
  };
  for (const Summary summary : {Summary::Mean, Summary::Std, Summary::Variation, Summary::Range,
                                Summary::Worst, Summary::Best, Summary::First, Summary::Last}) {
    Response r = response_of(values, weights);
    double linear = 0, squares = 0, spread = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      r.points[i].modulation.parts.sampling = errors[i];
      r.points[i].modulation.parts.grid = 2 * errors[i];
      const double slope = (value(summary, i, 1e-6) - value(summary, i, -1e-6)) / 2e-6;
      linear += slope * errors[i];
      squares += square(slope * errors[i]);
    }
    // Of a quotient by the mean: its parts, of the spread and of the mean, in squares.
    const double mean = value(Summary::Mean, 0, 0), mean_error = 0.0262500000;
    if (summary == Summary::Variation) {
      double deviation = 0;
      for (std::size_t i = 0; i < values.size(); ++i)
        deviation += square((value(Summary::Std, i, 1e-6) - value(Summary::Std, i, -1e-6)) / 2e-6 *
                            errors[i]);
      spread = std::sqrt(deviation + square(value(Summary::Variation, 0, 0) * mean_error)) / mean;
    } else if (summary == Summary::Range) {
      spread = std::hypot(errors[0], errors[3]) / mean;
    }
    const double expected = spread > 0                 ? spread
                            : summary == Summary::Mean ? linear
                                                       : std::sqrt(squares);
    const SummaryValue out = *summarise(summary, kModulation, r);
    EXPECT_NEAR(out.parts.sampling, expected, 1e-8) << static_cast<int>(summary);
    EXPECT_NEAR(out.parts.grid.value(), 2 * expected, 1e-8) << static_cast<int>(summary);
  }
}

// Each name its own number, and the better direction that decides what is worst.
TEST(Metrics, EveryNameIsTheQuantityThatItSays) {
  ResponsePoint p;
  for (std::size_t k = 0; k < kPointQuantities.size(); ++k)
    (p.*kPointQuantities[k].value).value = 1.0 + static_cast<double>(k);
  p.patch_pressure = 8;
  p.indentation.parts = {.sampling = 0.5, .grid = 0.25};
  for (const auto& [name, value] : {std::pair{"friction", p.friction_off.value},
                                    {"friction_on", p.friction_on.value},
                                    {"modulation", p.modulation.value},
                                    {"contact_area", p.area_fraction_off.value},
                                    {"capillary_force", p.capillary_force.value},
                                    {"adhesion", p.capillary_force.value},
                                    {"electrostatic_force", p.electrostatic_force.value},
                                    {"retention_force", p.retention_force.value},
                                    {"bridges", p.bridges.value},
                                    {"wetted_fraction", p.wetted_fraction.value},
                                    {"mean_gap", p.mean_gap.value},
                                    {"compliance", p.indentation.value / 8}})
    EXPECT_DOUBLE_EQ(metric_at(*find_metric(name), p)->value, value) << name;
  EXPECT_DOUBLE_EQ(metric_at(Compliance{}, p)->parts.sampling, 0.5 / 8);
  EXPECT_DOUBLE_EQ(metric_at(Compliance{}, p)->parts.grid.value(), 0.25 / 8);
  p.capillary_force.value = -1;  // it pushes off
  EXPECT_EQ(metric_at(Adhesion{}, p)->value, 0);
  EXPECT_EQ(metric_at(QuantityMetric{&PointQuantities::capillary_force}, p)->value, -1);
  Optics look;
  look.haze = 0.1, look.transmittance = 0.2, look.gloss = 0.3, look.colour_shift = 0.4;
  look.total_transmittance = 0.5, look.gloss_20 = 0.6, look.gloss_85 = 0.7;
  look.distinctness = 0.8, look.sparkle = 0.9;
  for (const auto& [name, value] : {std::pair{"haze", 0.1},
                                    {"transmittance", 0.2},
                                    {"gloss", 0.3},
                                    {"colour_shift", 0.4},
                                    {"total_transmittance", 0.5},
                                    {"gloss_20", 0.6},
                                    {"gloss_85", 0.7},
                                    {"distinctness", 0.8},
                                    {"sparkle", 0.9}})
    EXPECT_EQ(look.*std::get<LookMetric>(*find_metric(name)).number, value) << name;
  for (const auto& [name, better] : {std::pair{"modulation", Better::Higher},
                                     {"friction", Better::Lower},
                                     {"friction_on", Better::Higher},
                                     {"adhesion", Better::Lower},
                                     {"compliance", Better::Neither},
                                     {"haze", Better::Lower},
                                     {"transmittance", Better::Higher},
                                     {"total_transmittance", Better::Higher},
                                     {"gloss", Better::Higher},
                                     {"gloss_20", Better::Higher},
                                     {"gloss_85", Better::Higher},
                                     {"distinctness", Better::Higher},
                                     {"sparkle", Better::Lower},
                                     {"colour_shift", Better::Lower}})
    EXPECT_EQ(info_of(*find_metric(name)).better, better) << name;
  std::set<std::string> driven;
  for (const MetricInfo& info : metric_list())
    if (info.needs_drive) driven.insert(info.name);
  EXPECT_EQ(driven, (std::set<std::string>{"modulation", "friction_on", "electrostatic_force",
                                           "drive.amplitude", "felt", "pull_in_margin"}));
}

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
  const SummaryValue bound = *summarise(Summary::Variation, kModulation, r);
  EXPECT_GT(bound.parts.sampling, 0.05 * bound.value);  // all that the points alone can say
  EXPECT_GT(bound.parts.grid.value(), 0.1 * bound.value);
  for (double factor : {0.9, 1.0, 1.1}) r.without.push_back(scaled(factor));
  r.controls.own.points = scaled(1);
  r.controls.coarse.points = scaled(1.2);
  for (int k = 0; k < 2; ++k) {
    r.controls.own.without.push_back(scaled(1));
    r.controls.coarse.without.push_back(scaled(1.2));
  }
  const SummaryValue variation = *summarise(Summary::Variation, kModulation, r),
                     mean = *summarise(Summary::Mean, kModulation, r);
  EXPECT_NEAR(variation.parts.sampling, 0, 1e-12);
  EXPECT_NEAR(variation.parts.grid.value(), 0, 1e-12);
  EXPECT_NEAR(mean.parts.sampling, 3 * 2 * 0.1 / std::sqrt(3), 1e-12);  // jackknife of 3 skins
  // A skin that matters at one humidity alone does move the spread.
  r.without[0][3].modulation.value += 1;
  EXPECT_NEAR(summarise(Summary::Variation, kModulation, r)->parts.sampling,
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

// Half of all people feel an effect at their Weber fraction; its errors soften the step.
TEST(Felt, IsTheShareThatWouldNotice) {
  Response r;
  r.driven = true;
  for (const double m : {0.1, 0.2, 0.3, 0.6}) {
    ResponsePoint p;
    p.modulation = {m, {.sampling = 0.05}};
    r.points.push_back(p);
  }
  const auto felt = [&](const char* text) {
    const MetricExpression e = parse_metric(text);
    return summarise(e.summary, e.metric, r)->value;
  };
  EXPECT_NEAR(felt("felt(modulation = 0.2)"), (0.02275 + 0.5 + 0.97725 + 1) / 4, 1e-4);
  EXPECT_NEAR(felt("worst(felt(modulation=0.2))"), 0.02275, 1e-5);
  // Whether one feels it is yes or no: sqrt(p (1 - p)) at each humidity, common to all of them.
  const auto mean = *summarise(Summary::Mean, Felt{0.2}, r);
  EXPECT_NEAR(mean.parts.sampling, (2 * 0.14910 + 0.5 + 0) / 4, 1e-4);
  // Each part of the modulation's error has its share: 3 and 4 make 5.
  ResponsePoint& edge = r.points[1];
  edge.modulation.parts = {.sampling = 0.03, .parameters = 0.04, .water = 0.2};
  const Measured there = *metric_at(Felt{0.2}, edge);
  EXPECT_NEAR(there.parts.sampling, 0.5 * 3 / 5, 1e-12);
  EXPECT_NEAR(*there.parts.parameters, 0.5 * 4 / 5, 1e-12);
  EXPECT_FALSE(there.parts.water);
  for (ResponsePoint& p : r.points) p.modulation.parts = {};
  EXPECT_EQ(felt("felt(modulation = 0.25)"), 0.5);
  EXPECT_EQ(metric_at(Felt{0.25}, edge)->se(), 0);
  EXPECT_EQ(metric_text(parse_metric("felt( modulation=0.2 )")), "mean(felt(modulation = 0.2))");
  for (const char* wrong : {"felt", "felt(friction = 1)", "felt(modulation = -1)", "felter"})
    EXPECT_THROW(parse_metric(wrong), InputError) << wrong;
  r.driven = false;
  EXPECT_FALSE(summarise(Summary::Mean, Felt{0.2}, r));
}

// What the fit of the finger leaves open moves all humidities together: two of four change sides
// between the finger one standard deviation stronger and the one weaker.
TEST(Felt, HasTheErrorOfTheFinger) {
  const auto points = [](double shift) {
    std::vector<ResponsePoint> out;
    for (const double m : {0.05, 0.19, 0.21, 0.6}) {
      ResponsePoint p;
      p.modulation = {m + shift, {}};
      out.push_back(p);
    }
    return out;
  };
  Response r;
  r.driven = true;
  r.points = points(0);
  r.parameters.steps = {{{points(0.05), {}}, {points(-0.05), {}}}};
  const auto share = *summarise(Summary::Mean, Felt{0.2}, r);
  EXPECT_EQ(share.value, 0.5);
  EXPECT_EQ(share.parts.parameters, (0.75 - 0.25) / 2);
}

TEST(Amplitude, IsWhatTheSourceApplies) {
  Response r;
  r.driven = true;
  for (const double volts : {120.0, 150.0}) {
    ResponsePoint p;
    p.source_voltage = volts;
    r.points.push_back(p);
  }
  EXPECT_EQ(summarise(Summary::Mean, SourceAmplitude{}, r)->value, 135);
  EXPECT_EQ(summarise(Summary::Worst, SourceAmplitude{}, r)->value, 150);  // less is better
  r.driven = false;
  EXPECT_FALSE(summarise(Summary::Mean, SourceAmplitude{}, r));
}

TEST(Metrics, ErrorsAreShownInTheUnitsOfTheirValues) {
  const MetricExpression friction = parse_metric("mean(friction)"),
                         variation = parse_metric("variation(friction)");
  EXPECT_EQ(shown_value(friction, 0.1234, false), "123.4");
  EXPECT_EQ(shown_error(friction, 0.00123), "1.2");  // mN
  EXPECT_EQ(shown_error(variation, 0.01234), "0.012");
  EXPECT_EQ(shown_error(parse_metric("mean(mean_gap)"), 43.2e-9), "43");  // nm
}

}  // namespace
}  // namespace papilla::tests::metrics_test
