// Calibration: wrong files are told where, a fit that explains nothing is no success.
#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "design/design.h"
#include "report/fit.h"
#include "tests/calibrate/files.h"

namespace papilla::tests {
namespace {

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
