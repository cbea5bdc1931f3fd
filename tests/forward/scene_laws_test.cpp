// The scene in the terms of each piece: every number of the electrical path, the field's problem,
// the water and the levels of accuracy, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "forward/electric_path.h"
#include "forward/fidelity.h"
#include "forward/scene_terms.h"
#include "physics/electrostatics/electrowetting.h"
#include "physics/electrostatics/rules.h"

namespace papilla::tests::scene_laws_test {
namespace {

using Complex = std::complex<double>;

// Two layers of film with corners of 2 kHz and 90 kHz, a gap of 40 Hz, a skin of 300 Hz.
Scene lossy() {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.drive.frequency = 1e4;
  scene.surface.dielectric.resize(2);
  FilmDielectric &a = scene.surface.dielectric[0], &b = scene.surface.dielectric[1];
  const auto resistivity = [](double corner, double permittivity) {
    return 1 / (2 * kPi * kVacuumPermittivity * permittivity * corner);
  };
  a.thickness = 400e-9, a.permittivity = 4, a.resistivity = resistivity(2e3, 4);
  b.thickness = 60e-9, b.permittivity = 3, b.resistivity = resistivity(9e4, 3);
  scene.finger.electrical.gap_resistivity = resistivity(40, 1);
  scene.finger.electrical.corner_frequency = 300;
  scene.finger.electrical.thickness_15 = 35e-9;
  scene.finger.electrical.thickness_75 = 15e-9;  // 25 nm at 45 %
  return scene;
}

// (jf + f_g)/(jf + f_i) of Eq. drive.12.
Complex counts(double own, double gap, double f) { return Complex(gap, f) / Complex(own, f); }

TEST(SceneLaws, LayersCountByTheirConductionBesideTheGaps) {
  const Scene scene = lossy();
  const SeriesLayers s = series_layers(scene, 0.45);
  ASSERT_EQ(s.of_film.size(), 2u);
  const Complex a = counts(2e3, 40, 1e4), b = counts(9e4, 40, 1e4), skin = counts(300, 40, 1e4);
  EXPECT_NEAR(std::abs(s.of_film[0] - a), 0, 1e-9);
  EXPECT_NEAR(std::abs(s.of_film[1] - b), 0, 1e-9);
  EXPECT_NEAR(std::abs(s.skin - 25e-9 * skin), 0, 1e-17);
  EXPECT_NEAR(std::abs(s.film(scene.surface) - (100e-9 * a + 20e-9 * b)), 0, 1e-16);
}

// A layer that conducts all but everything keeps a ten-thousandth of its d/eps, one that conducts
// far less than the gap counts 1e4 times, and no more.
TEST(SceneLaws, ALayersShareHasItsEnds) {
  Scene scene = lossy();
  scene.surface.dielectric[0].resistivity = 1e-6;
  EXPECT_NEAR(series_layers(scene, 0.45).of_film[0].real(), 1e-4, 1e-12);
  scene.drive.waveform = Waveform::Dc;
  scene.surface.dielectric[0].resistivity = 1e14;  // 45 uHz
  EXPECT_NEAR(series_layers(scene, 0.45).of_film[0].real(), 1e4, 1e-6);
  // A direct voltage is none of the drive's frequency: corners alone divide it.
  EXPECT_NEAR(series_layers(scene, 0.45).of_film[1].real(), 40 / 9e4, 1e-9);
  EXPECT_NEAR(series_layers(scene, 0.45).skin.real(), 25e-9 * 40 / 300, 1e-15);
}

TEST(SceneLaws, TheFieldsProblemIsTheSeriesOfItsLayers) {
  const Scene scene = lossy();
  const Complex a = counts(2e3, 40, 1e4), b = counts(9e4, 40, 1e4), skin = counts(300, 40, 1e4);
  const FieldProblem p = field_problem(scene, 0.45);
  EXPECT_NEAR(p.v_peak, 100, 1e-12);
  EXPECT_NEAR(p.v_rms, 100 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(p.dielectric, 100e-9 * a.real() + 20e-9 * b.real(), 1e-16);
  EXPECT_NEAR(p.dielectric_thickness, 460e-9, 1e-18);
  const Complex film = 100e-9 * a + 20e-9 * b;
  EXPECT_NEAR(std::abs(p.skin_layer - (25e-9 * skin + Complex(0, film.imag()))), 0, 1e-16);
  EXPECT_NEAR(p.film_phase, std::abs(film) / film.real(), 1e-12);
  EXPECT_TRUE(p.screening && p.droplet_enhancement);
  EXPECT_FALSE(p.zero_under_droplets || p.even_screening);
  EXPECT_EQ(p.air_limit, AirLimit::None);
  Scene other = scene;
  other.surface.electrode_edge_radius = 70e-9;
  other.model.air_limit = AirLimit::Ionisation;
  other.model.droplet_enhancement = false;
  const FieldProblem q = field_problem(other, 0.45);
  EXPECT_EQ(q.edge_radius, 70e-9);
  EXPECT_EQ(q.air_limit, AirLimit::Ionisation);
  EXPECT_FALSE(q.droplet_enhancement);
  other.model.droplet_enhancement = true;
  other.model.preset = Preset::M3;
  const FieldProblem m3 = field_problem(other, 0.45);
  EXPECT_TRUE(m3.zero_under_droplets && m3.even_screening);
  EXPECT_FALSE(m3.droplet_enhancement);
  // Without a film nothing lags.
  other.surface.dielectric.clear();
  EXPECT_EQ(field_problem(other, 0.45).film_phase, 1);
}

TEST(SceneLaws, TheFilmKeepsItsProcessButInThePaper) {
  Scene scene = lossy();
  scene.surface.process = FilmProcess::Directional;
  scene.surface.step_coverage = 0.4;
  scene.surface.dielectric[1].process = LayerProcess::Conformal;
  const std::vector<FilmLayer> film = film_of(scene);
  const double a = counts(2e3, 40, 1e4).real(), b = counts(9e4, 40, 1e4).real();
  ASSERT_EQ(film.size(), 2u);
  EXPECT_NEAR(film[0].permittivity, 4 / a, 1e-9);
  EXPECT_NEAR(film[1].permittivity, 3 / b, 1e-9);
  EXPECT_EQ(film[0].process, FilmProcess::Directional);
  EXPECT_EQ(film[1].process, FilmProcess::Conformal);
  EXPECT_EQ(film[0].step_coverage, 0.4);
  scene.model.preset = Preset::M3;
  for (const FilmLayer& layer : film_of(scene)) {
    EXPECT_EQ(layer.process, FilmProcess::Directional);
    EXPECT_EQ(layer.step_coverage, 0);
  }
  EXPECT_EQ(film_of(scene)[1].thickness, 60e-9);
  EXPECT_NEAR(film_of(scene)[1].permittivity, 3 / b, 1e-9);
}

// Eq. drive.13: |sum z|^2 over the sum of |z|^2/h.
TEST(SceneLaws, BelowWaterTheEnergyStandsInWhatDoesNotConduct) {
  const Scene scene = lossy();
  const auto z = [](double h, double corner) { return h * Complex(0, 1e4) / Complex(corner, 1e4); };
  const Complex a = z(100e-9, 2e3), b = z(20e-9, 9e4), c = z(25e-9, 300);
  const double energy = std::norm(a) / 100e-9 + std::norm(b) / 20e-9 + std::norm(c) / 25e-9;
  const double expected = std::norm(a + b + c) / energy;
  EXPECT_NEAR(wetted_series(scene, 0.45), expected, 1e-9 * expected);
  Scene none = scene;
  none.surface.dielectric.clear();
  none.finger.electrical.thickness_15 = none.finger.electrical.thickness_75 = 0;
  EXPECT_EQ(wetted_series(none, 0.45), 0);
  // The angle that follows is the saturated law's over a cycle, or at the peak.
  for (const Waveform w : {Waveform::Sine, Waveform::Am, Waveform::Square, Waveform::Dc}) {
    Scene s = scene;
    s.drive.waveform = w;
    const double rest = s.surface.contact_angle, c0 = std::cos(rest);
    // A modulated carrier is the sine of its mean square, here half of the full one's.
    const double mean_square = (w == Waveform::Am ? 0.5 : 1) * 100 * 100;
    const double eta = kVacuumPermittivity * mean_square /
                       (2 * s.finger.water.surface_tension * wetted_series(s, 0.45));
    const double end = std::cos(s.finger.saturation.angle(rest));
    const bool cycle = w == Waveform::Sine || w == Waveform::Am;
    EXPECT_NEAR(std::cos(driven_contact_angle(s, 0.45)), electrowetted_cosine(c0, end, eta, cycle),
                1e-9);
  }
}

// Eq. drive.15: the charge between film and gap.
TEST(SceneLaws, ADirectVoltageRelaxesThroughGapAndFilm) {
  Scene scene = lossy();
  const double h = 100e-9 + 20e-9 + 25e-9;
  const double leak = 1 / (100e-9 / 2e3 + 20e-9 / 9e4 + 25e-9 / 300);
  for (const double g : {0.1e-6, 1e-6}) {
    EXPECT_NEAR(relaxation_time(scene, 0.45, g), (1 / g + 1 / h) / (2 * kPi * (40 / g + leak)),
                1e-12);
  }
  // One layer that insulates leaves the gap alone to leak; both, nothing.
  scene.surface.dielectric[0].resistivity = 0;
  EXPECT_NEAR(relaxation_time(scene, 0.45, 1e-6), (1e6 + 1 / h) / (2 * kPi * 40e6), 1e-12);
  scene.finger.electrical.gap_resistivity = 0;
  EXPECT_EQ(relaxation_time(scene, 0.45, 1e-6), kInfinity);
  // A bare electrode under a bare skin is no capacitor: at once.
  scene.surface.dielectric.clear();
  scene.finger.electrical.thickness_15 = scene.finger.electrical.thickness_75 = 0;
  EXPECT_EQ(relaxation_time(scene, 0.45, 1e-6), 0);
}

TEST(SceneLaws, ASourceHoldsItsVoltageOrItsCurrent) {
  Scene scene = lossy();
  for (const auto& [waveform, rms] :
       {std::pair{Waveform::Sine, std::sqrt(0.5)}, {Waveform::Square, 1.0}, {Waveform::Dc, 1.0}}) {
    scene.drive.waveform = waveform;
    const SourceVoltage v = source_voltage(scene, 0.45);
    EXPECT_EQ(v.peak, 100);
    EXPECT_NEAR(v.rms, 100 * rms, 1e-12);
    EXPECT_FALSE(v.at_compliance);
  }
  scene.drive.source_compliance = 50;  // of a current alone
  EXPECT_EQ(source_voltage(scene, 0.45).peak, 100);
  scene.drive.source_compliance = 0;
  scene.drive.waveform = Waveform::Sine;
  scene.drive.control = DriveControl::Current;
  EXPECT_EQ(source_voltage(scene, 0.45).peak, 0);
  scene.drive.current = 20e-6;
  const double one = source_voltage(scene, 0.45).peak;
  scene.drive.current = 60e-6;
  EXPECT_NEAR(source_voltage(scene, 0.45).peak, 3 * one, 1e-9 * one);
  // No area, no current: whatever voltage.
  scene.finger.load = 0;
  EXPECT_EQ(source_voltage(scene, 0.45).peak, kInfinity);
  scene.drive.source_compliance = 50;
  EXPECT_EQ(source_voltage(scene, 0.45).peak, 50);
  EXPECT_TRUE(source_voltage(scene, 0.45).at_compliance);
}

TEST(SceneLaws, WaterAndWhatThePaperCountsOfIt) {
  Scene scene;
  scene.finger.water.surface_tension = 0.06;
  scene.finger.water.contact_angle = 1.2;
  scene.finger.water.hysteresis = 0.2;
  const WaterProperties w = water_properties(scene, 0.7);
  EXPECT_EQ(w.surface_tension, 0.06);
  EXPECT_EQ(w.theta_skin, 1.2);
  EXPECT_EQ(w.theta_substrate, 0.7);
  EXPECT_EQ(w.hysteresis, 0.2);
  EXPECT_FALSE(w.pressure_alone);
  scene.surface.contact_angle = 0.7;  // draws together
  EXPECT_TRUE(capillary_off_counts(scene) && retention_counts(scene));
  scene.model.preset = Preset::M3;
  EXPECT_TRUE(water_properties(scene, 0.7).pressure_alone);
  EXPECT_TRUE(capillary_off_counts(scene));
  EXPECT_FALSE(retention_counts(scene));
  scene.surface.contact_angle = 2.2;  // pushes apart: 1.2 + 2.2 > pi
  EXPECT_FALSE(capillary_off_counts(scene));
  EXPECT_TRUE(retention_counts(scene));
  scene.model.preset = Preset::Papilla;
  EXPECT_TRUE(capillary_off_counts(scene) && retention_counts(scene));
}

TEST(SceneLaws, ThePapersRuleIsColumnsUnlessAnotherIsAskedFor) {
  ModelOptions m;
  for (const FieldMethod method : {FieldMethod::Local, FieldMethod::Spread, FieldMethod::Full}) {
    m.field = method;
    m.preset = Preset::Papilla;
    EXPECT_EQ(field_method(m), method);
    m.preset = Preset::M3;
    EXPECT_EQ(field_method(m), method == FieldMethod::Spread ? FieldMethod::Local : method);
  }
}

// Rigid glass has one kernel, of 15 % RH; a soft surface one of its humidity, with its own side.
TEST(SceneLaws, TheKernelIsThatOfSkinAndSurface) {
  Scene scene;
  scene.surface.modulus = 5e6, scene.surface.poisson = 0.3;
  const Skin& s = scene.finger.skin;
  const Grid grid{16, 16, 12e-6, 12e-6};
  const auto solid = [&](const CompliantBody& body) {
    return contact_kernel(scene, body, grid, 0.75)->solid();
  };
  EXPECT_EQ(solid({}), (LayeredSolid{s.layer_modulus, s.layer_poisson, s.layer_thickness,
                                     s.bulk_modulus, s.bulk_poisson, 0, 0.3, 0}));
  const double soft = 1 / 2.0;  // from 15 to 75 % RH
  const LayeredSolid with = solid({2e-6, 0.5});
  EXPECT_NEAR(with.layer_modulus, s.layer_modulus * soft, 1e-6 * s.layer_modulus);
  EXPECT_NEAR(with.bulk_modulus, s.bulk_modulus * soft, 1e-6 * s.bulk_modulus);
  EXPECT_EQ(with.counter_modulus, 5e6);
  EXPECT_EQ(with.counter_poisson, 0.3);
  EXPECT_EQ(with.counter_thickness, 2e-6);
}

// By hand: heights 0, 1, 2, 3 um over a floor: volume per pixel 1.5 um, thickness 14/6 um.
TEST(SceneLaws, ACompliantBodyIsMeasuredFromItsFloor) {
  Surface surface;
  surface.modulus = 1e6, surface.poisson = 0.25;
  for (const double floor : {0.0, -5e-6, 2e-6}) {
    Heightmap h{{2, 2, 1e-6, 1e-6}, {}};
    for (const double z : {0.0, 1e-6, 2e-6, 3e-6}) h.z.push_back(floor + z);
    const CompliantBody body = compliant_body(surface, h);
    EXPECT_NEAR(body.thickness, 14e-6 / 6, 1e-15);
    EXPECT_NEAR(body.solid, 1.5 * 6 / 14, 1e-9);
    // Confined: t (1 + nu)(1 - 2 nu)/(E (1 - nu)) over the solid share.
    EXPECT_NEAR(body.compliance(surface), body.thickness * 1.25 * 0.5 / (1e6 * 0.75 * body.solid),
                1e-9 * body.compliance(surface));
  }
  Surface rigid = surface;
  rigid.modulus = 0;
  EXPECT_EQ((CompliantBody{1e-6, 0.5}).compliance(rigid), 0);
  EXPECT_EQ(CompliantBody{}.compliance(surface), 0);
}

TEST(SceneLaws, TheLevelsOfAccuracyAreOneTable) {
  struct Level {
    const char* name;
    int grid, skins;
    Estimator estimator;
    double contact, field;
    int passes;
    double coupling;
    int nodes, controls, field_skins;
  };
  for (const Level& l :
       {Level{"search", 128, 8, Estimator::Load, 1e-3, 1e-2, 16, 1e-3, 3, 0, 0},
        Level{"draft", 128, 16, Estimator::Load, 1e-3, 1e-3, 16, 1e-3, 3, 4, 1},
        Level{"design", 256, 40, Estimator::Area, 1e-4, 1e-3, 16, 2e-3, 3, 4, 2},
        Level{"reference", 512, 96, Estimator::Area, 1e-6, 1e-5, 40, 5e-4, 6, 4, 6}}) {
    const Fidelity f = fidelity_level(l.name);
    EXPECT_EQ(f.level, l.name);
    EXPECT_EQ(f.grid, l.grid) << l.name;
    EXPECT_EQ(f.skins, l.skins) << l.name;
    EXPECT_EQ(f.estimator, l.estimator) << l.name;
    EXPECT_EQ(f.contact_tolerance, l.contact) << l.name;
    EXPECT_EQ(f.field_tolerance, l.field) << l.name;
    EXPECT_EQ(f.coupling_passes, l.passes) << l.name;
    EXPECT_EQ(f.coupling_tolerance, l.coupling) << l.name;
    EXPECT_EQ(f.equilibrium_skins, f.level == "search" ? 4 : 3) << l.name;
    EXPECT_EQ(f.bridge_nodes, l.nodes) << l.name;
    EXPECT_EQ(f.control_skins, l.controls) << l.name;
    EXPECT_EQ(f.field_skins, l.field_skins) << l.name;
    EXPECT_EQ(f.most_pixels, 0);
    EXPECT_EQ(f.first_skin, 0);
    EXPECT_EQ(f.droplet_seeds, 1);
    EXPECT_EQ(f.load_exponent, 0.84);
    EXPECT_EQ(f.seed, 1u);
    EXPECT_EQ(f.threads, 0);
  }
  EXPECT_THROW(fidelity_level("best"), InputError);
  Fidelity f;
  EXPECT_EQ(f.pixels_per_side(), 1024);
  f.grid = 2048;
  EXPECT_EQ(f.pixels_per_side(), 2048);
  f.most_pixels = 300;
  EXPECT_EQ(f.pixels_per_side(), 300);
  EXPECT_NEAR(f.area_by_load(2), std::pow(2, 0.84), 1e-12);
  EXPECT_EQ(f.area_by_load(-1), 0);  // lifted off
}

}  // namespace
}  // namespace papilla::tests::scene_laws_test
