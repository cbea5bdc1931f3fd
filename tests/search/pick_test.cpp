#include "search/pick.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace papilla::tests::pick_test {
namespace {

const std::vector<std::string> kNames{"mean(modulation)", "variation(modulation)"};

// Mean (negated) against variation: the middle one gives up little for much.
const std::vector<PickCandidate> kFront{{kNames, {-0.50, 0.60}, 0.20},
                                        {kNames, {-0.46, 0.25}, 0.30},
                                        {kNames, {-0.40, 0.10}, 0.39},
                                        {kNames, {-0.30, 0.08}, 0.38}};

TEST(Pick, EachRuleHasItsDesign) {
  EXPECT_EQ(pick_design("", kFront), 2u);  // nowhere weaker than the others' weakest
  EXPECT_EQ(pick_design("worst", kFront), 2u);
  EXPECT_EQ(pick_design("knee", kFront), 1u);
  EXPECT_EQ(pick_design("mean(modulation)", kFront), 0u);
  EXPECT_EQ(pick_design("mean", kFront), 0u);
  EXPECT_EQ(pick_design("variation", kFront), 3u);
  EXPECT_EQ(pick_design("4", kFront), 3u);
}

TEST(Pick, OneDesignIsEveryRulesDesign) {
  for (const char* rule : {"", "worst", "knee", "variation", "1"})
    EXPECT_EQ(pick_design(rule, {kFront[0]}), 0u);
}

TEST(Pick, UnknownRulesAreRefused) {
  for (const char* rule : {"5", "0", "best", "3.5", "haze"})
    EXPECT_THROW(pick_design(rule, kFront), InputError) << rule;
  EXPECT_THROW(pick_design("", {}), InputError);
}

}  // namespace
}  // namespace papilla::tests::pick_test
