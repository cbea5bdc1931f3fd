// What predictions are made of, and what belief leaves of them, without a run.
#include "claims/predict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "numerics/statistics.h"

namespace papilla::tests::predict_test {
namespace {

TEST(Predictions, TouchASampleAsTheSampleSays) {
  Finger finger, other;
  finger.skin.rms = other.skin.rms = 123e-9;
  other.load = 1;
  other.state = FingerState::Wet;
  other.touch_time = 30;
  const Design first = predicted_design(finger, "flat", {});
  EXPECT_EQ(first, predicted_design(other, "flat", {}));
  EXPECT_EQ(first.finger.load, 0.2);
  EXPECT_EQ(first.finger.state, FingerState::Clean);
  EXPECT_EQ(first.finger.touch_time, 0);
  EXPECT_EQ(first.finger.skin.rms, 123e-9);
  EXPECT_EQ(first.model, finger.calibrated_for);
  const Design asked = predicted_design(
      other, "flat",
      {"finger.load=\"0.5 N\"", "finger.state=\"natural\"", "finger.touch_time=\"5 s\""});
  EXPECT_EQ(asked.finger.load, 0.5);
  EXPECT_EQ(asked.finger.state, FingerState::Natural);
  EXPECT_EQ(asked.finger.touch_time, 5);
}

class ModelParts : public ::testing::Test {
 protected:
  ModelParts() : belief_(), members_(8) {
    belief_.members.resize(members_.size());
    for (BeliefMember& m : belief_.members) m.weight = 1.0 / 8;
  }

  static Prediction of(const char* id, double value, bool of_finger = true) {
    Prediction p;
    p.id = id;
    p.value = {value, 0.5};
    p.of_finger = of_finger;
    return p;
  }

  Belief belief_;
  std::vector<std::vector<Prediction>> members_;
};

TEST_F(ModelParts, AreTheSpreadOverTheMembersThatHaveAnAnswer) {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    members_[k].push_back(of("all", k % 2 ? 3 : 1));
    members_[k].push_back(of("none moves", 7.3));
    if (k < 6) members_[k].push_back(of("most", k % 2 ? 14 : 10));
    if (k < 4) members_[k].push_back(of("few", 10 + static_cast<double>(k)));
  }
  std::vector<Prediction> all{of("all", 2), of("none moves", 7.3), of("most", 12), of("few", 11),
                              of("a look", 1.0617, false)};
  take_model_parts(all, belief_, members_);
  for (const Prediction& p : all) EXPECT_EQ(p.members, 8) << p.id;
  ASSERT_TRUE(all[0].model);
  EXPECT_DOUBLE_EQ(*all[0].model, 1);
  EXPECT_EQ(all[0].silent, 0);
  ASSERT_TRUE(all[1].model);
  EXPECT_EQ(*all[1].model, 0);
  ASSERT_TRUE(all[2].model);
  EXPECT_DOUBLE_EQ(*all[2].model, 2);
  EXPECT_EQ(all[2].silent, 2);
  EXPECT_FALSE(all[3].model);
  EXPECT_EQ(all[3].silent, 4);
  EXPECT_FALSE(all[4].model);
  EXPECT_EQ(all[4].silent, 0);
}

// Values of 1 and 3 lie 1 from their mean; on three skins each is off by -c, 0 and c, the one up
// where the other is down: squares of 1 and c^2/3. Eq. accuracy.18
TEST_F(ModelParts, LeaveOutWhatSkinsScatterThemBy) {
  for (const double c : {0.0, 0.3, std::sqrt(3.0), 6.0}) {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const double value = k % 2 ? 3 : 1, off = k % 2 ? c : -c;
      Prediction there = of("all", value);
      there.samples = {value - off, value, value + off};
      members_[k] = {there};
    }
    std::vector<Prediction> all{of("all", 2)};
    take_model_parts(all, belief_, members_);
    ASSERT_TRUE(all[0].model);
    const double meant = c > 0 ? meant_share(3 / (c * c), 5, 3).value : 1;
    EXPECT_NEAR(*all[0].model, std::sqrt(meant), 1e-12) << c;
    EXPECT_GT(*all[0].model, 0) << c;
  }
}

}  // namespace
}  // namespace papilla::tests::predict_test
