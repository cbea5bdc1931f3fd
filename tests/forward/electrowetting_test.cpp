// The contact angle that a drive leaves, from a scene as a user writes it.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "forward/scene_terms.h"

namespace papilla::tests::electrowetting_test {
namespace {

// Far below saturation the angle is Lippmann's at the mean square of the voltage:
// cos(theta) = cos(theta_0) + eps0 V_rms^2 / (2 gamma sum d/eps).
double lippmann_gain(const Scene& scene, double mean_square) {
  const FieldProblem field = field_problem(scene, 0.5);
  return kVacuumPermittivity * mean_square /
         (2 * scene.finger.water.surface_tension * (field.dielectric + std::abs(field.skin_layer)));
}

double gain(const Scene& scene) {
  return std::cos(driven_contact_angle(scene, 0.5)) - std::cos(scene.surface.contact_angle);
}

Scene scene_of(Waveform waveform, double amplitude) {
  Scene scene;
  scene.surface.contact_angle = 110 * kPi / 180;
  scene.drive.waveform = waveform;
  scene.drive.amplitude = amplitude;
  return scene;
}

TEST(DrivenAngle, IsLippmannsAtTheMeanSquareOfASine) {
  const Scene scene = scene_of(Waveform::Sine, 10);
  const double expected = lippmann_gain(scene, 10.0 * 10 / 2);
  EXPECT_GT(expected, 1e-4);
  EXPECT_NEAR(gain(scene), expected, 0.01 * expected);
}

TEST(DrivenAngle, OfASquareWaveIsThatOfItsAmplitude) {
  const Scene scene = scene_of(Waveform::Square, 10);
  const double expected = lippmann_gain(scene, 10.0 * 10);
  EXPECT_NEAR(gain(scene), expected, 0.01 * expected);
}

// Half of the sine's: the pull has the same.
TEST(DrivenAngle, OfAModulatedCarrierIsThatOfItsMeanSquare) {
  Scene scene = scene_of(Waveform::Am, 10);
  scene.drive.envelope_exponent = 0.5;
  const double expected = lippmann_gain(scene, 10.0 * 10 / 4);
  EXPECT_NEAR(gain(scene), expected, 0.01 * expected);
  EXPECT_NEAR(square(field_problem(scene, 0.5).v_rms), 10.0 * 10 / 4, 1e-9);
}

// Eqs. electrostatics.5 and 22: the work of the charge is the integral of D dV, D = eps0 V/h up to
// eps0 E_s and that much beyond; over half a sine |V| is 2/pi of its peak on the mean.
TEST(DrivenAngle, OfAFilmThatSaturatesIsThatOfTheChargeItTakes) {
  for (const Waveform waveform : {Waveform::Square, Waveform::Sine}) {
    Scene scene = scene_of(waveform, 10);
    const double free = gain(scene), mean = waveform == Waveform::Sine ? 2 / kPi : 1;
    Dielectric& film = scene.surface.dielectric.front();
    const FieldProblem field = field_problem(scene, 0.5);
    const double series = field.dielectric + std::abs(field.skin_layer);
    const auto saturates_at = [&](double share) {  // of the peak voltage
      film.saturation_field = share * 10 / series / film.permittivity;
      return gain(scene);
    };
    EXPECT_EQ(saturates_at(1.1), free);
    const double share = 0.01;
    const double expected = kVacuumPermittivity * share * 10 / series * 10 * (mean - share / 2) /
                            scene.finger.water.surface_tension;
    EXPECT_NEAR(saturates_at(share), expected, 0.01 * expected);
    EXPECT_LT(saturates_at(1e-9), 1e-8 * free);
  }
}

TEST(DrivenAngle, GrowsWithTheSquareOfTheVoltageAndIsRestAtNone) {
  EXPECT_NEAR(gain(scene_of(Waveform::Sine, 10)) / gain(scene_of(Waveform::Sine, 5)), 4, 0.02);
  EXPECT_EQ(driven_contact_angle(scene_of(Waveform::Sine, 0), 0.5), 110 * kPi / 180);
}

}  // namespace
}  // namespace papilla::tests::electrowetting_test
