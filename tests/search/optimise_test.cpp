#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "numerics/statistics.h"
#include "report/response.h"
#include "report/results.h"
#include "report/summary.h"
#include "search/differing.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/search/small_study.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::optimise_test {
namespace {

std::string response_text(const Response& response) { return response_json(response, false); }

TEST(Risk, HasItsClosedForms) {
  const std::vector<double> values{1, 2, 3, 4}, weights{1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk(""), true, values, weights), 2.5);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("worst"), true, values, weights), 1);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("worst"), false, values, weights), 4);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("mean - 2 std"), true, values, weights),
                   2.5 - 2 * std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("mean - 2 std"), false, values, weights),
                   2.5 + 2 * std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("cvar 50 %"), true, values, weights), 1.5);
  EXPECT_DOUBLE_EQ(apply_risk(parse_risk("cvar 37.5 %"), false, values, weights),
                   (4 + 0.5 * 3) / 1.5);
  for (const char* risk : {"", "worst", "mean - 2 std", "cvar 50 %"})
    EXPECT_FALSE(std::signbit(apply_risk(parse_risk(risk), false, {0, 0}, {1, 1}))) << risk;
  EXPECT_THROW(parse_risk("mean - two std"), InputError);
  EXPECT_THROW(parse_risk("cvar 0 %"), InputError);
}

TEST(Risk, CvarOfANormalSampleIsItsFormula) {
  std::vector<double> values, weights;
  for (int i = 0; i < 4000; ++i) {
    values.push_back(normal_quantile((i + 0.5) / 4000));
    weights.push_back(1);
  }
  const double z = normal_quantile(0.2);
  EXPECT_NEAR(apply_risk(parse_risk("cvar 20 %"), true, values, weights),
              -std::exp(-0.5 * z * z) / std::sqrt(2 * std::acos(-1.0)) / 0.2, 2e-3);
}

TEST(StudyProblem, RefusesShapesOutsideTheFabricationLimits) {
  const Study study = small_study();
  const StudyProblem problem(study);
  // period 5 um, diameter 4.8 um, depth 350 nm, 50 deg
  const Point thin = problem.space().unit({5e-6, 4.8e-6, 350e-9, 0.87});
  EXPECT_EQ(problem.constraints().geometry_reason(thin), "min_wall 0.2 um is below 0.4 um");
  const Point flat = problem.space().unit({5e-6, 4.8e-6, 0, 0.87});
  EXPECT_EQ(problem.constraints().geometry_reason(flat), "");
  EXPECT_EQ(problem.space().starts().size(), 2u);  // the study's own design and the flat surface
}

TEST(StudyProblem, RefusesToMaximiseTheModulationOfAnUndrivenDesign) {
  Study study = small_study();
  study.design.drive.amplitude = 0;
  EXPECT_THROW(StudyProblem{study}, InputError);
}

TEST(StudyProblem, RefusesAFrequencyThatNothingFeels) {
  Study study = small_study();
  study.variables.push_back({"drive.frequency", "kHz", 1e3, 20e3, {}});
  study.design.finger.electrical.corner_frequency = 0;
  study.design.finger.electrical.gap_resistivity = 0;
  try {
    const StudyProblem problem(study);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("drive.frequency has no effect: neither film nor gap"),
              std::string::npos)
        << e.what();
  }
  // One finger of the population that conducts at low frequency is enough.
  study.population.assign(2, study.design.finger);
  study.population[1].electrical.corner_frequency = 2e3;
  EXPECT_NO_THROW(StudyProblem{study});
}

// Friction is proportional to the shear strength: of fingers that share its uncertainty the errors
// add, of others they add in squares.
TEST(StudyProblem, FingersOfOneUncertaintyMoveTogether) {
  Study study = small_study();
  study.design.environment.relative_humidity = {0.35};
  study.objective.maximise.clear();
  study.objective.minimise = {parse_metric("friction")};
  study.design.accuracy.parameters = true;
  study.population.assign(2, study.design.finger);
  for (Finger& f : study.population) {
    f.water.hysteresis = 0;
    f.uncertainty = {{"macro.shear_strength", 0.1, {}}};
  }
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  f.skins = 6;
  const auto score = [&] {
    const StudyProblem problem(study);
    const Design design = problem.space().design(problem.space().unit_of_study());
    std::vector<TaskAnswer> tasks;
    for (std::size_t t = 0; t < problem.tasks().size(); ++t)
      tasks.push_back(evaluate_task(problem, design, t, {f, true, response_text}));
    return problem.score(problem.study().design, tasks);
  };
  const Score same = score();
  ASSERT_TRUE(same.ok) << same.reason;
  const double friction = same.values[0];
  EXPECT_NEAR(*parameter_error(same, 0) / friction, std::sinh(0.1), 2e-3);
  EXPECT_EQ(*parameter_error(same, same, 0), 0);
  EXPECT_NE(same.reports[0].find("\"directions\": 1"), std::string::npos);
  {
    const StudyProblem problem(study);  // the steps alone
    const Design design = problem.space().design(problem.space().unit_of_study());
    Score alone;
    alone.of_tasks = same.of_tasks;
    problem.add_steps(
        alone, {evaluate_steps(problem, design, 0, {f}), evaluate_steps(problem, design, 1, {f})});
    EXPECT_EQ(alone.parameter_steps, same.parameter_steps);
  }

  study.population[1].uncertainty[0].deviation = 0.1 + 1e-9;
  const Score other = score();
  EXPECT_EQ(other.parameter_steps[0].size(), 2u);
  EXPECT_NEAR(*parameter_error(other, 0) / friction, std::sinh(0.1) / std::sqrt(2), 2e-3);
  EXPECT_EQ(other.errors[0], same.errors[0]);  // of its own

  study.population[1].uncertainty.clear();
  EXPECT_FALSE(parameter_error(score(), 0));
  EXPECT_NE(StudyProblem(study).parameters_unknown().find("[[uncertainty]]"), std::string::npos);
}

TEST(Optimise, ARefusedStartLeavesNothingBehind) {
  const Study study = small_study();
  const std::string folder = fresh_folder("refused");
  EXPECT_THROW(optimise_to_folder(study, {folder, true, {}, nullptr}),
               InputError);  // nothing to continue
  EXPECT_THROW(optimise_to_folder(study, {folder, false, {}, nullptr, "bestest"}), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Optimise, AResumedRunIsNotShortened) {
  Study study = small_study();
  study.search.evaluations = 5;
  const std::string folder = fresh_folder("shortened");
  std::atomic<bool> stop{false};
  const auto progress = [&](const Progress& p) { stop = p.done >= 4; };
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, progress, &stop}).interrupted);
  study.search.evaluations = 3;
  try {
    optimise_to_folder(study, {folder, true, {}, nullptr});
    ADD_FAILURE() << "went on";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("has 4 evaluations already, more than the 3"),
              std::string::npos)
        << e.what();
  }
}

// Who continues a run with another study hears in which keys they differ.
TEST(Optimise, AnotherStudyIsRefusedByTheKeysThatDiffer) {
  Study study = small_study();
  const std::string folder = fresh_folder("another");
  std::atomic<bool> stop{true};
  EXPECT_TRUE(optimise_to_folder(study, {folder, false, {}, &stop}).interrupted);
  study.search.evaluations += 5;  // may be more
  study.design.drive.amplitude = 150;
  try {
    optimise_to_folder(study, {folder, true, {}, nullptr});
    FAIL();
  } catch (const InputError& e) {
    const std::string why = e.what();
    EXPECT_NE(why.find("written for another study"), std::string::npos) << why;
    EXPECT_NE(why.find("drive.amplitude \"200 V\", \"150 V\""), std::string::npos) << why;
    EXPECT_EQ(why.find("evaluations"), std::string::npos) << why;
  }
}

// Three are enough to see what is other; keys that a run may be continued with are none of them.
TEST(DifferingKeys, AreThreeAtMostWithBothOfTheirValues) {
  const std::string here = "a = 1\nb = 2\nc = 3\nd = 4\nonly = 5\n[search]\ntime = \"1 h\"\n";
  EXPECT_EQ(differing_keys(here, here), "");
  EXPECT_EQ(
      differing_keys("a = 9\nb = 2\nc = 3\nd = 4\nother = 7\n[search]\ntime = \"2 h\"\n", here),
      "a 9, 1; only none, 5; other 7, none");
  EXPECT_EQ(differing_keys("a = 9\nb = 8\nc = 7\nd = 6\nonly = 5\n", here),
            "a 9, 1; b 8, 2; c 7, 3");
}

// What the finger leaves open of two designs cancels where both answer alike, and only there.
TEST(Results, DifferencesAreSaidToBeBetterKnownWhereTheyAre) {
  const Study study = without_belief(read_study(find_design("m3_glass/conformal.toml")));
  const StudyProblem problem(study);
  ASSERT_EQ(problem.objectives().size(), 2u);
  FinalDesign d;
  d.unit.assign(study.variables.size(), 0.5);
  d.design = study.design;
  d.feasible = d.on_front = true;
  d.folder = "front/01";
  d.confirmed.ok = true;
  d.confirmed.values = {0.366, 0.215};
  d.confirmed.errors = {0.075, 0.120};
  d.confirmed.parameter_steps = {{{0.05, 0.05}}, {{0.010, 0.010}}};
  OptimiseResult result;
  result.evaluations = 1;
  result.any_feasible = true;
  result.finalists = {d};
  result.stability.variants = {{"alone", {d.confirmed.values}, {true}}};
  result.stability.times_on_front = {1};
  result.flat = d.confirmed;
  result.flat->values = {0.344, 0.222};
  result.flat->errors = {0.071, 0.114};
  result.flat->parameter_steps = {{{0.04, 0.04}}, {{-0.005, -0.005}}};
  const std::string first = problem.objectives()[0].name, second = problem.objectives()[1].name;
  const std::string table = result_table(study, result);
  EXPECT_NE(table.find("less uncertain by it than the values in " + first + ";"),
            std::string::npos);
  EXPECT_NE(table.find("as uncertain by it as the values in " + second), std::string::npos)
      << table;

  const std::string folder = temporary("results"), pick;
  std::filesystem::create_directories(folder);
  write_results({folder, study, problem, {}, result, pick});
  const std::string summary = read_bytes(folder + "/summary.md");
  EXPECT_NE(summary.find("| +0.022 ± 0.075 (0.010) | -0.007 ± 0.120 (0.015) |"), std::string::npos)
      << summary;
  EXPECT_NE(summary.find("1 evaluation."), std::string::npos) << summary;
  result.flat->parameter_steps.clear();
  EXPECT_EQ(result_table(study, result).find("difference"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::optimise_test
