// A pin in place of the finger against what has a closed form: Hertz' circle, combined roughness,
// parallel plates over frequency, Amontons.
#include "forward/counterface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "forward/forward.h"
#include "forward/patch_setup.h"
#include "forward/scene_terms.h"
#include "physics/contact/closed_forms.h"

namespace papilla::tests::counterface_test {
namespace {

Pin polymer() {
  Pin pin;
  pin.load = 1;
  pin.modulus = 3e9;
  pin.poisson = 0.4;
  pin.radius = 0.7e-3;
  pin.shear_strength = 20e6;
  return pin;
}

Scene dry_glass() {
  Scene scene;
  scene.surface.base_modulus = 72e9;
  scene.surface.base_poisson = 0.2;
  scene.environment.relative_humidity = {0.2, 0.8};
  return scene;
}

Fidelity few_skins() {
  Fidelity f = fidelity_level("search");
  f.skins = 2;
  return f;
}

// 1/E* = (1 - nu^2)/E of both; a^3 = 3 F R/(4 E*): by hand 3.405 GPa and 53.6 um.
TEST(PinCounterface, ASmoothSphereRubsByHertzCircle) {
  const Scene scene = touched_by(polymer(), dry_glass());
  const double modulus = 1 / ((1 - 0.16) / 3e9 + (1 - 0.04) / 72e9);
  const double radius = std::cbrt(3 * 1.0 * 0.7e-3 / (4 * modulus));
  const Response r = evaluate(scene, Texture{}, few_skins());
  ASSERT_EQ(r.points.size(), 2u);
  for (const ResponsePoint& p : r.points) {
    EXPECT_NEAR(p.area_fraction_off.value, 1, 1e-9);
    EXPECT_NEAR(p.friction_off.value, 20e6 * kPi * radius * radius, 1e-6);
  }
}

TEST(PinCounterface, GrossContactGrowsWithTheLoadAsHertzHasIt) {
  Pin pin = polymer();
  for (const double load : {0.1, 2.0}) {
    pin.load = load;
    const Scene scene = touched_by(pin, dry_glass());
    const double radius =
        Hertz{contact_modulus(pin, scene.surface), pin.radius}.contact_radius(load);
    EXPECT_NEAR(scene.finger.macro.gross_area(load, 0.3), kPi * radius * radius,
                1e-12 * radius * radius);
  }
  pin.face = PinFace::Flat;
  pin.radius = 0;
  pin.area = 2e-6;
  EXPECT_EQ(touched_by(pin, dry_glass()).finger.macro.gross_area(3, 0.9), 2e-6);
}

// Parallel plates: a smooth face on the film, whatever its pressure; one of waves within patches
// stands off by less than their rms height.
TEST(PinCounterface, ACurrentTakesTheVoltageOfItsFaceOnTheFilm) {
  Pin pin = polymer();
  pin.face = PinFace::Flat;
  pin.radius = 0, pin.area = 1e-6;
  Scene scene = dry_glass();
  scene.drive.control = DriveControl::Current;
  scene.drive.current = 0.5e-3;
  const double film = scene.surface.equivalent_thickness();
  const double plates =
      0.5e-3 * film / (2 * kPi * scene.drive.frequency * kVacuumPermittivity * pin.area);
  const auto volts = [&] { return source_voltage(touched_by(pin, scene), 0.5).peak; };
  EXPECT_NEAR(volts(), plates, 1e-3 * plates);
  pin.roughness.map = "face.gsf";  // no spectrum: said by the plan
  EXPECT_NEAR(volts(), plates, 1e-3 * plates);
  pin.roughness = {
      .rms = 60e-9, .longest = 12e-6, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.4e-6};
  EXPECT_GT(volts(), plates);
  EXPECT_LT(volts(), plates * (film + 5 * 60e-9) / film);
}

TEST(PinCounterface, ARigidBaseLeavesThePinsOwnModulus) {
  Scene scene = dry_glass();
  scene.surface.base_modulus = 0;
  EXPECT_NEAR(contact_modulus(polymer(), scene.surface), 3e9 / 0.84, 1);
}

// Two rough faces are one of the summed spectrum: rms heights add in squares.
TEST(PinCounterface, RoughOnRoughIsTheCombinedSpectrum) {
  Pin pin = polymer();
  pin.roughness = {
      .rms = 60e-9, .longest = 12e-6, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.4e-6};
  const Texture glass{RandomRough{.rms = 80e-9, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.4e-6}};
  const PatchSetup setup(touched_by(pin, dry_glass()), glass, few_skins());
  double both = 0, own = 0, other = 0;
  constexpr int kSkins = 40;  // crosses between two random faces average out
  for (int k = 0; k < kSkins; ++k) {
    const Heightmap skin = setup.skin(k);
    const std::vector<double> sum = setup.height(skin);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      both += square(sum[i]);
      own += square(skin.z[i]);
      other += square(setup.texture().z[i]);
    }
  }
  EXPECT_NEAR(both, own + other, 0.03 * both);
  EXPECT_NEAR(std::sqrt(own / (kSkins * static_cast<double>(setup.texture().z.size()))), 60e-9,
              2e-9);
}

// And rub as that: 60 and 80 nm as 100 nm on a flat.
TEST(PinCounterface, RoughOnRoughRubsAsTheCombinedSpectrumOnAFlat) {
  Pin pin = polymer();
  pin.roughness = {
      .rms = 60e-9, .longest = 12e-6, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.4e-6};
  Scene scene = dry_glass();
  scene.environment.relative_humidity = {0.5};
  Fidelity fidelity = few_skins();
  fidelity.skins = 32;
  const Texture glass{RandomRough{.rms = 80e-9, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.4e-6}};
  const Measured on_rough =
      evaluate(touched_by(pin, scene), glass, fidelity).points[0].friction_off;
  pin.roughness.rms = 100e-9;
  const Measured on_flat =
      evaluate(touched_by(pin, scene), Texture{}, fidelity).points[0].friction_off;
  EXPECT_NEAR(on_rough.value, on_flat.value, 0.04 * on_flat.value);
  pin.roughness.rms = 60e-9;
  const Measured alone =
      evaluate(touched_by(pin, scene), Texture{}, fidelity).points[0].friction_off;
  EXPECT_GT(alone.value, 1.15 * on_flat.value);
}

// Waves above the patch are its ridges; both shares of the rms height together are all of it.
TEST(PinCounterface, LongWavesAreRidgesOfABalance) {
  Pin pin = polymer();
  pin.roughness = {
      .rms = 1e-6, .longest = 200e-6, .roll_off = 100e-6, .hurst = 0.8, .cutoff = 0.2e-6};
  const Scene scene = touched_by(pin, dry_glass());
  EXPECT_EQ(scene.model.closure, Closure::Balance);
  const double skin = scene.finger.skin.rms, ridges = scene.finger.macro.ridge_rms;
  EXPECT_NEAR(std::hypot(skin, ridges), 1e-6, 1e-12);
  EXPECT_GT(ridges, skin);
  EXPECT_EQ(touched_by(polymer(), dry_glass()).model.closure, Closure::Uniform);
}

// Flat metal on a film: p = eps0/2 V^2/(d/eps)^2, by the permittivity of the frequency.
TEST(PinCounterface, ParallelPlatesFollowTheFilmOverFrequency) {
  Pin pin = polymer();
  pin.face = PinFace::Flat;
  pin.radius = 0;
  pin.area = 4e-6;
  pin.shear_strength = 0;
  pin.coefficient = 0.2;
  Scene scene = dry_glass();
  scene.model.air_limit = AirLimit::None;
  FilmDielectric& film = scene.surface.dielectric[0];
  film.thickness = 24e-6;
  film.permittivity = 54.2;
  film.resistivity = 0;
  film.relaxation.law = RelaxationLaw::ColeCole;
  film.relaxation.infinite = 4;
  film.relaxation.time = 2.82e-6;
  film.relaxation.alpha = 0.438;
  scene.drive.amplitude = 40;
  for (const double frequency : {1.0, 1e4, 1e6}) {
    scene.drive.frequency = frequency;
    const std::complex<double> turn =
        std::pow(std::complex(0.0, 2 * kPi * frequency * 2.82e-6), 0.562);
    const std::complex<double> permittivity = 4.0 + 50.2 / (1.0 + turn);
    const double field = 40 / std::sqrt(2.0) / (24e-6 / std::abs(permittivity));
    const double pull = 0.5 * kVacuumPermittivity * square(field) * 4e-6;
    const Response r = evaluate(touched_by(pin, scene), Texture{}, few_skins());
    EXPECT_NEAR(r.points[0].friction_off.value, 0.2, 1e-9);
    EXPECT_NEAR(r.points[0].friction_on.value, 0.2 * (1 + pull), 2e-3 * 0.2 * pull) << frequency;
  }
}

TEST(PinCounterface, NoFieldReachesAnInsulator) {
  Pin pin = polymer();
  pin.conducting = false;
  Scene scene = dry_glass();
  scene.drive.amplitude = 100;
  const Response r = evaluate(touched_by(pin, scene), Texture{}, few_skins());
  EXPECT_FALSE(r.driven);
  EXPECT_NE(r.plan.text().find("does not conduct"), std::string::npos);
}

TEST(PinCounterface, AContactOfLessThanAPatchIsRefused) {
  Pin pin = polymer();
  EXPECT_EQ(pin_refusal(pin, dry_glass().surface), "");
  pin.radius = 1e-6;
  EXPECT_NE(pin_refusal(pin, dry_glass().surface).find("smaller than a patch"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::counterface_test
