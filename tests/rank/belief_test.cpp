// Orders over the members of a belief: by hand, and of designs that belief moves alike.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/constants.h"
#include "base/error.h"
#include "numerics/statistics.h"
#include "rank/rank.h"
#include "report/ranking.h"
#include "tests/temporary.h"

namespace papilla::tests::belief_test {
namespace {

// Steps of two members of weight .75 and .25 that move a score by -1 and 3 from its mean.
StepSamples moves(double scale) {
  const double first = std::sqrt(0.75) * -1 * scale, second = std::sqrt(0.25) * 3 * scale;
  return {{first, first}, {second, second}};
}

// A leads by 2; under the second member by 2 - 3, under the first by 2 + 1. The skins say nothing.
TEST(MemberScores, AreProbableByTheWeightOfTheMembersThatSaySo) {
  Scores s;
  s.skins = {{2, 2}, {0, 0}};
  s.steps = {moves(0), moves(1)};
  s.member_weights = {0.75, 0.25};
  EXPECT_NEAR(s.probability_ahead(0, 1), 0.75, 1e-12);
  EXPECT_NEAR(s.probability_ahead(1, 0), 0.25, 1e-12);
  EXPECT_NEAR(s.probabilities(0)[0], 0.75, 0.02);  // 4000 draws
  EXPECT_NEAR(*s.difference(0, 1).parameters, std::sqrt(0.75 + 0.25 * 9), 1e-12);
  // Moved alike, no member turns them.
  s.steps = {moves(1), moves(1)};
  EXPECT_EQ(s.probability_ahead(0, 1), 1);
  EXPECT_NEAR(s.probabilities(0)[0], 1, 1e-9);  // a sum of draws
  EXPECT_EQ(*s.difference(0, 1).parameters, 0);
}

// With skins that scatter each member's lead is Student's.
TEST(MemberScores, HaveTheScatterOfTheSkinsInEachMember) {
  Scores s;
  s.skins = {{2.5, 1.5, 2.2, 1.8}, {0, 0, 0, 0}};
  const auto four = [](double v) { return std::vector<double>(4, v); };
  s.steps = {{four(0), four(0)}, {four(-std::sqrt(0.75)), four(std::sqrt(0.25) * 3)}};
  s.member_weights = {0.75, 0.25};
  const double se = mean_estimate(s.skins[0]).se;
  EXPECT_NEAR(s.probability_ahead(0, 1),
              0.75 * student_t_cdf(3 / se, 3) + 0.25 * student_t_cdf(-1 / se, 3), 1e-9);
}

class RankedByBelief : public ::testing::Test {
 protected:
  RankedByBelief() {
    const std::string file = temporary("rank_belief.toml");
    std::ofstream(file) << R"(schema_version = 1
[[member]]
weight = 0.5
set = { "macro.shear_strength" = "7.2 MPa" }
[[member]]
weight = 0.5
set = { "macro.shear_strength" = "10.8 MPa" }
)";
    for (const char* name : {"flat", "a3h600"}) {
      Design d = read_design(find_design(std::string("m3_samples/") + name + ".toml"));
      d.title = name;
      d.environment.relative_humidity = {0.35, 0.65};
      d.environment.weights.clear();
      d.finger.water.hysteresis = 0;
      d.finger.belief = file;
      d.accuracy.level = AccuracyLevel::Draft;
      d.accuracy.grid = 32;
      designs_.push_back(d);
    }
    options_.criteria = parse_criteria("friction:low");
    options_.states = {FingerState::Clean};
    options_.max_skins = 12;
    options_.threads = 2;
    options_.parameters = true;
  }

  std::vector<Design> designs_;
  RankOptions options_;
};

// A shear strength of 9 MPa ± 20 %: every friction is moved by that share of what it is on the
// skins that it met, however the members' few skins have it. Eq. accuracy.15
TEST_F(RankedByBelief, EveryFrictionIsMovedByTheSameShare) {
  const Ranking r = ranking_of(designs_, options_);
  EXPECT_EQ(r.members, 2);
  EXPECT_EQ(r.directions, 0);
  for (const RankedCandidate& c : r.states[0].candidates)
    EXPECT_NEAR(*c.metrics[0].parameters / c.metrics[0].value, 0.2, 2e-3);
  const std::string table = ranking_table({"flat", "a3h600"}, options_, r);
  EXPECT_NE(table.find("belief about finger and model"), std::string::npos) << table;
  EXPECT_NE(ranking_json({"flat", "a3h600"}, options_, r).find("\"members\": 2"),
            std::string::npos);
}

TEST_F(RankedByBelief, OtherBeliefsOrOtherModelOptionsAreRefused) {
  options_.any_conditions = true;
  std::vector<Design> other = designs_;
  other[1].finger.belief.clear();
  EXPECT_THROW(ranking_of(other, options_), InputError);
  other = designs_;
  for (Design& d : other) d.model.air_limit = AirLimit::Emission;
  EXPECT_THROW(ranking_of(other, options_), InputError);
}

}  // namespace
}  // namespace papilla::tests::belief_test
