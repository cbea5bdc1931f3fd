// Residuals of a table against runs of its own, and a fit whose answer is a weighted mean.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/watch.h"
#include "calibrate/calibrate.h"
#include "calibrate/residuals.h"
#include "forward/forward.h"
#include "numerics/statistics.h"
#include "published/targets.h"
#include "tests/calibrate/files.h"

namespace papilla::tests::residuals_by_hand_test {
namespace {

void near(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected) + 1e-15) << expected;
}

Finger asked() {
  Finger finger;
  finger.load = 19;  // the table says how hard it presses
  finger.state = FingerState::Wet;
  finger.macro.shear_strength *= 1.2;
  return finger;
}

// Four frictions of one design, at two humidities under one drive, the wetter first, one of another
// load, one without voltage; all on two skins of few pixels, checked on more pixels.
Calibration few_pixels() {
  Calibration c;
  c.finger = asked();
  c.sampling = {.level = "search", .skins = 2, .first_skin = 4, .grid = 32};
  c.check = {.level = "draft", .skins = 9, .first_skin = 70, .grid = 48};
  const std::string file = find_design("m3_samples/flat.toml");
  c.data = {{file, 0.55, 150, 2e3, 0.3, 0.1, 0.01, 0.15, 0.02, 2},
            {file, 0.35, 150, 2e3, 0.3, 0.1, 0.03, 0.15, 0.04, 3},
            {file, 0.35, 150, 2e3, 0.5, 0.2, 0.01, 0.25, 0.02, 4},
            {file, 0.35, 0, 0, 0.3, 0.1, 0.05, 0, 0, 5}};
  return c;
}

// One datum again: the design under its drive and load with the finger that is asked, at all
// humidities that the table has of these.
ResponsePoint run(const FrictionDatum& d, const Finger& finger, const Fidelity& fidelity) {
  const Design design = read_design(d.design);
  Scene scene = scene_of(design);
  scene.finger = finger;
  scene.finger.load = d.load;
  scene.finger.state = d.state.value_or(design.finger.state);
  scene.model = finger.calibrated_for;
  scene.drive.amplitude = d.amplitude;
  if (d.frequency > 0) scene.drive.frequency = d.frequency;
  const bool two = d.load == 0.3 && d.amplitude > 0;
  scene.environment.relative_humidity = {0.35};
  if (two) scene.environment.relative_humidity.push_back(0.55);
  scene.environment.weights.clear();
  return evaluate(scene, design.texture, fidelity).points[d.relative_humidity > 0.5 ? 1 : 0];
}

TEST(ResidualsByHand, OfATableAreFrictionsInMillinewtons) {
  const Calibration c = few_pixels();
  Residuals residuals(c, 1);
  EXPECT_EQ(residuals.size(), 7);
  Fidelity fidelity = c.sampling.fidelity(1);
  const std::vector<Estimate> model = residuals.model(c, {});
  ASSERT_EQ(model.size(), 7u);
  std::size_t at = 0;
  for (const FrictionDatum& d : c.data) {
    const ResponsePoint p = run(d, asked(), fidelity);
    near(model[at].value, 1e3 * p.friction_off.value);
    near(model[at++].se, 1e3 * p.friction_off.parts.sampling);
    if (d.amplitude == 0) continue;
    near(model[at].value, 1e3 * p.friction_on.value);
    near(model[at++].se, 1e3 * p.friction_on.parts.sampling);
  }
  EXPECT_GT(model[1].value, 1.01 * model[0].value);
  std::vector<double> r(7);
  for (FitRow& row : residuals.rows()) row.sampling_sd = 2 * row.sd;
  EXPECT_TRUE(residuals.residuals(c, {}, r));
  near(r[0], (model[0].value - 100) / (10 * std::sqrt(5.0)));
  near(r[6], (model[6].value - 100) / (50 * std::sqrt(5.0)));
}

// Frictions that meet the same skins: what each skin moves them by, of runs with and without it.
TEST(ResidualsByHand, HaveInCommonWhatTheirSkinsLeaveOpen) {
  Calibration c = few_pixels();
  c.sampling.skins = 5;
  Residuals residuals(c, 1);
  residuals.weigh(c, {});
  const std::vector<FitRow>& rows = residuals.rows();
  const Fidelity fidelity = c.sampling.fidelity(1);
  const FrictionDatum &wetter = c.data[0], &pressed = c.data[2];
  near(rows[0].sampling_sd, 1e3 * run(wetter, asked(), fidelity).friction_off.parts.sampling);
  ASSERT_EQ(rows[4].common.size(), 5u);
  // Samples of friction off: what all skins but one have, taken off what all have.
  const auto moves = [&](const FrictionDatum& d) {
    const Design design = read_design(d.design);
    Scene scene = scene_of(design);
    scene.finger = asked();
    scene.finger.load = d.load;
    scene.finger.state = design.finger.state;
    scene.drive.amplitude = d.amplitude;
    scene.drive.frequency = d.frequency;
    scene.environment.relative_humidity = {d.relative_humidity};
    scene.environment.weights.clear();
    const Response r = evaluate(scene, design.texture, fidelity);
    Eigen::VectorXd out(5);
    for (int k = 0; k < 5; ++k)
      out(k) = r.points[0].friction_off.value -
               r.without[static_cast<std::size_t>(k)][0].friction_off.value;
    return Eigen::VectorXd((out.array() - out.mean()).matrix().normalized());
  };
  const auto common = [&](std::size_t row) {
    return Eigen::Map<const Eigen::VectorXd>(rows[row].common.data(), 5);
  };
  const double share = common(0).squaredNorm();
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 1);
  for (std::size_t i = 1; i < rows.size(); ++i) near(common(i).squaredNorm(), share);
  EXPECT_NEAR((common(4) / std::sqrt(share)).dot(moves(pressed)), 1, 0.01);
  near(rows[0].own_deviation(),
       std::sqrt(square(rows[0].sd) + (1 - share) * square(rows[0].sampling_sd)));
  // The sum of squares is by the covariance of the rows as a whole.
  const double student = student_t_quantile(0.975, 4) / normal_quantile(0.975);
  std::vector<double> r(7), answers(7);
  ASSERT_TRUE(residuals.residuals(c, {}, r));
  ASSERT_TRUE(residuals.answers(c, {}, answers));
  Eigen::MatrixXd whole(7, 7);
  Eigen::VectorXd off(7);
  for (std::size_t i = 0; i < 7; ++i) {
    const auto a = static_cast<Eigen::Index>(i);
    off(a) = answers[i] * rows[i].own_deviation();
    for (std::size_t j = 0; j < 7; ++j)
      whole(a, static_cast<Eigen::Index>(j)) =
          square(student) * rows[i].sampling_sd * rows[j].sampling_sd * common(i).dot(common(j));
    whole(a, a) += square(rows[i].own_deviation());
  }
  double sum = 0;
  for (const double v : r) sum += square(v);
  EXPECT_NEAR(sum, off.dot(whole.inverse() * off), 1e-5 * sum);
  // What people are told of a row is by its own whole deviation.
  const std::vector<double> misses = residuals.misses(r);
  EXPECT_NEAR(misses[4], off(4) / std::sqrt(whole(4, 4)), 1e-5 * std::abs(misses[4]));
}

// Two states of one surface, and a friction that is known under voltage alone.
TEST(ResidualsByHand, AreOfTheStateThatARowSays) {
  Calibration c = few_pixels();
  FrictionDatum natural = c.data[3], wet = c.data[2];
  natural.state = FingerState::Natural;
  wet.state = FingerState::Wet;
  wet.off = wet.off_sd = 0;
  c.data = {c.data[3], natural, wet};
  Residuals residuals(c, 1);
  ASSERT_EQ(residuals.size(), 3);
  EXPECT_EQ(residuals.sources().size(), 3u);
  EXPECT_EQ(residuals.rows()[0].what, "F_off of flat at 0.3 N, 35 % RH, 0 V, mN");
  EXPECT_EQ(residuals.rows()[2].what, "F_on of flat at 0.5 N, 35 % RH, 150 V, wet, mN");
  const Fidelity fidelity = c.sampling.fidelity(1);
  const std::vector<Estimate> model = residuals.model(c, {});
  ASSERT_EQ(model.size(), 3u);
  near(model[0].value, 1e3 * run(c.data[0], asked(), fidelity).friction_off.value);
  near(model[1].value, 1e3 * run(natural, asked(), fidelity).friction_off.value);
  near(model[2].value, 1e3 * run(wet, asked(), fidelity).friction_on.value);
  EXPECT_GT(std::abs(model[1].value / model[0].value - 1), 0.01);
  EXPECT_TRUE(std::isfinite(residuals.correct(c, {})));
}

// The finer level of the check, on the skins of the fit: frictions follow it from then on.
TEST(ResidualsByHand, AreCorrectedToTheLevelOfTheCheck) {
  const Calibration c = few_pixels();
  Residuals residuals(c, 1);
  const std::vector<Estimate> before = residuals.model(c, {});
  Fidelity fine = fidelity_level("draft");
  fine.grid = 48;
  fine.skins = 2;
  fine.first_skin = 4;
  fine.contact_tolerance = 1e-5;
  fine.field_skins = 0;
  fine.threads = 1;
  EXPECT_EQ(residuals.factors_between(c, {}), std::pair(1.0, 1.0));
  const double moved = residuals.correct(c, {});
  const std::vector<Estimate> after = residuals.model(c, {});
  double largest = 0, least_factor = kInfinity, largest_factor = 0;
  std::size_t at = 0;
  for (const FrictionDatum& d : c.data) {
    const ResponsePoint p = run(d, asked(), fine);
    const auto expect = [&](const Measured& force, double sd) {
      near(after[at].value, 1e3 * force.value);
      near(after[at].se / after[at].value, before[at].se / before[at].value);
      largest = std::max(largest, std::abs(after[at].value - before[at].value) / (1e3 * sd));
      least_factor = std::min(least_factor, after[at].value / before[at].value);
      largest_factor = std::max(largest_factor, after[at].value / before[at].value);
      ++at;
    };
    expect(p.friction_off, d.off_sd);
    if (d.amplitude > 0) expect(p.friction_on, d.on_sd);
  }
  EXPECT_EQ(at, 7u);
  EXPECT_GT(largest, 0.01);
  near(moved, largest);
  near(residuals.factors_between(c, {}).first, least_factor);
  near(residuals.factors_between(c, {}).second, largest_factor);
  EXPECT_NEAR(residuals.correct(c, {}), 0, 1e-9);  // the same again
  Calibration claims;
  claims.fit = {"M3"};
  EXPECT_EQ(Residuals(claims, 1).correct(claims, {}), 0);
}

// What the level of the fit gets wrong depends on the finger: a belief that holds it as it is at
// the fitted one is sure of the wrong fingers.
TEST(ResidualsByHand, FollowTheCorrectionToOtherFingers) {
  Calibration c = few_pixels();
  const auto parameter = [&](const char* path, double start) {
    CalibrationParameter p{path, "", {}};
    p.fit = {.name = path,
             .start = start,
             .low = start / 4,
             .high = start * 4,
             .prior = start,
             .prior_sd = std::log(2),
             .logarithmic = true,
             .step = 0.04};
    c.parameters.push_back(p);
  };
  parameter("skin.layer_modulus", c.finger.skin.layer_modulus);
  parameter("macro.load_share", c.finger.macro.load_share);
  std::vector<double> start;
  for (const CalibrationParameter& p : c.parameters) start.push_back(p.fit.start);
  const std::vector<double> other{start[0] * 1.5, start[1] / 1.3};
  Residuals held(c, 1), followed(c, 1);
  held.correct(c, start);
  followed.correct(c, start);
  followed.follow(c, start);
  near(followed.model(c, start)[0].value, held.model(c, start)[0].value);
  // Each says how far it was off there.
  const double off = held.correct(c, other);
  EXPECT_GT(off, 0.5);
  EXPECT_LT(followed.correct(c, other), 0.25 * off);
}

// A claim's row is its target; inside the band nothing is left, outside the way to its nearer end.
TEST(ResidualsByHand, OfAClaimAreTheWayToItsBand) {
  Calibration c;
  c.fit = {"M3"};
  Residuals residuals(c, 1);
  ASSERT_EQ(residuals.size(), 1);
  FitRow& row = residuals.rows()[0];
  EXPECT_EQ(row.source, "M3");
  EXPECT_EQ(row.what, "growth of the gross area, %");
  EXPECT_EQ(row.low, 58.5);
  EXPECT_EQ(row.high, 58.5);
  EXPECT_EQ(row.sd, 3);
  EXPECT_EQ(row.sampling_sd, 0);
  EXPECT_EQ(row.before, 0);
  EXPECT_EQ(row.after, 0);
  Finger& finger = c.finger;
  finger.macro.area_growth = 0.5;
  std::vector<double> r(1);
  const auto left = [&](double low, double high, double sampling) {
    row.low = low, row.high = high, row.sampling_sd = sampling;
    EXPECT_TRUE(residuals.residuals(c, {}, r));
    return r[0];
  };
  near(left(56, 70, 0), -2);
  near(left(30, 44, 4), 1.2);
  EXPECT_NEAR(left(49, 51, 0), 0, 1e-12);
  finger.macro.area_15 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(residuals.residuals(c, {}, r));
}

using FitByHand = Calibrate;

// A growth of 58.5 ± 3 by the paper and one of 56 ± 4 by a prior: weights of 16 and 9.
TEST_F(FitByHand, OfOneNumberIsTheMeanByItsWeights) {
  Finger start;
  start.macro.area_growth = 0.7;
  Calibration c;
  c.finger = start;
  c.fit = {"M3"};
  CalibrationParameter p{"macro.area_growth", "%", {}};
  p.fit.name = p.path;
  p.fit.start = 0.7;
  p.fit.step = 0.04;
  p.fit.low = 0.2;
  p.fit.high = 1.2;
  p.fit.prior = 0.56;
  p.fit.prior_sd = 0.04;
  c.parameters = {p};
  c.check = {.level = "search", .skins = 2, .first_skin = 3, .grid = 32};
  CalibrationOptions options;
  options.threads = 1;
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  const CalibrationResult r = fit_finger(c, options);
  const double mean = (16 * 0.585 + 9 * 0.56) / 25, deviation = 0.03 * 4 / 5;
  EXPECT_NEAR(r.finger.macro.area_growth, mean, 1e-4);
  EXPECT_EQ(r.start, start);
  near(r.chi2_before, square(11.5 / 3));
  ASSERT_EQ(r.rows.size(), 1u);
  near(r.rows[0].before, 70);
  EXPECT_NEAR(r.rows[0].after, 100 * r.finger.macro.area_growth, 1e-9);
  ASSERT_EQ(r.finger.uncertainty.size(), 1u);
  EXPECT_EQ(r.finger.uncertainty[0].parameter, "macro.area_growth");
  EXPECT_NEAR(r.finger.uncertainty[0].deviation, deviation / mean, 1e-3 * deviation / mean);
  EXPECT_EQ(r.finger.fitted_to, "M3");
  EXPECT_EQ(r.gap_before, capacitance_gap(start));
  EXPECT_EQ(r.gap_after, capacitance_gap(r.finger));
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes[0], "1 residuals, 1 parameters; the first evaluation tells the price");
  EXPECT_EQ(std::count(notes.begin(), notes.end(), "chi2 14.69 at the start"), 1);
  EXPECT_GT(r.evaluations, 4);
  // The friction coefficient on flat glass at four humidities, at the level of the check.
  Design flat = read_design(find_design("m3_samples/flat.toml"));
  const double load = flat.finger.load;
  flat.finger = r.finger;
  flat.finger.load = load;
  const Response own = evaluate(scene_of(flat), flat.texture, c.check.fidelity(1));
  ASSERT_EQ(r.friction_coefficient.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    near(r.friction_coefficient[k], own.points[k].friction_off.value / load);
}

// A growth of 58.5 ± 3, which a finger of at most `high` explains or does not.
struct Walked {
  CalibrationResult result;
  std::vector<std::string> notes;

  Walked(double high, int iterations) {
    Calibration c;
    c.title = "mine";
    c.finger.name = "start";
    c.finger.macro.area_growth = 0.25;
    c.fit = {"M3"};
    CalibrationParameter p{"macro.area_growth", "%", {}};
    p.fit = {.name = p.path, .start = 0.25, .low = 0.2, .high = high, .step = 0.04};
    c.parameters = {p};
    c.iterations = iterations;
    c.profiles = true;
    CalibrationOptions options;
    options.threads = 1;
    options.check = false;
    options.note = [&](const std::string& text) { notes.push_back(text); };
    result = fit_finger(c, options);
  }
  int count(const std::string& beginning) const {
    return static_cast<int>(std::count_if(notes.begin(), notes.end(), [&](const std::string& text) {
      return text.starts_with(beginning);
    }));
  }
};

TEST_F(FitByHand, SaysItsWorstRowAndWalksProfilesOfWhatExplainsTheData) {
  const Walked w(1.2, 15);
  EXPECT_TRUE(explains_data(w.result));
  EXPECT_EQ(w.count("chi2 "), 2);  // at the start, after the descent
  EXPECT_EQ(w.count("profile of macro.area_growth, 1 of 1"), 1);
  EXPECT_EQ(w.count("profiles are not walked"), 0);
  // chi2 rises by t^2: no prior, no degree of freedom, so by the normal distribution.
  const ParameterFit& f = w.result.fit.parameters[0];
  EXPECT_NEAR(f.value, 0.585, 1e-4);
  EXPECT_NEAR(f.low, 0.585 - 1.96 * 0.03, 2e-4);
  EXPECT_NEAR(f.high, 0.585 + 1.96 * 0.03, 2e-4);
}

TEST_F(FitByHand, WalksNoProfileOfAFingerThatExplainsNothing) {
  const Walked w(0.3, 15);
  EXPECT_FALSE(explains_data(w.result));
  EXPECT_EQ(w.count("profile of"), 0);
  EXPECT_EQ(w.count("profiles are not walked: chi2 per degree of freedom is 90."), 1);
  ASSERT_EQ(w.count("chi2 90.25 after the descent; the worst is M3 ("), 1);
  EXPECT_TRUE(w.result.fit.parameters[0].low_open && w.result.fit.parameters[0].high_open);
  EXPECT_NEAR(w.result.rows[0].miss, -9.5, 1e-3);
}

TEST_F(FitByHand, NamesItsFingerByTheTitleWhereItMayMove) {
  EXPECT_EQ(Walked(1.2, 15).result.finger.name, "mine");
  EXPECT_EQ(Walked(1.2, 0).result.finger.name, "start");
}

// The model's answers lie in the folder until the fit ends: a second call asks the same again.
TEST_F(FitByHand, AStoppedFitGoesOnToTheSameFinger) {
  Calibration c;
  c.finger.macro.area_growth = 0.7;
  c.fit = {"M3"};
  c.file = write("fit.toml", "title = \"of one number\"");
  CalibrationParameter p{"macro.area_growth", "%", {}};
  p.fit = {.name = p.path, .start = 0.7, .low = 0.2, .high = 1.2, .step = 0.04};
  c.parameters = {p};
  c.check = {.level = "search", .skins = 2, .first_skin = 3, .grid = 32};
  CalibrationOptions options;
  options.threads = 1;
  options.check = false;
  const Finger whole = fit_finger(c, options).finger;

  const auto unfinished = [&] {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      count += entry.path().filename().string().starts_with("unfinished-");
    return count;
  };
  options.folder = folder_;
  std::atomic<bool> stop{false};
  options.note = [&](const std::string&) { stop = true; };
  {
    const Watch watch({}, &stop);
    EXPECT_THROW(fit_finger(c, options), WorkStopped);
  }
  EXPECT_EQ(unfinished(), 1);
  std::vector<std::string> notes;
  options.note = [&](const std::string& text) { notes.push_back(text); };
  EXPECT_EQ(fit_finger(c, options).finger, whole);
  ASSERT_FALSE(notes.empty());
  EXPECT_TRUE(notes[0].starts_with("goes on: ")) << notes[0];
  EXPECT_EQ(unfinished(), 0);
}

// Answers that were kept of another map of the finger's skin are none.
TEST_F(FitByHand, KeepsAnswersOfTheMapThatTheyWereMadeWith) {
  Calibration c;
  c.fit = {"M3"};
  c.file = write("fit.toml", "title = \"of a map\"");
  c.finger.skin.map = write("skin.gsf", "a");
  const auto file = [&] { return Residuals(c, 1, folder_).kept().file(); };
  const std::string first = file();
  EXPECT_EQ(file(), first);
  write("skin.gsf", "another");
  EXPECT_NE(file(), first);
}

// At its bound a number has no deviation, and those after it no correlation with it.
TEST_F(FitByHand, ANumberAtItsBoundIsNotUncertain) {
  Calibration c;
  c.fit = {"M3", "C_gap"};
  const auto parameter = [&](const char* path, double start, double low, double high) {
    CalibrationParameter p{path, "", {}};
    p.fit.name = path;
    p.fit.start = start;
    p.fit.step = 0.04;
    p.fit.low = low;
    p.fit.high = high;
    c.parameters.push_back(p);
  };
  parameter("macro.area_growth", 0.4, 0.3, 0.5);
  parameter("macro.ridge_rms", 2.2e-6, 1e-7, 1e-4);
  CalibrationOptions options;
  options.threads = 1;
  options.check = false;
  const CalibrationResult r = fit_finger(c, options);
  EXPECT_NEAR(r.finger.macro.area_growth, 0.5, 1e-9);
  EXPECT_NEAR(r.gap_after, 1.06e-6, 0.005e-6);
  EXPECT_NEAR(r.fit.chi2, square(8.5 / 3), 1e-2);
  ASSERT_EQ(r.finger.uncertainty.size(), 1u);
  EXPECT_EQ(r.finger.uncertainty[0].parameter, "macro.ridge_rms");
  EXPECT_TRUE(r.finger.uncertainty[0].correlation.empty());
  EXPECT_TRUE(r.friction_coefficient.empty());
  EXPECT_EQ(r.finger.fitted_to, "M3 C_gap");
}

TEST(Misfit, IsThePartOfEachDegreeOfFreedom) {
  CalibrationResult r;
  r.fit.chi2 = 32;
  r.fit.degrees_of_freedom = 2;
  EXPECT_EQ(misfit(r), 16);
  EXPECT_TRUE(explains_data(r));
  r.fit.chi2 = 32.1;
  EXPECT_FALSE(explains_data(r));
  r.fit.degrees_of_freedom = 0;
  EXPECT_EQ(misfit(r), 32.1);
  r.fit.chi2 = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(explains_data(r));
}

}  // namespace
}  // namespace papilla::tests::residuals_by_hand_test
