// Orders of many candidates.
#include <gtest/gtest.h>

#include "tests/rank/samples.h"

namespace papilla::tests {
namespace {

// Skins beyond the first six happen to be of lower modulation: only the close pairs meet them.
TEST(Rank, TheLuckOfFewSkinsDoesNotOrder) {
  std::vector<Design> designs;
  for (const char* name : {"a3h350", "a3h600", "a3h900", "a4h350", "a4h600"})
    designs.push_back(sample(name));
  for (const char* by_what : {"modulation:high", "modulation:low", "friction:low"}) {
    const Ranking r = ranking_of(designs, by(by_what));
    const auto& c = r.states.front().candidates;
    double p = 0;
    for (const RankedCandidate& x : c) {
      EXPECT_GE(x.ahead_of_next.value, 0) << by_what;
      p += x.p_best;
      if (&x != &c.back()) {
        EXPECT_GE(x.p_ahead, 0.5) << by_what;
      }
    }
    EXPECT_NEAR(p, 1, 1e-9);
  }
}

}  // namespace
}  // namespace papilla::tests
