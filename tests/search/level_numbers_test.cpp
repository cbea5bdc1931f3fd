// What each stage of a run is computed with and what that costs, number by number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/constants.h"
#include "forward/plan.h"
#include "search/levels.h"
#include "search/stability.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::level_numbers_test {
namespace {

Study one_finger() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.search.seed = 77;
  return study;
}

// As `papilla evaluate` has them of the same file.
TEST(LevelNumbers, OfTheConfirmationTakeGridAndPlacementsOfTheStudy) {
  Study study = one_finger();
  study.design.accuracy.grid = 512;
  study.design.accuracy.droplet_seeds = 6;
  const StudyProblem problem(study);
  const Fidelity confirm = stage_fidelity(problem, Stage::Confirm);
  EXPECT_EQ(confirm.grid, 512);
  EXPECT_EQ(confirm.droplet_seeds, 6);
  EXPECT_EQ(steps_fidelity(problem, confirm).grid, 64);
  EXPECT_EQ(stage_fidelity(problem, Stage::Search).droplet_seeds, 1);
}

TEST(LevelNumbers, OfEachStageAreThoseOfTheTheory) {
  const Study study = one_finger();
  const StudyProblem problem(study);
  const auto of = [&](Stage stage) { return stage_fidelity(problem, stage); };
  const Fidelity check = of(Stage::Sensitivity), search = of(Stage::Search),
                 draft = of(Stage::Draft), narrow = of(Stage::Narrow), confirm = of(Stage::Confirm);
  for (const Fidelity& f : {check, search, draft, narrow, confirm}) EXPECT_EQ(f.seed, 77u);
  // The search: eight skins of its own pixels, four of them in equilibrium; its drafts two.
  Fidelity expected = fidelity_level("search");
  expected.seed = 77;
  expected.level = "steer";
  expected.grid = search.grid;
  EXPECT_EQ(search, expected);
  EXPECT_EQ(search.skins, 8);
  EXPECT_EQ(search.equilibrium_skins, 4);
  expected.skins = 2;
  EXPECT_EQ(draft, expected);
  // Between: twice as many from the 500th on, the pull corrected by the field of one.
  expected.level = "narrow";
  expected.skins = 16, expected.first_skin = 500, expected.field_skins = 1;
  EXPECT_EQ(narrow, expected);
  // So is what is said of one design on one finger, on the search's skins.
  expected.level = "check";
  expected.skins = 8, expected.first_skin = 0;
  EXPECT_EQ(check, expected);
  EXPECT_EQ(of(Stage::Stability), check);
  // Confirmed at the study's own level from the 1000th on.
  expected = fidelity_level("design");
  expected.seed = 77, expected.first_skin = 1000;
  EXPECT_EQ(confirm, expected);
  EXPECT_EQ(of(Stage::Rounding), confirm);
  EXPECT_EQ(of(Stage::Steps), confirm);
  const Fidelity steps = steps_fidelity(problem, confirm);
  expected.skins = 12, expected.grid = 64;
  EXPECT_EQ(steps, expected);
}

TEST(LevelNumbers, AreSharedOutOverThePopulation) {
  Study study = one_finger();
  const int whole = fidelity_level("design").skins;
  for (const auto& [fingers, searched, steps] :
       {std::tuple{1, 8, 12}, {2, 4, 6}, {3, 4, 4}, {4, 4, 3}, {5, 4, 2}, {8, 4, 2}}) {
    study.population.assign(static_cast<std::size_t>(fingers), study.design.finger);
    const StudyProblem problem(study);
    EXPECT_EQ(stage_fidelity(problem, Stage::Search).skins, searched) << fingers;
    EXPECT_EQ(stage_fidelity(problem, Stage::Draft).skins, 2);
    EXPECT_EQ(stage_fidelity(problem, Stage::Narrow).skins, 2 * searched);
    EXPECT_EQ(stage_fidelity(problem, Stage::Stability).skins, 8);
    EXPECT_EQ(stage_fidelity(problem, Stage::Confirm).skins, std::max(10, whole / fingers));
    EXPECT_EQ(steps_fidelity(problem, fidelity_level("design")).skins, steps) << fingers;
  }
}

double plan_seconds(const Study& study, const Fidelity& fidelity) {
  const Design& d = study.design;
  return make_plan({d.surface, d.finger, d.environment, d.drive, d.model}, d.texture, fidelity)
      .seconds();
}

// Each target of voltage_for drives the patches again: 2.1 of an evaluation by the load law that
// solves no 3-D field, 0.9 of one that does, 2.3 by solved areas.
TEST(LevelNumbers, APriceIsThatOfThePlanAndOfItsVoltages) {
  Study study = one_finger();
  for (const int targets : {0, 1, 2}) {
    if (targets > 0)
      study.objective.minimise = {parse_metric("worst(voltage_for(modulation = 0.3))")};
    if (targets > 1)
      study.objective.maximise = {parse_metric("mean(voltage_for(modulation = 0.4))")};
    const StudyProblem problem(study);
    ASSERT_EQ(problem.goals().voltage_targets.size(), static_cast<std::size_t>(targets));
    for (const auto& [stage, each] :
         {std::pair{Stage::Search, 2.1}, {Stage::Narrow, 0.9}, {Stage::Confirm, 2.3}}) {
      const double plain = plan_seconds(study, stage_fidelity(problem, stage));
      EXPECT_NEAR(task_price(problem, stage), plain * (1 + each * targets), 1e-9 * plain);
    }
  }
}

// Two evaluations a direction of the fit.
TEST(LevelNumbers, StepsOfTheFingerCostTwoEvaluationsEach) {
  Study study = one_finger();
  study.design.finger.uncertainty = {{"macro.shear_strength", 0.1, {}},
                                     {"macro.load_share", 0.2, {}}};
  const StudyProblem problem(study);
  ASSERT_EQ(problem.parameters_unknown(), "");
  Study other = one_finger();
  other.design.finger.uncertainty = {{"macro.shear_strength", 0.1, {}}};
  const StudyProblem single(other);
  const double two = task_price(problem, Stage::Steps), one = task_price(single, Stage::Steps);
  EXPECT_NEAR(two, 2 * one, 1e-9 * two);
  EXPECT_GT(one, 0);
  // A run has them of the best design and of its flat surface, on every finger.
  Study none = one_finger();
  none.design.finger.uncertainty.clear();
  EXPECT_NEAR(study_cost(StudyProblem(study)).seconds - study_cost(StudyProblem(none)).seconds,
              2 * over_price(Stage::Steps) * two, 1e-6 * study_cost(StudyProblem(study)).seconds);
}

TEST(LevelNumbers, ThePlanOfASearchNamesItsStages) {
  Study study = one_finger();
  study.design.finger.name = "mine";
  study.search.evaluations = 40, study.search.drafts = 9;
  const auto level = [&](Stage stage) {
    const StudyProblem problem(study);
    const Design& d = study.design;
    return make_plan({d.surface, d.finger, d.environment, d.drive, d.model}, d.texture,
                     stage_fidelity(problem, stage))
        .text();
  };
  const std::string plan = search_plan(StudyProblem(study));
  EXPECT_TRUE(plan.starts_with("search: bayesian (")) << plan;
  EXPECT_NE(plan.find("), 9 drafts, 40 evaluations, seed 77\n"
                      "tasks of an evaluation (finger, scenario): [mine]\n\nsearch level:\n" +
                      level(Stage::Search) +
                      "\n13 of them and of their neighbours again, other skins:\n" +
                      level(Stage::Narrow) + "\nconfirmation of up to 9 finalists, fresh skins:\n"),
            std::string::npos)
      << plan;
  EXPECT_TRUE(plan.ends_with(level(Stage::Confirm)));
  study.search.drafts = 0;
  study.search.evaluations = 5;  // one to judge again is none
  const std::string few = search_plan(StudyProblem(study));
  EXPECT_NE(few.find("), 5 evaluations, seed 77\n"), std::string::npos) << few;
  EXPECT_EQ(few.find("again, other skins"), std::string::npos) << few;
  study.search.evaluations = 6;
  EXPECT_NE(search_plan(StudyProblem(study)).find("\n2 of them and of their neighbours again"),
            std::string::npos);
}

// The smallest feature that a search meets lies on the limit of its walls, between the places that
// are drawn; without limits in a corner of the space.
TEST(LevelNumbers, TheSmallestFeatureIsThatOfTheLimitOrOfACorner) {
  Study study = one_finger();
  HoleArray& holes = std::get<HoleArray>(study.design.texture.kind);
  holes.wall_angle = kPi / 2, holes.edge_radius = 0;
  study.variables = {{"texture.period", "um", 4e-6, 6e-6, {}},
                     {"texture.diameter", "um", 2e-6, 3.9e-6, {}}};
  study.constraints = {read_constraint("min_wall", 0.7e-6)};
  EXPECT_NEAR(StudyProblem(study).smallest_feature(), 0.7e-6, 0.7e-8);
  EXPECT_GE(StudyProblem(study).smallest_feature(), 0.7e-6 * (1 - 1e-9));
  study.constraints.clear();
  EXPECT_NEAR(StudyProblem(study).smallest_feature(), 0.1e-6, 1e-12);
  study.constraints = {read_constraint("min_wall", 10e-6)};  // none keeps it
  EXPECT_EQ(StudyProblem(study).smallest_feature(), kInfinity);
  const StudyCost cost = study_cost(StudyProblem(study));
  EXPECT_EQ(cost.pixels, 64);
  EXPECT_EQ(cost.feature, kInfinity);
}

}  // namespace
}  // namespace papilla::tests::level_numbers_test
