// From fingertip to patches: the closures by their equations, with Persson's theory asked directly.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "base/constants.h"
#include "forward/scale_bridge.h"
#include "physics/macro/fingertip.h"
#include "physics/persson/patches.h"
#include "physics/persson/persson.h"

namespace papilla::tests::scale_laws_test {
namespace {

constexpr double kHumidity = 0.6;
const Grid kGrid{32, 32, 12e-6, 12e-6};

// Ridges from their longest wave to the patch, then the skin to its cut-off; moduli of the
// humidity.
MeanField ridges_and_skin(const Finger& f, double patch) {
  const double q = 2 * kPi / patch, lowest = 2 * kPi / f.macro.ridge_longest;
  PowerSpectrum all = self_affine_spectrum(f.macro.ridge_rms, lowest, lowest, q, f.skin.hurst);
  const double roll_off = 2 * kPi / f.skin.roll_off, cutoff = 2 * kPi / f.skin.cutoff;
  const PowerSpectrum skin =
      self_affine_spectrum(f.skin.rms, std::min(q, roll_off), roll_off, cutoff, f.skin.hurst)
          .between(q, cutoff);
  for (std::size_t i = 0; i < skin.wave_number.size(); ++i) {
    const double k = i == 0 ? q * (1 + 1e-9) : skin.wave_number[i];
    if (k <= all.wave_number.back()) continue;
    all.wave_number.push_back(k);
    all.density.push_back(skin.density[i]);
  }
  const double factor = f.skin.modulus_factor(kHumidity);
  return {all,
          {f.skin.bulk_modulus * factor, f.skin.bulk_poisson, f.macro.corneum_thickness,
           f.macro.tissue_modulus, 0.5}};
}

double nominal(const Finger& f) {
  return f.load / (f.macro.ridge_share * f.macro.gross_area(f.load, kHumidity));
}

TEST(ScaleLaws, UniformPatchesCarryTheLoadByTheirShare) {
  Scene scene;
  scene.finger.load = 0.7;
  const ScaleBridge bridge(scene, fidelity_level("search"), kGrid, kHumidity);
  const MacroContact& m = scene.finger.macro;
  const double pressure = 0.7 / (m.load_share * m.gross_area(0.7, kHumidity));
  ASSERT_EQ(bridge.pressures().size(), 1u);
  EXPECT_NEAR(bridge.pressures()[0], pressure, 1e-9 * pressure);
  EXPECT_NEAR(bridge.mean_pressure(), pressure, 1e-9 * pressure);
  EXPECT_EQ(bridge.carrying_share(), m.load_share);
  PatchResult one;
  one.pull = 3, one.load = 2;
  EXPECT_EQ(bridge.combine({&one, 1}).pull, 3);
  EXPECT_EQ(bridge.combine({&one, 1}).load, 2);
}

// Eq. coupling.6: as many patches more as stand within 5 nm and the body's compression instead of
// 5 nm, at the pressure that then carries the load.
TEST(ScaleLaws, ASoftSurfaceBringsThePatchesWithinItsCompression) {
  Scene scene;
  scene.surface.modulus = 2e6;
  const CompliantBody body{1.5e-6, 0.4};
  const ScaleBridge soft(scene, fidelity_level("search"), kGrid, kHumidity, body);
  const double rigid = scene.finger.patch_pressure(kHumidity);
  const double pressure = soft.mean_pressure();
  EXPECT_NEAR(soft.carrying_share() * pressure, scene.finger.macro.load_share * rigid,
              1e-9 * rigid);
  EXPECT_EQ(soft.pressures(), std::vector<double>{pressure});
  const MeanField all = ridges_and_skin(scene.finger, 12e-6);
  const MeanField ridges(all.spectrum().between(all.spectrum().lowest(), 2 * kPi / 12e-6),
                         all.solid());
  const GapDistribution gaps = ridges.gaps(nominal(scene.finger));
  const double more =
      gaps.cumulative(5e-9 + body.compliance(scene.surface) * pressure) / gaps.cumulative(5e-9);
  EXPECT_GT(more, 1.3);
  EXPECT_NEAR(rigid / pressure, more, 1e-6 * more);
  // A ridge without roughness has no more to bring.
  scene.finger.macro.ridge_rms = 0;
  EXPECT_EQ(ScaleBridge(scene, fidelity_level("search"), kGrid, kHumidity, body).mean_pressure(),
            rigid);
}

Scene persson(double amplitude) {
  Scene scene;
  scene.model.closure = Closure::Persson;
  scene.drive.amplitude = amplitude;
  return scene;
}

TEST(ScaleLaws, PatchesOfTheRidgesHavePerssonsPressures) {
  const Scene scene = persson(0);
  Fidelity fidelity = fidelity_level("search");
  for (const int nodes : {3, 5}) {
    fidelity.bridge_nodes = nodes;
    const ScaleBridge bridge(scene, fidelity, kGrid, kHumidity);
    const MeanField field = ridges_and_skin(scene.finger, 12e-6);
    const PatchPressures patches(field.stress_measure(2 * kPi / 12e-6), nominal(scene.finger),
                                 nodes);
    ASSERT_EQ(bridge.pressures().size(), static_cast<std::size_t>(nodes));
    for (int k = 0; k < nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_NEAR(bridge.pressures()[at] / patches.pressure()[at], 1, 1e-9) << k;
    }
    const double touching = std::accumulate(patches.share().begin(), patches.share().end(), 0.0);
    EXPECT_NEAR(bridge.mean_pressure(), nominal(scene.finger) / touching,
                1e-9 * bridge.mean_pressure());
    EXPECT_EQ(bridge.carrying_share(), scene.finger.macro.ridge_share);
    // Another patch, another wave number.
    const ScaleBridge wide(scene, fidelity, {32, 16, 24e-6, 12e-6}, kHumidity);
    const MeanField longer = ridges_and_skin(scene.finger, std::sqrt(24.0 * 12) * 1e-6);
    const PatchPressures other(longer.stress_measure(2 * kPi / (std::sqrt(24.0 * 12) * 1e-6)),
                               nominal(scene.finger), nodes);
    EXPECT_NEAR(wide.pressures()[0] / other.pressure()[0], 1, 1e-9);
  }
}

// Eq. coupling.3: the pull of the gaps that stay open, at the pressure that it makes itself.
TEST(ScaleLaws, TheFarGapsPullAtThePressureThatTheyMake) {
  const Scene scene = persson(150);
  const ScaleBridge bridge(scene, fidelity_level("search"), kGrid, kHumidity);
  const std::size_t nodes = bridge.pressures().size();
  const PatchResult none = bridge.combine(std::vector<PatchResult>(nodes));
  EXPECT_TRUE(none.status.sound());
  EXPECT_NEAR(none.load / kGrid.area(), nominal(scene.finger), 1e-9 * nominal(scene.finger));
  const double far = none.pull / kGrid.area();
  // Of an insulating film: 500 nm of 3.9, and the skin with its corner at 60 Hz beside 5 kHz.
  const double gap_corner = 1 / (2 * kPi * kVacuumPermittivity * 4.8e8);
  const std::complex<double> at(gap_corner, 5e3);
  const double film_corner = 1 / (2 * kPi * kVacuumPermittivity * 3.9 * 1e14);
  const double skin = scene.finger.electrical.equivalent_thickness(kHumidity);
  const std::complex<double> h0 = 500e-9 / 3.9 * at / std::complex<double>(film_corner, 5e3) +
                                  skin * at / std::complex<double>(60, 5e3);
  const MeanField field = ridges_and_skin(scene.finger, 12e-6);
  const double pull =
      0.5 * kVacuumPermittivity * square(150) / 2 *
      field.gaps(nominal(scene.finger) + far).far_inverse_square(h0, 2 * kPi / 12e-6);
  EXPECT_NEAR(far, pull, 1e-5 * pull);
  EXPECT_GT(far, 0.01 * nominal(scene.finger));
}

TEST(ScaleLaws, WithoutALoadItIsOnePatchWithoutPressure) {
  Scene idle = persson(0);
  idle.finger.load = 0;
  const ScaleBridge still(idle, fidelity_level("search"), kGrid, kHumidity);
  EXPECT_EQ(still.pressures(), std::vector<double>{0});
  EXPECT_EQ(still.mean_pressure(), 0);
  PatchResult one;
  one.area_off = 0.2, one.area_on = 0.3;
  EXPECT_EQ(still.combine({&one, 1}).area_off, 0.2);
  EXPECT_EQ(still.combine({&one, 1}).area_on, 0.3);
}

// Ridges that a voltage closes have no far pull to state.
TEST(ScaleLaws, FarGapsThatCloseAreAPullIn) {
  const ScaleBridge bridge(persson(20000), fidelity_level("search"), kGrid, kHumidity);
  const std::size_t nodes = bridge.pressures().size();
  const PatchResult none = bridge.combine(std::vector<PatchResult>(nodes));
  EXPECT_EQ(none.status, (ModelStatus{Trouble::FarGapPullIn, 0, ""}));
  EXPECT_EQ(none.pull, 0);
  // The patches are shared as before the drive.
  std::vector<PatchResult> ones(nodes);
  for (PatchResult& p : ones) p.area_off = p.area_on = 1;
  EXPECT_NEAR(bridge.combine(ones).area_on, bridge.combine(ones).area_off, 1e-9);
}

// Eq. coupling.4: the plane gap of the same capacitance over the same layers.
TEST(ScaleLaws, TheCapacitiveGapIsThatOfTheMeanInverse) {
  const Finger finger;
  for (const double pressure : {20e3, 200e3}) {
    for (const double dielectric : {30e-9, 400e-9}) {
      const double h0 = dielectric + finger.electrical.equivalent_thickness(kHumidity);
      const double inverse = ridges_and_skin(finger, 12e-6).gaps(pressure).inverse(h0);
      const double gap = capacitive_gap(finger, pressure, dielectric, kHumidity);
      EXPECT_NEAR(1 / (gap + h0), inverse, 1e-9 * inverse);
      EXPECT_GT(gap, 0);
    }
  }
}

}  // namespace
}  // namespace papilla::tests::scale_laws_test
