// The report of a fit: made-up numbers, each another, in the unit that stands beside it.
#include "report/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/constants.h"
#include "tests/report/same_json.h"

namespace papilla::tests::fit_test {
namespace {

struct Fitted {
  Calibration c;
  CalibrationResult r;

  Fitted() {
    c.title = "a fit";
    c.parameters = {{"skin.rms", "um", {}}, {"water.scale", "", {}}};
    FitParameter& rms = c.parameters[0].fit;
    rms.start = 2e-6, rms.low = 1e-6, rms.high = 9e-6, rms.prior = 3e-6, rms.prior_sd = 5e-7;
    FitParameter& scale = c.parameters[1].fit;
    scale.start = 1, scale.low = 0.1, scale.high = 10, scale.prior = 1.5;
    scale.prior_sd = std::log(2), scale.logarithmic = true;
    c.sampling = {"draft", 12, 5, 0};
    c.check = {"design", 20, 100, 0};
    c.data.resize(1);
    r.fit.converged = true;
    r.fit.parameters = {{.name = "skin.rms",
                         .value = 2.5e-6,
                         .se = 1e-7,
                         .low = 2.25e-6,
                         .high = 2.75e-6,
                         .high_open = true,
                         .data_share = 0.25},
                        {.name = "water.scale",
                         .value = 1.25,
                         .se = 0.2,
                         .low = 0.8,
                         .high = 1.75,
                         .at_bound = true,
                         .data_share = 0.6}};
    r.fit.correlation = {1, -0.35, -0.35, 1};
    r.fit.directions = {{4.5, {0.98, 0.1}}, {0.5, {-0.3, 0.95}}};
    r.fit.chi2 = 7.5, r.fit.prior_chi2 = 0.75, r.fit.degrees_of_freedom = 3;
    r.fit.variance_factor = 2.25;
    r.rows = {{"M1", "friction", 0.1, 0.3, 0.02, 0.003, 0.4, 0.25, 0.5},
              {"M2", "ratio", 1.5, 1.5, 0.25, 0.05, 1.75, 1.625, -1.25},
              {"M3", "more", 2, kInfinity, 0.5, 0.01, 1, 3, 2, 0.75}};
    r.chi2_before = 30;
    r.evaluations = 17;
    r.least_factor = 0.812, r.largest_factor = 1.05;
    r.gap_before = 1.5e-6, r.gap_after = 1.25e-6;
    r.friction_coefficient = {0.21, 0.32, 0.43, 0.54};
  }
};

TEST(FitReport, ForPeopleHasEachNumberInTheUnitBesideIt) {
  const Fitted f;
  const std::string page = calibration_markdown(f.c, f.r);
  for (const char* line :
       {"# Fit: a fit\n",
        "3 residuals, 2 parameters; χ² of the data 30 before, 7.5 after, of the priors 0.75; 3 "
        "degrees of freedom; errors times 1.5; 17 evaluations of the model; converged.\n",
        "Skins 5 to 16 at level draft; frictions times 0.812 to 1.050, which level design says "
        "over "
        "it on the same skins (Eq. calibration.6).\n",
        "| skin.rms | 2 um | 2.5 um | 2.25 um to 2.75 um (bound) | 3 um ± 0.5 um | 25 |\n",
        "| water.scale | 1 | 1.25 | 0.8 to 1.75 | 1.5 times or by 2 | 60; at its bound, interval "
        "by "
        "profile |\n",
        "| skin.rms | 1.00 | -0.35 |\n| water.scale | -0.35 | 1.00 |\n",
        "| 4.5 | +0.98 skin.rms |  |\n",
        "| 0.5 | -0.30 skin.rms +0.95 water.scale | not identified |\n",
        "| M1 | friction | 0.1 to 0.3 | 0.02 | 0.003 | 0.4 | 0.25 | +0.50 |\n",
        "| M2 | ratio | 1.5 | 0.25 | 0.05 | 1.75 | 1.625 | -1.25 |\n",
        "| M3 | more | above 2 | 0.5 | 0.01 | 1 | 3 | +2.00 |\n",
        "(published 1.06 µm): 1.50 µm before, 1.25 µm after",
        "0.21, 0.32, 0.43, 0.54 at 15, 35, 55, 75 % RH"})
    EXPECT_NE(page.find(line), std::string::npos) << line << page;
}

TEST(FitReport, SaysThatFewSkinsMoveAllResidualsTogether) {
  Fitted f;
  const auto says = [&f] {
    return calibration_markdown(f.c, f.r).find("All residuals meet these skins") !=
           std::string::npos;
  };
  ASSERT_EQ(f.c.sampling.skins, 12);
  EXPECT_FALSE(says());
  f.c.sampling.skins = 5;
  EXPECT_TRUE(says());
  f.c.sampling.skins = 6;  // rows of a table know what they have in common
  EXPECT_FALSE(says());
  f.c.fit = {"M1"};  // claims do not
  EXPECT_TRUE(says());
}

TEST(FitReport, AMisfitNamesItsWorstRow) {
  Fitted f;
  EXPECT_EQ(calibration_warning(f.r), "");
  f.r.rows[1].miss = -40;
  f.r.fit.chi2 = 1605;
  const std::string warning = calibration_warning(f.r);
  EXPECT_NE(warning.find("χ² per degree of freedom is 53"), std::string::npos) << warning;
  EXPECT_NE(warning.find("the worst is M2 (ratio), -40.0 standard deviations"), std::string::npos)
      << warning;
}

TEST(FitReport, AFitThatStoppedEarlySaysWhatToDo) {
  Fitted f;
  f.r.fit.converged = false, f.r.iterations = 4, f.r.fit.message = "the end. Iterations: 4.";
  const std::string warning =
      "not converged after 4 iterations (the end. Iterations: 4): raise `iterations`; what is "
      "written is where it stopped";
  EXPECT_EQ(calibration_warning(f.r), warning);
  const std::string page = calibration_markdown(f.c, f.r);
  EXPECT_NE(page.find("Warning: " + warning + ".\n"), std::string::npos) << page;
  EXPECT_NE(page.find("stopped: the end. Iterations: 4.\n"), std::string::npos) << page;
  EXPECT_EQ(nlohmann::json::parse(calibration_json(f.c, f.r))["warning"], warning);
}

// What is warned of need not be that the fit misses the data.
TEST(FitReport, TellsProgramsWhetherTheDataAreExplained) {
  Fitted f;
  const auto told = [&] {
    return nlohmann::json::parse(calibration_json(f.c, f.r)).at("explains_data");
  };
  f.r.fit.converged = false;
  EXPECT_NE(calibration_warning(f.r), "");
  EXPECT_EQ(told(), true);
  f.r.fit.chi2 = 1605;
  EXPECT_EQ(told(), false);
}

// Twenty values, each missed by a share of its deviation; chi squared of 20 degrees of freedom is
// below 5.4 in one of two thousand tables.
TEST(FitReport, DeviationsThatAreTooLargeAreSaidSo) {
  Fitted f;
  const auto warning = [&](double missed) {
    f.r.rows.assign(20, {"line 2", "F_off", 10, 10, 0.5, 40, 12, 10 + 0.5 * missed, 0.001});
    f.r.fit.degrees_of_freedom = 20, f.r.fit.chi2 = 0.01;
    return calibration_warning(f.r);
  };
  EXPECT_EQ(warning(1), "");
  EXPECT_EQ(warning(0.54), "");
  EXPECT_TRUE(
      warning(0.48).starts_with("the stated standard deviations are larger than what is "
                                "missed: by them alone χ² per degree of freedom is 0.23"))
      << warning(0.48);
  // A band leaves room within it, and few rows are near by chance.
  f.r.rows[0].high = 11;
  EXPECT_EQ(calibration_warning(f.r), "");
  f.r.rows.resize(1);
  f.r.rows[0].high = 10, f.r.fit.degrees_of_freedom = 1;
  EXPECT_EQ(calibration_warning(f.r), "");
}

TEST(FitReport, ForProgramsIsInSi) {
  const Fitted f;
  const auto json = nlohmann::json::parse(calibration_json(f.c, f.r));
  expect_same(json["parameters"][0],
              {{"path", "skin.rms"},
               {"unit", "um"},
               {"per_unit", 1e-6},
               {"lowest", 1e-6},
               {"highest", 9e-6},
               {"prior", {{"value", 3e-6}, {"sd", 5e-7}}},
               {"start", 2e-6},
               {"value", 2.5e-6},
               {"se", 1e-7},
               {"low", 2.25e-6},
               {"high", 2.75e-6},
               {"low_open", false},
               {"high_open", true},
               {"at_bound", false},
               {"data_share", 0.25}},
              "parameters");
  expect_same(json["parameters"][1]["prior"], {{"value", 1.5}, {"factor", 2}}, "prior");
  expect_same(json["residuals"][2],
              {{"source", "M3"},
               {"what", "more"},
               {"low", 2},
               {"high", nullptr},
               {"sd", 0.5},
               {"sampling_sd", 0.01},
               {"deviation", 0.75},
               {"before", 1},
               {"after", 3},
               {"residual", 2}},
              "residuals");
  for (const auto& [key, value] : {std::pair{"chi2_before", 30.0},
                                   {"chi2", 7.5},
                                   {"prior_chi2", 0.75},
                                   {"degrees_of_freedom", 3.0},
                                   {"variance_factor", 2.25},
                                   {"evaluations", 17.0},
                                   {"check_skins", 20.0}})
    EXPECT_EQ(json.at(key), value) << key;
  expect_same(json["gap_by_capacitance"], {{"before", 1.5e-6}, {"after", 1.25e-6}}, "gap");
  expect_same(json["directions"][1], {{"singular_value", 0.5}, {"weights", {-0.3, 0.95}}}, "");
}

TEST(FitReport, ClaimsAreCountedBeforeAndAfter) {
  Fitted f;
  f.c.fit = {"M1"};
  const std::vector<Claim> claims{{"M1", "paper", "it rises", "", false, {}},
                                  {"M2", "paper", "it falls", "", false, {}},
                                  {"M3", "paper", "it stays", "", false, {}}};
  JudgedFit judged;
  for (const Claim& claim : claims) {
    ClaimResult before, after;
    before.claim = after.claim = &claim;
    before.papilla = {Verdict::Differs, 1, 0.1, "old", ""};
    after.papilla = {claim.id == "M3" ? Verdict::Differs : Verdict::Agrees, 2, 0.2, "new", ""};
    judged.before.push_back(before);
    judged.after.push_back(after);
  }
  const std::string page = calibration_markdown(f.c, f.r, judged);
  EXPECT_NE(page.find("## Fitted claims\n\nOn 20 other skins at level design: 0 of 1 hold before, "
                      "1 after."),
            std::string::npos)
      << page;
  EXPECT_NE(
      page.find("## Held-out claims\n\nOn 20 other skins at level design: 0 of 2 hold before, "
                "1 after."),
      std::string::npos);
  EXPECT_NE(page.find("| M3 | it stays | differs: old | differs: new |"), std::string::npos);
  const auto rows = nlohmann::json::parse(calibration_json(f.c, f.r, judged))["claims"];
  expect_same(rows[1],
              {{"id", "M2"},
               {"statement", "it falls"},
               {"fitted", false},
               {"held_before", false},
               {"holds", true},
               {"before", "old"},
               {"after", "new"},
               {"model", 2},
               {"se", 0.2}},
              "claims");
}

TEST(FitReport, SaysWhatTheDataKnowOfEachParameter) {
  Fitted f;
  const auto verdict = [&f] {
    const std::string page = calibration_markdown(f.c, f.r);
    const std::size_t at = page.find("\nVerdict: ") + 1;
    return page.substr(at, page.find('\n', at) - at);
  };
  const std::string apart = "; skin.rms and water.scale are not told apart by these data.";
  EXPECT_EQ(verdict(),
            "Verdict: skin.rms is not identified: 75 % of what is known of it is the prior's; "
            "water.scale is known to one side only: its interval ends at a bound" +
                apart);
  // Half of 0.5 um of 2.5 um, half of 0.95 of 1.25; a share of a half is enough.
  f.r.fit.parameters[0].data_share = 0.5, f.r.fit.parameters[0].high_open = false;
  f.r.fit.parameters[1].at_bound = false;
  EXPECT_EQ(verdict(),
            "Verdict: skin.rms is known within ± 10 % (95 %); water.scale is known within ± 38 % "
            "(95 %)" +
                apart);
  f.r.fit.parameters[1].high = 0.8 + 2 * 2.3 * 1.25;
  EXPECT_NE(verdict().find("water.scale is known within ± 230 % (95 %)"), std::string::npos)
      << verdict();
  f.r.fit.parameters[1].high = 100;
  EXPECT_NE(verdict().find("water.scale is not known: its 95 % interval is wider than ± 1000 %"),
            std::string::npos)
      << verdict();
  f.r.fit.parameters[1].high = 1.75;
  f.r.fit.parameters[0].low_open = true;
  f.r.fit.directions[1] = {0.5, {0.1, 0.99}};  // one parameter is not apart from itself
  EXPECT_EQ(verdict(),
            "Verdict: skin.rms is known to one side only: its interval ends at a bound; "
            "water.scale is known within ± 38 % (95 %).");
  f.r.fit.parameters[0].high_open = true;
  EXPECT_TRUE(verdict().starts_with(
      "Verdict: skin.rms is known to neither side: its interval is all of what the bounds leave; "))
      << verdict();
  f.r.fit.directions = {{1, {0.7, 0.7}}, {0.99, {0.2, -0.2}}};  // below 1 the prior decides
  EXPECT_TRUE(verdict().ends_with("38 % (95 %)" + apart)) << verdict();
  EXPECT_EQ(verdict().find(apart), verdict().rfind(apart));
  EXPECT_EQ(nlohmann::json::parse(calibration_json(f.c, f.r))["verdicts"].size(), 3u);
}

TEST(FitReport, EndsOfRowsThatAreOpenAreSaidSo) {
  Fitted f;
  f.r.rows[2].low = -kInfinity, f.r.rows[2].high = 0.125;
  f.r.fit.converged = false, f.r.fit.message = "budget";
  f.c.parameters[0].fit.prior_sd = 0;
  f.c.check.level = "draft";
  f.c.title = "", f.c.finger.name = "mine";
  const std::string page = calibration_markdown(f.c, f.r);
  EXPECT_TRUE(page.starts_with("# Fit: mine\n")) << page;
  EXPECT_NE(page.find("| M3 | more | below 0.125 |"), std::string::npos) << page;
  EXPECT_NE(page.find("17 evaluations of the model; stopped: budget.\n"), std::string::npos);
  EXPECT_NE(page.find("2.25 um to 2.75 um (bound) | none | 25 |"), std::string::npos);
  EXPECT_NE(page.find("times 0.812 to 1.050, which level draft says over it"), std::string::npos);
  const auto json = nlohmann::json::parse(calibration_json(f.c, f.r));
  EXPECT_TRUE(json["parameters"][0]["prior"].is_null());
  EXPECT_EQ(json["converged"], false);
}

}  // namespace
}  // namespace papilla::tests::fit_test
