// Calibration: wrong files are told where, a fit that explains nothing is no success.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/constants.h"
#include "base/error.h"
#include "design/design.h"
#include "report/fit.h"
#include "tests/calibrate/files.h"
#include "tests/support/refusal.h"

namespace papilla::tests::calibrate_test {
namespace {

TEST_F(Calibrate, BadCellsAreNamedByLineAndColumn) {
  const auto wrong = problems_of([&] {
    read_friction(
        write("bad.csv", std::string(kHeader) +
                             "m3_samples/flat.toml,35 %,200,5000,0.2,0.09,0.005,0.15,0.01\n"
                             "m3_samples/flat.toml,35,200,5000,0.2,abc,0.005,0.15,0.01\n"
                             "m3_samples/flat.toml,0.35,200,5000,0.2,0.09\n"
                             "m3_samples/flat.toml,0.35,0,5000,0.2,0.09,0,0.15,0.01\n"));
  });
  ASSERT_EQ(wrong.size(), 5u);
  EXPECT_EQ(wrong[0].line, 3);
  EXPECT_EQ(wrong[0].key, "relative_humidity");
  EXPECT_EQ(wrong[1].key, "F_off");
  EXPECT_EQ(wrong[1].column, 6);
  EXPECT_EQ(wrong[2].line, 4);
  EXPECT_EQ(wrong[3].key, "F_off_sd");
  EXPECT_EQ(wrong[4].key, "F_on");
  const auto unknown = problems_of([&] {
    read_friction(
        write("none.csv", std::string(kHeader) +
                              "m3_samples/flat.toml,35 %,200,5000,0.2,0.09,0.005,0.15,0.01\n"
                              "m3_samples/none.toml,0.35,200,5000,0.2,0.09,0.005,0.15,0.01\n"));
  });
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_EQ(unknown[0].line, 3);
  EXPECT_EQ(unknown[0].key, "design");
}

TEST_F(Calibrate, AMissingColumnIsNotTakenForAnotherThatIsThere) {
  const auto problems = problems_of([&] {
    read_friction(write("a.csv",
                        "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_on_N,"
                        "F_on_sd_N\nm3_samples/flat.toml,35 %,200,5000,0.2,0.09,0.15,0.01\n"));
  });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].key, "F_off_sd");
}

TEST_F(Calibrate, FrictionBeyondTenTimesTheLoadIsRefusedAsAnotherUnit) {
  const auto problems = problems_of([&] {
    read_friction(write(
        "mn.csv", std::string(kHeader) + "m3_samples/flat.toml,35 %,200,5000,0.2,81,4,142,6\n"));
  });
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].key, "F_off");
  EXPECT_NE(problems[0].message.find("are these mN? Then 0.081 N"), std::string::npos)
      << problems[0].message;
  EXPECT_EQ(problems[1].key, "F_on");
}

TEST_F(Calibrate, FrictionOfLessThanFiftyTimesTheLoadIsNotTakenForMillinewtons) {
  for (const auto& [force, guess] :
       {std::pair("9", "no finger rubs so"), std::pair("11", "are these mN? Then 0.011 N")}) {
    const auto problems = problems_of([&, force = force] {
      read_friction(write(
          "n.csv",
          std::string(kHeader) + "m3_samples/flat.toml,35 %,200,5000,0.2," + force + ",1,12,1\n"));
    });
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_NE(problems[0].message.find(std::string(force) + " N is "), std::string::npos);
    EXPECT_NE(problems[0].message.find(guess), std::string::npos) << problems[0].message;
  }
}

// Columns exchanged fit for 23 minutes and explained nothing.
TEST_F(Calibrate, AVoltageThatLowersFrictionIsTakenForExchangedColumns) {
  const std::string row = "m3_samples/flat.toml,0.55,200,5000,0.3,";
  EXPECT_EQ(read_friction(write("right.csv", kHeader + row + "0.1,0.01,0.15,0.01\n" + row +
                                                 "0.12,0.01,0.11,0.01\n"))
                .rows.size(),
            2u);
  const std::vector<Problem> exchanged = problems_of(
      [&] { read_friction(write("exchanged.csv", kHeader + row + "0.15,0.01,0.1,0.01\n")); });
  ASSERT_EQ(exchanged.size(), 1u);
  EXPECT_EQ(exchanged[0].message,
            "under voltage the finger rubs less on average than without it: are F_off and "
            "F_on exchanged?");
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
  good.fit.converged = true;
  EXPECT_EQ(calibration_warning(good), "");
}

// What data do not determine at all: no finger file has more than 300 %.
TEST_F(Calibrate, DeviationsEndWhereAFingerFileDoesAndSaySo) {
  LeastSquaresFit fit;
  const auto add = [&](const char* name, double value, double se) {
    ParameterFit p;
    p.name = name, p.value = value, p.se = se;
    fit.parameters.push_back(p);
  };
  add("skin.rms", 2e-7, 2e-8);
  add("skin.layer_modulus", 1e7, 4e7);
  add("macro.shear_fall", 0, 0.1);
  fit.correlation = {1, 0.5, 0, 0.5, 1, 0, 0, 0, 1};
  std::vector<std::string> notes;
  const std::vector<ParameterDeviation> rows =
      deviations(fit, [&](const std::string& note) { notes.push_back(note); });
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].deviation, 0.1, 1e-12);
  EXPECT_EQ(rows[1].deviation, 3);
  EXPECT_EQ(rows[1].correlation, std::vector<double>{0.5});
  EXPECT_EQ(rows[2].deviation, 3);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0],
            "skin.layer_modulus is not known: its standard error is 400 % of it; the finger's file "
            "says 300 %, the most that it takes");
  EXPECT_EQ(notes[1].rfind("macro.shear_fall is not known: ", 0), 0u);
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

// A datum is a row in mN for each of its frictions, named by its line.
TEST_F(Calibrate, RowsAreTheDataInMillinewtons) {
  write("two.csv", std::string(kHeader) +
                       "m3_samples/flat.toml,35 %,200,5000,0.2,0.09,0.005,0.15,0.01\n"
                       "m3_samples/a3h350.toml,0.55,0,0,0.2,0.12,0.02,,\n");
  const Calibration calibration = read(write("fit.toml", R"(schema_version = 1
finger = "fingers/reference.toml"
data = "two.csv"
[parameters]
"skin.softening" = { low = 1.2, high = 4.0 }
)"));
  Residuals residuals(calibration, 1);
  const std::vector<FitRow>& rows = residuals.rows();
  ASSERT_EQ(rows.size(), 3u);
  const auto expect_row = [&](std::size_t i, const std::string& source, const std::string& what,
                              double value, double sd) {
    EXPECT_EQ(rows[i].source, source);
    EXPECT_EQ(rows[i].what, what);
    EXPECT_NEAR(rows[i].low, value, 1e-12);
    EXPECT_NEAR(rows[i].high, value, 1e-12);
    EXPECT_NEAR(rows[i].sd, sd, 1e-12);
    EXPECT_EQ(rows[i].sampling_sd, 0);
  };
  expect_row(0, "line 2", "F_off of flat at 0.2 N, 35 % RH, 200 V, mN", 90, 5);
  expect_row(1, "line 2", "F_on of flat at 0.2 N, 35 % RH, 200 V, mN", 150, 10);
  expect_row(2, "line 3", "F_off of a3h350 at 0.2 N, 55 % RH, 0 V, mN", 120, 20);
}

// What a fit says of its finger: relative deviations, and each parameter's correlations with those
// before it, of a matrix that is the same both ways.
TEST_F(Calibrate, TheFittedFingerCarriesItsDeviationsAndCorrelations) {
  write("one.csv", std::string(kHeader) + "m3_samples/flat.toml,35 %,200,5000,0.2,0.1,0.1,,\n");
  const Calibration calibration = read(write("fit.toml", R"(schema_version = 1
finger = "fingers/reference.toml"
data = "one.csv"
iterations = 1
[sampling]
level = "draft"
grid = 64
skins = 4
[check]
level = "draft"
grid = 64
skins = 4
[parameters]
"macro.shear_strength" = { low = "1 MPa", high = "90 MPa", prior = "9 MPa", factor = 1.5 }
"skin.layer_modulus" = { low = "5 MPa", high = "600 MPa", prior = "66 MPa", factor = 1.5 }
"skin.softening" = { low = 1.05, high = 8.0, prior = 2.0, factor = 1.5 }
"macro.load_share" = { low = 0.0005, high = 0.08, prior = 0.006, factor = 1.5 }
)"));
  CalibrationOptions options;
  options.check = false;
  options.threads = 1;
  const CalibrationResult r = fit_finger(calibration, options);
  const std::size_t n = r.fit.parameters.size();
  ASSERT_EQ(n, 4u);
  ASSERT_EQ(r.finger.uncertainty.size(), n);
  bool correlated = false;
  for (std::size_t i = 0; i < n; ++i) {
    const ParameterDeviation& row = r.finger.uncertainty[i];
    EXPECT_EQ(row.parameter, calibration.parameters[i].path);
    EXPECT_DOUBLE_EQ(row.deviation, r.fit.parameters[i].se / r.fit.parameters[i].value);
    EXPECT_GT(row.deviation, 0);
    ASSERT_EQ(row.correlation.size(), i);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(row.correlation[j], r.fit.correlation[j * n + i], 1e-12) << i << j;
      correlated = correlated || std::abs(row.correlation[j]) > 1e-3;
    }
  }
  EXPECT_TRUE(correlated);
  // Before and after: the model of the finger at the start and of the fitted one.
  Residuals residuals(calibration, 1);
  std::vector<double> start;
  for (const CalibrationParameter& p : calibration.parameters) start.push_back(p.fit.start);
  const std::vector<double> found = r.fit.values();
  residuals.correct(calibration, start);
  ASSERT_EQ(r.rows.size(), 1u);
  EXPECT_NEAR(r.rows[0].before, residuals.model(calibration, start)[0].value,
              1e-9 * r.rows[0].before);
  EXPECT_NEAR(r.chi2_before,
              square((r.rows[0].before - 100) / std::hypot(100, r.rows[0].sampling_sd)), 1e-9);
  residuals.correct(calibration, found);
  EXPECT_NEAR(r.rows[0].after, residuals.model(calibration, found)[0].value,
              1e-9 * r.rows[0].after);
  EXPECT_NEAR(r.rows[0].miss, (r.rows[0].after - 100) / std::hypot(100, r.rows[0].sampling_sd),
              1e-12);
  EXPECT_EQ(r.finger.fitted_to, "");
  EXPECT_TRUE(explains_data(r));
}

}  // namespace
}  // namespace papilla::tests::calibrate_test
