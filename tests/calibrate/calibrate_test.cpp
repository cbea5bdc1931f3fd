// Calibration: what was planted is found again, within its interval; wrong files are told where.
#include "calibrate/calibrate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "claims/claim.h"
#include "design/design.h"
#include "forward/forward.h"
#include "report/fit.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

constexpr const char* kHeader =
    "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,F_on_sd_"
    "N\n";

Calibration read(const std::string& path) { return read_calibration(path, m3_claim_ids()); }

class Calibrate : public testing::Test {
 protected:
  Calibrate() {
    folder_ =
        temporary("calibrate_") + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  static Finger planted_finger() {
    Finger truth = read_finger(find_design("fingers/reference.toml"));
    truth.macro.load_share = 0.009;
    truth.macro.shear_strength = 7.5e6;
    truth.skin.softening = 2.3;
    return truth;
  }
  // The fit of three parameters to the planted finger's table, from `start`.
  // Its data are of the level `check`; the fit runs on four skins of 64 pixels.
  Calibration planted_calibration(const std::string& start, const std::string& check) const;
  std::string planted_file() const {
    return write("truth.toml", "schema_version = 1\nbase = \"" +
                                   find_design("fingers/reference.toml") +
                                   R"("
[macro]
load_share = 0.009
shear_strength = "7.5 MPa"
[skin]
softening = 2.3
)");
  }

  std::string folder_;
};

// What people would measure on two samples if the model with other parameters were right, without
// noise: the fit has to find them again. Stated errors of 2 %.
std::string planted_table(const Finger& truth, const SkinSampling& sampling) {
  std::string out = kHeader;
  for (const char* name : {"m3_samples/flat.toml", "m3_samples/a3h350.toml"}) {
    Design d = read_design(find_design(name));
    const double load = d.finger.load;
    d.finger = truth;
    d.finger.load = load;
    const Response r = evaluate(scene_of(d), d.texture, sampling.fidelity(1));
    for (const ResponsePoint& p : r.points) {
      const double off = p.friction_off.value, on = p.friction_on.value;
      out += fmt::format("{},{:.0f} %,200,5000,0.2,{:.8g},{:.8g},{:.8g},{:.8g}\n", name,
                         100 * p.relative_humidity, off, 0.02 * off, on, 0.02 * on);
    }
  }
  return out;
}

Calibration Calibrate::planted_calibration(const std::string& start,
                                           const std::string& check) const {
  write("measured.csv", planted_table(planted_finger(), {check, 4, 0, 64}));
  return read(write("fit.toml", "schema_version = 1\nfinger = \"" + start + R"("
data = "measured.csv"
[sampling]
level = "draft"
grid = 64
skins = 4
[parameters]
"macro.load_share" = { low = 0.001, high = 0.05 }
"macro.shear_strength" = { low = "3 MPa", high = "20 MPa" }
"skin.softening" = { low = 1.2, high = 4.0 }
[check]
grid = 64
level = ")" + check + "\"\n"));
}

TEST_F(Calibrate, PlantedParametersAreFoundWithinTheirIntervals) {
  const Calibration calibration = planted_calibration("fingers/reference.toml", "draft");
  ASSERT_EQ(calibration.data.size(), 8u);
  EXPECT_FALSE(calibration.profiles);
  CalibrationOptions options;
  options.check = false;
  options.threads = 1;
  const CalibrationResult r = fit_finger(calibration, options);
  EXPECT_TRUE(r.fit.converged) << r.fit.message;
  EXPECT_GT(r.chi2_before, 100);
  // Not zero as at the planted values (below): droplets jump from hollow to hollow, so that the sum
  // of squares has ripples of a few tenths of a per cent of friction, and the descent ends in one.
  EXPECT_LT(r.fit.chi2, 0.05);
  const std::vector<double> planted{0.009, 7.5e6, 2.3};
  for (std::size_t i = 0; i < planted.size(); ++i) {
    const ParameterFit& p = r.fit.parameters[i];
    EXPECT_LT(p.low, planted[i]) << p.name;
    EXPECT_GT(p.high, planted[i]) << p.name;
    EXPECT_NEAR(p.value / planted[i], 1, 0.01) << p.name;
  }
  const auto json = nlohmann::json::parse(calibration_json(calibration, r));
  EXPECT_EQ(json["parameters"].size(), 3u);
  EXPECT_EQ(json["residuals"].size(), 16u);
  const std::string report = calibration_markdown(calibration, r);
  for (const char* words :
       {"95 % interval", "Correlations", "What the data tell apart", "miss, sd"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
}

TEST_F(Calibrate, AtThePlantedValuesNothingIsLeft) {
  // Of data of the level design too: a draft judges, corrected on the same skins.
  for (const char* level : {"draft", "design"}) {
    const Calibration calibration = planted_calibration(planted_file(), level);
    CalibrationOptions options;
    options.check = false;
    options.threads = 1;
    const CalibrationResult r = fit_finger(calibration, options);
    EXPECT_LT(r.chi2_before, 1e-9) << level;  // eight digits in the table
    EXPECT_NEAR(r.fit.parameters[0].value, 0.009, 1e-8) << level;
  }
}

TEST_F(Calibrate, WhatOnlyTheirProductMovesIsNotIdentified) {
  // Without a drive the friction depends on shear strength over modulus: their singular direction
  // is empty, and the prior decides.
  const Finger start = read_finger(find_design("fingers/reference.toml"));
  write("measured.csv", std::string(kHeader) +
                            "m3_samples/flat.toml,0.35,0,0,0.2,0.09,0.005,,\n"
                            "m3_samples/flat.toml,0.55,0,0,0.2,0.12,0.005,,\n");
  const std::string file = write("fit.toml", R"(schema_version = 1
finger = "fingers/reference.toml"
data = "measured.csv"
[sampling]
level = "draft"
grid = 64
skins = 4
[parameters]
"macro.shear_strength" = { low = "1 MPa", high = "90 MPa", prior = "9 MPa", factor = 1.5 }
"skin.layer_modulus" = { low = "5 MPa", high = "600 MPa", prior = "66 MPa", factor = 1.5 }
)");
  CalibrationOptions options;
  options.check = false;
  options.threads = 1;
  const CalibrationResult r = fit_finger(read(file), options);
  ASSERT_EQ(r.fit.directions.size(), 2u);
  EXPECT_GT(r.fit.directions[0].singular_value, 3);
  EXPECT_LT(r.fit.directions[1].singular_value, 1);
  EXPECT_GT(r.fit.correlation[1], 0.7);
}

std::vector<Problem> problems_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

TEST_F(Calibrate, BadCellsAreNamedByLineAndColumn) {
  const std::string path =
      write("bad.csv", std::string(kHeader) +
                           "m3_samples/flat.toml,35 %,200,5000,0.2,0.09,0.005,0.15,0.01\n"
                           "m3_samples/none.toml,0.35,200,5000,0.2,0.09,0.005,0.15,0.01\n"
                           "m3_samples/flat.toml,35,200,5000,0.2,abc,0.005,0.15,0.01\n"
                           "m3_samples/flat.toml,0.35,200,5000,0.2,0.09\n"
                           "m3_samples/flat.toml,0.35,0,5000,0.2,0.09,0,0.15,0.01\n");
  const auto problems = problems_of([&] { read_friction(path); });
  ASSERT_EQ(problems.size(), 6u);
  EXPECT_EQ(problems[0].line, 3);
  EXPECT_EQ(problems[0].key, "design");
  EXPECT_EQ(problems[1].line, 4);
  EXPECT_EQ(problems[1].key, "relative_humidity");
  EXPECT_EQ(problems[2].key, "F_off_N");
  EXPECT_EQ(problems[2].column, 6);
  EXPECT_EQ(problems[3].line, 5);
  EXPECT_EQ(problems[4].key, "F_off_sd_N");
  EXPECT_EQ(problems[5].key, "F_on_N");
  const auto header = problems_of(
      [&] { read_friction(write("head.csv", "design,humidity,amplitude_V\n1,2,3\n")); });
  ASSERT_FALSE(header.empty());
  EXPECT_EQ(header[0].line, 1);
  EXPECT_FALSE(problems_of([&] { read_friction(write("empty.csv", kHeader)); }).empty());
}

TEST_F(Calibrate, AMissingColumnIsNotTakenForAnotherThatIsThere) {
  const auto problems = problems_of([&] {
    read_friction(write("a.csv",
                        "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_on_N,"
                        "F_on_sd\n"));
  });
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].key, "F_off_sd_N");
  EXPECT_EQ(problems[0].message.find("`F_off_N`"), std::string::npos) << problems[0].message;
  EXPECT_EQ(problems[1].message, "no such column, is it `F_on_sd`?");
}

TEST_F(Calibrate, FrictionBeyondTenTimesTheLoadIsRefusedAsAnotherUnit) {
  const auto problems = problems_of([&] {
    read_friction(write(
        "mn.csv", std::string(kHeader) + "m3_samples/flat.toml,35 %,200,5000,0.2,81,4,142,6\n"));
  });
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].key, "F_off_N");
  EXPECT_NE(problems[0].message.find("are these mN? Then 0.081 N"), std::string::npos)
      << problems[0].message;
  EXPECT_EQ(problems[1].key, "F_on_N");
}

TEST_F(Calibrate, AFitThatExplainsNothingIsNoSuccess) {
  write("far.csv", std::string(kHeader) +
                       "m3_samples/flat.toml,35 %,200,5000,0.2,1.2,0.01,1.2,"
                       "0.01\n");
  const std::string file = write("fit.toml", R"(schema_version = 1
finger = "fingers/reference.toml"
data = "far.csv"
iterations = 2
[sampling]
level = "draft"
grid = 64
skins = 4
[check]
level = "draft"
grid = 64
skins = 4
[parameters]
"macro.shear_strength" = { low = "8 MPa", high = "10 MPa", prior = "9 MPa", sd = "1 MPa" }
)");
  const Calibration calibration = read(file);
  CalibrationOptions options;
  options.check = false;
  const CalibrationResult r = fit_finger(calibration, options);
  EXPECT_NE(calibration_warning(r).find("does not explain the data"), std::string::npos);
  EXPECT_NE(calibration_markdown(calibration, r).find("Warning: "), std::string::npos);
  EXPECT_NE(calibration_json(calibration, r).find("does not explain"), std::string::npos);
  CalibrationResult good = r;
  good.fit.chi2 = 2.0 * good.fit.degrees_of_freedom;
  EXPECT_EQ(calibration_warning(good), "");
}

TEST_F(Calibrate, MistakesOfTheFileAreToldTogether) {
  const std::string file = write("fit.toml", R"(schema_version = 1
finger = "fingers/reference.toml"
fit = ["M1", "M6", "M99"]
hold_out = ["M1", "M8"]
[parameters]
"skin.rmss" = { low = "1 nm", high = "2 nm" }
"skin.rms" = { low = "200 nm", high = "100 nm" }
"macro.load_share" = { low = 0.001, high = 0.05, prior = 0.006 }
"skin.softening" = { low = 3.0, high = 4.0 }
)");
  const auto problems = problems_of([&] { read(file); });
  ASSERT_EQ(problems.size(), 7u);
  std::string all;
  for (const Problem& p : problems) all += p.text() + "\n";
  for (const char* words : {"M6", "M99", "among the fitted", "did you mean `skin.rms`",
                            "expected low < high", "needs its width", "lies outside the bounds"})
    EXPECT_NE(all.find(words), std::string::npos) << words << " in\n" << all;
}

TEST_F(Calibrate, TheReferenceFitReadsAndHoldsOutMoreThanItFits) {
  const Calibration c = read(find_design("fingers/reference.calibration.toml"));
  EXPECT_LT(c.fit.size(), c.hold_out.size());
  for (const CalibrationParameter& p : c.parameters) EXPECT_GT(p.fit.prior_sd, 0) << p.path;
}

}  // namespace
}  // namespace papilla::tests
