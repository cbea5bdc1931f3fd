// What belief says of designs where some members say nothing of them.
#include "lab/standing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla::tests::standing_test {
namespace {

// Two designs, no readings.
std::unique_ptr<Standing> standing_by(const std::vector<double>& weights,
                                      const std::vector<std::vector<double>>& worth,
                                      const std::vector<std::vector<bool>>& kept = {},
                                      const std::vector<std::string>& hypotheses = {},
                                      const std::string& risk = "regret") {
  Belief belief;
  for (const double weight : weights) {
    BeliefMember& m = belief.members.emplace_back();
    m.weight = weight;
    m.hypothesis = hypotheses.empty() ? "one" : hypotheses[belief.members.size() - 1];
  }
  LabFile file;
  file.worth = "worst(voltage_for(modulation = 0.3))";
  file.risk = risk;
  const std::vector<LabDesign> designs{{"a", {}, true}, {"b", {}, true}};
  MemberModel model(belief, "", 1);
  const ResponseTable table(designs, model);
  std::vector<MemberNumbers> numbers;
  for (const std::vector<double>& of : worth) numbers.push_back({of, 0, {"of the run", {}}, 0});
  return standing_of(belief, file, designs, table, {}, numbers, kept);
}

// Of a voltage that is minimised 0 V would be the best there can be.
TEST(Standing, LeavesOutMembersAtWhichNoDesignHasAWorth) {
  const double none = std::nan("");
  const auto all = standing_by({0.3, 0.5, 0.2}, {{-150, none, -210}, {-170, none, -190}});
  const auto some = standing_by({0.6, 0.4}, {{-150, -210}, {-170, -190}});
  EXPECT_NEAR(all->best_worth, some->best_worth, 1e-9);
  EXPECT_LT(all->best_worth, -100);
  ASSERT_EQ(all->prospects.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(all->prospects[i].p_best, some->prospects[i].p_best, 1e-12);
    EXPECT_NEAR(all->prospects[i].regret, some->prospects[i].regret, 1e-9);
    EXPECT_NEAR(all->worth[i].low, some->worth[i].low, 1e-9);
  }
  EXPECT_NEAR(all->unanswered, 0.5, 1e-12);
  EXPECT_EQ(some->unanswered, 0);
  EXPECT_EQ(all->weights.size(), 3u);  // they are members of belief all the same
}

// Draws of a kernel lie in pairs about its middle, so that the mean over belief is kept.
TEST(Standing, TellsTheMeanOfAWorthFromItsMedian) {
  const auto s = standing_by({0.6, 0.4}, {{-150, -210}, {-170, -190}});
  ASSERT_EQ(s->worth.size(), 2u);
  EXPECT_NEAR(s->worth[0].mean, -174, 1e-6);
  EXPECT_NEAR(s->worth[1].mean, -178, 1e-6);
  EXPECT_NEAR(s->behind[1].mean, 4, 1e-6);
  const Standing::Interval shown = s->worth[0].times(-1);
  EXPECT_EQ(shown.mean, -s->worth[0].mean);
  EXPECT_EQ(shown.low, -s->worth[0].high);
  EXPECT_EQ(shown.median, -s->worth[0].median);
  // The best at each member takes less voltage than the choice, by its regret.
  EXPECT_EQ(s->best, 0u);
  EXPECT_GT(s->prospects[0].regret, 1);
  EXPECT_NEAR(-s->best_worth, shown.mean - s->prospects[0].regret, 1e-6);
}

// At four equal members, of which the last two are of another hypothesis; 90 % are wanted.
TEST(Standing, SaysWhatTellsWhetherTheChoiceKeepsItsLimits) {
  const auto by = [](const std::vector<double>& weights, const std::vector<bool>& kept) {
    return standing_by(weights, {{0.3, 0.3, 0.3, 0.3}, {0.2, 0.2, 0.2, 0.2}}, {kept, kept},
                       {"one", "one", "two", "two"});
  };
  const std::vector<double> equal(4, 0.25);
  const auto sure = by(equal, {true, true, true, true}),
             by_hypothesis = by(equal, {true, true, false, false}),
             by_finger = by(equal, {true, false, true, false}),
             broken = by({0.04, 0.04, 0.46, 0.46}, {true, true, false, false});
  EXPECT_TRUE(sure->keeps_limits());
  EXPECT_EQ(aim_at_limits(*sure), std::nullopt);
  EXPECT_FALSE(by_hypothesis->keeps_limits());
  EXPECT_NEAR(by_hypothesis->prospects[by_hypothesis->best].p_limits, 0.5, 1e-12);
  EXPECT_EQ(aim_at_limits(*by_hypothesis), Aim::Hypotheses);
  EXPECT_EQ(aim_at_limits(*by_finger), Aim::Parameters);
  EXPECT_FALSE(broken->keeps_limits());
  EXPECT_EQ(aim_at_limits(*broken), std::nullopt);  // 8 %: they are broken, whatever is read
}

// Of twenty members the better design keeps its limits at eight and the other at the other twelve:
// .91 standard errors of their difference. Each member's eight kernel draws know nothing more of
// it (2.6 standard errors, were they members). So does the run that this lab stands on choose.
TEST(Standing, CountsAMemberOnceWhereMembersTellDesignsApart) {
  std::vector<bool> eight(20, false), twelve(20, true);
  for (std::size_t m = 0; m < 8; ++m) {
    eight[m] = true;
    twelve[m] = false;
  }
  const auto s =
      standing_by(std::vector<double>(20, 0.05),
                  {std::vector<double>(20, 1), std::vector<double>(20, 0)}, {eight, twelve});
  EXPECT_NEAR(s->prospects.at(0).less_sure, 0.2 / std::sqrt((12 * 0.8 * 0.8 + 8 * 1.2 * 1.2) / 400),
              1e-9);
  EXPECT_EQ(s->best, 0u);
}

// The first has the higher mean, the second the better worst member.
TEST(Standing, DecidesByTheRiskOfItsLab) {
  const std::vector<double> equal(4, 0.25);
  const std::vector<std::vector<double>> worth{{1, 1, 1, 0}, {0.6, 0.6, 0.6, 0.6}};
  EXPECT_EQ(standing_by(equal, worth)->best, 0u);
  EXPECT_EQ(standing_by(equal, worth, {}, {}, "mean")->best, 0u);
  EXPECT_EQ(standing_by(equal, worth, {}, {}, "worst")->best, 1u);
}

TEST(Standing, DecidesNothingWhereNoMemberHasAWorth) {
  const double none = std::nan("");
  const auto standing = standing_by({0.6, 0.4}, {{none, none}, {none, none}});
  EXPECT_FALSE(standing->decided());
  EXPECT_EQ(standing->unanswered, 1);
}

}  // namespace
}  // namespace papilla::tests::standing_test
