// The finger, its water and its drive against the laws that docs/theory/scene.md states.
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "report/reference.h"
#include "scene/uncertainty.h"

namespace papilla::tests::scene_test {
namespace {

TEST(Finger, SoftensByItsRatioBetween15And75Percent) {
  Skin skin;
  skin.softening = 4;
  EXPECT_DOUBLE_EQ(skin.modulus_factor(0.15), 1);
  EXPECT_DOUBLE_EQ(skin.modulus_factor(0.45), 0.625);  // the mean of both
  EXPECT_DOUBLE_EQ(skin.modulus_factor(0.75), 0.25);
  EXPECT_DOUBLE_EQ(skin.modulus_factor(0), 1.1875);
  skin.softening_saturated = 10;
  EXPECT_NEAR(skin.modulus_factor(1), 0.25 / 10, 1e-15);
}

TEST(Finger, ItsAreaGrowsWithHumidityAndLoad) {
  MacroContact macro;
  macro.area_15 = 40e-6, macro.area_growth = 0.5, macro.load_exponent = 0.5;
  EXPECT_DOUBLE_EQ(macro.gross_area(0.2, 0.15), 40e-6);
  EXPECT_DOUBLE_EQ(macro.gross_area(0.2, 0.75), 60e-6);
  EXPECT_DOUBLE_EQ(macro.gross_area(0.2, 0.45), 50e-6);
  EXPECT_DOUBLE_EQ(macro.gross_area(0.8, 0.15), 80e-6);  // twice, under four times the load
  macro.area_growth = 10;
  EXPECT_DOUBLE_EQ(macro.gross_area(0.2, 0), 0.05 * 40e-6);
  Finger finger;
  finger.load = 0.8;
  finger.macro = macro;
  finger.macro.load_share = 0.01;
  EXPECT_DOUBLE_EQ(finger.patch_pressure(0.15), 0.8 / (0.01 * 80e-6));
}

TEST(Finger, ItsShearStrengthFallsWithHumidity) {
  MacroContact macro;
  macro.shear_strength = 10e6;
  macro.shear_fall = macro.shear_fall_saturated = 0;
  EXPECT_DOUBLE_EQ(macro.shear_strength_at(0.9), 10e6);
  macro.shear_fall = 0.3;
  EXPECT_DOUBLE_EQ(macro.shear_strength_at(0.15), 10e6);
  EXPECT_DOUBLE_EQ(macro.shear_strength_at(0.35), 9e6);
  EXPECT_DOUBLE_EQ(macro.shear_strength_at(0.75), 7e6);
  macro.shear_fall_saturated = 0.4;
  EXPECT_NEAR(macro.shear_strength_at(1), 0.6 * 7e6, 1e-6);
  EXPECT_NEAR((7e6 - macro.shear_strength_at(0.75 + 1e-7)) / 1e-7, 0.3 * 10e6 / 0.6, 1e3);
  macro.shear_fall = macro.shear_fall_saturated = 0.95;
  EXPECT_NEAR(macro.shear_strength_at(1), 0.05 * 0.05 * 10e6, 1e-6);  // never nothing
}

TEST(Film, ItsCornerFrequencyIsThatOfItsMaterial) {
  // Thermal oxide hardly leaks, glass at 1e8 ohm m does below 46 Hz.
  EXPECT_NEAR(corner_frequency(3.9, 1e8), 46.1, 0.1);
  EXPECT_EQ(corner_frequency(3.9, 0), 0);  // a perfect insulator
}

TEST(Finger, ItsElectricalLayerIsALineOverHumidity) {
  ElectricalLayer layer;
  layer.thickness_15 = 30e-9, layer.thickness_75 = 18e-9;
  EXPECT_DOUBLE_EQ(layer.equivalent_thickness(0.15), 30e-9);
  EXPECT_DOUBLE_EQ(layer.equivalent_thickness(0.75), 18e-9);
  EXPECT_DOUBLE_EQ(layer.equivalent_thickness(0.35), 26e-9);
  // Beyond 75 % on with the same slope, and never nothing.
  EXPECT_NEAR((layer.equivalent_thickness(0.75 + 1e-6) - 18e-9) / 1e-6, -12e-9 / 0.6, 1e-13);
  EXPECT_NEAR(layer.equivalent_thickness(1), 18e-9 * std::exp(-(12.0 / 18) * (0.25 / 0.6)), 1e-17);
  layer.thickness_75 = 0;
  EXPECT_EQ(layer.equivalent_thickness(1), 0);
}

TEST(Finger, ItsWaterIsALineOfTheLogarithmBetweenNodes) {
  SkinWater water;
  water.relative_humidity = {0.2, 0.4, 0.6, 0.8};
  water.volume = {1e-18, 4e-18, 8e-18, 72e-18};
  const auto volume = [&](double rh) { return water.volume_per_area(rh) * square(12e-6); };
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(volume(water.relative_humidity[i]), water.volume[i], 1e-12 * water.volume[i]);
  EXPECT_NEAR(volume(0.3), 2e-18, 1e-30);
  EXPECT_NEAR(volume(0.7), 24e-18, 1e-29);
  EXPECT_NEAR(volume(0.1), 0.5e-18, 1e-30);  // the slopes of the ends go on
  EXPECT_NEAR(volume(0.9), 216e-18, 1e-28);
  water.volume = {0, 4e-18, 8e-18, 72e-18};  // from a dry node on a line
  EXPECT_NEAR(volume(0.3), 2e-18, 1e-30);
  EXPECT_EQ(volume(0.1), 0);
  water.relative_humidity = {0.5};
  water.volume = {3e-18};
  EXPECT_NEAR(volume(0.1), 3e-18, 1e-30);
}

TEST(Finger, TheSaturatedAngleIsNeverAboveTheAngleAtRest) {
  const Saturation law{
      .rest_low = 0.8, .saturated_low = 0.5, .rest_high = 2, .saturated_high = 1.4};
  EXPECT_DOUBLE_EQ(law.angle(0.8), 0.5);
  EXPECT_DOUBLE_EQ(law.angle(2), 1.4);
  EXPECT_DOUBLE_EQ(law.angle(1.4), 0.95);
  EXPECT_EQ(law.angle(0.05), 0);
  const Saturation none{
      .rest_low = 0.8, .saturated_low = 0.9, .rest_high = 2, .saturated_high = 2.5};
  EXPECT_DOUBLE_EQ(none.angle(1), 1);
}

TEST(Finger, ItsStateChangesAngleSweatAndShear) {
  Finger finger;
  finger.natural = {1.1, 8, 0.75};
  finger.wet = {0.9, 20, 0.5};
  EXPECT_EQ(finger.applied(), finger);
  for (const auto& [state, change] :
       {std::pair{FingerState::Natural, finger.natural}, {FingerState::Wet, finger.wet}}) {
    finger.state = state;
    const Finger out = finger.applied();
    EXPECT_EQ(out.state, FingerState::Clean);
    EXPECT_EQ(out.water.contact_angle, change.contact_angle);
    for (std::size_t i = 0; i < out.water.volume.size(); ++i)
      EXPECT_DOUBLE_EQ(out.water.volume[i], change.water_factor * finger.water.volume[i]);
    EXPECT_DOUBLE_EQ(out.macro.shear_strength, change.shear_factor * finger.macro.shear_strength);
  }
}

TEST(Drive, TheRootMeanSquareIsThatOfItsWaveform) {
  Drive drive;
  drive.amplitude = 200;
  EXPECT_DOUBLE_EQ(drive.v_rms(), 200 / std::sqrt(2.0));
  drive.waveform = Waveform::Square;
  EXPECT_EQ(drive.v_rms(), 200);
  drive.waveform = Waveform::Dc;
  EXPECT_EQ(drive.v_rms(), 200);
  drive.waveform = Waveform::Am;  // mean square of [(1 + sin)/2]^2g: 1/2 for g = 1/2, 3/8 for 1
  drive.envelope_exponent = 0.5;
  EXPECT_NEAR(drive.v_rms(), 200 * std::sqrt(0.5 * 0.5), 1e-9);
  drive.envelope_exponent = 1;
  EXPECT_NEAR(drive.v_rms(), 200 * std::sqrt(0.5 * 0.375), 1e-9);
  // With a kink where the envelope is nothing: sqrt((1 + sin)/2) = |cos|, of mean 2/pi. By 64
  // midpoints 1 + (pi/128)^2/6 of it; by 64 ends twice as far off, below.
  drive.envelope_exponent = 0.25;
  EXPECT_NEAR(square(drive.v_rms() / 200) * kPi, 1 + square(kPi / 128) / 6, 1e-6);
  EXPECT_TRUE(drive.driven());
  EXPECT_FALSE(Drive{}.driven());
}

TEST(Surface, LayersAddTheirThicknessOverPermittivity) {
  Surface surface;
  surface.dielectric = {{"a", 400e-9, 4, 1, 1}, {"b", 60e-9, 3, 1, 1}};
  EXPECT_DOUBLE_EQ(surface.equivalent_thickness(), 120e-9);
  EXPECT_DOUBLE_EQ(surface.dielectric_thickness(), 460e-9);
}

// Key, default, range and source of every number of a scene, as they are written down.
TEST(Keys, OfASceneAreThoseOfTheReference) {
  for (const char* section : {"finger", "environment", "drive", "surface", "model", "view"}) {
    const std::string page = std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md";
    EXPECT_EQ(reference_section(section, ReferenceFormat::Markdown), read_bytes(page)) << section;
  }
}

TEST(Uncertainty, StepsAreTheColumnsOfACovarianceWithTheStatedCorrelations) {
  Finger finger;
  finger.uncertainty = {{"skin.rms", 0.1, {}},
                        {"macro.load_share", 0.2, {0.5}},
                        {"water.scale", 0.3, {-0.4, 0.25}},
                        {"skin.softening", 0, {}}};
  const std::vector<double> l = covariance_factor(finger.uncertainty);
  const double deviation[] = {0.1, 0.2, 0.3, 0};
  const double correlation[4][4] = {
      {1, 0.5, -0.4, 0}, {0.5, 1, 0.25, 0}, {-0.4, 0.25, 1, 0}, {0, 0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += l[i * 4 + k] * l[j * 4 + k];
      EXPECT_NEAR(sum, deviation[i] * deviation[j] * correlation[i][j], 1e-15) << i << j;
      if (j > i) {
        EXPECT_EQ(l[i * 4 + j], 0);
      }
    }
  }
  const std::vector<FingerStep> steps = finger_steps(finger);
  ASSERT_EQ(steps.size(), 3u);  // what is certain moves nothing
  for (std::size_t k = 0; k < 3; ++k) {
    const Finger &up = steps[k].up, &down = steps[k].down;
    EXPECT_NEAR(std::log(up.skin.rms / finger.skin.rms), l[k], 1e-14);
    EXPECT_NEAR(std::log(down.skin.rms / finger.skin.rms), -l[k], 1e-14);
    EXPECT_NEAR(std::log(up.macro.load_share / finger.macro.load_share), l[4 + k], 1e-14);
    EXPECT_NEAR(std::log(down.water.volume[2] / finger.water.volume[2]), -l[8 + k], 1e-14);
    EXPECT_EQ(up.skin.softening, finger.skin.softening);
  }
}

TEST(Uncertainty, MovedNumbersStayInsideTheirLimits) {
  Finger finger;
  finger.uncertainty = {{"macro.ridge_share", 0.1, {}}, {"skin.rms", 0.1, {}}};
  EXPECT_DOUBLE_EQ(moved_finger(finger, {100, 0}).macro.ridge_share, 1);
  EXPECT_DOUBLE_EQ(moved_finger(finger, {-100, 0}).macro.ridge_share, 0.001);
  EXPECT_DOUBLE_EQ(moved_finger(finger, {0, std::log(2)}).skin.rms, 2 * finger.skin.rms);
  EXPECT_NEAR(moved_finger(finger, {0, 100}).skin.rms, 1e-4, 1e-12);  // 1e5 nm
}

TEST(Uncertainty, WhatContradictsItselfOrNamesNothingIsRefused) {
  EXPECT_THROW(covariance_factor({{"a", 1, {}}, {"b", 1, {0.9}}, {"c", 1, {0.9, -0.9}}}),
               InputError);
  EXPECT_THROW(covariance_factor({{"a", 1, {}}, {"b", 1, {1}}}), InputError);  // one number twice
  EXPECT_THROW(covariance_factor({{"a", 1, {0.5}}}), InputError);
  EXPECT_THROW(finger_steps(Finger{}), InputError);
  Finger finger;
  finger.uncertainty = {{"skin.rsm", 0.1, {}}};
  EXPECT_NE(uncertainty_problem(finger).find("skin.rms"), std::string::npos);
  finger.uncertainty = {{"skin.rms", 0.1, {}}};
  EXPECT_EQ(uncertainty_problem(finger), "");
}

}  // namespace
}  // namespace papilla::tests::scene_test
