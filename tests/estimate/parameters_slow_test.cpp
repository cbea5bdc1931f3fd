// The parameter part of the reference finger against draws from its covariance.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "base/constants.h"
#include "base/random.h"
#include "design/design.h"
#include "estimate/parameters.h"
#include "metrics/metrics.h"

namespace papilla::tests::parameters_slow_test {
namespace {

TEST(ParametersSlow, OfTheReferenceFingerEqualDrawsFromItsCovariance) {
  constexpr int kDraws = 48;
  const Design design = read_design(find_design("m3_samples/a3h600.toml"));
  const Scene scene = scene_of(design);
  Fidelity f = fidelity_level("draft");
  f.grid = 64;
  f.skins = 16;
  f.control_skins = 0;
  Response r = evaluate(scene, design.texture, f);
  add_parameter_errors(r, scene, design.texture, f);

  const std::size_t n = scene.finger.uncertainty.size();
  const std::vector<double> factor = covariance_factor(scene.finger.uncertainty);
  const std::array<MetricExpression, 3> kinds{{{Summary::Mean, kModulation},
                                               {Summary::Variation, kModulation},
                                               {Summary::Mean, kFriction}}};
  std::array<std::vector<double>, kinds.size()> values;
  RandomStream random(1, "parameter draws", 0);
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> logarithms(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const double z = random.normal();
      for (std::size_t i = k; i < n; ++i) logarithms[i] += factor[i * n + k] * z;
    }
    Scene drawn = scene;
    drawn.finger = moved_finger(scene.finger, logarithms);
    const Response there = evaluate(drawn, design.texture, f);
    for (std::size_t q = 0; q < kinds.size(); ++q)
      values[q].push_back(summarise(kinds[q].summary, kinds[q].metric, there)->value);
  }
  for (std::size_t q = 0; q < kinds.size(); ++q) {
    double mean = 0, variance = 0;
    for (const double v : values[q]) mean += v / kDraws;
    for (const double v : values[q]) variance += square(v - mean) / (kDraws - 1);
    const auto stated = summarise(kinds[q].summary, kinds[q].metric, r);
    const double ratio = *stated->parts.parameters / std::sqrt(variance);
    std::cout << metric_text(kinds[q]) << ": stated " << *stated->parts.parameters / stated->value
              << ", drawn " << std::sqrt(variance) / mean << " of the value\n";
    // The scatter of a standard deviation of 48 draws is 10 %; the rest is curvature.
    EXPECT_NEAR(ratio, 1, 0.35) << metric_text(kinds[q]);
  }
}

}  // namespace
}  // namespace papilla::tests::parameters_slow_test
