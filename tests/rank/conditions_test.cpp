// What is said of candidates under other conditions, and of criteria.
#include "rank/conditions.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/rank/samples.h"
#include "tests/support/refusal.h"

namespace papilla::tests::conditions_test {
namespace {

std::string refusal(const std::vector<ConditionDifference>& differences) {
  return refusal_of([&] { require_same_conditions(differences); });
}

TEST(Conditions, ADifferenceNamesBothCandidatesAndTheirValues) {
  Design mine, other;
  mine.finger.load = 0.3;
  mine.title = "mine";
  const auto named = condition_differences({{mine}, {other}}, by("friction:low"));
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named[0].text(), "finger.load: 0.3 N in \"mine\", 0.2 N in candidate 2");
  RankOptions options = by("friction:low");
  options.names = {"one", "two"};
  EXPECT_EQ(condition_differences({{mine}, {other}}, options).at(0).text(),
            "finger.load: 0.3 N in one, 0.2 N in two");
  EXPECT_TRUE(condition_differences({{mine}, {mine}}, options).empty());
}

TEST(Conditions, OnlyTheFirstDifferenceOfAKeyIsTold) {
  Design a, b, c;
  b.finger.load = 0.3;
  c.finger.load = 0.4;
  const auto told = condition_differences({{a}, {b}, {c}}, by("friction:low"));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].other_value, "0.3 N");
}

TEST(Conditions, WhatNoCriterionFeelsIsNone) {
  Design a, b;
  b.accuracy.target = 0.1;  // no condition: a ranking takes the skins that its order asks for
  b.accuracy.parameters = true;
  b.finger.name = "another name";
  b.finger.state = FingerState::Natural;
  EXPECT_TRUE(condition_differences({{a}, {b}}, by("friction:low")).empty());
  b.drive.amplitude = 120;
  EXPECT_TRUE(condition_differences({{a}, {b}}, by("friction:low")).empty());
  EXPECT_FALSE(condition_differences({{a}, {b}}, by("friction:low,modulation:high")).empty());
}

// The state is no condition, but without one asked for all have to be in the same.
TEST(Conditions, TheStateOfAllIsTheOneThatTheyShare) {
  Design clean, natural;
  clean.finger.state = FingerState::Clean;
  natural.finger.state = FingerState::Natural;
  EXPECT_EQ(common_state({{natural}, {natural, natural}}), FingerState::Natural);
  EXPECT_EQ(refusal_of([&] {
              common_state({{natural}, {natural, clean}});
            }),
            "the designs' fingers are in different states (finger.state), natural, clean: say in "
            "which of them, or in which ones, all are judged");
}

// A pin has none, whatever the finger that is not there is in.
TEST(Conditions, TheStateOfAllIsThatOfTheFingersAmongThem) {
  Design pin, natural;
  pin.counterface.type = CounterfaceType::Pin;
  natural.finger.state = FingerState::Natural;
  EXPECT_EQ(common_state({{pin}, {natural}}), FingerState::Natural);
  pin.finger.state = FingerState::Wet;
  EXPECT_EQ(common_state({{pin}, {pin}}), FingerState::Clean);
}

TEST(Conditions, LongValuesAreCutAndShortOnesAreNot) {
  const std::string longest(48, 'x');
  EXPECT_EQ((ConditionDifference{"k", "a", longest, longest + "y", "b"}.text()),
            "k: " + longest + " in a, " + longest + "... in b");
}

TEST(Conditions, AFewAreSetByTheirKeysAndManyAreCounted) {
  std::vector<ConditionDifference> list;
  EXPECT_EQ(refusal(list), "");
  for (int i = 0; i < 3; ++i) list.push_back({"k" + std::to_string(i), "a", "1", "2", "b"});
  EXPECT_NE(refusal(list).find("make them equal: --set 'k0=1' --set 'k1=1' --set 'k2=1'; or"),
            std::string::npos)
      << refusal(list);
  for (int i = 3; i < 6; ++i) list.push_back({"k" + std::to_string(i), "a", "1", "2", "b"});
  EXPECT_EQ(refusal(list).find("--set"), std::string::npos) << refusal(list);
  EXPECT_NE(refusal(list).find("k5: 1 in a, 2 in b\nmake them equal: the same [finger] base"),
            std::string::npos)
      << refusal(list);
  for (int i = 6; i < 8; ++i) list.push_back({"k" + std::to_string(i), "a", "1", "2", "b"});
  EXPECT_NE(refusal(list).find("k5: 1 in a, 2 in b\n  and 2 keys more\n"), std::string::npos)
      << refusal(list);
}

TEST(Criteria, AreReadBackAsTheyAreWritten) {
  const std::vector<Criterion> c =
      parse_criteria("friction:high,modulation,compliance:low,worst(friction):low");
  ASSERT_EQ(c.size(), 4u);
  EXPECT_EQ(c[0].text(), "mean(friction):high");
  EXPECT_EQ(c[1].text(), "mean(modulation):high");
  EXPECT_EQ(c[2].text(), "mean(compliance):low");
  EXPECT_EQ(c[3].text(), "worst(friction):low");
  EXPECT_THROW(parse_criteria("voltage_for(modulation=0.2):low"), InputError);
  EXPECT_THROW(parse_criteria(",friction:low"), InputError);
  EXPECT_EQ(refusal_of([] { parse_criteria("friction:low,adhesion:low,mean(friction):high"); }),
            "\"friction:low,adhesion:low,mean(friction):high\": mean(friction) is named twice");
  RankOptions options;
  options.criteria = {c[0]};
  EXPECT_TRUE(options.scored());
  options.criteria = c;
  EXPECT_FALSE(options.scored());
  options.weights = {1, 1, 1, 1};
  EXPECT_TRUE(options.scored());
}

}  // namespace
}  // namespace papilla::tests::conditions_test
