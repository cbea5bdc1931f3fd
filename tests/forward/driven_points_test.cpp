// Patches that are driven at one voltage after another answer as a run of that voltage; what a
// patch's pictures, fields and looks are made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "fields/gap.h"
#include "fields/price.h"
#include "fields/wetting.h"
#include "forward/appearance.h"
#include "forward/forward.h"
#include "forward/patch_setup.h"
#include "tests/support/glass.h"

namespace papilla::tests::driven_points_test {
namespace {

Fidelity small(Estimator estimator) {
  Fidelity f = fidelity_level("search");
  f.grid = 32, f.skins = 3, f.estimator = estimator;
  return f;
}

void expect_same_points(const ResponsePoint& a, const ResponsePoint& b, double error) {
  for (const PointQuantity& q : kPointQuantities) {
    const Measured &x = a.*q.value, &y = b.*q.value;
    EXPECT_NEAR(x.value, y.value, error * std::abs(y.value));
    EXPECT_NEAR(x.parts.sampling, y.parts.sampling, error * std::abs(y.value));
    EXPECT_EQ(x.parts.field.has_value(), y.parts.field.has_value());
    EXPECT_EQ(x.parts.water.has_value(), y.parts.water.has_value());
  }
  EXPECT_EQ(a.relative_humidity, b.relative_humidity);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_NEAR(a.source_voltage, b.source_voltage, 1e-9);
  EXPECT_NEAR(a.patch_pressure, b.patch_pressure, 1e-9 * b.patch_pressure);
  EXPECT_NEAR(a.peak_oxide_field, b.peak_oxide_field, error * b.peak_oxide_field);
  EXPECT_EQ(a.field_correction, b.field_correction);
  EXPECT_EQ(a.status, b.status);
}

// Of droplets at two placements and volumes, of patches at three pressures, with the rule
// corrected.
TEST(UndrivenPatchesLaws, AnswerAsARunOfTheirVoltage) {
  for (const Closure closure : {Closure::Uniform, Closure::Persson}) {
    Scene scene;
    scene.environment.relative_humidity = {0.6};
    scene.model.closure = closure;
    scene.finger.water.volume_spread = closure == Closure::Uniform ? 0.3 : 0;
    Fidelity f = small(Estimator::Load);
    f.droplet_seeds = closure == Closure::Uniform ? 2 : 1;
    const Texture texture{HoleArray{}};
    const UndrivenPatches patches(scene, texture, f);  // whatever its voltage
    for (const double amplitude : {60.0, 140.0}) {
      scene.drive.amplitude = amplitude;
      expect_same_points(patches.drive(amplitude, Estimator::Load).points[0],
                         evaluate(scene, texture, f).points[0], 1e-9);
    }
    scene.drive.amplitude = 0;
  }
}

// The rule is corrected on the water of a volt, where no voltage is known yet, else of the scene's,
// until another is asked for.
TEST(UndrivenPatchesLaws, AreCorrectedAsAtOneAmplitude) {
  Scene scene;
  scene.environment.relative_humidity = {0.6};
  Fidelity f = small(Estimator::Load);
  f.field_skins = 1;
  for (const double amplitude : {0.0, 80.0}) {
    scene.drive.amplitude = amplitude;
    UndrivenPatches patches(scene, Texture{}, f);
    Scene measured = scene;
    measured.drive.amplitude = amplitude > 0 ? amplitude : 1;
    const FieldRatio ratio = field_ratios(measured, Texture{}, f)[0];
    const ResponsePoint p = patches.drive(120, Estimator::Load).points[0];
    EXPECT_EQ(p.field_correction, ratio.correction);
    EXPECT_NE(ratio.correction, 1);
    EXPECT_EQ(p.field_error, ratio.error);
    EXPECT_NEAR(*p.electrostatic_force.parts.field, *ratio.error * p.electrostatic_force.value,
                1e-12);
    EXPECT_EQ(patches.corrected_at(), measured.drive.amplitude);
    patches.correct_at(120);
    measured.drive.amplitude = 120;
    EXPECT_EQ(patches.drive(120, Estimator::Load).points[0].field_correction,
              field_ratios(measured, Texture{}, f)[0].correction);
  }
  f.field_skins = 0;
  EXPECT_EQ(UndrivenPatches(scene, Texture{}, f).corrected_at(), 0);
}

TEST(UndrivenPatchesLaws, ByAreasOrTheLoadLawAsAsked) {
  Scene scene;
  scene.environment.relative_humidity = {0.6};
  scene.drive.control = DriveControl::Current;  // voltages are tried, whatever is held
  const UndrivenPatches patches(scene, Texture{}, small(Estimator::Area));
  scene.drive.control = DriveControl::Voltage;
  scene.drive.amplitude = 120;
  expect_same_points(patches.drive(120, Estimator::Area).points[0],
                     evaluate(scene, Texture{}, small(Estimator::Area)).points[0], 1e-3);
  // The load law on patches that have their capillary state solved as well.
  const ResponsePoint law = patches.drive(120, Estimator::Load).points[0];
  const ResponsePoint run = evaluate(scene, Texture{}, small(Estimator::Load)).points[0];
  EXPECT_NEAR(law.modulation.value, run.modulation.value, 1e-9);
  EXPECT_NEAR(law.area_fraction_on.value, run.area_fraction_on.value, 1e-9);
}

// The patch of a picture is that of the run: skin first_skin + index, placement of the droplets.
TEST(PicturesLaws, AreThePatchesOfARun) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.environment.relative_humidity = {0.6};
  Fidelity f = small(Estimator::Area);
  f.first_skin = 4;
  const Texture texture{HoleArray{}};
  const PatchSetup setup(scene, texture, f);
  for (const auto& [index, placement] : {std::pair{0, 0}, {2, 1}}) {
    const PatchPicture p = picture_patch(scene, texture, f, 0.6, index, placement);
    EXPECT_EQ(p.texture.z, setup.texture().z);
    EXPECT_EQ(p.skin.z, setup.skin(index).z);
    const std::vector<double> height = setup.height(p.skin);
    const auto kernel = contact_kernel(setup.scene(), setup.body(), setup.plan().grid, 0.6);
    const std::uint64_t stream =
        static_cast<std::uint64_t>(4 + index) + (static_cast<std::uint64_t>(placement) << 32);
    PatchStates states;
    PatchFields fields;
    solve_patch(setup.problem(height, *kernel, 0.6, scene.finger.patch_pressure(0.6), {1, stream}),
                setup.plan(), f, states, &fields);
    EXPECT_EQ(p.fields.off.gap, fields.off.gap);
    EXPECT_EQ(p.fields.on.gap, fields.on.gap);
    EXPECT_EQ(p.fields.wetting_on.bridged, fields.wetting_on.bridged);
    EXPECT_EQ(p.fields.pull.value, fields.pull.value);
  }
}

TEST(FieldsOfPatches, HaveTheirMeansAndTheirPrices) {
  const Gap gap{{3, 2, 1e-6, 1e-6}, {0, 1, 2, 3, 4, 5}};
  EXPECT_EQ(gap(2, 0), 2);
  EXPECT_EQ(gap(0, 1), 3);
  EXPECT_EQ((Traction{gap.grid, {1, 2, 6}}).mean(), 3);
  EXPECT_EQ(Traction{}.mean(), 0);
  // Digits that a tolerance asks for, one at least.
  EXPECT_NEAR(digits(1e-4), 4, 1e-12);
  EXPECT_NEAR(digits(1e-1), 1, 1e-12);
  EXPECT_EQ(digits(0.5), 1);
  EXPECT_NEAR(fft_pair_seconds({64, 32, 1, 1}), 3.3e-10 * 2048 * 11 * (1 + 2048 / 2.5e5), 1e-15);
  const Droplet d;
  for (const double zero :
       {d.x, d.y, d.volume, d.radius, d.height, d.edge_gap, d.force, d.energy, d.film})
    EXPECT_EQ(zero, 0);
  EXPECT_EQ(d.state, DropletState::OnSubstrate);
  const Wetting w;
  for (const double zero : {w.capillary_force, w.wetted_fraction, w.volume, w.bridge_volume,
                            w.wicked_volume, w.retention, static_cast<double>(w.bridges)})
    EXPECT_EQ(zero, 0);
  EXPECT_EQ(w.status, WettingStatus::Dry);
}

TEST(LooksLaws, WarningsAreSaidInWholeAndJoined) {
  const auto warning = [](double diameter, double depth, double fill) {
    HoleArray holes;
    holes.period = 2.5 * diameter, holes.diameter = diameter, holes.depth = depth;
    holes.wall_angle = kPi / 2;
    return appearance(Texture{holes}, glass_of(1.46), filled_with(fill)).warning;
  };
  const std::string narrow = "features of 1.8 um are few wavelengths: scalar theory is rough",
                    deep = "deep against its width: a thin screen is rough",
                    filled = "seen with the texture filled; the finger feels it open";
  EXPECT_EQ(warning(1.8e-6, 1e-6, 1), narrow);
  EXPECT_EQ(warning(1.8e-6, 0.2e-6, 1.3), narrow + "; " + filled);
  EXPECT_EQ(warning(2.4e-6, 1.21e-6, 1), deep);
  EXPECT_EQ(warning(2.4e-6, 1.19e-6, 1), "");
  EXPECT_EQ(warning(2.4e-6, 1.21e-6, 1.1), deep + "; " + filled);
}

// A flat plate is seen by the screen's law: 0.96/1.04 of light at the normal, in either medium.
TEST(LooksLaws, OfNoReliefIsAFlatPlate) {
  const Optics bare = appearance(Texture{}, glass_of(1.5), {});
  EXPECT_EQ(bare.regime, OpticsRegime::Flat);
  EXPECT_NEAR(bare.transmittance, 0.96 / 1.04, 1e-12);
  // Fresnel at 60 deg: of 1.5 over that of the black glass, 1.567.
  EXPECT_NEAR(bare.gloss, 100 * 0.08918671 / 0.10005603, 1e-4);
  EXPECT_NEAR(bare.haze, 0, 1e-12);
  EXPECT_EQ(bare.warning, "");
  ASSERT_EQ(bare.spectrum.size(), 17u);
  // Under 1.2 of fill: (0.3/2.7)^2 at one face, 0.04 at the other, (0.2/2.2)^2 at the fill's own.
  const double r = square(0.3 / 2.7), outer = square(0.2 / 2.2);
  const double plate = (1 - r) * 0.96 / (1 - 0.04 * r);
  const Optics filled = appearance(Texture{}, glass_of(1.5), filled_with(1.2));
  EXPECT_NEAR(filled.transmittance, plate * (1 - outer) / (1 - outer * (1 - plate)), 1e-12);
  EXPECT_EQ(appearance(Texture{}, glass_of(1.5), view_from({0, 0.5, 1})).spectrum.size(), 51u);
}

}  // namespace
}  // namespace papilla::tests::driven_points_test
