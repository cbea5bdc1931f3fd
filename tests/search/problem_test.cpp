// What a study asks of a search, worked out by hand: its tasks, goals, space, levels and price. No
// contact is solved.
#include "search/problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "forward/plan.h"
#include "numerics/statistics.h"
#include "search/levels.h"
#include "search/stability.h"
#include "tests/support/refusal.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::problem_test {
namespace {

using Names = std::vector<std::string>;

Study oxide_study() {
  return without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
}

Names names_of(const std::vector<StudyTask>& tasks) {
  Names out;
  for (const StudyTask& t : tasks) out.push_back(t.name);
  return out;
}

std::string refusal(const Study& study) {
  return refusal_of([&] { const StudyProblem problem(study); });
}

TEST(Tasks, AreEveryFingerInEveryScenarioThenBothEndsOfEachScatter) {
  Study study = oxide_study();
  study.population.resize(2);
  study.population[0].name = "one", study.population[1].name = "two";
  study.scenarios = {{"new", 3, {}},
                     {"worn", 1, {{"surface.contact_angle", 1.2}, {"finger.load", 0.5}}}};
  study.scatter = {{"texture.depth", 20e-9}, {"texture.diameter", 50e-9}};
  const std::vector<StudyTask> tasks = study_tasks(study);
  ASSERT_EQ(tasks.size(), 4u * 5u);
  const Names names = names_of(tasks);
  EXPECT_EQ(Names(names.begin(), names.begin() + 9),
            (Names{"one, new", "two, new", "one, worn", "two, worn", "one, new, texture.depth low",
                   "one, new, texture.depth high", "one, new, texture.diameter low",
                   "one, new, texture.diameter high", "two, new, texture.depth low"}));
  EXPECT_EQ(names.back(), "two, worn, texture.diameter high");
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const std::size_t own = t < 4 ? t : (t - 4) / 4;
    EXPECT_EQ(tasks[t].nominal(), t < 4);
    EXPECT_EQ(tasks[t].weight, own < 2 ? 3 : 1) << t;
    EXPECT_EQ(tasks[t].finger.name, own % 2 == 0 ? "one" : "two") << t;
    const Design d = task_design(study, study.design, tasks[t]);
    EXPECT_EQ(d.finger.name, tasks[t].finger.name);
    EXPECT_EQ(d.surface.contact_angle, own < 2 ? study.design.surface.contact_angle : 1.2);
    const auto& holes = std::get<HoleArray>(d.texture.kind);
    const int k = t < 4 ? -1 : static_cast<int>((t - 4) % 4);
    EXPECT_NEAR(holes.depth, 350e-9 + (k == 0 ? -20e-9 : k == 1 ? 20e-9 : 0), 1e-18) << t;
    EXPECT_NEAR(holes.diameter, 3e-6 + (k == 2 ? -50e-9 : k == 3 ? 50e-9 : 0), 1e-18) << t;
  }
  // No number leaves the range that it may have at all.
  Design shallow = study.design;
  std::get<HoleArray>(shallow.texture.kind).depth = 5e-9;
  const auto depth = [&](std::size_t t) {
    return std::get<HoleArray>(task_design(study, shallow, tasks[t]).texture.kind).depth;
  };
  EXPECT_EQ(depth(4), 0);
  EXPECT_NEAR(depth(5), 25e-9, 1e-18);
  study.scenarios = {{"new", 0, {}}, {"worn", 0, {}}};
  EXPECT_NE(refusal(study).find("at least one weight above 0"), std::string::npos);
}

// A fault of a shape within its scatter is found and named. All ends are of one design: to make one
// for each takes longer than to judge them, and a search asks this of thousands of shapes.
TEST(Tasks, OfAShapeAreJudgedInLessTimeThanTheyAreMade) {
  Study study = oxide_study();
  study.population.resize(1);
  study.scatter = {{"texture.depth", 20e-9},
                   {"texture.diameter", 50e-9},
                   {"surface.dielectric.0.thickness", 50e-9}};
  const std::vector<StudyTask> tasks = study_tasks(study);
  EXPECT_EQ(shape_trouble(study, tasks, study.design), "");
  Design wide = study.design;
  HoleArray& holes = std::get<HoleArray>(wide.texture.kind);
  holes.wall_angle = kPi / 2, holes.edge_radius = 0;
  holes.diameter = holes.period - 20e-9;
  EXPECT_TRUE(design_problems(wide).empty());
  EXPECT_NE(shape_trouble(study, tasks, wide).find(": within the scatter, "), std::string::npos)
      << shape_trouble(study, tasks, wide);
  const auto seconds = [](const auto& work) {  // of this process, the least of three times
    double least = kInfinity;
    for (int time = 0; time < 3; ++time) {
      const std::clock_t begin = std::clock();
      for (int k = 0; k < 50; ++k) work();
      least = std::min(least, static_cast<double>(std::clock() - begin));
    }
    return least;
  };
  std::size_t faults = 0;
  const double judged =
      seconds([&] { faults += shape_trouble(study, tasks, study.design).size(); });
  const double made = seconds([&] {
    for (const StudyTask& task : tasks)
      faults += !task.nominal() && task_design(study, study.design, task).texture == Texture{};
  });
  EXPECT_EQ(faults, 0u);
  EXPECT_LT(judged, made);
}

// A scenario gives the surface without a texture none: it is one surface in all of them.
TEST(Tasks, OfAFlatSurfaceHaveNoTextureOfAScenario) {
  Study study = oxide_study();
  study.population.resize(1);
  study.scenarios = {{"new", 1, {}}, {"worn", 1, {{"texture.depth", 100e-9}}}};
  study.scatter = {{"texture.depth", 20e-9}};
  const std::vector<StudyTask> tasks = study_tasks(study);
  const auto depth = [&](std::size_t t, bool flat) {
    const Design d = task_design(study, study.design, tasks[t], flat);
    return std::get<HoleArray>(d.texture.kind).depth;
  };
  EXPECT_EQ(depth(1, false), 100e-9);
  for (std::size_t t = 0; t < tasks.size(); ++t) EXPECT_EQ(depth(t, true), 1e-12) << tasks[t].name;
}

// What every scenario sets tells no designs apart; what some set is said once.
TEST(Tasks, OfScenariosThatSetWhatIsSearchedAreRefusedOrSaid) {
  Study study = oxide_study();
  study.population.resize(1);
  study.scenarios = {{"new", 1, {}}, {"worn", 1, {{"texture.depth", 100e-9}}}};
  EXPECT_EQ(refusal(study), "");
  const std::string said =
      "texture.depth of the design space counts for nothing where a scenario sets it: \"worn\"";
  const auto times = [&] {
    const std::vector<std::string> all = unused_of(study);
    return std::count(all.begin(), all.end(), said);
  };
  EXPECT_EQ(times(), 1);
  study.scenarios[1].set[0].path = "texture.height";  // another kind's word for it
  EXPECT_EQ(times(), 1);
  study.scenarios[0].weight = 0;
  EXPECT_NE(refusal(study).find("\"worn\" sets texture.depth, which design_space varies"),
            std::string::npos)
      << refusal(study);
  study.scenarios[0] = {"new", 1, {{"texture.depth", 300e-9}}};
  EXPECT_NE(refusal(study).find("set texture.depth"), std::string::npos) << refusal(study);
}

// A spread over one humidity tells no designs apart, and is said where it is asked for.
TEST(Tasks, OfOneHumidityHaveNoSpreadAndThatIsSaid) {
  Study study = oxide_study();
  study.population.clear();
  study.objective = {};
  study.objective.maximise = {parse_metric("mean(modulation)")};
  study.objective.minimise = {parse_metric("variation(friction)")};
  study.constraints = {read_constraint("range(modulation)", 0.3),
                       read_constraint("variation(friction)", 0.3)};
  const auto said = [&] {
    const std::vector<std::string> all = unused_of(study);
    return std::any_of(all.begin(), all.end(), [](const std::string& line) {
      return line.starts_with("variation(friction), range(modulation): 0 for every design");
    });
  };
  study.design.environment.relative_humidity = {0.35, 0.75};
  EXPECT_FALSE(said());
  study.design.environment.relative_humidity = {0.35};
  EXPECT_TRUE(said());
}

// What counts for nothing is not evaluated, so that it cannot fail either.
TEST(Tasks, OfAScenarioWithoutWeightAreNone) {
  Study study = oxide_study();
  study.population.resize(1);
  study.population[0].name = "one";
  study.scenarios = {{"new", 0, {}}, {"worn", 2, {{"finger.load", 0.3}}}};
  EXPECT_EQ(names_of(study_tasks(study)), Names{"one, worn"});
}

TEST(Tasks, WithoutAPopulationTheDesignsOwnFingerIsTheOnlyOne) {
  Study study = oxide_study();
  study.population.clear();
  study.design.finger.name = "own";
  EXPECT_EQ(names_of(study_tasks(study)), Names{"own"});
  study.population = {study.design.finger, study.design.finger};
  EXPECT_EQ(StudyProblem(study).nominal_tasks(), 2u);
}

// Of a study each finger is asked, not the one of the design that they stand in for; what several
// say in the same words is said once.
TEST(Study, OfModelOptionsThatAFingerWasNotFittedWithIsRefused) {
  Study study = oxide_study();
  const auto refused = [&] {
    return refusal_of(
        [&] { require_fitted_fingers(StudyProblem(study), "mine.toml", "run with --force"); });
  };
  EXPECT_EQ(refused(), "");
  study.design.model.rim_pinning = !study.design.model.rim_pinning;
  study.population.resize(1);
  study.population[0].name = "one";
  study.scenarios = {{"new", 1, {}}, {"worn", 1, {{"finger.load", 0.3}}}};
  const std::string said = refused(), line = "the finger \"one\" was fitted with";
  EXPECT_NE(said.find("model.rim_pinning is "), std::string::npos) << said;
  EXPECT_NE(said.find("run with --force"), std::string::npos) << said;
  EXPECT_NE(said.find(line), std::string::npos) << said;
  EXPECT_EQ(said.find(line), said.rfind(line)) << said;
  study.population[0].calibrated_for.rim_pinning = study.design.model.rim_pinning;
  EXPECT_EQ(refused(), "");
}

TEST(Goals, AreNamedInTheOrderOfTheirFileAndAtMostThree) {
  Study study = oxide_study();
  study.objective = {};
  study.objective.maximise = {parse_metric("modulation"), parse_metric("worst(friction_on)")};
  study.objective.targets = {{kFrictionOn, 0.4}};
  study.constraints = {read_constraint("mean(friction)", 0.4), read_constraint("min_wall", 0.5e-6),
                       read_constraint("worst(voltage_for(modulation = 0.3))", 100),
                       read_constraint("mean(voltage_for(modulation = 0.3))", 80)};
  {
    const StudyProblem problem(study);
    const auto& wanted = problem.objectives();
    ASSERT_EQ(wanted.size(), 3u);
    EXPECT_EQ(wanted[0].name, "mean(modulation)");
    EXPECT_EQ(wanted[1].name, "worst(friction_on)");
    EXPECT_EQ(wanted[2].name, "distance(friction_on = 0.4)");
    EXPECT_TRUE(wanted[0].maximise && wanted[1].maximise && !wanted[2].maximise);
    EXPECT_TRUE(wanted[2].aimed && !wanted[0].aimed);
    ASSERT_EQ(problem.goals().limited.size(), 3u);  // the wall is no metric
    EXPECT_FALSE(problem.goals().limited[0].maximise);
    EXPECT_EQ(problem.goals().voltage_targets, std::vector<double>{0.3});  // once
    EXPECT_FALSE(problem.goals().looks);
    // By the quantity at each humidity: an aim always, a mean under a risk.
    const auto by_points = [](const StudyProblem& p) {
      return std::vector<bool>{p.goals().by_points(0), p.goals().by_points(1),
                               p.goals().by_points(2)};
    };
    EXPECT_EQ(by_points(problem), (std::vector<bool>{false, false, true}));
    study.objective.risk = "worst";
    EXPECT_EQ(by_points(StudyProblem(study)), (std::vector<bool>{true, false, true}));
  }
  study.objective.minimise = {parse_metric("haze")};
  EXPECT_NE(refusal(study).find("one to three objectives are possible, got 4"), std::string::npos)
      << refusal(study);
  study.objective = {};
  EXPECT_NE(refusal(study).find("a design and no study"), std::string::npos);
  study.objective.minimise = {parse_metric("haze")};
  EXPECT_TRUE(StudyProblem(study).goals().looks);
}

// Of two of one name a table of results would hold one.
TEST(Goals, AreNamedOnce) {
  Study study = oxide_study();
  study.objective = {};
  study.objective.maximise = {parse_metric("modulation")};
  study.objective.minimise = {parse_metric("mean(modulation)")};
  EXPECT_NE(refusal(study).find("objective.minimise: mean(modulation) is an objective already"),
            std::string::npos)
      << refusal(study);
  study.objective.minimise.clear();
  study.objective.maximise.push_back(parse_metric("mean(modulation)"));
  EXPECT_NE(refusal(study).find("objective.maximise: mean(modulation)"), std::string::npos);
  study.objective.maximise.back() = parse_metric("worst(modulation)");
  EXPECT_EQ(refusal(study), "");
  // A limit on what is wished for is no second objective.
  study.constraints = {read_constraint("mean(modulation)", 0.4)};
  EXPECT_EQ(refusal(study), "");
}

TEST(Goals, OfADriveAreRefusedWhereNothingIsDriven) {
  Study study = oxide_study();
  EXPECT_TRUE(StudyProblem(study).driven());
  study.design.drive.amplitude = 0;
  EXPECT_NE(refusal(study).find("mean(modulation) needs a driven design"), std::string::npos);
  // A search that may drive it does, but only from a voltage above 0 on.
  study.variables.push_back({"drive.amplitude", "V", 10, 100, {}});
  EXPECT_EQ(refusal(study), "");
  EXPECT_TRUE(StudyProblem(study).driven());
  study.variables.back().low = 0;
  EXPECT_NE(refusal(study), "");
  study.variables.pop_back();
  study.objective.maximise = {parse_metric("mean(friction)")}, study.objective.minimise.clear();
  study.constraints.clear();
  EXPECT_FALSE(StudyProblem(study).driven());
}

// What a searcher minimises, and what it must keep: shapes before an evaluation, the rest after it.
TEST(Outcomes, KeepEveryLimit) {
  Study study = oxide_study();
  study.population.clear();
  const StudyProblem problem(study);
  const Point unit = problem.space().unit_of_study();
  Score score;
  score.ok = true;
  score.values = {0.6, 0.2};
  score.oxide_margin = 4;
  EXPECT_EQ(problem.outcome(score).constraints, std::vector<double>{2.0 / 4 - 1});
  EXPECT_TRUE(problem.feasible(score, problem.space().design(unit)));
  score.oxide_margin = 1;
  EXPECT_FALSE(problem.feasible(score, problem.space().design(unit)));
  score.oxide_margin = 4;
  const Point thin = problem.space().unit({3e-6, 2.9e-6, 350e-9, 0.87});  // walls of 100 nm
  EXPECT_FALSE(problem.feasible(score, problem.space().design(thin)));
  EXPECT_EQ(problem.residuals(), 0u);
}

TEST(Evaluations, AreAsManyAsTheMethodAndTheVariablesAsk) {
  Study study = oxide_study();
  for (const auto& [method, objectives, variables, expected] : {std::tuple{"auto", 2, 0, 20},
                                                                {"auto", 2, 1, 25},
                                                                {"auto", 2, 3, 75},
                                                                {"auto", 2, 5, 100},
                                                                {"auto", 3, 1, 50},
                                                                {"auto", 3, 3, 150},
                                                                {"auto", 3, 9, 400},
                                                                {"bayesian", 3, 2, 50},
                                                                {"evolution", 1, 0, 50},
                                                                {"evolution", 1, 4, 200}}) {
    study.search.method = method;
    study.objective.maximise.assign(1, parse_metric("mean(modulation)"));
    study.objective.minimise.assign(objectives > 1 ? 1 : 0, parse_metric("mean(friction)"));
    study.objective.targets.assign(objectives > 2 ? 1 : 0, {kFrictionOn, 0.4});
    study.variables.assign(static_cast<std::size_t>(variables), Variable{});
    EXPECT_EQ(default_evaluations(study), expected) << method << objectives << variables;
  }
}

TEST(Levels, GiveUpSkinsThenPixelsThenMoreSkins) {
  Study study = oxide_study();
  study.population.clear();
  const StudyProblem problem(study);
  const Fidelity whole = stage_fidelity(problem, Stage::Confirm);
  const double price = task_price(problem, Stage::Confirm);
  ASSERT_GT(whole.skins, 8);
  ASSERT_GT(whole.grid, 64);
  EXPECT_EQ(stage_fidelity(problem, Stage::Confirm, 1.001 * price).skins, whole.skins);
  int skins = whole.skins, grid = whole.grid;
  for (const double share : {0.9, 0.6, 0.3, 0.2, 0.1, 0.05, 0.02, 1e-3, 1e-6}) {
    const Fidelity f = stage_fidelity(problem, Stage::Confirm, share * price);
    EXPECT_LE(f.skins, skins) << share;
    EXPECT_LE(f.grid, grid) << share;
    EXPECT_TRUE(f.grid == whole.grid || f.skins <= 8) << share;  // skins go first
    EXPECT_TRUE(f.skins >= 8 || f.grid == 64) << share;          // then pixels
    EXPECT_GE(f.skins, 4) << share;
    EXPECT_GE(f.grid, 64) << share;
    const double taken = task_price(problem, Stage::Confirm, share * price);
    EXPECT_TRUE(taken <= share * price || (f.skins == 4 && f.grid == 64)) << share;
    skins = f.skins, grid = f.grid;
  }
  EXPECT_EQ(skins, 4);
  EXPECT_EQ(grid, 64);
  EXPECT_EQ(stage_fidelity(problem, Stage::Draft).skins, 2);
  EXPECT_EQ(whole.level, "design");
}

// Two pixels across the smallest feature, from 64 to 256 along 12 um.
TEST(Levels, TheSearchSeesTheSmallestFeature) {
  Study study = oxide_study();
  study.population.clear();
  study.constraints.clear();
  study.variables = {{"texture.depth", "nm", 100e-9, 200e-9, {}}};
  HoleArray& holes = std::get<HoleArray>(study.design.texture.kind);
  holes.wall_angle = kPi / 2, holes.edge_radius = 0;
  for (const auto& [period, diameter, grid] : {std::tuple{3e-6, 2e-6, 64},
                                               {1e-6, 0.6e-6, 64},
                                               {1e-6, 0.64e-6, 128},
                                               {1e-6, 0.8e-6, 128},
                                               {1e-6, 0.82e-6, 256},
                                               {1e-6, 0.95e-6, 256}}) {
    holes.period = period, holes.diameter = diameter;
    const StudyProblem problem(study);
    const double feature = std::min(diameter, period - diameter);
    EXPECT_NEAR(problem.smallest_feature(), feature, 1e-12);
    EXPECT_EQ(stage_fidelity(problem, Stage::Search).grid, grid) << diameter;
    const StudyCost cost = study_cost(StudyProblem(study));
    EXPECT_EQ(cost.pixels, grid);
    EXPECT_NEAR(cost.feature_pixels, feature * grid / 12e-6, 1e-9);
  }
}

// Every stage by its own price.
TEST(Price, OfAStudyIsThatOfItsStages) {
  Study study = oxide_study();
  study.search.evaluations = 60;
  const StudyProblem problem(study);
  const StudyCost cost = study_cost(StudyProblem(study));
  EXPECT_EQ(cost.evaluations, 60);
  EXPECT_EQ(cost.tasks, 4);
  EXPECT_EQ(cost.narrowed, 20u);
  EXPECT_EQ(cost.finalists, 9u);
  const auto price = [&](double count, Stage stage) {
    return count * over_price(stage) * task_price(problem, stage);
  };
  double seconds =
      price(60 * 4, Stage::Search) + price(20 * 4, Stage::Narrow) +
      price((9 + 2 + 3) * 4, Stage::Confirm) +
      price(8.0 * static_cast<double>(stability_variants(problem).size()), Stage::Stability) +
      price((1 + 2 * 4) * 4, Stage::Sensitivity);
  if (problem.parameters_unknown().empty()) seconds += price(2 * 4, Stage::Steps);
  EXPECT_NEAR(cost.seconds, seconds, 1e-9 * seconds);
  EXPECT_GT(seconds, 0);
  // No more designs are confirmed than are evaluated, and one that is searched for.
  study.search.evaluations = 2;
  const StudyCost few = study_cost(StudyProblem(study));
  EXPECT_EQ(few.finalists, 3u);
  EXPECT_LT(few.seconds, 0.6 * cost.seconds);
  study.search.evaluations = 60;
  // Memory: a patch of the confirmation, and what is kept for designs to come: 64 kernels, skins in
  // 64 MB, their waves and what films do, a quarter more for the allocator.
  const Design& d = study.design;
  const Grid grid = make_plan({d.surface, d.finger, d.environment, d.drive, d.model}, d.texture,
                              stage_fidelity(problem, Stage::Confirm))
                        .grid;
  const auto pixels = static_cast<double>(grid.size());
  EXPECT_NEAR(cost.bytes, 50e6 + 210 * pixels + 1.25 * ((64 * 32 + 384) * pixels + 64e6), 1);
}

TEST(Space, AReliefOfLessThanTwoNanometresIsNone) {
  Study study = oxide_study();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const auto at = [&](double depth) {
    return space.value(space.snapped(space.unit({5e-6, 2e-6, depth, 1.0})));
  };
  EXPECT_NEAR(at(2.1e-9)[2], 2.1e-9, 1e-15);
  EXPECT_NEAR(at(2.1e-9)[0], 5e-6, 1e-12);
  // Flat, its measures are the study's own; its finish stays.
  const std::vector<double> flat = at(1.9e-9), own = space.value(space.unit_of_study());
  EXPECT_EQ(flat[2], 0);
  EXPECT_NEAR(flat[0], own[0], 1e-12);
  EXPECT_NEAR(flat[1], own[1], 1e-12);
  EXPECT_NEAR(flat[3], 1.0, 1e-12);
  // A search starts at the study's own design and at its flat surface.
  const std::vector<Point> starts = space.starts();
  ASSERT_EQ(starts.size(), 2u);
  EXPECT_EQ(starts[0], space.unit_of_study());
  EXPECT_EQ(space.value(starts[1])[2], 0);
  const auto without = space.flattened(space.unit({5e-6, 2e-6, 400e-9, 1.0}));
  ASSERT_TRUE(without);
  EXPECT_EQ(space.value(*without)[2], 0);
  EXPECT_NEAR(space.value(*without)[3], 1.0, 1e-12);
  EXPECT_FALSE(space.flattened(starts[1]));  // is flat already
  ASSERT_TRUE(space.has_features());
  EXPECT_NEAR(space.features(space.unit({4e-6, 2e-6, 400e-9, 1.0}))[0], std::sqrt(kPi / 16), 1e-9);
  study.variables.erase(study.variables.begin());  // the period is given
  EXPECT_FALSE(StudyProblem(study).space().has_features());
}

// The same designs in every variant; of each the objectives, their errors and samples, its margin.
Stability judged(const StudyProblem& problem, const std::vector<TaskAnswer>& designs) {
  const Point unit = problem.space().unit_of_study();
  std::vector<std::vector<TaskAnswer>> answers;
  for (const TaskAnswer& a : designs) answers.emplace_back(stability_variants(problem).size(), a);
  return judge_stability(problem, std::vector<Point>(designs.size(), unit), answers);
}

// A pin has no skin: what follows its tasks are choices of the model.
TEST(Stability, OfAPinIsThatOfItsChoicesOfTheModelAlone) {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/finger_and_pen/study.toml",
                                          {"counterface.type=pen"}));
  study.objective = {};
  study.objective.minimise = {parse_metric("mean(friction)")};
  study.constraints.clear();
  study.design.drive.amplitude = 0;
  const StudyProblem problem(study);
  EXPECT_EQ(skin_variant(problem), std::nullopt);
  const Stability s = judged(problem, {});
  EXPECT_EQ(s.other_skin, std::nullopt);
  ASSERT_EQ(s.first_choice, 1u);
  EXPECT_EQ(s.variants[1].name, "air insulates");
}

TEST(Stability, NamesEachFingerAndEachChoiceOfTheModel) {
  Study study = oxide_study();
  study.population.resize(2);
  study.population[0].name = "one", study.population[1].name = "two";
  EXPECT_EQ(
      stability_variants(StudyProblem(study)),
      (Names{"finger one", "finger two", "natural skin, not degreased", "first droplet step 50 nm",
             "first droplet step 800 nm", "a quarter of the droplets", "three times the droplets",
             "droplets do not raise the pull", "air insulates", "air breaks down at 350 V/um",
             "one pass"}));
  EXPECT_EQ(skin_variant(StudyProblem(study)), std::optional<std::size_t>(2));
  EXPECT_EQ(judged(StudyProblem(study), {}).first_choice, 3u);
  for (Finger& f : study.population) {
    f.water.volume.clear();
    f.state = FingerState::Natural;
  }
  EXPECT_EQ(stability_variants(StudyProblem(study)),
            (Names{"finger one", "finger two", "degreased skin", "air insulates",
                   "air breaks down at 350 V/um", "one pass"}));
}

TaskAnswer answered(const std::vector<double>& values, double error, double margin = 10) {
  TaskAnswer out;
  for (const double x : values) out.objectives.push_back({x, error, {}});
  out.oxide_margin = margin;
  return out;
}

// A loss within its error is none, and a design that is better in one objective alone beats nobody.
TEST(Stability, CountsALossBeyondItsErrorOnly) {
  Study study = oxide_study();  // maximises the first, minimises the second
  study.population.resize(1);
  const StudyProblem problem(study);
  ASSERT_EQ(stability_variants(problem).size(), 10u);
  const auto times = [&](const std::vector<double>& first, const std::vector<double>& second) {
    return judged(problem, {answered(first, 0.005), answered(second, 0.005)}).times_on_front;
  };
  using Times = std::vector<int>;
  EXPECT_EQ(times({0.5, 0.20}, {0.506, 0.194}), (Times{0, 10}));
  EXPECT_EQ(times({0.5, 0.20}, {0.504, 0.1}), (Times{10, 10}));  // 0.004 is within 0.005
  EXPECT_EQ(times({0.5, 0.20}, {0.9, 0.196}), (Times{10, 10}));
  EXPECT_EQ(times({0.5, 0.20}, {0.4, 0.3}), (Times{10, 0}));
  EXPECT_EQ(times({-0.5, 0.20}, {-0.49, 0.19}), (Times{0, 10}));
  TaskAnswer failed;
  failed.status = {TaskStatus::Kind::NotDefined, "no"};
  const Stability one_failed = judged(problem, {answered({0.5, 0.2}, 0), failed});
  EXPECT_EQ(one_failed.times_on_front, (Times{10, 0}));
  EXPECT_EQ(one_failed.variants[0].unanswered, (Names{"", "no"}));
  // Skin by skin the difference is known to 0.0005, however much the skins scatter.
  TaskAnswer one = answered({0.5, 0.20}, 0.1), other = answered({0.504, 0.19}, 0.1);
  one.samples = {{{{0.40, 0.60}, {}, {}}}, {{{0.10, 0.30}, {}, {}}}};
  other.samples = {{{{0.4045, 0.6035}, {}, {}}}, {{{0.0905, 0.2895}, {}, {}}}};
  const Stability paired = judged(problem, {one, other});
  EXPECT_EQ(paired.times_on_front, (Times{0, 10}));
  EXPECT_EQ(paired.variants[0].beaten_by[0], std::optional<std::size_t>(1));
  EXPECT_FALSE(paired.variants[0].beaten_by[1]);
}

// What breaks a limit of the study in a variant does not hold there, and beats nobody.
TEST(Stability, TestsTheLimitsOfTheStudy) {
  Study study = oxide_study();  // a margin of 2 at least
  study.population.resize(1);
  const StudyProblem problem(study);
  const Stability s =
      judged(problem, {answered({0.5, 0.20}, 0.001), answered({0.9, 0.1}, 0.001, 1.9)});
  EXPECT_EQ(s.times_on_front, (std::vector<int>{10, 0}));
  ASSERT_EQ(s.variants[0].broken[1].size(), 1u);
  EXPECT_EQ(limit_name(s.variants[0].broken[1][0].limit.on), "oxide_breakdown_margin");
  EXPECT_NEAR(s.variants[0].broken[1][0].value, 1.9, 1e-12);
  EXPECT_TRUE(s.variants[0].broken[0].empty());
}

// Limits are those of the confirmation, moved as a variant moves what the level of the checks says:
// the finger as it is breaks none of them.
TEST(Stability, JudgesLimitsAsTheyWereConfirmed) {
  Study study = oxide_study();  // a margin of 2 at least
  study.population.resize(1);
  const StudyProblem problem(study);
  std::vector<TaskAnswer> answers(stability_variants(problem).size(),
                                  answered({0.5, 0.2}, 0.001, 1.8));
  answers[1].oxide_margin = 1.5;
  answers[2] = TaskAnswer::refused(TaskStatus::Kind::NoEquilibrium, "pulled in");
  set_confirmed_limits(problem, {answered({0.5, 0.2}, 0.001, 2.2)}, answers);
  EXPECT_NEAR(answers[0].oxide_margin, 2.2, 1e-12);
  EXPECT_NEAR(answers[1].oxide_margin, 2.2 * 1.5 / 1.8, 1e-12);
  EXPECT_FALSE(answers[2].status.ok());
  EXPECT_NEAR(answers.back().oxide_margin, 2.2, 1e-12);
  // Of a design without a confirmed answer they stay.
  std::vector<TaskAnswer> alone(answers.size(), answered({0.5, 0.2}, 0.001, 1.8));
  set_confirmed_limits(problem, {TaskAnswer::refused(TaskStatus::Kind::TimedOut, "late")}, alone);
  EXPECT_EQ(alone[1].oxide_margin, 1.8);
}

// Two thirds of the variants make a design stable.
TEST(Stability, IsFromTwoThirdsOn) {
  // Stable from two thirds of them on.
  Stability s;
  s.variants.resize(8);
  s.times_on_front = {5, 6};
  EXPECT_FALSE(s.stable(0));
  EXPECT_TRUE(s.stable(1));
  EXPECT_TRUE(s.judged(1));
  EXPECT_FALSE(s.judged(2));
}

// Samples of a mean over tasks are the means of their samples, and so is every change.
TEST(Samples, OfAMeanOverTasksAreTheirMeans) {
  Study study = oxide_study();
  study.population.clear();
  study.scenarios = {{"new", 3, {}}, {"worn", 1, {}}};
  const StudyProblem problem(study);
  const std::vector<std::vector<double>> sampling{{0.2, 0.3, 0.7}, {0.5, 0.1, 0.3}},
      grid{{0.01, 0.03}, {-0.02, 0.05}}, method{{0.004, -0.001}, {0.002, 0.003}};
  std::vector<TaskAnswer> answers(2);
  for (std::size_t t = 0; t < 2; ++t) {
    const double value = mean_estimate(sampling[t]).value;
    for (std::size_t k = 0; k < 2; ++k) {
      answers[t].objectives.push_back({value, 0.01, {}});
      answers[t].samples.push_back({{sampling[t], grid[t], method[t]}});
    }
  }
  const Score score = problem.score(problem.study().design, answers);
  ASSERT_TRUE(score.ok) << score.reason;
  ASSERT_EQ(score.samples.size(), 2u);
  const auto expect_means = [](const std::vector<double>& found,
                               const std::vector<std::vector<double>>& of) {
    ASSERT_EQ(found.size(), of[0].size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], (3 * of[0][i] + of[1][i]) / 4, 1e-12) << i;
  };
  for (const ErrorSamples& s : score.samples) {
    expect_means(s.sampling, sampling);
    expect_means(s.grid, grid);
    expect_means(s.method, method);
  }
  // The error of a mean is that which the tasks state.
  for (const double error : score.errors) EXPECT_NEAR(error, 0.01, 1e-12);
  // Of a difference of two designs the skins that both share count for nothing.
  Score other = score;
  for (ErrorSamples& s : other.samples) {
    for (double& v : s.sampling) v += 0.2;
  }
  for (double& v : other.values) v += 0.2;
  EXPECT_NEAR(difference_error(score, other, 0), 0, 1e-12);
  EXPECT_FALSE(no_better(problem.objectives(), score, other));  // the second is minimised
  EXPECT_TRUE(no_better(problem.objectives(), other, other));
  // Without samples the larger of both errors.
  other.samples.clear();
  other.errors = {0.5, 0.001};
  EXPECT_EQ(difference_error(score, other, 0), 0.5);
  EXPECT_EQ(difference_error(score, other, 1), score.errors[1]);
}

// The worst over fingers is that of the worst one, and so is its error.
TEST(Samples, OfTheWorstTaskAreItsOwn) {
  Study study = oxide_study();
  study.population.resize(2);
  study.objective = {};
  study.objective.maximise = {parse_metric("worst(modulation)")};
  const StudyProblem problem(study);
  std::vector<TaskAnswer> answers(2);
  answers[0].objectives = {{0.9, 0.001, {}}}, answers[1].objectives = {{0.4, 0.1, {}}};
  answers[0].samples = {{{{0.8, 0.9, 1.0}, {}, {}}}},
  answers[1].samples = {{{{0.2, 0.3, 0.7}, {}, {}}}};
  const Score score = problem.score(problem.study().design, answers);
  ASSERT_TRUE(score.ok) << score.reason;
  EXPECT_EQ(score.values[0], 0.4);
  EXPECT_NEAR(score.errors[0], std::sqrt((0.04 + 0.01 + 0.09) / 6), 1e-12);
}

// Under the risk of the worst humidity its samples alone count, and they say the error.
TEST(Samples, OfTheWorstHumidityAreItsOwn) {
  Study study = oxide_study();
  study.population.clear();
  study.design.environment.relative_humidity = {0.2, 0.7};
  study.objective = {};
  study.objective.maximise = {parse_metric("modulation")};
  study.objective.risk = "worst";
  const StudyProblem problem(study);
  const ErrorSamples dry{{0.85, 0.9, 0.95}, {0.5, 0.4}, {0.3, 0.2}},
      moist{{0.2, 0.3, 0.7}, {0.01, 0.03}, {0.004, 0.002}};
  TaskAnswer answer;
  answer.objectives = {{0.65, 0.01, {0.9, 0.4}}};
  answer.samples = {{dry, moist}};
  const Score score = problem.score(problem.study().design, {answer});
  ASSERT_TRUE(score.ok) << score.reason;
  EXPECT_NEAR(score.values[0], 0.4, 1e-12);
  ASSERT_EQ(score.samples.size(), 1u);
  const auto expect_same = [](const std::vector<double>& found, const std::vector<double>& own) {
    ASSERT_EQ(found.size(), own.size());
    for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(found[i], own[i], 1e-12) << i;
  };
  expect_same(score.samples[0].sampling, moist.sampling);
  expect_same(score.samples[0].grid, moist.grid);
  expect_same(score.samples[0].method, moist.method);
  // Variance of the mean of three; mean and error of two in squares; their difference.
  const double sampling = (0.04 + 0.01 + 0.09) / 6, grid = 4e-4 + 1e-4, method = 9e-6 - 1e-6;
  EXPECT_NEAR(score.errors[0], std::sqrt(sampling + grid + method), 1e-12);
  // So does what their corrections to the 3-D field leave open.
  answer.samples[0][0].field = {0.02, 0.03, {-0.1}, 0.03};
  answer.samples[0][1].field = {0.01, 0.02, {-0.2}, 0.04};
  const Score corrected = problem.score(problem.study().design, {answer});
  EXPECT_NEAR(corrected.samples[0].field.common, 0.01, 1e-12);
  EXPECT_NEAR(corrected.samples[0].field.own, 0.02, 1e-12);
  EXPECT_EQ(corrected.samples[0].field.corrections, (std::vector<double>{-0.1, -0.2}));
  EXPECT_NEAR(corrected.samples[0].field.of_skins, std::sqrt((9e-4 + 16e-4) / 2), 1e-12);
  EXPECT_NEAR(corrected.errors[0], std::sqrt(sampling + grid + method + 5e-4), 1e-12);
  // Tasks of unlike numbers of skins have none in common.
  answer.samples[0][0].sampling.pop_back();
  const Score unlike = problem.score(problem.study().design, {answer});
  EXPECT_TRUE(unlike.samples[0].sampling.empty());
  EXPECT_NEAR(unlike.errors[0], 0.01, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::problem_test
