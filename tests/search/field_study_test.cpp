// Studies whose drive is part of what is searched: breakdown, pull-in, the voltage a modulation
// takes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/results.h"
#include "search/problem.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

namespace fs = std::filesystem;

std::string study_file(const std::string& name, const std::string& sections) {
  const fs::path file = temporary(name + ".toml");
  std::ofstream(file) << "schema_version = 1\n"
                         "[texture]\ntype = \"hole_array\"\n"
                         "[finger]\nbase = \"fingers/reference.toml\"\n"
                         "[environment]\nrelative_humidity = [\"35 %\"]\n"
                         "[accuracy]\nlevel = \"draft\"\n"
                      << sections;
  return file.string();
}

Fidelity small() {
  Fidelity f = fidelity_level("search");
  f.grid = 64;
  f.skins = 2;
  return f;
}

TEST(FieldStudy, TheStrongestModulationKeepsTheMarginOfTheOxide) {
  Study study = read_study(study_file(
      "margin",
      "[drive]\namplitude = \"150 V\"\n"
      "[design_space]\n\"drive.amplitude\" = [\"50 V\", \"900 V\"]\n"
      "\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
      "[objective]\nmaximise = \"mean(modulation)\"\n"
      "[constraints]\noxide_breakdown_margin = 2.0\n[search]\nevaluations = 10\ndrafts = 10\n"));
  OptimiseOptions options;
  options.folder = temporary("margin");
  fs::remove_all(options.folder);
  const OptimiseResult result = optimise_to_folder(study, options);
  ASSERT_FALSE(result.finalists.empty());
  bool feasible = false;
  for (const FinalDesign& d : result.finalists) {
    if (!d.feasible) continue;
    feasible = true;
    EXPECT_GE(d.confirmed.oxide_margin, 2 * (1 - 1e-9));
    EXPECT_LE(d.design.drive.amplitude, 250 * (1 + 1e-9));  // 500 nm of 1 GV/m, twice
    const auto report = nlohmann::json::parse(d.confirmed.reports.at(0));
    for (const auto& point : report["points"]) {
      EXPECT_GT(point["over_limit_area"].get<double>(), 0);
      EXPECT_GT(point["over_limit_share"].get<double>(), 0);
      EXPECT_LE(point["over_limit_share"].get<double>(), 1);
      EXPECT_GE(point["oxide_margin"].get<double>(), 2 * (1 - 1e-9));
    }
  }
  EXPECT_TRUE(feasible);
}

TEST(FieldStudy, VoltageForIsAnObjectiveAndAConstraint) {
  const Study study =
      read_study(study_file("voltage",
                            "[drive]\namplitude = \"150 V\"\n"
                            "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                            "[objective]\nminimise = \"voltage_for(modulation = 0.5)\"\n"
                            "[constraints]\n\"worst(voltage_for(modulation = 0.25))\" = \"60 V\"\n"
                            "\"worst(modulation)\" = 0.01\n"));
  const StudyProblem problem(study);
  EXPECT_EQ(problem.objectives()[0].name, "mean(voltage_for(modulation = 0.5))");
  EXPECT_EQ(problem.constraints().evaluated(), 2u);
  const TaskAnswer task = evaluate_task(problem, study.design, 0, {small()});
  ASSERT_TRUE(task.status.ok()) << task.status.text;
  const Score score = problem.score({task});
  ASSERT_EQ(score.limited.size(), 2u);
  EXPECT_LT(score.limited[0], score.values[0]);  // a quarter takes less than a half
  const Outcome outcome = problem.outcome(score);
  EXPECT_EQ(outcome.constraints.size(), 2u);
  EXPECT_EQ(outcome.constraints[0] <= 0, score.limited[0] <= 60);
  EXPECT_LT(outcome.constraints[1], 0);
}

TEST(FieldStudy, AVoltageThatCannotBeReachedIsARefusalWithItsReason) {
  const Study study = read_study(
      study_file("unreached",
                 "[drive]\namplitude = \"150 V\"\n[design_space]\n\"texture.depth\" = [\"0 nm\", "
                 "\"500 nm\"]\n[objective]\nminimise = \"voltage_for(modulation = 1000)\"\n"));
  const TaskAnswer task = evaluate_task(StudyProblem(study), study.design, 0, {small()});
  EXPECT_FALSE(task.status.ok());
  EXPECT_EQ(task.status.kind, TaskStatus::Kind::NotDefined);
  EXPECT_NE(task.status.text.find("the dielectric breaks down at 500 V"), std::string::npos)
      << task.status.text;
}

TEST(FieldStudy, AVoltagePastPullInIsARefusalWithItsReason) {
  Study study = read_study(
      study_file("pullin",
                 "[drive]\namplitude = \"150 V\"\n[design_space]\n\"drive.amplitude\" = [\"50 V\", "
                 "\"20000 V\"]\n[objective]\nmaximise = \"mean(modulation)\"\n"));
  study.design.model.coupling = Coupling::SelfConsistent;
  study.design.drive.amplitude = 20000;
  const TaskAnswer task = evaluate_task(StudyProblem(study), study.design, 0, {small()});
  EXPECT_FALSE(task.status.ok());
  EXPECT_EQ(task.status.kind, TaskStatus::Kind::NoEquilibrium);
  EXPECT_NE(task.status.text.find("35 % RH: "), std::string::npos) << task.status.text;
}

TEST(FieldStudy, AConstraintOnAnUnknownMetricIsAMistakeAtItsPlace) {
  try {
    read_study(study_file("wrong",
                          "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                          "[objective]\nminimise = \"friction\"\n"
                          "[constraints]\n\"worst(modulatoin)\" = 0.3\n\"mean(bridges)\" = 3\n"));
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2u);
    EXPECT_NE(error.problems()[0].message.find("did you mean \"modulation\""), std::string::npos);
    EXPECT_NE(error.problems()[1].message.find("no better direction"), std::string::npos);
  }
}

}  // namespace
}  // namespace papilla::tests
