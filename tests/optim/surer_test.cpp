// What surer judgements say of those that they do not judge: borders and whole lists.
#include <gtest/gtest.h>

#include <cmath>

#include "optim/search.h"

namespace papilla::tests::surer_test {
namespace {

Evaluation seen(Point unit, double objective, std::vector<double> constraints, bool ok = true) {
  return {std::move(unit), {ok, "", {objective}, std::move(constraints), {}}};
}

// Each limit by its own worst worsening; what was found better loosens nothing, and a failure on
// either side tells nothing.
TEST(Surer, EveryLimitIsTightenedByItsOwnWorstWorsening) {
  const std::vector<Evaluation> all{seen({0.1}, 1, {-0.5, -0.2}), seen({0.2}, 2, {-0.4, -0.3}),
                                    seen({0.3}, 3, {-1, -2, -3}), seen({0.4}, 4, {-1}),
                                    seen({0.5}, 5, {-7, -7}, false)};
  const std::vector<Evaluation> judged{seen({0.1}, 11, {-0.4, -0.6}),
                                       seen({0.2}, 12, {-0.1, -0.25}), seen({0.5}, 13, {9, 9}),
                                       seen({0.9}, 14, {5, 5})};
  const std::vector<Evaluation> out = tightened(all, judged);
  ASSERT_EQ(out.size(), 6u);
  EXPECT_EQ(out[0].outcome, judged[0].outcome);
  EXPECT_EQ(out[1].outcome, judged[1].outcome);
  EXPECT_EQ(out[2].outcome.objectives[0], 3);
  ASSERT_EQ(out[2].outcome.constraints.size(), 3u);
  EXPECT_NEAR(out[2].outcome.constraints[0], -1 + 0.3, 1e-15);
  EXPECT_NEAR(out[2].outcome.constraints[1], -2 + 0.05, 1e-15);
  EXPECT_EQ(out[2].outcome.constraints[2], -3);
  EXPECT_NEAR(out[3].outcome.constraints[0], -1 + 0.3, 1e-15);
  EXPECT_EQ(out[4].outcome, judged[2].outcome);
  EXPECT_EQ(out[5].unit, Point{0.9});
  EXPECT_EQ(out[5].outcome, judged[3].outcome);
  // A failed judgement replaces what it judges and tightens nothing.
  const std::vector<Evaluation> failed = tightened(all, {seen({0.1}, 0, {5, 5}, false)});
  EXPECT_FALSE(failed[0].outcome.ok);
  EXPECT_EQ(failed[1].outcome, all[1].outcome);
}

// 0.15 of the range from a failure in some coordinate; any distance from one that was kept.
TEST(Surer, TheNextIsTheBestThatIsNotBesideAFailure) {
  const std::vector<Evaluation> all{seen({0.1, 0.5}, 1, {-1}), seen({0.2499, 0.36}, 2, {-1}),
                                    seen({0.2, 0.6501}, 3, {-1}), seen({0.2501, 0.5}, 4, {-1}),
                                    seen({0.9, 0.9}, 0, {0.1})};
  const auto next = [&](const std::vector<Evaluation>& judged) { return next_safer(all, judged); };
  EXPECT_EQ(next({}), 0u);
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {-1})}), 1u);
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {}, false)}), 2u);
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {}, false), seen({0.2, 0.6501}, 3, {-1})}), 3u);
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {}, false), seen({0.3, 0.55}, 3, {}, false)}), std::nullopt);
  // One that the tightened limits refuse is none, nor is one that was refused from the start.
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {0.0})}), 1u);
  EXPECT_EQ(next({seen({0.1, 0.5}, 1, {0.1})}), std::nullopt);
}

// Two kinds of three and a number among other numbers; features as they come.
TEST(Surer, AKindIsHalfAUnitFromEveryOther) {
  SearchProblem p;
  p.space.dimensions = {{0, 2, {0, 1, 2}, false}, {0, 10, {}, true, {{2, 7}}}};
  const auto expect = [&](const Point& unit, const Point& seen_as) {
    const Point out = model_coordinates(p, unit);
    ASSERT_EQ(out.size(), seen_as.size());
    for (std::size_t k = 0; k < out.size(); ++k) EXPECT_NEAR(out[k], seen_as[k], 1e-9);
  };
  // Half of the unit interval's five is 2.5 from the low end: beyond the gap 7.5 of 10.
  expect({1.0 / 6, 0.5}, {0.5, 0, 0, 0.75});
  expect({0.5, 0.2}, {0, 0.5, 0, 0.1});
  expect({5.0 / 6, 1}, {0, 0, 0.5, 1});
}

}  // namespace
}  // namespace papilla::tests::surer_test
