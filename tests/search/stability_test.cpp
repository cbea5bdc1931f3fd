#include "search/stability.h"

#include <gtest/gtest.h>

#include "tests/support/without_belief.h"

namespace papilla::tests::stability_test {
namespace {

// A flat surface against the deepest holes of the samples, judged by the mean alone: texture never
// raises the mean modulation, whatever finger or model choice, so the flat design is on the front
// in every variant, and the other is unstable.
TEST(Stability, TheFlatSurfaceHasTheHighestMeanUnderEveryVariant) {
  Study study =
      without_belief(read_study(std::string(PAPILLA_DESIGNS_DIR) + "/m3_glass/conformal.toml"));
  study.objective.minimise.clear();
  study.population.resize(1);
  const StudyProblem problem(study);
  Design holes = study.design, flat = study.design;
  flat.texture = Texture{};
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = 64;
  const std::vector<Point> units(2, problem.space().unit_of_study());
  std::vector<std::vector<TaskAnswer>> answers(2);
  for (std::size_t v = 0; v < stability_variants(problem).size(); ++v) {
    answers[0].push_back(evaluate_variant(problem, flat, v, fidelity));
    answers[1].push_back(evaluate_variant(problem, holes, v, fidelity));
  }
  const Stability s = judge_stability(problem, units, answers);
  EXPECT_EQ(s.variants.size(), 10u);
  EXPECT_EQ(s.times_on_front[0], 10);
  for (const StabilityVariant& v : s.variants) EXPECT_GT(v.values[0][0], v.values[1][0]) << v.name;
  // The less the pull, the less is the difference known: not worse than its error, the load law's
  // scatter from skin to skin with it.
  EXPECT_LE(s.times_on_front[1], 3);
  EXPECT_TRUE(s.stable(0));
  EXPECT_FALSE(s.stable(1));
  // Air that insulates leaves more of the pull, air that breaks down at any voltage less; one pass
  // lacks what the closing gap adds.
  const auto flat_mean = [&](std::size_t v) { return s.variants[v].values[0][0]; };
  EXPECT_GT(flat_mean(7), flat_mean(0));
  EXPECT_LT(flat_mean(8), flat_mean(0));
  EXPECT_LT(flat_mean(9), flat_mean(0));
}

}  // namespace
}  // namespace papilla::tests::stability_test
