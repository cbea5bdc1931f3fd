// The corneum over humidity, hydration and time of touch: the laws that docs/theory/scene.md
// states.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"

namespace papilla::tests::hydration_test {
namespace {

// Every ratio that a file may hold, from dry air to saturation.
TEST(Softening, IsPositiveFallsAndHasNoStepForEveryRatio) {
  Skin skin;
  for (skin.softening = 1; skin.softening <= 100; skin.softening *= 1.5) {
    for (const double saturated : {1.0, 1.01, 2.0, 10.0, 350.0, 1e4}) {
      skin.softening_saturated = saturated;
      double before = skin.modulus_factor(0);
      constexpr int kSteps = 4000;
      for (int i = 1; i <= kSteps; ++i) {
        const double now = skin.modulus_factor(static_cast<double>(i) / kSteps);
        EXPECT_GT(now, 0);
        EXPECT_LE(now, before * (1 + 1e-12));
        // No more than the slopes allow: that of the line, and four times the mean one above 75 %.
        const double line = 1 / 0.6 / kSteps,
                     log_slope = 4 * std::log(saturated) / 0.25 + (skin.softening - 1) / 0.6;
        EXPECT_LE(before - now, line + before * log_slope / kSteps) << i;
        before = now;
      }
      EXPECT_NEAR(skin.modulus_factor(0.75) * skin.softening, 1, 1e-12);
      EXPECT_NEAR(skin.modulus_factor(1) * skin.softening * saturated, 1, 1e-12);
    }
  }
}

TEST(Softening, GoesOnAbove75PercentWithTheSlopeOfTheLine) {
  for (const double softening : {1.2, 1.98, 4.0, 20.0}) {
    Skin skin;
    skin.softening = softening;
    const double line = (1 - 1 / softening) / 0.6;
    EXPECT_NEAR((skin.modulus_factor(0.75) - skin.modulus_factor(0.75 + 1e-7)) / 1e-7, line,
                1e-4 * line);
  }
}

// Between the fits' humidities nothing but the line counts.
TEST(Softening, ToSaturationMovesNothingBelow75Percent) {
  Skin soft, hard;
  soft.softening_saturated = 350;
  hard.softening_saturated = 1;
  for (const double rh : {0.0, 0.15, 0.35, 0.55, 0.75})
    EXPECT_EQ(soft.modulus_factor(rh), hard.modulus_factor(rh)) << rh;
}

// In series, shares of soft and of stiff corneum give as their compliances add.
TEST(Hydration, AddsCompliancesByTheirShares) {
  Skin skin;
  const double dry = skin.modulus_factor(0.35), saturated = skin.modulus_factor(1);
  for (const double share : {0.1, 0.5, 0.9}) {
    skin.hydration = share;
    EXPECT_NEAR(1 / skin.modulus_factor(0.35), (1 - share) / dry + share / saturated,
                1e-12 / saturated);
    EXPECT_NEAR(skin.relief_factor(), 1 - share * (1 - skin.relief_saturated), 1e-15);
  }
  skin.hydration = 1;  // what is soaked does not feel the air
  for (const double rh : {0.0, 0.15, 0.75, 1.0})
    EXPECT_NEAR(skin.modulus_factor(rh), saturated, 1e-15);
}

TEST(Hydration, TakesLayerAndShearStrengthToThoseOfSaturation) {
  const ElectricalLayer layer;
  const MacroContact macro;
  for (const double rh : {0.15, 0.55, 1.0}) {
    EXPECT_EQ(layer.equivalent_thickness(rh, 0), layer.equivalent_thickness(rh));
    EXPECT_EQ(macro.shear_strength_at(rh, 0), macro.shear_strength_at(rh));
    EXPECT_DOUBLE_EQ(layer.equivalent_thickness(rh, 1), layer.equivalent_thickness(1));
    EXPECT_DOUBLE_EQ(macro.shear_strength_at(rh, 1), macro.shear_strength_at(1));
  }
  EXPECT_GT(layer.equivalent_thickness(1), 0);
  Finger finger;
  finger.skin.hydration = 0.3;
  EXPECT_EQ(finger.skin_layer(0.4), finger.electrical.equivalent_thickness(0.4, 0.3));
}

// Dzidek 2017: first-order kinetics, 95 % of the way within 20 s.
TEST(Touch, SaturatesTheCorneumByFirstOrderKinetics) {
  Finger finger;
  const double dry = 1 / finger.skin.modulus_factor(0.35);
  const double last = 1 / finger.skin.modulus_factor(1);
  double before = 0;
  for (const double time : {0.0, 0.1, 1.0, 3.0, 7.0, 20.0, 60.0}) {
    finger.touch_time = time;
    const Skin skin = finger.applied().skin;
    EXPECT_GE(skin.hydration, before);
    before = skin.hydration;
    // The compliance, and with it the contact, is what relaxes.
    EXPECT_NEAR((last - 1 / skin.modulus_factor(0.35)) / (last - dry), std::exp(-time / 7), 1e-12);
  }
  finger.touch_time = 20;
  EXPECT_NEAR(finger.applied().skin.hydration, 0.95, 0.01);
  finger.touch_time = 1e6;
  EXPECT_EQ(finger.applied().skin.hydration, 1);
}

TEST(Touch, OfNoTimeIsTheFingerOfTheFits) {
  const Finger finger;
  EXPECT_EQ(finger.touch_time, 0);
  EXPECT_EQ(finger.applied(), finger);
}

TEST(Touch, ActsOnWhatTheStateLeavesInBalanceWithTheAir) {
  Finger finger;
  finger.skin.hydration = 0.2;
  finger.natural.hydration = 0.5;
  finger.state = FingerState::Natural;
  finger.touch_time = 7 * std::log(2.0);
  const Finger out = finger.applied();
  EXPECT_NEAR(out.skin.hydration, 1 - 0.8 * 0.5 * 0.5, 1e-12);
  EXPECT_EQ(out.touch_time, 0);
  EXPECT_EQ(out.applied(), out);  // nothing more to apply
}

TEST(Touch, OfAnotherFingerIsItsLoadStateAndTime) {
  Finger finger, other;
  finger.skin.rms = 123e-9;
  other.load = 1, other.state = FingerState::Wet, other.touch_time = 30;
  Finger expected = finger;
  expected.load = 1, expected.state = FingerState::Wet, expected.touch_time = 30;
  EXPECT_EQ(finger.touching_as(other), expected);
}

}  // namespace
}  // namespace papilla::tests::hydration_test
