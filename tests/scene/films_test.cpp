// Films of several layers, how each was made, and the steps of a finger whose numbers all hang
// together.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "scene/scene.h"
#include "scene/uncertainty.h"
#include "tests/support/refusal.h"

namespace papilla::tests::films_test {
namespace {

FilmDielectric layer(double thickness, LayerProcess process) {
  FilmDielectric out;
  out.thickness = thickness, out.process = process;
  return out;
}

TEST(Films, ALayerIsMadeAsItSaysOrAsItsSurface) {
  for (const FilmProcess surface :
       {FilmProcess::Conformal, FilmProcess::Directional, FilmProcess::Planar}) {
    EXPECT_EQ(layer(0, LayerProcess::Surface).made_by(surface), surface);
    EXPECT_EQ(layer(0, LayerProcess::Conformal).made_by(surface), FilmProcess::Conformal);
    EXPECT_EQ(layer(0, LayerProcess::Directional).made_by(surface), FilmProcess::Directional);
    EXPECT_EQ(layer(0, LayerProcess::Planar).made_by(surface), FilmProcess::Planar);
  }
}

// The planar layer that is nearest to the finger, and thinner by the depth of the texture there.
TEST(Films, TheLastPlanarLayerCarriesTheTexture) {
  Surface s;
  s.dielectric = {layer(300e-9, LayerProcess::Planar), layer(200e-9, LayerProcess::Planar),
                  layer(50e-9, LayerProcess::Surface)};
  EXPECT_EQ(s.carrying_layer(), 1);
  std::vector<Dielectric> thin = s.thinnest_layers({.deepest = 150e-9});
  ASSERT_EQ(thin.size(), 3u);
  EXPECT_DOUBLE_EQ(thin[0].thickness, 300e-9);
  EXPECT_NEAR(thin[1].thickness, 50e-9, 1e-20);
  EXPECT_DOUBLE_EQ(thin[2].thickness, 50e-9);
  EXPECT_EQ(s.thinnest_layers({.deepest = 250e-9})[1].thickness, 0);  // never less
  s.process = FilmProcess::Planar;
  EXPECT_EQ(s.carrying_layer(), 2);
  s.dielectric.resize(1);
  EXPECT_EQ(s.carrying_layer(), 0);
  // What is not planar, or not there, carries none.
  s.process = FilmProcess::Conformal;
  s.dielectric[0].process = LayerProcess::Directional;
  EXPECT_EQ(s.carrying_layer(), -1);
  EXPECT_EQ(s.thinnest_layers({.deepest = 150e-9})[0].thickness, 300e-9);
  Surface bare;
  bare.dielectric = std::vector<FilmDielectric>{};
  EXPECT_EQ(bare.carrying_layer(), -1);
  s.dielectric.clear();
  EXPECT_EQ(s.carrying_layer(), -1);
  EXPECT_EQ(s.equivalent_thickness(), 0);
  EXPECT_EQ(s.dielectric_thickness(), 0);
  EXPECT_TRUE(s.layers().empty());
}

// Eq. electrostatics.9: at the foot of a wall what the ellipse of a directional layer leaves, by
// the wall's normal or, of a low one, by the place beside the film on the land.
TEST(Films, DirectionalLayersAreThinOnWalls) {
  Surface s;
  s.process = FilmProcess::Directional;
  const auto left = [&](const FilmGround& ground) {
    return s.thinnest_layers(ground)[0].thickness / s.dielectric[0].thickness;  // 500 nm
  };
  EXPECT_EQ(left({}), 1);
  EXPECT_EQ(left({.height = kInfinity}), 1);  // no slope is stated
  EXPECT_EQ(left({.height = 500e-9, .steepest = 0.5 * kPi}), 0);
  EXPECT_NEAR(left({.height = 350e-9, .steepest = 0.5 * kPi}), 0.3, 1e-12);
  EXPECT_NEAR(left({.height = 2e-6, .steepest = kPi / 3}), 0.5, 1e-12);
  s.step_coverage = 0.5;
  EXPECT_NEAR(left({.height = 2e-6, .steepest = 0.5 * kPi}), 0.5, 1e-12);
  EXPECT_NEAR(left({.height = 2e-6, .steepest = kPi / 4}), std::sqrt(0.5 + 0.25 * 0.5), 1e-12);
  EXPECT_NEAR(left({.height = 100e-9, .steepest = 0.5 * kPi}), std::sqrt(0.64 + 0.25 * 0.36),
              1e-12);
  s.step_coverage = 1;
  EXPECT_NEAR(left({.height = 2e-6, .steepest = 0.5 * kPi}), 1, 1e-12);
}

// Two directional layers are as thin on a wall as one of their sum; a conformal one beside them is
// not thinner, nor are those below a planar one.
TEST(Films, OtherLayersBesideDirectionalOnesKeepTheirThickness) {
  Surface s;
  s.dielectric = {layer(100e-9, LayerProcess::Conformal), layer(200e-9, LayerProcess::Directional),
                  layer(300e-9, LayerProcess::Directional)};
  const FilmGround wall{.deepest = 250e-9, .height = 250e-9, .steepest = 0.5 * kPi};
  std::vector<Dielectric> thin = s.thinnest_layers(wall);
  EXPECT_EQ(thin[0].thickness, 100e-9);
  EXPECT_NEAR(thin[1].thickness, 100e-9, 1e-18);
  EXPECT_NEAR(thin[2].thickness, 150e-9, 1e-18);
  s.dielectric[0].process = LayerProcess::Planar;
  s.dielectric[0].thickness = 400e-9;
  thin = s.thinnest_layers(wall);
  EXPECT_NEAR(thin[0].thickness, 150e-9, 1e-18);
  // Of the coats above it half is left, as of those without it.
  EXPECT_NEAR(thin[1].thickness, 100e-9, 1e-18);
  EXPECT_NEAR(thin[2].thickness, 150e-9, 1e-18);
  std::swap(s.dielectric[0], s.dielectric[2]);  // below a planar layer they lie on level ground
  thin = s.thinnest_layers(wall);
  EXPECT_EQ(thin[0].thickness, 300e-9);
  EXPECT_EQ(thin[1].thickness, 200e-9);
  EXPECT_NEAR(thin[2].thickness, 150e-9, 1e-18);
}

// Thermal oxide of 1e14 ohm m: 1 / (2 pi 8.854e-12 3.9 1e14) = 4.6e-5 Hz, and 500 nm of it 128 nm.
TEST(Films, ThermalOxideIsWhatASurfaceHasUnlessItSaysOtherwise) {
  const Surface s;
  ASSERT_EQ(s.dielectric.size(), 1u);
  const Dielectric& oxide = s.dielectric[0];
  EXPECT_EQ(oxide.material, "SiO2");
  EXPECT_NEAR(oxide.corner_frequency(), 1 / (2 * kPi * 8.8541878e-12 * 3.9 * 1e14), 1e-12);
  EXPECT_NEAR(oxide.equivalent_thickness(), 500e-9 / 3.9, 1e-16);
  EXPECT_DOUBLE_EQ(oxide.strength, 1e9);
  EXPECT_EQ(s.process, FilmProcess::Conformal);
  EXPECT_NEAR(s.contact_angle, 50 * kPi / 180, 1e-12);
  EXPECT_DOUBLE_EQ(s.refractive_index, 1.46);
  EXPECT_DOUBLE_EQ(s.poisson, 0.4);
  for (const double none : {s.step_coverage, s.electrode_edge_radius, s.modulus, s.shear_strength,
                            s.shear_strength_natural, s.shear_strength_wet})
    EXPECT_EQ(none, 0);
}

// Numbers of a finger as the paper of M3 has them or its fit.
TEST(Fingers, AreThatOfTheReferenceUnlessTheySayOtherwise) {
  const Finger f;
  EXPECT_NEAR(f.water.contact_angle, 80 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.natural.contact_angle, 60 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.wet.contact_angle, 60 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.saturation.rest_low, 50 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.saturation.saturated_low, 39.8 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.saturation.rest_high, 110 * kPi / 180, 1e-12);
  EXPECT_NEAR(f.saturation.saturated_high, 79 * kPi / 180, 1e-12);
  EXPECT_DOUBLE_EQ(f.skin.layer_thickness, 1e-6);
  EXPECT_DOUBLE_EQ(f.load, 0.2);
  EXPECT_EQ(f.natural.water_factor, 8);
  EXPECT_EQ(f.natural.shear_factor, 0.75);
  EXPECT_EQ(f.wet.water_factor, 20);
  // 5 MPa on wet skin, against 9 MPa at 15 % RH (Kovalev 2014).
  EXPECT_NEAR(f.wet.shear_factor * f.macro.shear_strength_at(1), 5e6, 0.05e6);
  EXPECT_EQ(f.natural.hydration, 0);
  EXPECT_EQ(f.wet.hydration, 1);
  EXPECT_EQ(f.water.volume_spread, 0);
  EXPECT_EQ(f.skin.hardness, 0);
  EXPECT_EQ(Drive{}.frequency, 5e3);
  EXPECT_EQ(Drive{}.current_limit, 5e-3);
  EXPECT_EQ(Drive{}.envelope_exponent, 0.5);
}

// What is held is a voltage or a current, and that alone drives.
TEST(Drives, HoldAVoltageOrACurrent) {
  Drive d;
  d.amplitude = 150, d.current = 2e-3;
  EXPECT_EQ(d.held(), 150);
  d.control = DriveControl::Current;
  EXPECT_EQ(d.held(), 2e-3);
  EXPECT_TRUE(d.driven());
  d.current = 0;
  EXPECT_FALSE(d.driven());
}

// Five numbers of which each hangs on all before it: the product of the factor with itself is the
// covariance, and the factor has nothing above its diagonal.
TEST(Uncertainty, OfFiveNumbersThatAllHangTogetherIsTheirCovariance) {
  const std::vector<ParameterDeviation> five{{"a", 0.5, {}},
                                             {"b", 0.25, {0.3}},
                                             {"c", 2, {-0.2, 0.4}},
                                             {"d", 1.5, {0.1, -0.3, 0.25}},
                                             {"e", 0.75, {0.35, 0.15, -0.1, 0.2}}};
  const std::vector<double> l = covariance_factor(five);
  ASSERT_EQ(l.size(), 25u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GT(l[i * 5 + i], 0);
    for (std::size_t j = 0; j < 5; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 5; ++k) sum += l[i * 5 + k] * l[j * 5 + k];
      const double correlation = i == j ? 1 : five[std::max(i, j)].correlation[std::min(i, j)];
      EXPECT_NEAR(sum, five[i].deviation * five[j].deviation * correlation, 1e-14) << i << j;
      if (j > i) {
        EXPECT_EQ(l[i * 5 + j], 0);
      }
    }
  }
}

TEST(Uncertainty, WhatItCannotBeIsSaid) {
  const auto refusal = [](const std::vector<ParameterDeviation>& all) -> std::string {
    return refusal_of([&] { covariance_factor(all); });
  };
  EXPECT_EQ(refusal({{"a", 1, {}}, {"b", 1, {0.5, 0.5}}}),
            "uncertainty of b: 2 correlations, but 1 entries before it");
  EXPECT_EQ(
      refusal({{"a", 1, {}}, {"b", 1, {-1}}}),
      "uncertainty of b: its correlations contradict those before it (not positive definite)");
  EXPECT_EQ(refusal({{"a", 1, {}}, {"b", 1, {0.999999}}}), "");
  // 1 - r^2 of a trillionth is the least that is left: r = 1 - 5e-13.
  EXPECT_EQ(refusal({{"a", 1, {}}, {"b", 1, {1 - 7e-13}}}), "");
  EXPECT_NE(refusal({{"a", 1, {}}, {"b", 1, {1 - 4e-13}}}), "");
  Finger f;
  f.name = "mine";
  EXPECT_EQ(refusal_of([&] { finger_steps(f); }),
            "finger \"mine\" has no [[uncertainty]]: nothing is known about its parameters "
            "(papilla calibrate writes it)");
}

}  // namespace
}  // namespace papilla::tests::films_test
