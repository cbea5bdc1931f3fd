// Finalists over the members of a belief, by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "search/score.h"

namespace papilla::tests {
namespace {

// Members of weight .75 and .25 move a value by these.
Score moved(double value, double first, double second) {
  Score out;
  out.ok = true;
  out.values = {value};
  out.parameter_steps = {{{std::sqrt(0.75) * first}, {std::sqrt(0.25) * second}}};
  return out;
}

TEST(BestByBelief, IsTheWeightOfTheMembersThatSaySo) {
  const Score a = moved(2, 0, 0), b = moved(1, -1, 3), c = moved(1, 0, 0);
  const std::vector<double> p = best_by_belief({&a, &b, &c}, 0, true, {0.75, 0.25});
  ASSERT_EQ(p.size(), 3u);
  EXPECT_NEAR(p[0], 0.75, 1e-12);
  EXPECT_NEAR(p[1], 0.25, 1e-12);
  EXPECT_EQ(p[2], 0);
  // Of what is to be low: b under the first member, a tie of none under the second.
  const std::vector<double> low = best_by_belief({&a, &b, &c}, 0, false, {0.75, 0.25});
  EXPECT_NEAR(low[1], 0.75, 1e-12);
  EXPECT_NEAR(low[2], 0.25, 1e-12);
}

TEST(BestByBelief, SharesTiesAndIsUnknownWithoutMembers) {
  const Score a = moved(1, 1, 1);
  const std::vector<double> p = best_by_belief({&a, &a}, 0, true, {0.75, 0.25});
  EXPECT_NEAR(p[0], 0.5, 1e-12);
  EXPECT_NEAR(p[1], 0.5, 1e-12);
  EXPECT_TRUE(best_by_belief({&a, &a}, 0, true, {}).empty());
  EXPECT_TRUE(best_by_belief({&a}, 0, true, {1}).empty());
  EXPECT_EQ(*parameter_error(a, a, 0), 0);
}

}  // namespace
}  // namespace papilla::tests
