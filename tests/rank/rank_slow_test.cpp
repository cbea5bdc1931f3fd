// Orders of many candidates.
#include <gtest/gtest.h>

#include "tests/rank/samples.h"

namespace papilla::tests::rank_slow_test {
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

// Surfaces of one roughness differ by their arrangement alone: no haze of one is that of another,
// and none is the best. Of an array there is no arrangement: its haze has no ±.
TEST(Rank, ArrangementsOfOneRoughnessAreNotToldApartByTheirHaze) {
  std::vector<Design> designs;
  for (const int seed : {1, 101}) {
    Design d = sample("flat");
    RandomRough rough;
    rough.rms = 60e-9, rough.roll_off = 6e-6, rough.seed = seed;
    d.texture = {rough};
    designs.push_back(d);
  }
  RankOptions options = by("haze:low");
  options.max_skins = 8;
  const Ranking r = ranking_of(designs, options);
  for (const RankedCandidate& c : r.states.front().candidates) {
    EXPECT_LT(c.p_best, 0.97) << c.index;
    EXPECT_GT(c.metrics[0].high, c.metrics[0].low) << c.index;
  }
  designs = {sample("a3h350"), sample("a3h600")};
  for (const RankedCandidate& c : ranking_of(designs, options).states.front().candidates)
    EXPECT_NEAR(c.metrics[0].high, c.metrics[0].low, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::rank_slow_test
