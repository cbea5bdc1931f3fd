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

// Columns are not corrected by the 3-D field, which is solved all the same, once.
TEST(Price, OfColumnsHasTheFieldOnce) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.model.field = FieldMethod::Local;
  scene.environment.relative_humidity = {0.35, 0.55};
  const Texture texture{HoleArray{}};
  Fidelity fidelity = small();
  fidelity.field_skins = 4;
  const auto evaluated = [&] { evaluate(scene, texture, fidelity); };
  work_seconds(evaluated);  // makes what later ones find
  const double announced = measured_seconds(scene, texture, fidelity),
               taken = work_seconds(evaluated);
  EXPECT_LT(taken, 3 * announced);
  EXPECT_GT(taken, announced / 3);
}

// Of a law of few skins no more skins are solved than its samples, and no more counted.
TEST(Price, CountsTheSkinsOfALoadLawThatAreNoMoreThanItsSamples) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.model.coupling = Coupling::Equilibrium;
  const Texture texture{HoleArray{}};
  Fidelity fidelity = small();
  fidelity.control_skins = fidelity.field_skins = 0;
  for (const int skins : {1, 2, 24}) {
    fidelity.skins = skins;
    fidelity.equilibrium_skins = 6;
    const auto evaluated = [&] { evaluate(scene, texture, fidelity); };
    work_seconds(evaluated);
    const double announced = measured_seconds(scene, texture, fidelity),
                 taken = work_seconds(evaluated);
    EXPECT_LT(taken, 3 * announced) << skins;
    EXPECT_GT(taken, announced / 3) << skins;
  }
}

// By the processor's time, within a factor 3 on any machine; `papilla bench --prices` is stricter.
TEST(Price, OfDrivenAndUndrivenDraftsIsWhatTheyTake) {
  for (const double amplitude : {0.0, 100.0, 10000.0}) {
    Scene scene;
    scene.drive.amplitude = amplitude;
    const Texture texture{HoleArray{}};
    const auto evaluated = [&] { evaluate(scene, texture, small()); };
    work_seconds(evaluated);  // makes what later ones find
    const double announced = measured_seconds(scene, texture, small()),
                 taken = work_seconds(evaluated);
    EXPECT_LT(taken, 3 * announced) << amplitude;
    EXPECT_GT(taken, announced / 3) << amplitude;
  }
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
