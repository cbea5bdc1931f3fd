// Limits of a study: how far beyond one a design is, and how people read it.
#include "search/constraints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "search/problem.h"

namespace papilla::tests {
namespace {

Study limited(const std::vector<Constraint>& constraints) {
  Study study = read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml");
  study.population.clear();
  study.constraints = constraints;
  return study;
}

// Of a limit at least: limit / value - 1, at most: value / limit - 1; bounded by 11.
TEST(Constraints, OfAShapeAreRelativeToTheirLimit) {
  const Study study = limited(
      {{"min_wall", 0.5e-6, true}, {"min_hole", 2e-6, true}, {"aspect_ratio", 0.05, false}});
  const StudyProblem problem(study);
  // Period 5 um, holes of 4 um, 400 nm deep, walls of 1 um at 88 degrees from the land.
  const Point unit = problem.space().unit({5e-6, 4e-6, 400e-9, 0.87});
  const std::vector<double> g = problem.constraints().geometry(unit);
  ASSERT_EQ(g.size(), 4u);
  EXPECT_EQ(g[0], -1);  // it can be made
  EXPECT_NEAR(g[1], 0.5 - 1, 1e-9);
  EXPECT_NEAR(g[2], 2 / (4 - 0.8 * std::tan(kPi / 90)) - 1, 1e-9);
  EXPECT_NEAR(g[3], 0.4 / 0.05 - 1, 1e-9);
  EXPECT_EQ(problem.constraints().geometry_reason(unit), "aspect_ratio 0.4  is above 0.05 ");
}

TEST(Constraints, OfAnEvaluationAreRelativeAndBounded) {
  const Study study = limited({{"oxide_breakdown_margin", 2, true},
                               {"mean(friction)", 0.05, false},
                               {"min_wall", 0.5e-6, true}});
  const StudyProblem problem(study);
  ASSERT_EQ(problem.constraints().evaluated(), 2u);
  const auto violations = [&](double margin, double friction) {
    Score score;
    score.oxide_margin = margin;
    score.limited = {friction};
    return problem.constraints().violations(score);
  };
  EXPECT_EQ(violations(4, 0.075), (std::vector<double>{2.0 / 4 - 1, 0.075 / 0.05 - 1}));
  EXPECT_EQ(violations(1, 0), (std::vector<double>{1, -1}));
  EXPECT_EQ(violations(0, 0.05), (std::vector<double>{11, 0}));  // never
  const double large = violations(1, 0.05 * 21)[1], larger = violations(1, 0.05 * 41)[1];
  EXPECT_NEAR(large, 11 - 10.0 / 20, 1e-9);
  EXPECT_NEAR(larger, 11 - 10.0 / 40, 1e-9);
}

TEST(Constraints, ThoseThatNobodyKeepsAreNamed) {
  const Study study =
      limited({{"min_wall", 5.5e-6, true}, {"haze", 0.05, false}, {"mean(friction)", 0.05, false}});
  const StudyProblem problem(study);
  Evaluation refused, judged;
  refused.outcome.constraints = {-1, 0.3, 0.2};
  judged.outcome.ok = true;
  judged.outcome.constraints = {0.5};
  const auto never = [&](const std::vector<Evaluation>& tried) {
    return problem.constraints().never_kept(tried);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(never({refused}), (Names{"min_wall (at least 5.5 um)", "haze (at most 5 %)"}));
  EXPECT_EQ(never({refused, judged}), (Names{"mean(friction) (at most 0.05)"}));
  judged.outcome.constraints = {-0.1};
  EXPECT_EQ(never({refused, judged}), Names{});
  EXPECT_EQ(never({}), Names{});
}

}  // namespace
}  // namespace papilla::tests
