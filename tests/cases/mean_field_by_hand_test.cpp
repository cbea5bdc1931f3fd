// Mean-field cases against the theory that they hand their numbers to: every point of every table,
// the curves, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "cases/persson.h"
#include "tests/support/refusal.h"

namespace papilla::tests::mean_field_by_hand_test {
namespace {

const std::string kWrist = PAPILLA_SOURCE_DIR "/designs/physics/wrist_on_glass.toml";

std::string refused(const std::vector<std::string>& overrides) {
  return keyed_refusal_of([&] { read_mean_field(kWrist, overrides); });
}

void near(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected)) << expected;
}

// A case whose numbers are all its own: 0.4 N on 50 mm2 are 8 kPa, below the 9 kPa at which the
// body is finite.
MeanFieldCase own_case() {
  MeanFieldCase c;
  SpectrumSettings& s = c.roughness;
  s.rms = 10e-6, s.lowest = 1e3, s.roll_off = 5e3, s.cutoff = 1e7, s.hurst = 0.8, s.scale = 1.5;
  c.skin.solid = {20e6, 0.45, 150e-6, 20e3, 0.48};
  c.interface.dielectric = {{"a", 1e-6, 4, 1e14, 1e9}, {"b", 2e-6, 8, 1e14, 1e9}};
  c.touch = {.load = 0.4, .area = 50e-6, .shear_strength = 7e6, .finite_size_pressure = 9e3};
  c.drive.amplitude = 80;
  c.drive.frequency = 2e3;
  c.sweep = {{20, 60}, {0, 0.3, 1}, {0, 0.5, 5e3}};
  c.theory = {1.8, 0.5};
  return c;
}
PowerSpectrum own_spectrum() { return self_affine_spectrum(10e-6, 1e3, 5e3, 1e7, 0.8).scaled(1.5); }
MeanField own_field(const PowerSpectrum& spectrum) {
  return {spectrum, {20e6, 0.45, 150e-6, 20e3, 0.48}, {.kappa = 1.8, .energy_factor = 0.5}};
}
// 1 um / 4 and 2 um / 8, and the skin's printed permittivities over 150 um.
std::complex<double> own_thickness(double frequency) {
  if (frequency == 0) return 0.5e-6;
  return series_thickness(0.5e-6, 150e-6, SkinDielectric{}, frequency);
}

void expect_point(const MeanFieldPoint& p, const MeanField& field, double voltage, double load,
                  double frequency, double rms) {
  EXPECT_EQ(p.voltage, voltage);
  EXPECT_EQ(p.load, load);
  EXPECT_EQ(p.frequency, frequency);
  const std::complex<double> h0 = own_thickness(frequency);
  EXPECT_NEAR(std::abs(p.thickness - h0), 0, 1e-9 * std::abs(h0));
  const FrictionPoint on = friction_at(field, load, 50e-6, 7e6, rms, h0, 9e3);
  near(p.on.normal_force, load);
  near(p.on.friction, on.friction);
  near(p.on.coefficient, on.coefficient);
  near(p.on.pull.pull, on.pull.pull);
  near(p.on.pull.pressure, on.pull.pressure);
  near(p.area_off, field.area(load / 50e-6));
  near(p.capacitance, kVacuumPermittivity * 50e-6 *
                          std::abs(field.gaps(std::max(on.pull.pressure, 9e3)).inverse(h0)));
}

TEST(MeanFieldByHand, EveryPointIsThatOfItsVoltageLoadAndFrequency) {
  const MeanFieldCase c = own_case();
  const MeanFieldResult r = solve_mean_field(c);
  const PowerSpectrum spectrum = own_spectrum();
  const MeanField field = own_field(spectrum);
  near(r.rms, 10e-6 * std::sqrt(1.5));
  near(r.slope, spectrum.slope());
  near(r.contact_modulus, effective_modulus({20e6, 0.45, 150e-6, 20e3, 0.48}, 1e7));
  const double half = std::sqrt(0.5);  // of a sine
  expect_point(r.point, field, 80, 0.4, 2e3, 80 * half);
  ASSERT_EQ(r.voltage.size(), 2u);
  ASSERT_EQ(r.load.size(), 3u);
  ASSERT_EQ(r.frequency.size(), 3u);
  expect_point(r.voltage[0], field, 20, 0.4, 2e3, 20 * half);
  expect_point(r.voltage[1], field, 60, 0.4, 2e3, 60 * half);
  expect_point(r.load[0], field, 80, 0, 2e3, 80 * half);
  expect_point(r.load[2], field, 80, 1, 2e3, 80 * half);
  expect_point(r.frequency[0], field, 80, 0.4, 0, 80 * half);
  expect_point(r.frequency[1], field, 80, 0.4, 0.5, 80 * half);
  expect_point(r.frequency[2], field, 80, 0.4, 5e3, 80 * half);
  MeanFieldCase dc = own_case();
  dc.drive.waveform = Waveform::Dc;
  expect_point(solve_mean_field(dc).point, field, 80, 0.4, 0, 80);
}

TEST(MeanFieldByHand, AMeasuredSpectrumIsTakenByItsKnots) {
  SpectrumSettings s;
  s.scale = 2;
  s.wave_number = {1e3, 1e4, 1e6};
  s.density = {1e-18, 3e-19, 1e-24};
  EXPECT_EQ(s.spectrum(), (PowerSpectrum{{1e3, 1e4, 1e6}, {2e-18, 6e-19, 2e-24}}));
}

// Yielding flattens the spectrum at the larger of the nominal pressure and the finite body's.
TEST(MeanFieldByHand, ASkinThatYieldsIsSmoothedAtItsPressure) {
  const PowerSpectrum given = own_spectrum();
  for (const double load : {0.4, 1.0}) {
    MeanFieldCase c = own_case();
    c.touch.load = load;
    c.skin.hardness = 1e6;
    const double pressure = std::max(load / 50e-6, 9e3);
    const PowerSpectrum smooth = plastic_smoothing(given, c.skin.solid, 1e6, pressure, 1.8);
    const MeanFieldResult r = solve_mean_field(c);
    near(r.rms, smooth.rms());
    near(r.slope, smooth.slope());
    near(r.point.area_off, own_field(smooth).area(load / 50e-6));
    EXPECT_LT(r.slope, 0.99 * given.slope());
    const auto curves = mean_field_curves(c).roughness;
    for (const std::size_t k : {10u, 60u, 120u}) {
      const double q = curves[k].wave_number;
      near(q, 1e3 * std::pow(1e4, static_cast<double>(k) / 120));
      near(curves[k].given, given.at(q));
      near(curves[k].smoothed, smooth.at(q));
      near(curves[k].area, own_field(smooth).area(load / 50e-6, q));
      const ContactShares shares =
          plastic_shares(load / 50e-6, own_field(given).stress_measure(q), 1e6);
      near(curves[k].elastic, shares.elastic);
      EXPECT_NEAR(curves[k].yielded, shares.plastic, 1e-9 * shares.plastic + 1e-300);
    }
  }
}

// A sweep is a row of single cases: a skin that yields is flattened at each load by that load.
TEST(MeanFieldByHand, EveryLoadOfASweepFlattensTheSkinByItsOwnPressure) {
  MeanFieldCase c = own_case();
  c.skin.hardness = 1e6;
  c.sweep = {{60}, {0.3, 1, 2}, {}};
  const MeanFieldResult r = solve_mean_field(c);
  const std::vector<MeanFieldPoint> grid = mean_field_curves(c).grid;
  ASSERT_EQ(r.load.size(), 3u);
  ASSERT_EQ(grid.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    MeanFieldCase one = c;
    one.touch.load = c.sweep.load[k];
    const MeanFieldResult alone = solve_mean_field(one);
    near(r.load[k].area_off, alone.point.area_off);
    near(r.load[k].on.friction, alone.point.on.friction);
    near(r.load[k].capacitance, alone.point.capacitance);
    near(grid[k].on.friction, alone.voltage[0].on.friction);
    near(grid[k].capacitance, alone.voltage[0].capacitance);
  }
}

// The pull counts: a skin that carries the load alone may yield under a voltage.
TEST(MeanFieldByHand, ASkinYieldsWhereLoadAndPullReachItsHardness) {
  MeanFieldCase c = own_case();
  c.skin.hardness = 1e6;
  for (Dielectric& layer : c.interface.dielectric) layer.strength = 1e12;  // else it breaks down
  c.sweep = {{0, 80, 1e3, 5e3}, {}, {}};
  const MeanFieldResult r = solve_mean_field(c);
  for (const MeanFieldPoint& p : r.voltage)
    EXPECT_EQ(p.yielded, p.on.pull.pressure >= 1e6) << p.voltage;
  EXPECT_FALSE(r.voltage.front().yielded);
  EXPECT_TRUE(r.voltage.back().yielded);
  c.skin.hardness = 0;
  EXPECT_FALSE(solve_mean_field(c).voltage.back().yielded);
}

// Two films of 0.25 um of air each, of which the first has the smaller permittivity, 4, and so the
// larger field; the skin in series takes a share of the voltage, the gap where they touch none.
// Eq. electrostatics.9
TEST(MeanFieldByHand, AFilmBreaksDownWhereTheSkinTouchesIt) {
  MeanFieldCase c = own_case();
  const auto margin = [&](double voltage, double frequency) {
    return c.interface.dielectric_margin(150e-6, voltage, frequency);
  };
  const double share = 0.5e-6 / std::abs(own_thickness(2e3));
  near(margin(80, 2e3), 1e9 / (80 * share / (4 * 0.5e-6)));
  near(margin(80, 0), 1e9 / (80 / (4 * 0.5e-6)));  // a lossy skin conducts
  c.interface.gap_resistivity = 1e6;
  near(margin(80, 2e3), 1e9 / (80 * share / (4 * 0.5e-6)));
  EXPECT_EQ(margin(0, 2e3), kInfinity);
  c.interface.gap_resistivity = 0;
  // At 0 Hz it holds up to 2 kV.
  c.drive.waveform = Waveform::Dc;
  c.sweep = {{1990, 2010}, {}, {}};
  const MeanFieldResult r = solve_mean_field(c);
  EXPECT_TRUE(r.point.sound());
  EXPECT_FALSE(r.voltage[0].breaks_down());
  EXPECT_TRUE(r.voltage[1].breaks_down());
  EXPECT_FALSE(r.voltage[1].sound() || r.voltage[1].yielded);
  EXPECT_FALSE(mean_field_curves(c).stress.empty());
  c.drive.amplitude = 2010;
  EXPECT_TRUE(mean_field_curves(c).stress.empty());
  c.interface.dielectric.clear();
  EXPECT_EQ(margin(80, 2e3), kInfinity);
}

TEST(MeanFieldByHand, CurvesAreThoseOfThePoint) {
  const MeanFieldCase c = own_case();
  const MeanFieldCurves curves = mean_field_curves(c);
  const MeanField field = own_field(own_spectrum());
  ASSERT_EQ(curves.roughness.size(), 121u);
  for (const std::size_t k : {0u, 60u, 120u}) {
    const auto& at = curves.roughness[k];
    near(at.area, field.area(8e3, at.wave_number));
    EXPECT_EQ(at.elastic, at.area);
    EXPECT_EQ(at.yielded, 0);
    EXPECT_EQ(at.smoothed, at.given);
  }
  ASSERT_EQ(curves.grid.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(curves.grid[k].voltage, c.sweep.voltage[k / 3]);
    EXPECT_EQ(curves.grid[k].load, c.sweep.load[k % 3]);
    EXPECT_EQ(curves.grid[k].frequency, 2e3);
  }
  // A quarter of a decade apart is every fifth of 121 points over six decades.
  ASSERT_EQ(curves.separation.size(), 121u);
  for (const std::size_t k : {0u, 60u, 100u}) {
    near(curves.separation[k].pressure, std::pow(10, static_cast<double>(k) / 20));
    near(curves.separation[k].gap, field.mean_gap(curves.separation[k].pressure));
    near(curves.separation[k].held_gap,
         field.mean_gap(std::max(9e3, curves.separation[k].pressure)));
  }
  const FrictionPoint on =
      friction_at(field, 0.4, 50e-6, 7e6, 80 * std::sqrt(0.5), own_thickness(2e3), 9e3);
  const GapDistribution gaps = field.gaps(std::max(on.pull.pressure, 9e3));
  ASSERT_EQ(curves.stress.size(), 121u);
  for (const std::size_t k : {0u, 50u, 120u}) {
    const double gap = 1e-11 * std::pow(1e8, static_cast<double>(k) / 120);
    near(curves.stress[k].gap, gap);
    // eps0 V^2 / 2 over the square of gap and layers, V the root mean square.
    near(curves.stress[k].stress,
         0.5 * kVacuumPermittivity * 3200 / std::norm(gap + own_thickness(2e3)));
  }
  // From a thousandth of the slowest time, that of contact, to a hundred of it.
  const StepResponse step{0.5e-6, 150e-6, SkinDielectric{}.permittivity_at(2e3),
                          SkinDielectric{}.resistivity_at(2e3)};
  ASSERT_EQ(curves.step.size(), 121u);
  for (const std::size_t k : {0u, 40u, 120u}) {
    const double t = 1e-3 * step.relaxation_time(0) * std::pow(1e5, static_cast<double>(k) / 120);
    near(curves.step[k].time, t);
    near(curves.step[k].field, step.field(80, gaps.mean_gap, t));
    near(curves.step[k].pull, step.pull(gaps, 80, t));
  }
}

// No voltage, no stress and no step; a constant voltage is taken at 1 Hz for the skin's layer.
TEST(MeanFieldByHand, CurvesOfAConstantVoltageAndOfNone) {
  MeanFieldCase c = own_case();
  c.sweep = {};
  c.drive.waveform = Waveform::Dc;
  const MeanFieldCurves dc = mean_field_curves(c);
  const StepResponse step{0.5e-6, 150e-6, SkinDielectric{}.permittivity_at(1),
                          SkinDielectric{}.resistivity_at(1)};
  ASSERT_EQ(dc.step.size(), 121u);
  near(dc.step.front().time, 1e-3 * step.relaxation_time(0));
  near(dc.stress.front().stress, 0.5 * kVacuumPermittivity * 6400 / square(0.5e-6 + 1e-11));
  EXPECT_TRUE(dc.grid.empty());
  c.interface.gap_resistivity = 1e6;  // it takes no voltage
  EXPECT_TRUE(mean_field_curves(c).stress.empty());
  EXPECT_FALSE(mean_field_curves(c).separation.empty());
  EXPECT_EQ(solve_mean_field(c).point.capacitance, 0);
  EXPECT_EQ(solve_mean_field(c).point.on.pull.pull, 0);
  EXPECT_EQ(solve_mean_field(c).point.thickness.real(), kInfinity);
  c = own_case();
  c.drive.amplitude = 0;
  EXPECT_TRUE(mean_field_curves(c).stress.empty());
  EXPECT_TRUE(mean_field_curves(c).step.empty());
}

// Far below its corner of 18 kHz the gap is a short: film and skin hold the voltage. Far above it
// is one of air.
TEST(MeanFieldByHand, AGapThatConductsLeavesTheCapacitanceOfTheLayers) {
  MeanFieldCase c = own_case();
  c.sweep = {};
  c.interface.lossy_skin = false;
  c.interface.skin_equivalent = 40e-9;
  c.interface.gap_resistivity = 1e6;
  c.drive.frequency = 1e-3;
  const double layers = kVacuumPermittivity * 50e-6 / 0.54e-6;
  EXPECT_NEAR(solve_mean_field(c).point.capacitance, layers, 1e-4 * layers);
  c.drive.frequency = 1e9;
  const double conducting = solve_mean_field(c).point.capacitance;
  c.interface.gap_resistivity = 0;
  EXPECT_NEAR(conducting, solve_mean_field(c).point.capacitance, 1e-6 * conducting);
  EXPECT_LT(conducting, 0.5 * layers);
}

TEST(MeanFieldByHand, MistakesOfAFileAreToldUnderTheirKeys) {
  EXPECT_EQ(refused({}), "");
  const std::string order = "roughness.roll_off: expected lowest <= roll_off < cutoff\n";
  EXPECT_EQ(refused({"roughness.roll_off=799 1/m"}), order);
  EXPECT_EQ(refused({"roughness.roll_off=800 1/m"}), "");
  EXPECT_EQ(refused({"roughness.roll_off=1e8 1/m"}), order);
  EXPECT_EQ(refused({"roughness.roll_off=9e7 1/m"}), "");
  const std::string one =
      "roughness.density: expected one density for each of at least two wave "
      "numbers\n";
  EXPECT_EQ(refused({"roughness.wave_number=[\"1e3 1/m\"]", "roughness.density=[\"1e-18 m4\"]"}),
            one);
  EXPECT_EQ(refused({"roughness.density=[\"1e-18 m4\"]"}), one);
  const auto knots = [](const char* second) {
    return refused({std::string("roughness.wave_number=[\"1e3 1/m\",\"") + second + " 1/m\"]",
                    "roughness.density=[\"1e-18 m4\",\"1e-20 m4\"]"});
  };
  EXPECT_EQ(knots("2e3"), "");
  EXPECT_EQ(knots("1e3"), "roughness.wave_number: expected rising wave numbers\n");
  EXPECT_EQ(knots("0.9e3"), "roughness.wave_number: expected rising wave numbers\n");
  EXPECT_EQ(refused({"drive.control=current", "drive.current=1 mA"}),
            "drive.control: the mean field takes a voltage; see papilla solve drive\n");
  // Its corner is at 46.1 Hz, and 1 Hz is the lowest of the sweep.
  const std::string leaks = "interface.dielectric.0.resistivity=1e8 ohm m";
  EXPECT_EQ(refused({leaks}),
            "interface.dielectric.0.resistivity: the mean field takes films that insulate, and "
            "below 4609 Hz this one conducts, 1 Hz are asked for: take higher frequencies, a "
            "resistivity of 0 for an insulator, or papilla evaluate with a pin\n");
  EXPECT_EQ(refused({leaks, "sweep.frequency=[]", "drive.frequency=5 kHz"}), "");
  EXPECT_EQ(refused({leaks, "sweep.frequency=[\"0 Hz\"]", "drive.waveform=dc"}), "");
  EXPECT_EQ(refused({"interface.dielectric.0.resistivity=0 ohm m"}), "");
  const std::string infinite =
      "touch.load: without load the gaps of an infinite body are infinite: "
      "give a load or a finite_size_pressure\n";
  const std::vector<std::string> loads{"sweep.load=[\"1 N\",\"0 N\"]", "sweep.load=[\"1 N\"]"};
  EXPECT_EQ(refused({"touch.finite_size_pressure=0 Pa", loads[0]}), infinite);
  EXPECT_EQ(refused({"touch.finite_size_pressure=0 Pa", loads[1]}), "");
  EXPECT_EQ(refused({"touch.finite_size_pressure=0 Pa", loads[1], "touch.load=0 N"}), infinite);
  EXPECT_EQ(refused({"touch.load=0 N", loads[0]}), "");
  // 0.5 N on 100 mm2 are 5 kPa; below 10 kPa the gaps, and with them the flattening, are held.
  const std::string alone = "sweep.load=[\"0.5 N\"]", smaller = "touch.finite_size_pressure=1 kPa";
  const std::string swept = "sweep.load: a nominal pressure of the sweep reaches the hardness\n";
  EXPECT_EQ(refused({"skin.hardness=4.9 kPa", smaller, "sweep.load=[]"}),
            "skin.hardness: the nominal pressure reaches the hardness\n");
  EXPECT_EQ(refused({"skin.hardness=5.1 kPa", smaller, alone}), "");
  for (const char* hardness : {"8 kPa", "10 kPa"})
    EXPECT_EQ(refused({std::string("skin.hardness=") + hardness, alone}),
              "skin.hardness: touch.finite_size_pressure reaches the hardness\n");
  EXPECT_EQ(refused({"skin.hardness=10.1 kPa", alone}), "");
  EXPECT_EQ(refused({"skin.hardness=19.9 kPa"}), swept);  // 2 N are 20 kPa
  EXPECT_EQ(refused({"skin.hardness=20.1 kPa"}), "");
}

// A voltage across nothing but the contact has no finite pull.
TEST(MeanFieldByHand, AVoltageWithoutALayerIsRefused) {
  const std::string bare =
      "interface.dielectric: no layer holds the voltage where the surfaces touch (at 0 Hz a lossy "
      "skin holds none): give a dielectric, or no voltage\n";
  const std::string none = "interface.dielectric=[]", lossless = "interface.lossy_skin=false",
                    constant = "drive.waveform=dc", off = "drive.amplitude=0 V";
  EXPECT_EQ(refused({none}), "");  // the skin is left
  EXPECT_EQ(refused({none, constant}), bare);
  EXPECT_EQ(refused({none, "skin.thickness=0 um"}), bare);
  EXPECT_EQ(refused({none, lossless}), bare);
  EXPECT_EQ(refused({none, lossless, "interface.skin_equivalent=1e-160 nm"}), bare);
  EXPECT_EQ(refused({none, lossless, "interface.skin_equivalent=40 nm"}), "");
  EXPECT_EQ(refused({lossless, "interface.dielectric.0.thickness=0 nm"}), bare);
  EXPECT_EQ(refused({none, lossless, off}), bare);  // the sweep's voltages
  EXPECT_EQ(refused({none, "sweep.frequency=[\"1 kHz\",\"0 Hz\"]"}), bare);
  EXPECT_EQ(refused({none, "sweep.frequency=[\"1 kHz\",\"0 Hz\"]", off}), "");
  EXPECT_EQ(refused({none, constant, "interface.gap_resistivity=1e6 ohm m"}), "");
  // Without a voltage it is a contact without a capacitance.
  const MeanFieldPoint p =
      solve_mean_field(read_mean_field(kWrist, {none, lossless, off, "sweep.voltage=[]"})).point;
  EXPECT_GT(p.on.friction, 0);
  EXPECT_EQ(p.capacitance, 0);
}

// Nothing holds the voltage in the end where the skin alone is in series.
TEST(MeanFieldByHand, AStepWithoutADielectricIsLeftOut) {
  MeanFieldCase c = own_case();
  c.sweep = {};
  c.interface.dielectric.clear();
  const MeanFieldCurves curves = mean_field_curves(c);
  EXPECT_TRUE(curves.step.empty());
  ASSERT_EQ(curves.stress.size(), 121u);
  for (const StressPoint& at : curves.stress) {
    EXPECT_TRUE(std::isfinite(at.stress) && std::isfinite(at.density)) << at.gap;
  }
}

TEST(MeanFieldByHand, ASkinThatYieldsAtEveryScaleIsRefused) {
  const MeanFieldCase c =
      read_mean_field(kWrist, {"skin.modulus=1e7 MPa", "skin.hardness=20.1 kPa"});
  EXPECT_EQ(keyed_refusal_of([&] { solve_mean_field(c); }),
            "skin.hardness: the skin yields at every scale of its roughness: take more, or a lower "
            "modulus\n");
}

TEST(MeanFieldByHand, ACaseThatSaysNothingIsTheWristOfThePaper) {
  const MeanFieldCase c;
  EXPECT_EQ(c.schema_version, 1);
  EXPECT_EQ(c.roughness.spectrum(), wrist_spectrum());
  EXPECT_EQ(c.roughness.scale, 1);
  EXPECT_EQ(c.skin.solid, (MeanFieldSolid{40e6, 0.5, 200e-6, 10e3, 0.5}));
  EXPECT_EQ(c.skin.hardness, 0);
  ASSERT_EQ(c.interface.dielectric.size(), 1u);
  EXPECT_EQ(c.interface.dielectric[0], (Dielectric{"oxide", 1e-6, 3.9, 1e14, 1e9}));
  EXPECT_EQ(c.interface.skin_equivalent, 0);
  EXPECT_EQ(c.interface.gap_resistivity, 0);
  EXPECT_TRUE(c.interface.lossy_skin);
  EXPECT_EQ(c.touch.load, 0.5);
  EXPECT_EQ(c.touch.area, 1e-4);
  EXPECT_EQ(c.touch.shear_strength, 8e6);
  EXPECT_EQ(c.touch.finite_size_pressure, 10e3);
  EXPECT_EQ(c.theory.kappa, 2);
  EXPECT_EQ(c.theory.energy_factor, 0.45);
  // A file that names no drive: 100 V at 1 kHz.
  const MeanFieldCase read = read_mean_field(parse_document("schema_version = 1\n", "a.toml"));
  EXPECT_EQ(read.drive.amplitude, 100);
  EXPECT_EQ(read.drive.frequency, 1e3);
  EXPECT_EQ(read.touch.load, 0.5);
}

}  // namespace
}  // namespace papilla::tests::mean_field_by_hand_test
