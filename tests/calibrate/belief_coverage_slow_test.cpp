// Coverage by planted truth: fingers drawn from what is believed before any data, their frictions
// with noise, a belief fitted to them, and its 95 % bars of what was in no table. The table that it
// prints stands in docs/measured/validation.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "design/design.h"
#include "estimate/belief.h"
#include "metrics/metrics.h"
#include "tests/calibrate/files.h"
#include "tests/support/thorough.h"

namespace papilla::tests::belief_coverage_slow_test {
namespace {

using BeliefCoverageSlow = Calibrate;

const int kTruths = cases(1, 20);                                        // the page is of all
constexpr double kNoise = 0.05;                                          // of each friction
constexpr const char* kHumidities[] = {"15 %", "30 %", "45 %", "75 %"};  // of flat glass
constexpr const char* kPredicted = "a3h600";                             // at 55 %

// The priors, all by a factor, are those of the shipped finger's own fit.
constexpr const char* kFit = R"(schema_version = 1
finger = "fingers/reference.toml"
data = "planted.csv"
iterations = 4
[sampling]
level = "draft"
grid = 32
skins = 4
[check]
level = "draft"
grid = 32
skins = 4
[parameters]
"macro.load_share" = { low = 0.001, high = 0.05, prior = 0.0063, factor = 2.0 }
"skin.rms" = { low = "150 nm", high = "450 nm", prior = "256 nm", factor = 1.2 }
"skin.layer_modulus" = { low = "10 MPa", high = "500 MPa", prior = "66 MPa", factor = 2.0 }
"skin.softening" = { low = 1.2, high = 4.0, prior = 2.08, factor = 1.12 }
"electrical.thickness_15" = { low = "5 nm", high = "200 nm", prior = "30 nm", factor = 1.6 }
"electrical.thickness_75" = { low = "5 nm", high = "200 nm", prior = "17 nm", factor = 1.6 }
"water.volume.3" = { low = "4 um3", high = "11 um3", prior = "7.5 um3", factor = 1.35 }
[belief]
starts = 1
samples = 60
members = 32
)";

Fidelity fidelity() {
  Fidelity f = fidelity_level("draft");
  f.grid = 32;
  f.skins = 4;
  f.field_skins = f.control_skins = 0;
  return f;
}

// Numbers of the priors, within their bounds.
std::vector<double> drawn(const Calibration& c, RandomStream& random) {
  std::vector<double> values;
  for (const CalibrationParameter& p : c.parameters) {
    double v = 0;
    do {
      v = p.fit.prior * std::exp(p.fit.prior_sd * random.normal());
    } while (v < p.fit.low || v > p.fit.high);
    values.push_back(v);
  }
  return values;
}

struct Held {
  int by_deviation = 0, by_quantiles = 0, all = 0;

  void count(const BeliefValues& over, double value, double truth) {
    ++all;
    by_deviation += std::abs(truth - value) <= normal_quantile(0.975) * over.deviation();
    by_quantiles += over.quantile(0.025) <= truth && truth <= over.quantile(0.975);
  }
  std::string row(const char* name) const {
    const double p = static_cast<double>(by_deviation) / all;
    return fmt::format("| {} | {} of {}: {:.0f} ± {:.0f} % | {} |\n", name, by_deviation, all,
                       100 * p, 100 * std::sqrt(p * (1 - p) / all), by_quantiles);
  }
};

TEST_F(BeliefCoverageSlow, HoldsTheTruthOfAnotherTextureAndHumidity) {
  const auto table = [&](const std::vector<double>& forces) {
    std::string text = kHeader;
    std::size_t k = 0;
    for (const char* humidity : kHumidities) {
      text += fmt::format("m3_samples/flat.toml,{},200,5000,0.2,{},{},{},{}\n", humidity, forces[k],
                          kNoise * forces[k], forces[k + 1], kNoise * forces[k + 1]);
      k += 2;
    }
    write("planted.csv", text);
    return read(write("fit.toml", kFit));
  };
  const Calibration blank = table(std::vector<double>(8, 0.1));
  Design predicted = read_design(find_design(fmt::format("m3_samples/{}.toml", kPredicted)));
  predicted.environment.relative_humidity = {0.55};
  predicted.environment.weights.clear();
  const auto at = [&](const Finger& finger) {
    Scene scene = scene_of(predicted);
    scene.finger = finger;
    scene.finger.load = predicted.finger.load;
    scene.model = finger.calibrated_for;
    return scene;
  };
  Held friction, modulation;
  double effective = 0;
  for (int k = 0; k < kTruths; ++k) {
    RandomStream random(1, "planted truth", static_cast<std::uint64_t>(k));
    const std::vector<double> values = drawn(blank, random);
    const Finger truth = with_parameters(blank, values);
    Residuals residuals(blank, 1);
    residuals.correct(blank, values);
    std::vector<double> forces;
    for (const Estimate& e : residuals.model(blank, values))
      forces.push_back(1e-3 * e.value * (1 + kNoise * random.normal()));
    CalibrationOptions options;
    options.threads = 1;
    options.check = false;
    CalibrationResult r = fit_finger(table(forces), options);
    effective += r.belief->belief.effective_samples / kTruths;
    r.finger.belief = write("belief.toml", belief_text(r.belief->belief));
    const Scene scene = at(r.finger);
    Response response = evaluate(scene, predicted.texture, fidelity());
    add_belief(response, scene, predicted.texture, fidelity());
    const Response of_truth = evaluate(at(truth), predicted.texture, fidelity());
    const auto held = [&](const QuantityMetric& metric, Held& out) {
      out.count(*belief_values_at(0, metric, response), (response.points[0].*metric.quantity).value,
                (of_truth.points[0].*metric.quantity).value);
    };
    held(kFriction, friction);
    held(kModulation, modulation);
  }
  fmt::print(
      "| prediction | ± 1.96 model holds | quantiles hold |\n|---|---|---|\n{}{}samples are "
      "worth {:.0f} in the mean\n",
      friction.row("friction, a3h600 at 55 %"), modulation.row("modulation, a3h600 at 55 %"),
      effective);
  const int held = friction.by_deviation + modulation.by_deviation;
  EXPECT_GE(held, std::floor(0.90 * 2 * kTruths));
  EXPECT_GT(effective, 15);
}

}  // namespace
}  // namespace papilla::tests::belief_coverage_slow_test
