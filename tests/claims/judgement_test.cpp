// How claims are judged, from estimates whose answers are known.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "claims/figures.h"
#include "claims/members.h"
#include "claims/papers.h"
#include "claims/predict.h"
#include "claims/reproduce.h"
#include "forward/forward.h"
#include "forward/skips.h"

namespace papilla::tests::judgement_test {
namespace {

SkinEstimate estimate(double value, double se, std::vector<double> single) {
  return {{value, se}, static_cast<int>(single.size()), std::move(single)};
}

TEST(Judgement, OfSeveralPartsShowsTheFirstThatFails) {
  const std::vector<Part> parts{{"a", {1.5, 0.1}, true, {true, true, false, true}},
                                {"b", {-2, 0.25}, false, {true, false, true, true}},
                                {"c", {7, 0.5}, false, {true, true, true, true}}};
  const Judgement j = all_of(parts, "because");
  EXPECT_EQ(j.verdict, Verdict::Differs);
  EXPECT_EQ(j.value, -2);
  EXPECT_EQ(j.se, 0.25);
  EXPECT_EQ(j.model, "-2 ± 0.25");
  EXPECT_EQ(j.reason,
            "a 1.5 ± 0.1 [75 %]; b -2 ± 0.25 (no) [75 %]; c 7 ± 0.5 (no) [100 %]. because");
  ASSERT_TRUE(j.single);
  EXPECT_DOUBLE_EQ(*j.single, 0.5);
}

TEST(Judgement, OfPartsThatAllHoldShowsTheFirstAndNoExcuse) {
  const Judgement j = all_of({{"a", {1, 0.1}, true, {true}}, {"b", {2, 0.2}, true}}, "because");
  EXPECT_EQ(j.verdict, Verdict::Agrees);
  EXPECT_EQ(j.value, 1);
  EXPECT_EQ(j.reason, "a 1 ± 0.1 [100 %]; b 2 ± 0.2");
  EXPECT_FALSE(j.single);  // not of the same patches
  EXPECT_FALSE(all_of({{"a", {1, 0.1}, true}}).single);
}

// Of three skins the half-width is 4.303 standard errors.
TEST(Judgement, ASignCountsWhereItsIntervalLeavesOutZero) {
  EXPECT_TRUE(above_zero("", estimate(4.4, 1, {1, 2, 3})).holds);
  EXPECT_FALSE(above_zero("", estimate(4.2, 1, {1, 2, 3})).holds);
  EXPECT_FALSE(above_zero("", estimate(-4.4, 1, {1, 2, 3})).holds);
  EXPECT_TRUE(below_zero("", estimate(-4.4, 1, {1, 2, 3})).holds);
  EXPECT_FALSE(below_zero("", estimate(-4.2, 1, {1, 2, 3})).holds);
  EXPECT_FALSE(below_zero("", estimate(4.4, 1, {1, 2, 3})).holds);
  using Flags = std::vector<bool>;
  EXPECT_EQ(above_zero("", estimate(1, 1, {-1, 0, 3})).single, (Flags{false, false, true}));
  EXPECT_EQ(below_zero("", estimate(1, 1, {-1, 0, 3})).single, (Flags{true, false, false}));
}

TEST(Judgement, ABandHoldsItsEnds) {
  using Flags = std::vector<bool>;
  const Part p = in_band("name", estimate(2, 0.5, {1.9, 2, 3, 3.1}), 2, 3);
  EXPECT_EQ(p.name, "name");
  EXPECT_EQ(p.value.value, 2);
  EXPECT_EQ(p.value.se, 0.5);
  EXPECT_TRUE(p.holds);
  EXPECT_EQ(p.single, (Flags{false, true, true, false}));
  EXPECT_FALSE(in_band("", estimate(3.01, 0, {}), 2, 3).holds);
  EXPECT_FALSE(in_band("", estimate(1.99, 0, {}), 2, 3).holds);
}

TEST(Judgement, ATrendHasNoStepBackAndNoneLevel) {
  EXPECT_EQ(trend({1, 2, 4}, true, "r").verdict, Verdict::Agrees);
  EXPECT_EQ(trend({1, 2, 4}, true, "r").value, 4);
  EXPECT_EQ(trend({1, 2, 4}, true, "r").model, "1, 2, 4");
  EXPECT_EQ(trend({1, 2, 4}, true, "r").reason, "r");
  EXPECT_EQ(trend({1, 2, 4}, false, "").verdict, Verdict::Differs);
  EXPECT_EQ(trend({4, 2, 1}, false, "").verdict, Verdict::Agrees);
  EXPECT_EQ(trend({1, 2, 2}, true, "").verdict, Verdict::Differs);
  EXPECT_EQ(trend({2, 2, 1}, false, "").verdict, Verdict::Differs);
  EXPECT_EQ(trend({3, 2, 4}, true, "").verdict, Verdict::Differs);
}

TEST(Judgement, EveryVerdictHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (const Verdict v : kVerdicts) words.insert(verdict_name(v));
  EXPECT_EQ(words, (std::set<std::string>{"agrees", "fitted", "differs", "paper inconsistent",
                                          "not testable"}));
}

TEST(Judgement, WhatBeliefLeavesIsTheSpreadOverItsWeightedMembers) {
  const std::vector<double> weights{0.5, 0.25, 0.25}, some{1, 1};
  EXPECT_DOUBLE_EQ(deviation_over(weights, std::vector<double>{1, 3, 5}), std::sqrt(2.75));
  EXPECT_DOUBLE_EQ(deviation_over(some, std::vector<double>{1, 3}), 1);
  EXPECT_EQ(deviation_over(weights, std::vector<double>{2, 2, 2}), 0);
}

TEST(Judgement, WhatBeliefLeavesIsNoRounding) {
  // Weights that do not sum up to 1 in the last digit, of a number that no member moves.
  const std::vector<double> weights(32, 1 / 32.0 + 1e-17), odd{0.1, 0.2, 0.7};
  EXPECT_EQ(deviation_over(weights, std::vector<double>(32, 1.0617)), 0);
  EXPECT_EQ(deviation_over(odd, std::vector<double>(3, 1.0617)), 0);
  EXPECT_EQ(deviation_over(odd, std::vector<double>{1, 1 + 1e-12, 1}), 0);
  EXPECT_GT(deviation_over(odd, std::vector<double>{1, 1 + 1e-6, 1}), 1e-7);
}

TEST(Judgement, OfNoNumberIsNotTestable) {
  const double none = std::nan("");
  EXPECT_EQ(all_of({{"a", {1, 0.1}, true}, {"b", {none, none}, true}}).verdict,
            Verdict::NotTestable);
  EXPECT_EQ(all_of({{"a", {1, 0.1}, true}, {"b", {2, none}, true}}).verdict, Verdict::Agrees);
}

TEST(Judgement, ADeviationIsFromTheNearestOfAPrintedRange) {
  PrintedNumber p;
  p.low = 20;
  p.high = 25;
  EXPECT_EQ(p.deviation({22, 1}), 0);
  EXPECT_DOUBLE_EQ(p.deviation({30, 1}), 0.2);
  EXPECT_DOUBLE_EQ(p.deviation({15, 1}), -0.25);
}

TEST(Judgement, AnErrorStandsBesideAllThatIsUncertainOfIt) {
  PrintedNumber p;
  p.low = 20;
  p.high = 25;
  p.published_sd = 2;
  p.papilla = {22, 1};
  EXPECT_EQ(p.error(), 0);
  p.papilla = {30, 1};
  EXPECT_DOUBLE_EQ(p.error(), 5);
  EXPECT_DOUBLE_EQ(p.validation_sd(), std::sqrt(5.0));
  p.papilla.value = 15;
  p.input_sd = 2;
  EXPECT_DOUBLE_EQ(p.error(), -5);
  EXPECT_DOUBLE_EQ(p.validation_sd(), 3);
}

TEST(M3Claims, AreNumberedInOrderAndAskForBothPresets) {
  int before = 0;
  for (const Claim& c : m3_claims()) {
    const int number = std::stoi(c.id.substr(1));
    EXPECT_GT(number, before) << c.id;
    before = number;
    EXPECT_TRUE(c.both_presets);
  }
  EXPECT_EQ(m3_claim_ids().size(), m3_claims().size());
  EXPECT_EQ(papilla::claims::claims().size(), m3_claims().size() + theory_claims().size());
}

// Claims about one sample, on two skins of few pixels, against the response of that sample.
class OfFewSkins : public ::testing::Test {
 protected:
  static SkinSampling few() { return {.level = "search", .skins = 2, .first_skin = 7, .grid = 48}; }

  Judgement judge(const std::string& id) {
    for (const Claim& c : papilla::claims::claims()) {
      if (c.id == id) return c.judge(model_);
    }
    return {};
  }

  FingerModel model_{Finger{}, Preset::Papilla, 1, few()};
};

TEST_F(OfFewSkins, TheRetentionIsItsShareOfTheFriction) {
  const Judgement j = judge("M17");
  const ResponsePoint& p = m3_sample(model_, "flat").point(kWet);
  EXPECT_DOUBLE_EQ(j.value, 100 * p.retention_force.value / p.friction_off.value);
  EXPECT_DOUBLE_EQ(j.se, 100 * p.retention_force.se() / p.friction_off.value);
  EXPECT_EQ(j.verdict, j.value >= 2 && j.value <= 10 ? Verdict::Agrees : Verdict::Differs);
}

TEST_F(OfFewSkins, TheFieldsAreThoseOfTheDryPatch) {
  const Judgement j = judge("M24");
  const ResponsePoint& p = m3_sample(model_, "flat").point(kDry);
  EXPECT_EQ(j.verdict, Verdict::PaperInconsistent);
  EXPECT_DOUBLE_EQ(j.value, p.peak_air_field * 1e-6);
  EXPECT_NE(j.model.find(std::to_string(std::lround(p.peak_oxide_field * 1e-6)) + " MV/m in SiO2"),
            std::string::npos)
      << j.model;
}

// The same attraction as the bound of what a plan skips: two codes, one integral.
TEST_F(OfFewSkins, VanDerWaalsIsThatOfTheSkippedPiece) {
  const Judgement j = judge("M18");
  const SampleCase c{.design = "m3_samples/flat.toml", .water = false};
  const Design d = read_case(c);
  const Scene s = scene_of(model_, c, d);
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const PatchPicture p = picture_patch(s, d.texture, model_.fidelity(), 0.15, k);
    double load = 0;
    for (const double pressure : p.fields.off.pressure) load += pressure;
    const Gap gap{p.texture.grid, p.fields.off.gap};
    sum += 100 * van_der_waals_traction(gap).mean() /
           (load / static_cast<double>(gap.value.size())) / 8;
  }
  EXPECT_NEAR(j.value, sum, 0.01 * sum);
  EXPECT_EQ(j.verdict, sum < 5 ? Verdict::Agrees : Verdict::Differs);
}

TEST_F(OfFewSkins, TheHighestModulationIsThatOfTheHydrophobicFlatWithoutWater) {
  const Judgement j = judge("M15");
  const Sample& s =
      sample(model_, {.design = "m3_samples/flat.toml", .angle = 110, .water = false});
  double best = 0;
  for (int rh = 0; rh < kHumidities; ++rh) best = std::max(best, modulation(s, rh, Skins::all()));
  EXPECT_NEAR(j.value, best, 1e-12 * best);
  EXPECT_EQ(j.verdict, std::abs(j.value / 1.38 - 1) <= 0.15 ? Verdict::Agrees : Verdict::Differs);
}

TEST_F(OfFewSkins, TheCapillaryAreaIsThatOfAPatchWithoutWater) {
  const Judgement j = judge("M5");
  SampleCase dry_case = m3_case("flat");
  dry_case.water = false;
  const auto area = [](const Sample& s) { return Skins::all().mean(s.at(kWet).area_off); };
  const double gain = 100 * (area(m3_sample(model_, "flat")) / area(sample(model_, dry_case)) - 1);
  EXPECT_GT(gain, 0);
  EXPECT_NE(j.reason.find("flat %"), std::string::npos);
  EXPECT_NEAR(std::stod(j.reason.substr(j.reason.find("flat %") + 7)), gain, 0.02 * gain + 0.05);
}

}  // namespace
}  // namespace papilla::tests::judgement_test
