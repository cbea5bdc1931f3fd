// Studies whose drive is part of what is searched: breakdown, pull-in, the voltage a modulation
// takes.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "forward/forward.h"
#include "numerics/statistics.h"
#include "report/results.h"
#include "search/levels.h"
#include "search/problem.h"
#include "search/run.h"
#include "search/task.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests::field_study_test {
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
  Study study = without_belief(read_study(study_file(
      "margin",
      "[drive]\namplitude = \"150 V\"\n"
      "[design_space]\n\"drive.amplitude\" = [\"50 V\", \"900 V\"]\n"
      "\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
      "[objective]\nmaximise = \"mean(modulation)\"\n"
      "[constraints]\noxide_breakdown_margin = 2.0\n[search]\nevaluations = 10\ndrafts = 10\n")));
  study.design.accuracy.grid = 64;
  study.design.finger.uncertainty.clear();
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
      EXPECT_GE(point["bridged_margin"].get<double>(), 2 * (1 - 1e-9));
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
  const Score score = problem.score(problem.study().design, {task});
  ASSERT_EQ(score.limited.size(), 2u);
  EXPECT_LT(score.limited[0], score.values[0]);  // a quarter takes less than a half
  const Outcome outcome = problem.outcome(score);
  EXPECT_EQ(outcome.constraints.size(), 2u);
  EXPECT_EQ(outcome.constraints[0] <= 0, score.limited[0] <= 60);
  EXPECT_LT(outcome.constraints[1], 0);
}

// The search has few pixels and no control skins: what they miss of contact areas a dry contact
// says, where a goal is about them, so that a limit on friction means the same at every level.
TEST(FieldStudy, ALimitOfFrictionIsJudgedInTheSearchAsItIsConfirmed) {
  const auto study_with = [](const std::string& limits) {
    return without_belief(
        read_study(study_file("friction",
                              "[drive]\namplitude = \"150 V\"\n"
                              "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                              "[objective]\nmaximise = \"mean(modulation)\"\n" +
                                  limits)));
  };
  const Study study = study_with("[constraints]\n\"worst(friction)\" = \"1 N\"\n"),
              without = study_with("");
  const StudyProblem problem(study);
  EXPECT_TRUE(problem.goals().areas);
  EXPECT_FALSE(StudyProblem(without).goals().areas);
  const Design design = problem.study().design;
  const Fidelity search = stage_fidelity(problem, Stage::Search);
  const TaskAnswer asked = evaluate_task(problem, design, 0, {search});
  ASSERT_TRUE(asked.status.ok()) << asked.status.text;
  const Response confirmed =
      evaluate(scene_of(design), design.texture, stage_fidelity(problem, Stage::Confirm));
  const double friction = confirmed.points[0].friction_off.value;
  EXPECT_NEAR(asked.limited[0], friction, 0.15 * friction);
  // By pixels alone it is not.
  const Response alone = evaluate(scene_of(design), design.texture, search);
  EXPECT_GT(alone.points[0].friction_off.value, 1.25 * friction);
  // Of modulations they miss next to nothing: both frictions have one factor.
  EXPECT_NEAR(asked.objectives[0].value, alone.points[0].modulation.value, 2e-3);
  // So is what a check says of the same finger.
  const TaskAnswer check =
      evaluate_variant(problem, design, 0, stage_fidelity(problem, Stage::Stability));
  EXPECT_NEAR(check.limited[0], friction, 0.15 * friction);
}

// So that designs which a skin moves alike are told apart by it: the confirmed answer has the
// voltage skin by skin. Eq. search.15
TEST(FieldStudy, AConfirmedVoltageHasItsSkins) {
  const Study study =
      read_study(study_file("skins",
                            "[drive]\namplitude = \"150 V\"\n"
                            "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                            "[objective]\nminimise = \"worst(voltage_for(modulation = 0.3))\"\n"));
  const StudyProblem problem(study);
  const TaskAnswer task = evaluate_task(problem, study.design, 0, {small(), true});
  ASSERT_TRUE(task.status.ok()) << task.status.text;
  const std::vector<double>& skins = task.samples.at(0).at(0).sampling;
  ASSERT_EQ(skins.size(), 2u);
  EXPECT_NEAR(mean_estimate(skins).value, task.objectives[0].value,
              1e-9 * task.objectives[0].value);
  EXPECT_GT(mean_estimate(skins).se, 0);
  EXPECT_LE(mean_estimate(skins).se, task.objectives[0].error);
}

// Members are run on few skins, without control skins: what is felt there takes the error of the
// modulation that the confirmation states, as a share of F_on/F_off.
TEST(FieldStudy, WhatIsFeltAtAMemberIsKnownAsTheConfirmedModulationIs) {
  const fs::path belief = temporary("felt_belief.toml");
  std::ofstream(belief) << "schema_version = 1\n[[member]]\nweight = 1\nhypothesis = \"weak\"\n"
                           "set = { \"macro.shear_strength\" = \"8 MPa\" }\n";
  Study study = read_study(study_file("felt",
                                      "[drive]\namplitude = \"150 V\"\n"
                                      "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                                      "[objective]\nmaximise = \"mean(modulation)\"\n"));
  study.design.finger.belief = belief.string();
  Fidelity f = small();
  f.grid = 32;
  f.control_skins = 2;
  const Measured known =
      evaluate(scene_of(study.design), study.design.texture, f).points.at(0).modulation;
  const double noticed = known.value - known.se();
  study.objective.maximise = {{Summary::Mean, Felt{noticed}}};
  const StudyProblem problem(study);
  const double relative = known.se() / (1 + known.value);
  const TaskAnswer answer = evaluate_steps(problem, study.design, 0, {f, true});
  ASSERT_EQ(answer.members.size(), 2u);  // the last is the finger as it is
  for (const TaskAnswer& there : answer.members) {
    ASSERT_TRUE(there.status.ok()) << there.status.text;
    const double m = there.worst;  // of the one humidity
    EXPECT_NEAR(there.objectives.at(0).value, normal_cdf((m - noticed) / (relative * (1 + m))),
                1e-9);
  }
  Study plain = study;
  plain.objective.maximise = {{Summary::Mean, kModulation}};
  EXPECT_NEAR(task_price(problem, Stage::Belief) - task_price(StudyProblem(plain), Stage::Belief),
              task_price(problem, Stage::Confirm), 1e-9 * task_price(problem, Stage::Confirm));
}

// 500 nm of 1 GV/m break down at 500 V: over the voltage that is asked for, not over the design's.
TEST(FieldStudy, TheFilmHoldsTheVoltageThatTheWishAsksFor) {
  const auto margin = [](const std::string& wishes) {
    const Study study =
        read_study(study_file("held",
                              "[drive]\namplitude = \"400 V\"\n"
                              "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n" +
                                  wishes));
    const StudyProblem problem(study);
    const TaskAnswer task = evaluate_task(problem, study.design, 0, {small()});
    EXPECT_TRUE(task.status.ok()) << task.status.text;
    return std::pair(task.oxide_margin, task.objectives.at(0).value);
  };
  const std::string voltage = "[objective]\nminimise = \"worst(voltage_for(modulation = 0.3))\"\n";
  const auto [asked, volts] = margin(voltage);
  EXPECT_NEAR(asked, 500 / volts, 1e-9);
  EXPECT_NE(asked, 500.0 / 400);
  const auto [own, same] = margin(voltage + "[constraints]\n\"worst(modulation)\" = 0.1\n");
  EXPECT_EQ(same, volts);
  EXPECT_NEAR(own, std::min(500.0 / 400, 500 / volts), 1e-6);
}

// A price is a promise about time: with the search for a voltage and without it, on one machine.
TEST(FieldStudy, ThePriceOfAnEvaluationKnowsItsVoltages) {
  const auto study_of = [](const std::string& wish) {
    return read_study(study_file("priced",
                                 "[drive]\namplitude = \"200 V\"\n"
                                 "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n"
                                 "[objective]\nminimise = \"" +
                                     wish + "\"\n"));
  };
  const Study without = study_of("variation(contact_area)"),
              with = study_of("worst(voltage_for(modulation = 0.3))");
  const StudyProblem plain(without), wish(with);
  const double ratio = task_price(wish, Stage::Search) / task_price(plain, Stage::Search);
  EXPECT_GT(ratio, 1.3);
  // The quickest of nine, side by side and on one thread: other work, and threads that wait for it,
  // only add.
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto time_of = [](const StudyProblem& problem) {
    const std::clock_t from = std::clock();
    EXPECT_TRUE(
        evaluate_task(problem, problem.study().design, 0, {stage_fidelity(problem, Stage::Search)})
            .status.ok());
    return static_cast<double>(std::clock() - from);
  };
  double plainly = std::numeric_limits<double>::infinity(), wishing = plainly;
  for (int run = 0; run < 9; ++run) {
    plainly = std::min(plainly, time_of(plain));
    wishing = std::min(wishing, time_of(wish));
  }
  omp_set_num_threads(threads);
  EXPECT_NEAR(std::log(wishing / plainly), std::log(ratio), std::log(2.0));
}

// What is left of a planar film below the texture holds the voltage or not: nobody evaluates that.
TEST(FieldStudy, AFilmThatCannotHoldIsRefusedBeforeItsEvaluation) {
  const auto study_of = [](const std::string& drive) {
    return read_study(
        study_file("film", drive + "[surface]\nprocess = \"planar\"\n"
                                   "[design_space]\n\"texture.depth\" = [\"0 nm\", \"300 nm\"]\n"
                                   "[objective]\nmaximise = \"mean(modulation)\"\n"
                                   "[constraints]\noxide_breakdown_margin = 2\n"));
  };
  const Study study = study_of("[drive]\namplitude = \"150 V\"\n");
  const StudyProblem problem(study);
  const auto& limits = problem.constraints();
  const Point shallow = problem.space().unit({190e-9}), deep = problem.space().unit({210e-9});
  EXPECT_NEAR(limits.geometry(shallow).back(), 2 / (310.0 / 150) - 1, 1e-9);
  EXPECT_NEAR(limits.geometry(deep).back(), 2 / (290.0 / 150) - 1, 1e-9);
  EXPECT_EQ(limits.geometry_reason(shallow), "");
  EXPECT_NE(limits.geometry_reason(deep).find("oxide_breakdown_margin 1.93"), std::string::npos)
      << limits.geometry_reason(deep);
  Evaluation refused{deep, {}};
  refused.outcome.constraints = limits.geometry(deep);
  EXPECT_EQ(limits.never_kept({refused}),
            std::vector<std::string>{"oxide_breakdown_margin (at least 2)"});
  // A direct voltage falls across the film as it leaks: the field has to say.
  const Study direct = study_of("[drive]\namplitude = \"150 V\"\nwaveform = \"dc\"\n");
  EXPECT_LE(StudyProblem(direct).constraints().geometry(deep).back(), 0);
}

TEST(FieldStudy, WishesForTheAmplitudeThatMakeNoSenseAreRefused) {
  const auto refusal = [](const std::string& rest) -> std::string {
    const Study study = read_study(study_file("wish", "[drive]\namplitude = \"150 V\"\n" + rest));
    try {
      const StudyProblem problem(study);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string depth = "[design_space]\n\"texture.depth\" = [\"0 nm\", \"500 nm\"]\n",
                    volts = depth + "\"drive.amplitude\" = [\"50 V\", \"200 V\"]\n",
                    least = "[objective]\nminimise = \"drive.amplitude\"\n",
                    strong = "[constraints]\n\"worst(modulation)\" = 0.3\n";
  EXPECT_NE(refusal(depth + least + strong).find("the same for all designs"), std::string::npos);
  EXPECT_NE(refusal(volts + least).find("the lowest is best"), std::string::npos);
  EXPECT_NE(refusal(volts + "[objective]\nminimise = \"voltage_for(modulation = 0.3)\"\n")
                .find("no effect on voltage_for"),
            std::string::npos);
  EXPECT_EQ(refusal(volts + least + strong), "");
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
  study.design.model.coupling = Coupling::Equilibrium;
  study.design.drive.amplitude = 20000;
  const TaskAnswer task = evaluate_task(StudyProblem(study), study.design, 0, {small()});
  EXPECT_FALSE(task.status.ok());
  EXPECT_EQ(task.status.kind, TaskStatus::Kind::NoEquilibrium);
  EXPECT_NE(task.status.text.find("35 % RH: "), std::string::npos) << task.status.text;
}

// A limit on the dielectric says how far beyond it a design is; without one it has no number.
TEST(FieldStudy, AVoltagePastBreakdownIsARefusalWhereNoLimitSaysSo) {
  const auto answer = [](const std::string& constraints) {
    Study study = without_belief(read_study(
        study_file("breakdown",
                   "[drive]\namplitude = \"1500 V\"\n[design_space]\n\"texture.depth\" = [\"0 "
                   "nm\", \"500 nm\"]\n[objective]\nmaximise = \"mean(modulation)\"\n" +
                       constraints)));
    study.design.model.coupling = Coupling::OnePass;
    return evaluate_task(StudyProblem(study), study.design, 0, {small()});
  };
  const TaskAnswer refused = answer("");
  EXPECT_EQ(refused.status.kind, TaskStatus::Kind::NoEquilibrium);
  EXPECT_NE(refused.status.text.find("35 % RH: breakdown: "), std::string::npos)
      << refused.status.text;
  // A limit that a broken film would keep leads nowhere.
  EXPECT_EQ(answer("[constraints]\noxide_breakdown_margin = 0.01\n").status.kind,
            TaskStatus::Kind::NoEquilibrium);
  const TaskAnswer limited = answer("[constraints]\noxide_breakdown_margin = 1.5\n");
  ASSERT_TRUE(limited.status.ok()) << limited.status.text;
  EXPECT_LT(limited.oxide_margin, 1);
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
}  // namespace papilla::tests::field_study_test
