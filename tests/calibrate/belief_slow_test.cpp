// A belief of a truth that was planted in solved patches, and what it says of another surface.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "design/design.h"
#include "estimate/belief.h"
#include "metrics/metrics.h"
#include "tests/calibrate/files.h"

namespace papilla::tests::belief_slow_test {
namespace {

using FitBeliefSlow = Calibrate;

constexpr const char* kFit = R"(schema_version = 1
finger = "fingers/reference.toml"
data = "planted.csv"
iterations = 8
[sampling]
level = "draft"
grid = 32
skins = 4
[check]
level = "draft"
grid = 32
skins = 4
[parameters]
"macro.shear_strength" = { low = "3 MPa", high = "30 MPa", prior = "9 MPa", factor = 1.5 }
"skin.layer_modulus" = { low = "10 MPa", high = "500 MPa", prior = "66 MPa", factor = 2.0 }
[belief]
starts = 2
samples = 150
members = 16
)";

// Frictions of flat glass, 5 % each, of a finger of 11 MPa and 90 MPa. They tell the product of
// area and strength, not either: members lie along a valley, and hold the truth.
TEST_F(FitBeliefSlow, HoldsATruthThatThePatchesWerePlantedWith) {
  const auto table = [&](const std::vector<double>& forces) {
    std::string text = kHeader;
    const char* humidity[] = {"15 %", "35 %", "75 %"};
    for (std::size_t k = 0; k < forces.size(); ++k)
      text += fmt::format("m3_samples/flat.toml,{},0,0,0.2,{},{},,\n", humidity[k], forces[k],
                          0.05 * forces[k]);
    write("planted.csv", text);
    return read(write("fit.toml", kFit));
  };
  const Calibration blank = table({0.1, 0.1, 0.1});
  const std::vector<double> values{11e6, 90e6};
  const Finger truth = with_parameters(blank, values);
  Residuals residuals(blank, 2);
  residuals.correct(blank, values);
  residuals.follow(blank, values);
  std::vector<double> forces;
  for (const Estimate& e : residuals.model(blank, values)) forces.push_back(1e-3 * e.value);
  const Calibration calibration = table(forces);
  CalibrationOptions options;
  options.threads = 2;
  options.check = false;
  const CalibrationResult r = fit_finger(calibration, options);
  const BeliefFit& b = *r.belief;
  EXPECT_GT(b.belief.effective_samples, 30);
  EXPECT_LT(b.largest_mean, 0.2);
  // Three rows of 5 %: by what was measured members know each better than its datum.
  // Corrected as the fit's own rows are: at the fitted finger.
  Residuals own(calibration, 2);
  own.correct(calibration, r.fit.values());
  own.follow(calibration, r.fit.values());
  std::vector<double> mean(forces.size(), 0), squares(forces.size(), 0);
  for (const BeliefMember& member : b.belief.members) {
    const Finger at = with_member(b.belief, member, r.finger, r.finger.calibrated_for).finger;
    const std::vector<double> there{at.macro.shear_strength, at.skin.layer_modulus};
    const std::vector<Estimate> rows = own.model(calibration, there);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double share = 1e-3 * rows[k].value / forces[k];
      mean[k] += member.weight * share;
      squares[k] += member.weight * share * share;
    }
  }
  // By the rows as they were learnt; what the model's own answers jitter by about these on so few
  // pixels comes on top (Eq. calibration.11).
  own.weigh(calibration, r.fit.values());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Posterior& posterior = b.hypotheses.front().posterior;
    const double unit = 1e-3 * own.rows()[k].own_deviation() / forces[k];
    // What a reading of 5 % on four skins says of a force, which all three readings have in common.
    const double datum = unit * own.common().deviation(k);
    EXPECT_GT(datum, 0.05) << k;
    double learnt = 0, learnt_mean = 0;
    for (const PosteriorSample& s : posterior.samples) {
      learnt_mean += s.weight * unit * s.answers[k];
      learnt += s.weight * square(unit * s.answers[k]);
    }
    learnt = std::sqrt(learnt - square(learnt_mean));
    const double deviation = std::sqrt(squares[k] - mean[k] * mean[k]);
    EXPECT_GT(deviation, 0.01) << k;
    EXPECT_LT(learnt, datum) << k;
    EXPECT_LT(deviation, 2.5 * datum)  // docs/measured/validation.md: too wide, never too narrow
        << k;
  }
  // Members through the file, on the design of the fit and on another one. They run without the
  // correction for what so few pixels leave out, which moves with the modulus: their bars are wider
  // than the rows' (docs/measured/validation.md), and hold the truth.
  Design d = read_design(find_design("m3_samples/flat.toml"));
  d.finger = r.finger;
  d.finger.belief = write("belief.toml", belief_text(b.belief));
  Fidelity f = fidelity_level("draft");  // with the control skins that data are corrected by
  f.grid = 32;
  f.skins = 4;
  f.field_skins = 0;
  const auto stated = [&](const Design& design) {
    Response out = evaluate(scene_of(design), design.texture, f);
    add_belief(out, scene_of(design), design.texture, f);
    return *belief_values(Summary::Mean, kFriction, out);
  };
  const auto of_truth = [&](const Design& design) {
    Design there = design;
    there.finger = truth;
    there.finger.load = design.finger.load;
    const Response out = evaluate(scene_of(there), there.texture, f);
    return summarise(Summary::Mean, kFriction, out)->value;
  };
  for (const char* name : {"flat", "a3h600"}) {
    Design other = read_design(find_design(std::string("m3_samples/") + name + ".toml"));
    other.finger = d.finger;
    const BeliefValues over = stated(other);
    const double share = over.deviation() / of_truth(other);
    EXPECT_GT(share, 0.01) << name;
    EXPECT_LE(over.quantile(0.025), of_truth(other)) << name;
    EXPECT_GE(over.quantile(0.975), of_truth(other)) << name;
  }
}

}  // namespace
}  // namespace papilla::tests::belief_slow_test
