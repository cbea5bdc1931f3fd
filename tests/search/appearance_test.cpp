// Haze and its kin as what a study wants and what it limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "report/response.h"
#include "search/levels.h"
#include "search/problem.h"
#include "search/task.h"

namespace papilla::tests::appearance_test {
namespace {

Study transparent_glass(const std::vector<std::string>& overrides = {}) {
  return read_study(PAPILLA_SOURCE_DIR "/designs/transparent_glass/study.toml", overrides);
}

TaskAnswer confirmed(const StudyProblem& problem, const Fidelity& fidelity) {
  const auto text = [](const Response& response) { return response_json(response, false); };
  return evaluate_task(problem, problem.space().design(problem.space().unit_of_study()), 0,
                       {fidelity, true, text});
}

TEST(AppearanceInStudies, HazeIsAnObjectiveBesideFriction) {
  const Study study = transparent_glass({"environment.relative_humidity=[\"35 %\"]"});
  const StudyProblem problem(study);
  ASSERT_EQ(problem.objectives().size(), 3u);
  EXPECT_EQ(problem.objectives()[2].name, "mean(haze)");
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = 64;
  fidelity.skins = 2;
  const TaskAnswer task = confirmed(problem, fidelity);
  ASSERT_TRUE(task.status.ok()) << task.status.text;
  const Score score = problem.score(problem.study().design, {task});
  EXPECT_EQ(score.values[2], appearance_of(study.design).haze);
  EXPECT_GT(score.values[2], 0.01);
  EXPECT_EQ(score.errors[2], 0);
  EXPECT_NE(score.reports[0].find("\"appearance\""), std::string::npos);
}

TEST(AppearanceInStudies, ALimitOnHazeHoldsBeforeAnEvaluation) {
  const auto violation = [](const std::string& depth) {
    const Study study = transparent_glass({"texture.depth=\"" + depth + "\""});
    const StudyProblem problem(study);
    EXPECT_EQ(problem.constraints().evaluated(), 1u);  // only the breakdown margin needs a field
    const Point unit = problem.space().unit_of_study();
    const std::vector<double> g = problem.constraints().geometry(unit),
                              look = problem.constraints().look(unit);
    EXPECT_LT(*std::max_element(g.begin(), g.end()), 0);  // the shape can be made
    EXPECT_EQ(look.size(), 1u);
    return std::pair{look.front(), problem.constraints().geometry_reason(unit)};
  };
  EXPECT_LT(violation("80 nm").first, 0);
  EXPECT_EQ(violation("80 nm").second, "");
  EXPECT_GT(violation("550 nm").first, 0);
  EXPECT_EQ(violation("550 nm").second.substr(0, 4), "haze");
}

// A viewer meets the design in the scenarios alone: the plate of the study's own file, of 30 %, in
// none of them. Of two plates the hazier one counts, of plates within their scatter too.
TEST(AppearanceInStudies, ALimitOnHazeIsForTheViewsOfTheScenarios) {
  Study study = transparent_glass({"texture.depth=\"80 nm\""});
  const auto haze = [&](double inner) {
    Design design = study.design;
    design.view.inner_haze = inner;
    return appearance_of(design).haze;
  };
  study.design.view.inner_haze = 0.3;
  study.constraints = {read_constraint("haze", 0.5 * (haze(0.01) + haze(0.3)))};
  study.scatter = {{"texture.depth", 1e-9}};
  const auto look = [&] {
    const StudyProblem problem(study);
    return problem.constraints().look(problem.space().unit_of_study()).at(0);
  };
  const auto share = [&] {
    const StudyProblem problem(study);
    const Scoring scoring{problem.goals(), problem.tasks(), problem.nominal_tasks(),
                          ScatterLaw(study.scatter, study.correlations),
                          study.design.environment.weights};
    Score score;
    score.by_task.resize(problem.tasks().size());
    for (LimitedNumbers& of : score.by_task) of.oxide_margin = kInfinity;
    return YieldModel(study, problem.constraints(), scoring).share(study.design, score, 16).share;
  };
  EXPECT_GT(look(), 0);
  EXPECT_EQ(share(), 0);
  study.scenarios = {{"clear", 1, {{"view.inner_haze", 0}}},
                     {"hazy", 1, {{"view.inner_haze", 0.01}}},
                     {"never", 0, {{"view.inner_haze", 0.9}}}};
  EXPECT_NEAR(look(), violation(study.constraints[0], haze(0.01)), 1e-9);
  EXPECT_LT(look(), 0);
  EXPECT_EQ(share(), 1);
  const StudyProblem problem(study);
  EXPECT_EQ(problem.constraints().geometry_reason(problem.space().unit_of_study()), "");
}

TEST(AppearanceInStudies, APeriodThatNoTheoryCoversIsOutsideTheSpace) {
  const std::vector<std::string> fine{"texture.period=\"1 um\"", "texture.diameter=\"0.5 um\"",
                                      "design_space.texture.period=[\"0.2 um\", \"10 um\"]"};
  const Study covered = transparent_glass(fine);  // by the rigorous theory
  const StudyProblem inside(covered);
  EXPECT_LT(inside.constraints().geometry(inside.space().unit_of_study()).front(), 0);
  EXPECT_EQ(look_theory(inside), "rigorous");  // named, not computed: that takes seconds
  std::vector<std::string> scalar = fine;
  scalar.emplace_back("view.lattices=\"scalar\"");
  const Study study = transparent_glass(scalar);
  const StudyProblem problem(study);
  const Point unit = problem.space().unit_of_study();
  EXPECT_GT(problem.constraints().geometry(unit).front(), 0);
  EXPECT_NE(problem.constraints().geometry_reason(unit).find("neither below"), std::string::npos);
}

TEST(AppearanceInStudies, NobodyPaysForALookThatIsNotAskedFor) {
  const Study study = read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml",
                                 {"population.fingers=[\"../fingers/reference.toml\"]",
                                  "environment.relative_humidity=[\"35 %\"]"});
  const StudyProblem problem(study);
  EXPECT_FALSE(problem.goals().looks);
  EXPECT_EQ(look_theory(problem), "");
  EXPECT_EQ(look_price(problem), 0);
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = 64;
  fidelity.skins = 1;
  const TaskAnswer task = confirmed(problem, fidelity);
  ASSERT_TRUE(task.status.ok()) << task.status.text;
  EXPECT_EQ(task.report.find("appearance"), std::string::npos);
  EXPECT_FALSE(task.look);
}

TEST(AppearanceInStudies, AFilledTextureLosesItsHazeAndSaysThatTheFingerFeelsItOpen) {
  Design design = transparent_glass().design;
  const double open = appearance_of(design).haze;
  design.view.fill_index = 1.33;
  // The phase step shrinks by (1.46 - 1.33)/(1.46 - 1), haze about with its square.
  const Optics wet = appearance_of(design);
  EXPECT_NEAR(wet.haze / open, std::pow(0.13 / 0.46, 2), 0.01);
  EXPECT_NE(wet.warning.find("feels it open"), std::string::npos);
  design.view.fill_index = design.surface.refractive_index;
  EXPECT_NEAR(appearance_of(design).haze, 0, 1e-12);
  design.view.fill_index = 2;
  EXPECT_EQ(design_problems(design).back().path, "view.fill_index");
}

}  // namespace
}  // namespace papilla::tests::appearance_test
