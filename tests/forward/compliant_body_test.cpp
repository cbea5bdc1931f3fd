// Soft features as finite bodies, and the patches that carry them.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"

namespace papilla::tests::compliant_body_test {
namespace {

constexpr double kHumidity = 0.55;
const Grid kGrid{256, 256, 12e-6, 12e-6};

Scene soft_scene(double modulus) {
  Scene scene;
  scene.surface.modulus = modulus;
  return scene;
}

TEST(CompliantBody, OfAHalfSphereIsThreeQuartersOfItsRadius) {
  Heightmap ball{kGrid, std::vector<double>(kGrid.size(), 0)};
  const double radius = 3e-6;
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix) {
      const double r2 =
          square((ix + 0.5) * kGrid.dx() - 6e-6) + square((iy + 0.5) * kGrid.dy() - 6e-6);
      ball.z[kGrid.index(ix, iy)] = std::sqrt(std::max(0.0, radius * radius - r2));
    }
  }
  const Surface surface = soft_scene(2.6e6).surface;
  const CompliantBody body = compliant_body(surface, ball);
  EXPECT_NEAR(body.thickness, 0.75 * radius, 1e-3 * radius);
  const double volume = 2 * kPi * radius * radius * radius / 3;
  EXPECT_NEAR(body.solid, volume / (kGrid.area() * body.thickness), 1e-3);
  EXPECT_NEAR(body.compliance(surface), body.thickness * 1.4 * 0.2 / (2.6e6 * 0.6 * body.solid),
              1e-18);
}

TEST(CompliantBody, IsNoneOfWhatIsRigidOrFlat) {
  const Heightmap flat{kGrid, std::vector<double>(kGrid.size(), 1e-6)};
  EXPECT_FALSE(compliant_body(soft_scene(2.6e6).surface, flat).present());
  Heightmap rough = flat;
  rough.z[7] = 0;
  EXPECT_FALSE(compliant_body(soft_scene(0).surface, rough).present());
  EXPECT_TRUE(compliant_body(soft_scene(2.6e6).surface, rough).present());
}

TEST(CompliantBody, MorePatchesCarryWhatGivesAndTheyCarryTheSameLoad) {
  const Scene scene = soft_scene(2.6e6);
  const Fidelity fidelity = fidelity_level("search");
  const ScaleBridge rigid(scene, fidelity, kGrid, kHumidity);
  double share = rigid.carrying_share();
  for (const double thickness : {0.1e-6, 1e-6, 3e-6}) {
    const ScaleBridge soft(scene, fidelity, kGrid, kHumidity, {thickness, 0.4});
    EXPECT_GT(soft.carrying_share(), share);
    share = soft.carrying_share();
    EXPECT_NEAR(soft.carrying_share() * soft.mean_pressure(),
                rigid.carrying_share() * rigid.mean_pressure(),
                1e-6 * rigid.carrying_share() * rigid.mean_pressure());
  }
  EXPECT_LT(share, 6 * rigid.carrying_share());
  // What hardly gives is met as glass is.
  const ScaleBridge stiff(soft_scene(1e12), fidelity, kGrid, kHumidity, {3e-6, 0.4});
  EXPECT_NEAR(stiff.carrying_share(), rigid.carrying_share(), 1e-3 * rigid.carrying_share());
}

TEST(ShearStrength, IsTheSurfacesOwnInTheFingersStateAndHumidity) {
  Scene scene;
  scene.finger.macro.shear_strength = 9e6;
  scene.finger.macro.shear_fall = 0.3;
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.75), 9e6 * 0.7);
  scene.surface.shear_strength = 2.5e6;
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.15), 2.5e6);
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.75), 2.5e6 * 0.7);
  scene.finger.state = FingerState::Natural;
  EXPECT_NEAR(shear_strength(in_its_state(scene), 0.15), 2.5e6 * scene.finger.natural.shear_factor,
              1e-6);
}

// Lipids lower one surface's shear strength and not another's.
TEST(ShearStrength, OfAStateIsWhatTheSurfaceSaysOfIt) {
  Scene scene;
  scene.finger.macro.shear_strength = 9e6;
  scene.finger.macro.shear_fall = 0.3;
  scene.surface.shear_strength = 2.5e6;
  scene.surface.shear_strength_natural = 2.2e6;
  scene.surface.shear_strength_wet = 1.1e6;
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.15), 2.5e6);  // clean: neither
  scene.finger.state = FingerState::Natural;
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.15), 2.2e6);
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.75), 2.2e6 * 0.7);
  scene.surface.shear_strength = 0;  // on glass but for this state
  EXPECT_DOUBLE_EQ(shear_strength(in_its_state(scene), 0.15), 2.2e6);
  // Soaked skin does not feel the air.
  scene.finger.state = FingerState::Wet;
  for (const double rh : {0.15, 0.75})
    EXPECT_NEAR(shear_strength(in_its_state(scene), rh), 1.1e6, 1e-6);
  scene.surface.shear_strength_wet = 0;
  const double saturated = scene.finger.macro.shear_strength_at(1) * scene.finger.wet.shear_factor;
  EXPECT_NEAR(shear_strength(in_its_state(scene), 0.15), saturated, 1e-6);
  EXPECT_EQ(in_its_state(in_its_state(scene)).finger, in_its_state(scene).finger);
}

// Particle films of the paper rub as films do, at every load.
TEST(ParticleFilm, ItsFrictionCoefficientIsOneOfFilmsFromFiveHundredthsToTwoNewton) {
  for (const char* film : {"hdpe_large_1", "hdpe_small_1"}) {
    for (const char* load : {"0.05 N", "0.3 N", "2 N"}) {
      const Design design =
          read_design(std::string(PAPILLA_DESIGNS_DIR) + "/coatings/" + film + ".toml",
                      {std::string("finger.load=\"") + load + "\""});
      Fidelity fidelity = fidelity_level("search");
      fidelity.skins = 4;
      const Response r = evaluate(scene_of(design), design.texture, fidelity);
      const double coefficient = r.points[0].friction_off.value / design.finger.load;
      EXPECT_GT(coefficient, 0.2) << film << ", " << load;
      EXPECT_LT(coefficient, 1.7) << film << ", " << load;  // a search's grid: a tenth too much
    }
  }
}

}  // namespace
}  // namespace papilla::tests::compliant_body_test
