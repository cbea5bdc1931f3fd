// A belief from a calibration: of one number in closed form, resumed, written and used.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "base/constants.h"
#include "base/watch.h"
#include "design/design.h"
#include "report/fit.h"
#include "report/fit_folder.h"
#include "tests/calibrate/files.h"
#include "tests/support/refusal.h"

namespace papilla::tests::belief_test {
namespace {

using FitBelief = Calibrate;

// A growth of 58.5 ± 3 % by the paper and 56 ± 4 % by a prior; cheap, as no patch is solved.
constexpr const char* kGrowth = R"(schema_version = 1
finger = "finger.toml"
fit = ["M3"]
[check]
level = "draft"
grid = 32
skins = 4
[parameters]
"macro.area_growth" = { low = "20 %", high = "120 %", start = "56 %", prior = "56 %", sd = "4 %" }
[belief]
starts = 2
samples = 600
members = 24
)";

CalibrationOptions quick() {
  CalibrationOptions out;
  out.threads = 1;
  out.check = false;
  return out;
}

TEST_F(FitBelief, OfOneNumberIsTheClosedForm) {
  write("finger.toml", "schema_version = 1\n");
  const Calibration c = read(write("fit.toml", kGrowth));
  const CalibrationResult r = fit_finger(c, quick());
  ASSERT_TRUE(r.belief);
  const BeliefFit& b = *r.belief;
  const double mean = (16 * 0.585 + 9 * 0.56) / 25, deviation = 0.03 * 4 / 5;
  EXPECT_EQ(b.variance_factor, 1);
  EXPECT_GT(b.hypotheses[0].posterior.effective, 300);
  double middle = 0, squares = 0;
  for (const BeliefMember& m : b.belief.members) {
    const double v =
        with_member(b.belief, m, r.finger, r.finger.calibrated_for).finger.macro.area_growth;
    middle += m.weight * v;
    squares += m.weight * square(v);
  }
  EXPECT_LE(b.belief.members.size(), 24u);
  EXPECT_NEAR(middle, mean, 0.15 * deviation);
  EXPECT_NEAR(std::sqrt(squares - square(middle)), deviation, 0.1 * deviation);
  EXPECT_LT(b.largest_mean, 0.05);
  EXPECT_NEAR(b.least_spread, 1, 0.05);
  EXPECT_NE(calibration_markdown(c, r).find("## Belief"), std::string::npos);
  EXPECT_NE(calibration_json(c, r).find("\"effective_samples\""), std::string::npos);
  // Without the section there is none.
  Calibration plain = c;
  plain.belief.reset();
  EXPECT_FALSE(fit_finger(plain, quick()).belief);
}

// A hypothesis that no row feels predicts as well: one half each.
TEST_F(FitBelief, HypothesesAreWeighedByWhatTheyPredict) {
  write("finger.toml", "schema_version = 1\n");
  const Calibration c = read(write("fit.toml", std::string(kGrowth) + R"(
[[hypothesis]]
name = "cap"
set = { "model.air_limit" = "emission" }
)"));
  const CalibrationResult r = fit_finger(c, quick());
  ASSERT_EQ(r.belief->hypotheses.size(), 2u);
  EXPECT_NEAR(r.belief->hypotheses[1].weight, 0.5, 0.02);
  double cap = 0;
  for (const BeliefMember& m : r.belief->belief.members) {
    const MemberScene at = with_member(r.belief->belief, m, r.finger, r.finger.calibrated_for);
    EXPECT_EQ(at.model.air_limit == AirLimit::Emission, m.hypothesis == "cap");
    cap += m.hypothesis == "cap" ? m.weight : 0;
  }
  EXPECT_NEAR(cap, r.belief->hypotheses[1].weight, 1e-9);
  // The log predictive density of 58.5 under a prior of 56 ± 4 and a measurement of ± 3.
  const double expected = -0.5 * square(2.5 / 5) - std::log(5.0) - 0.5 * std::log(2 * kPi);
  EXPECT_NEAR(r.belief->hypotheses[0].score, expected, 0.1);
}

TEST_F(FitBelief, MistakesOfItsSectionsAreTold) {
  write("finger.toml", "schema_version = 1\n");
  const auto told = [&](const std::string& more, const std::string& words) {
    const auto problems = problems_of([&] { read(write("fit.toml", kGrowth + more)); });
    ASSERT_EQ(problems.size(), 1u) << more;
    EXPECT_NE(problems[0].message.find(words), std::string::npos) << problems[0].text();
    EXPECT_GE(problems[0].line, 14);
  };
  told("seeds = 3\n", "unknown key `seeds`");
  told("[[hypothesis]]\nname = \"a\"\nset = { \"model.closre\" = \"persson\" }\n", "did you mean");
  told("[[hypothesis]]\nname = \"as fitted\"\nset = { \"model.air_limit\" = \"emission\" }\n",
       "a name of its own");
  told("[[hypothesis]]\nname = \"a\"\nset = { \"macro.area_growth\" = \"50 %\" }\n", "is fitted");
  told(
      "[[hypothesis]]\nname = \"a\"\nset = { \"model.air_limit\" = \"emission\" }\nstart = { "
      "\"macro.load_share\" = 0.01 }\n",
      "is not fitted");
  told(
      "[[hypothesis]]\nname = \"a\"\nset = { \"model.air_limit\" = \"emission\" }\nstart = { "
      "\"macro.area_growth\" = \"10 %\" }\n",
      "outside the parameter's bounds");
}

TEST_F(FitBelief, AHypothesisBeginsWhereItsFileSays) {
  write("finger.toml", "schema_version = 1\n");
  const Calibration c = read(write("fit.toml", std::string(kGrowth) + R"(
[[hypothesis]]
name = "cap"
set = { "model.air_limit" = "emission" }
start = { "macro.area_growth" = "70 %" }
)"));
  const Calibration cap = under(c, c.hypotheses[0]);
  EXPECT_DOUBLE_EQ(cap.parameters[0].fit.start, 0.7);
  EXPECT_DOUBLE_EQ(c.parameters[0].fit.start, 0.56);
  EXPECT_EQ(cap.finger.calibrated_for.air_limit, AirLimit::Emission);
  // Wherever it begins, its posterior is that of the data.
  const CalibrationResult r = fit_finger(c, quick());
  EXPECT_NEAR(r.belief->hypotheses[1].score, r.belief->hypotheses[0].score, 0.1);
}

// What is stopped goes on to the same belief, and the folder has it beside the finger that names
// it.
TEST_F(FitBelief, AStoppedOneGoesOnToTheSameMembers) {
  write("finger.toml", "schema_version = 1\n");
  const std::string file = write("fit.toml", kGrowth);
  const Calibration c = read(file);
  CalibrationOptions options = quick();
  const std::string whole = belief_text(fit_finger(c, options).belief->belief);
  options.folder = folder_;
  std::atomic<bool> stop{false};
  options.note = [&](const std::string& text) {
    stop = stop || text.find("sample 200 ") != std::string::npos;
  };
  {
    const Watch watch({}, &stop);
    EXPECT_THROW(fit_finger(c, options), WorkStopped);
  }
  options.note = {};
  EXPECT_EQ(belief_text(fit_finger(c, options).belief->belief), whole);
}

TEST_F(FitBelief, IsWrittenBesideTheFingerThatNamesIt) {
  write("finger.toml", "schema_version = 1\n");
  const std::string out = folder_ + "/out";
  fit_to_folder(write("fit.toml", kGrowth), {1, out, {}});
  const Finger finger = read_finger(out + "/finger.toml");
  EXPECT_GE(belief_of(finger).members.size(), 12u);
}

}  // namespace
}  // namespace papilla::tests::belief_test
