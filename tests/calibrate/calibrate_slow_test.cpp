// Calibration: what was planted is found again, within its interval.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "calibrate/residuals.h"
#include "design/design.h"
#include "forward/forward.h"
#include "report/fit.h"
#include "tests/calibrate/files.h"

namespace papilla::tests::calibrate_slow_test {
namespace {

class Planted : public Calibrate {
 protected:
  static Finger planted_finger() {
    Finger truth = read_finger(find_design("fingers/reference.toml"));
    truth.macro.load_share = 0.009;
    truth.macro.shear_strength = 7.5e6;
    truth.skin.softening = 2.3;
    return truth;
  }
  // The fit of three parameters to the planted finger's table, from `start`.
  // Its data are of the level `check`; the fit runs on four skins of `grid` pixels.
  Calibration planted_calibration(const std::string& start, const std::string& check,
                                  int grid) const;
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
    Fidelity fidelity = sampling.fidelity(1);
    // As frictions are corrected: for what the grid leaves out.
    fidelity.control_skins = fidelity_level(sampling.level).control_skins;
    const Response r = evaluate(scene_of(d), d.texture, fidelity);
    for (const ResponsePoint& p : r.points) {
      const double off = p.friction_off.value, on = p.friction_on.value;
      out += fmt::format("{},{:.0f} %,200,5000,0.2,{:.8g},{:.8g},{:.8g},{:.8g}\n", name,
                         100 * p.relative_humidity, off, 0.02 * off, on, 0.02 * on);
    }
  }
  return out;
}

Calibration Planted::planted_calibration(const std::string& start, const std::string& check,
                                         int grid) const {
  write("measured.csv", planted_table(planted_finger(), {check, 4, 0, grid}));
  const std::string pixels = fmt::format("grid = {}\n", grid);
  return read(write("fit.toml", "schema_version = 1\nfinger = \"" + start + R"("
data = "measured.csv"
[sampling]
level = "draft"
skins = 4
)" + pixels + R"(
[parameters]
"macro.load_share" = { low = 0.001, high = 0.05 }
"macro.shear_strength" = { low = "3 MPa", high = "20 MPa" }
"skin.softening" = { low = 1.2, high = 4.0 }
[check]
level = ")" + check + "\"\n" + pixels));
}

TEST_F(Planted, PlantedParametersAreFoundWithinTheirIntervals) {
  const Calibration calibration = planted_calibration("fingers/reference.toml", "draft", 64);
  ASSERT_EQ(calibration.data.size(), 8u);
  EXPECT_FALSE(calibration.profiles);
  CalibrationOptions options;
  options.check = false;
  options.threads = 1;
  const CalibrationResult r = fit_finger(calibration, options);
  EXPECT_TRUE(r.fit.converged) << r.fit.message;
  EXPECT_GT(r.chi2_before, 100);
  // Not zero as at the planted values (below): the factor that areas are corrected by is followed
  // to first order, and droplets that merge or not hold a descent up. A fifth of a standard
  // deviation of a row, root mean square.
  EXPECT_LT(r.fit.chi2, 0.5);
  for (const FitRow& row : r.rows) EXPECT_LT(std::abs(row.miss), 0.4) << row.what;
  const std::vector<double> planted{0.009, 7.5e6, 2.3};
  for (std::size_t i = 0; i < planted.size(); ++i) {
    const ParameterFit& p = r.fit.parameters[i];
    EXPECT_LT(p.low, planted[i]) << p.name;
    EXPECT_GT(p.high, planted[i]) << p.name;
    EXPECT_NEAR(p.value / planted[i], 1, 0.02) << p.name;
  }
  const auto json = nlohmann::json::parse(calibration_json(calibration, r));
  EXPECT_EQ(json["parameters"].size(), 3u);
  EXPECT_EQ(json["residuals"].size(), 16u);
  const std::string report = calibration_markdown(calibration, r);
  for (const char* words :
       {"95 % interval", "Correlations", "What the data tell apart", "miss, sd"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
}

TEST_F(Planted, AtThePlantedValuesNothingIsLeft) {
  // Of data of the level design too: a draft judges, corrected on the same skins.
  for (const char* level : {"draft", "design"}) {
    const Calibration calibration = planted_calibration(planted_file(), level, 32);
    CalibrationOptions options;
    options.check = false;
    options.threads = 1;
    const CalibrationResult r = fit_finger(calibration, options);
    EXPECT_LT(r.chi2_before, 1e-9) << level;  // eight digits in the table
    EXPECT_NEAR(r.fit.parameters[0].value, 0.009, 1e-8) << level;
  }
}

TEST_F(Planted, WhatOnlyTheirProductMovesIsNotIdentified) {
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

// Frictions to half a percent, fitted on six skins each time: what those skins are off by is common
// to all rows. By errors of each row's own ten of the sixteen intervals hold the strength.
TEST_F(Planted, IsHeldByIntervalsOnOtherSkins) {
  constexpr int kFits = 16, kSkins = 6;
  const std::string flat = find_design("m3_samples/flat.toml");
  Calibration c;
  c.finger = read_finger(find_design("fingers/reference.toml"));
  c.check = {.level = "search", .skins = kSkins, .first_skin = 0, .grid = 32};
  for (const double humidity : {0.15, 0.45, 0.75})
    c.data.push_back({flat, humidity, 150, 5e3, 0.2, 0.1, 0.1, 0.1, 0.1, 2});
  CalibrationParameter strength{"macro.shear_strength", "MPa", {}};
  strength.fit.name = strength.path;
  strength.fit.start = c.finger.macro.shear_strength;
  strength.fit.low = 0.3 * strength.fit.start;
  strength.fit.high = 3 * strength.fit.start;
  strength.fit.step = 0.04;
  strength.fit.logarithmic = true;
  c.parameters = {strength};
  const auto on_skins = [&](int fit) {
    c.sampling = {.level = "search", .skins = kSkins, .first_skin = fit * kSkins, .grid = 32};
    c.check.first_skin = c.sampling.first_skin;
  };
  std::vector<double> truth(6);
  for (int fit = 0; fit < kFits; ++fit) {
    on_skins(fit);
    const std::vector<Estimate> rows =
        Residuals(c, 1).model(c, std::vector<double>{strength.fit.start});
    for (std::size_t i = 0; i < rows.size(); ++i) truth[i] += 1e-3 * rows[i].value / kFits;
  }
  int held = 0;
  for (int fit = 0; fit < kFits; ++fit) {
    on_skins(fit);
    RandomStream random(1, "readings", static_cast<std::uint64_t>(fit));
    for (std::size_t i = 0; i < c.data.size(); ++i) {
      FrictionDatum& d = c.data[i];
      d.off_sd = 0.005 * truth[2 * i];
      d.on_sd = 0.005 * truth[2 * i + 1];
      d.off = truth[2 * i] + d.off_sd * random.normal();
      d.on = truth[2 * i + 1] + d.on_sd * random.normal();
    }
    CalibrationOptions options;
    options.threads = 1;
    options.check = false;
    const ParameterFit found = fit_finger(c, options).fit.parameters.front();
    held += found.low <= strength.fit.start && strength.fit.start <= found.high;
  }
  EXPECT_GE(held, 13);
}

}  // namespace
}  // namespace papilla::tests::calibrate_slow_test
