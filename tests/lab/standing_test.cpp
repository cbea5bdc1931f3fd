// What belief says of designs where some members say nothing of them.
#include "lab/standing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla::tests::standing_test {
namespace {

// Two designs, no readings.
std::unique_ptr<Standing> standing_by(const std::vector<double>& weights,
                                      const std::vector<std::vector<double>>& worth) {
  Belief belief;
  for (const double weight : weights) {
    BeliefMember& m = belief.members.emplace_back();
    m.weight = weight;
    m.hypothesis = "one";
  }
  LabFile file;
  file.worth = "worst(voltage_for(modulation = 0.3))";
  const std::vector<LabDesign> designs{{"a", {}, true}, {"b", {}, true}};
  MemberModel model(belief, "", 1);
  const ResponseTable table(designs, model);
  std::vector<MemberNumbers> numbers;
  for (const std::vector<double>& of : worth) numbers.push_back({of, 0, {"of the run", {}}, 0});
  return standing_of(belief, file, designs, table, {}, numbers, {});
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

TEST(Standing, DecidesNothingWhereNoMemberHasAWorth) {
  const double none = std::nan("");
  const auto standing = standing_by({0.6, 0.4}, {{none, none}, {none, none}});
  EXPECT_FALSE(standing->decided());
  EXPECT_EQ(standing->unanswered, 1);
}

}  // namespace
}  // namespace papilla::tests::standing_test
