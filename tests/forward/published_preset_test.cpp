// What preset m3, the model as published, counts and leaves out.
#include <gtest/gtest.h>

#include "base/constants.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"

namespace papilla::tests::published_preset_test {
namespace {

Scene published(double angle, FingerState state = FingerState::Clean) {
  Scene scene;
  scene.model.preset = Preset::M3;
  scene.finger.state = state;
  scene.surface.contact_angle = angle * kPi / 180;
  return scene;
}

TEST(PublishedPreset, CapillariesCountWhereTheyPullAndHysteresisWhereTheyPush) {
  EXPECT_TRUE(capillary_off_counts(published(50)));
  EXPECT_TRUE(capillary_off_counts(published(95)));  // polyethylene against 80 deg of skin
  EXPECT_FALSE(capillary_off_counts(published(110)));
  EXPECT_TRUE(capillary_off_counts(published(110, FingerState::Natural)));  // 60 deg of skin
  for (const double angle : {50.0, 95.0, 110.0})
    EXPECT_NE(retention_counts(published(angle)), capillary_off_counts(published(angle)));
}

TEST(PublishedPreset, AFilmOfPolyethyleneRubsMoreOnASweatyFinger) {
  Fidelity fidelity = fidelity_level("draft");
  fidelity.skins = 4;
  fidelity.grid = 64;
  Texture texture;
  Scene scene = published(95, FingerState::Natural);
  scene.drive = {};
  scene.environment.relative_humidity = {0.55};
  const Response wet = evaluate(scene, texture, fidelity);
  EXPECT_GT(wet.points[0].capillary_force.value, 0);
  for (double& v : scene.finger.water.volume) v = 0;
  const Response dry = evaluate(scene, texture, fidelity);
  EXPECT_GT(wet.points[0].friction_off.value, 1.01 * dry.points[0].friction_off.value);
}

// Water of one volume in one gap has one contact line whatever the angle, so one pass holds as much
// under the drive as before it; a drive that closes the gap spreads the water.
TEST(DrivenRetention, GrowsAsTheDriveClosesTheGap) {
  Fidelity fidelity = fidelity_level("draft");
  fidelity.skins = 4;
  fidelity.grid = 64;
  fidelity.field_skins = 0;
  Scene scene;
  scene.environment.relative_humidity = {0.75};
  scene.drive.waveform = Waveform::Sine;
  scene.drive.frequency = 5e3;
  scene.drive.amplitude = 150;
  const ResponsePoint one_pass = evaluate(scene, Texture{}, fidelity).points[0];
  EXPECT_NEAR(one_pass.retention_gain, 0, 1e-9 * one_pass.retention_force.value);
  scene.model.coupling = Coupling::Equilibrium;
  const ResponsePoint closed = evaluate(scene, Texture{}, fidelity).points[0];
  EXPECT_GT(closed.retention_gain, 1e-3 * closed.retention_force.value);
  EXPECT_LT(closed.retention_gain, closed.retention_force.value);
  for (const ResponsePoint& p : {one_pass, closed})
    EXPECT_NEAR(p.modulation.value, p.friction_on.value / p.friction_off.value - 1, 1e-9);
}

}  // namespace
}  // namespace papilla::tests::published_preset_test
