// What is announced before an evaluation. That it is what the work takes is measured: `papilla
// bench --prices`.
#include "forward/price.h"

#include <gtest/gtest.h>

#include "forward/forward.h"

namespace papilla::tests::price_test {
namespace {

Fidelity small() {
  Fidelity f = fidelity_level("draft");
  f.grid = 64;
  f.threads = 1;
  return f;
}

TEST(Price, CountsTheSkinsThatAreNotSolved) {
  Scene scene;
  const Texture texture{HoleArray{}};
  Fidelity few = small();
  few.control_skins = 0;
  few.skins = 8;
  Fidelity many = few;
  many.skins = 800;
  measured_seconds(scene, texture, few);  // what the first evaluation of a process makes
  const double one = measured_seconds(scene, texture, few),
               hundred = measured_seconds(scene, texture, many);
  EXPECT_GT(one, 0);
  EXPECT_GT(hundred, 20 * one);
  EXPECT_LT(hundred, 500 * one);
}

// Of a drive the 3-D field is most.
TEST(Price, CountsTheControlsAndTheFieldOfADrive) {
  Scene scene;
  const Texture texture{HoleArray{}};
  measured_seconds(scene, texture, small());
  const double undriven = measured_seconds(scene, texture, small());
  Fidelity bare = small();
  bare.control_skins = 0;
  EXPECT_GT(undriven, measured_seconds(scene, texture, bare));
  scene.drive.amplitude = 100;
  const double driven = measured_seconds(scene, texture, small());
  EXPECT_GT(driven, undriven);
  Fidelity more = small();
  more.field_skins = 50;
  EXPECT_GT(measured_seconds(scene, texture, more), 5 * driven);
}

TEST(Price, LeavesTheAnswersAsTheyAre) {
  Scene scene;
  scene.drive.amplitude = 100;
  const Texture texture{HoleArray{}};
  const Response before = evaluate(scene, texture, small());
  measured_seconds(scene, texture, small());
  EXPECT_GT(machine_pace({scene}, texture, small()), 0);
  const Response after = evaluate(scene, texture, small());
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    EXPECT_EQ(before.points[i].friction_off.value, after.points[i].friction_off.value);
    EXPECT_EQ(before.points[i].modulation.value, after.points[i].modulation.value);
  }
}

}  // namespace
}  // namespace papilla::tests::price_test
