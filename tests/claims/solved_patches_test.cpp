// Claims that solve patches of their own: what share of them, and on which side of the border.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "claims/papers.h"
#include "tests/support/one_pass.h"

namespace papilla::tests::solved_patches_test {
namespace {

Judgement judge(const std::string& id, double rms, double water) {
  Finger finger = one_pass_finger();
  finger.skin.rms = rms;
  for (double& volume : finger.water.volume) volume *= water;
  FingerModel model(finger, Preset::Papilla, 1,
                    {.level = "search", .skins = 2, .first_skin = 7, .grid = 32});
  for (const Claim& c : m3_claims()) {
    if (c.id == id) return c.judge(model);
  }
  ADD_FAILURE() << "no claim " << id;
  return {};
}

// Smoother skins come closer: below 5 % of the load, and above.
TEST(SolvedPatches, VanDerWaalsIsNegligibleBelowFivePercent) {
  double before = 0;
  for (const double rms : {256e-9, 150e-9, 100e-9}) {
    const Judgement j = judge("M18", rms, 1);
    EXPECT_EQ(j.verdict, rms > 120e-9 ? Verdict::Agrees : Verdict::Differs) << j.value;
    EXPECT_GT(j.value, 2 * before);
    EXPECT_GT(j.se, 0.1 * j.value);
    EXPECT_EQ(j.model, fmt::format("{:.2f} ± {:.2f} % of the contact load", j.value, j.se));
    before = j.value;
  }
  EXPECT_GT(before, 6);
}

// Counts scatter as their square root, none as one; without a bridge there is nothing to judge.
TEST(SolvedPatches, BridgesRarelySpanHolesBelowFivePercent) {
  int agree = 0, differ = 0;
  for (const auto& [rms, water] : {std::pair{256e-9, 1.0}, std::pair{100e-9, 2.0},
                                   std::pair{150e-9, 0.2}, std::pair{100e-9, 0.05}}) {
    const Judgement j = judge("M27", rms, water);
    int spanning = -1, all = -1;
    ASSERT_EQ(
        std::sscanf(j.reason.c_str(), "%d of %d bridges at 75 %% RH stand on the floor of a hole",
                    &spanning, &all),
        2);
    ASSERT_GT(all, 0);
    const double share = 100.0 * spanning / all, se = 100 * std::sqrt(std::max(spanning, 1)) / all;
    EXPECT_NEAR(j.value, share, 1e-9);
    EXPECT_NEAR(j.se, se, 1e-9);
    EXPECT_EQ(j.model, fmt::format("{:.1f} ± {:.1f} %", share, se));
    EXPECT_EQ(j.verdict, share < 5 ? Verdict::Agrees : Verdict::Differs);
    agree += share<5, differ += share> 5;
  }
  EXPECT_GT(agree, 0);
  EXPECT_GT(differ, 0);
  const Judgement none = judge("M27", 150e-9, 0);
  EXPECT_TRUE(std::isnan(none.value));
  EXPECT_EQ(none.se, 0);
  EXPECT_EQ(none.verdict, Verdict::NotTestable);
  EXPECT_EQ(none.model, "no bridge");
  EXPECT_EQ(none.reason, "at 75 % RH no droplet of this finger bridges skin and glass");
}

}  // namespace
}  // namespace papilla::tests::solved_patches_test
