// Drive cases small enough to work out: networks layer by layer, sources sample by sample, limits,
// lines and onsets as whole results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "cases/drive.h"
#include "tests/support/refusal.h"

namespace papilla::tests::drive_by_hand_test {
namespace {

const std::string kFingertip = PAPILLA_SOURCE_DIR "/designs/physics/fingertip_drive.toml";

std::string refused(const std::vector<std::string>& overrides) {
  return keyed_refusal_of([&] { read_drive_case(kFingertip, overrides); });
}

void near(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected)) << expected;
}

// Two films of 1 um and 3 um on 2 mm2, permittivities 4 and 6, the second an insulator; a skin of
// 100 um; a gap of 2 um that conducts.
DriveCase layered() {
  DriveCase c;
  c.touch = {.load = 0.5, .area = 2e-6, .coefficient = 0.25};
  c.surface.dielectric = {{"a", 1e-6, 4, 1e10}, {"none", 0, 4, 0}, {"b", 3e-6, 6, 0}};
  c.skin = {100e-6, 1000, 3e4};
  c.gap.distance = 2e-6;
  c.gap.permittivity = 3;
  c.gap.resistivity = 1e8;
  c.source.shunt = 2e6;
  c.drive.amplitude = 100;
  c.drive.frequency = 1e3;
  return c;
}

TEST(DriveByHand, ANetworkIsItsLayersInSeries) {
  DriveCase c = layered();
  const Network n = solve_drive(c).network;
  near(n.dielectric.capacitance, kVacuumPermittivity * 4 * 2e-6 / 1e-6);
  near(n.dielectric.resistance, 1e10 * 1e-6 / 2e-6);
  ASSERT_EQ(n.apart.size(), 1u);  // the insulator
  near(n.apart[0].capacitance, kVacuumPermittivity * 6 * 2e-6 / 3e-6);
  EXPECT_EQ(n.apart[0].resistance, kInfinity);
  near(n.skin.capacitance, kVacuumPermittivity * 1000 * 2e-6 / 100e-6);
  near(n.skin.resistance, 3e4 * 100e-6 / 2e-6);
  near(n.gap.distance, 2e-6);
  near(n.gap.layer.capacitance, kVacuumPermittivity * 3 * 2e-6 / 2e-6);
  near(n.gap.layer.resistance, 1e8 * 2e-6 / 2e-6);
  near(n.gap.force_factor, 0.5 * kVacuumPermittivity * 3 * 2e-6 / square(2e-6));
  EXPECT_EQ(n.shunt, 2e6);
  c.surface.dielectric.back().resistivity = 1e10 * 4 / 6;       // the time constant of the other
  c.gap.resistivity = c.skin.resistivity = c.source.shunt = 0;  // insulators, and no shunt
  const Network leaky = solve_drive(c).network;
  // 1 um / 4 + 3 um / 6 = 0.75 um of air on 2 mm2.
  EXPECT_TRUE(leaky.apart.empty());
  near(leaky.dielectric.capacitance, kVacuumPermittivity * 2e-6 / 0.75e-6);
  near(leaky.dielectric.resistance, (1e10 * 1e-6 + 1e10 * 4 / 6 * 3e-6) / 2e-6);
  EXPECT_EQ(leaky.gap.layer.resistance, kInfinity);
  EXPECT_EQ(leaky.skin.resistance, kInfinity);
  EXPECT_EQ(leaky.shunt, kInfinity);
  c.surface.dielectric.clear();
  EXPECT_EQ(solve_drive(c).network.dielectric.capacitance, 0);
  EXPECT_EQ(solve_drive(c).network.dielectric.resistance, 0);
}

// Far below the corner of the one layer, 45 kHz, the other has all of the film's voltage: 3 um of 6
// beside a gap of 2 um of 3, which share it as 3 to 4.
TEST(DriveByHand, ALayerThatLeaksLeavesTheFilmsVoltageToTheOneThatInsulates) {
  DriveCase c = layered();
  c.surface.dielectric[0].resistivity = 1e5;
  c.gap.resistivity = 0;
  c.skin.thickness = 0;
  c.drive.frequency = 0.1;
  const DriveResult r = solve_drive(c);
  EXPECT_NEAR(r.carrier.gap_voltage, 100 * 4.0 / 7, 1e-3);
  EXPECT_NEAR(r.carrier.film_voltage, 100 * 3.0 / 7, 1e-3);
  c.drive.waveform = Waveform::Dc;
  EXPECT_NEAR(solve_drive(c).carrier.gap_voltage, 100 * 4.0 / 7, 1e-9);
}

// Without films and skin the gap has the source's voltage: force and friction sample by sample.
DriveCase bare() {
  DriveCase c = layered();
  c.surface.dielectric.clear();
  c.skin.thickness = 0;
  return c;
}
void expect_friction(const DriveResult& r, double period, std::size_t samples,
                     const std::function<double(double)>& voltage) {
  near(r.friction.period, period);
  ASSERT_EQ(r.friction.value.size(), samples);
  double most = 0, mean = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double v = voltage(period * static_cast<double>(i) / static_cast<double>(samples));
    const double force = r.network.gap.force_factor * v * v;
    EXPECT_NEAR(r.series.force.value[i], force, 1e-9 * r.network.gap.force_factor * 1e4) << i;
    EXPECT_NEAR(r.friction.value[i], 0.25 * (0.5 + r.series.force.value[i]), 1e-12) << i;
    most = std::max(most, std::abs(v));
    mean += force / static_cast<double>(samples);
  }
  EXPECT_NEAR(r.series.peak_gap_voltage, most, 1e-9 * most);
  EXPECT_NEAR(r.series.mean_force, mean, 1e-9 * mean);
}

TEST(DriveByHand, ASineHasSixtyFourSamplesAndASquareWave4096) {
  DriveCase c = bare();
  expect_friction(solve_drive(c), 1e-3, 64,
                  [](double t) { return 100 * std::sin(2 * kPi * 1e3 * t); });
  c.drive.waveform = Waveform::Square;
  expect_friction(solve_drive(c), 1e-3, 4096, [](double t) { return t < 0.5e-3 ? 100 : -100; });
  c.drive.waveform = Waveform::Dc;
  const DriveResult dc = solve_drive(c);
  expect_friction(dc, 1, 64, [](double) { return 100; });
  EXPECT_EQ(dc.carrier.gap_voltage, 100);
  EXPECT_EQ(dc.distortion, 0);
}

// Tones of 100 and 300 Hz on 3 kHz: 30 cycles of 32 samples, which 1024 hold.
TEST(DriveByHand, TonesModulateTheirCarrier) {
  DriveCase c = bare();
  c.drive.waveform = Waveform::Am;
  c.drive.frequency = 3e3;
  c.drive.envelope_exponent = 1;
  c.tones = {{100, 300}, {0.25, 0.5}};
  const DriveResult r = solve_drive(c);
  expect_friction(r, 0.01, 1024, [](double t) {
    return 100 * std::sin(2 * kPi * 3e3 * t) *
           (1 + 0.25 * std::sin(2 * kPi * 100 * t) + 0.5 * std::sin(2 * kPi * 300 * t)) / 1.75;
  });
  EXPECT_EQ(r.modulation.frequency, (std::vector<double>{100, 300}));
  EXPECT_EQ(r.modulation.amplitude, (std::vector<double>{0.25, 0.5}));
  // The square of the envelope below half the carrier: wanted 2 m of 0.5 and 1. Beside it of
  // 0.25^2 sin^2 a + 2 x 0.25 x 0.5 sin a sin 3a + 0.5^2 sin^2 3a the cosines of 2a, 4a and 6a.
  const double beside = std::sqrt(square(0.125 - 0.03125) + 2 * square(0.125));
  near(r.distortion, beside / std::hypot(0.5, 1));
  c.tones.amplitude.clear();  // shares of one
  EXPECT_EQ(solve_drive(c).modulation.amplitude, (std::vector<double>{0.5, 0.5}));
  c.tones.frequency.clear();  // the drive's own, at full depth
  c.drive.modulation_frequency = 150;
  EXPECT_EQ(solve_drive(c).modulation.frequency, std::vector<double>{150});
  EXPECT_EQ(solve_drive(c).modulation.amplitude, std::vector<double>{1});
  c.drive.waveform = Waveform::Sine;
  EXPECT_TRUE(solve_drive(c).modulation.frequency.empty());
}

// From 200 Hz to 1 kHz in 20 ms: 32 samples for each of 20 cycles of the fastest, so 1024.
TEST(DriveByHand, AChirpRisesEvenly) {
  DriveCase c = bare();
  c.drive.frequency = 200;
  c.source.chirp_to = 1e3;
  c.source.chirp_time = 0.02;
  expect_friction(solve_drive(c), 0.02, 1024, [](double t) {
    return 100 * std::sin(2 * kPi * (200 * t + 0.5 * 800 * t * t / 0.02));
  });
  c.source.chirp_time = 1e-4;
  EXPECT_EQ(solve_drive(c).friction.value.size(), 64u);
  c.drive.frequency = 2e3;  // down as well: 40 cycles
  c.source.chirp_time = 0.02;
  EXPECT_EQ(solve_drive(c).friction.value.size(), 2048u);
  c.drive.control = DriveControl::Current;
  c.drive.current = 3e-3;
  c.source.chirp_time = 0.02;
  c.source.shunt = 0;  // all of it flows through the body
  EXPECT_NEAR(solve_drive(c).series.peak_current, 3e-3, 1e-5);
}

// Four million samples are the most: 32 a cycle, 4,194,304 of 131,072 cycles.
TEST(DriveByHand, MoreSamplesThanFourMillionAreRefused) {
  DriveCase c = bare();
  c.drive.frequency = 200;
  c.source.chirp_to = 131073;
  c.source.chirp_time = 1;
  EXPECT_EQ(keyed_refusal_of([&] { solve_drive(c); }),
            "source.chirp_time: too many cycles: take less time\n");
  DriveCase tones = bare();
  tones.drive.waveform = Waveform::Am;
  tones.drive.frequency = 131073;
  tones.tones.frequency = {1};
  EXPECT_EQ(keyed_refusal_of([&] { solve_drive(tones); }),
            "tones.frequency: carrier and tones have no short common period: choose frequencies "
            "that are multiples of one that is not too low\n");
  tones.drive.frequency = 3e3;
  tones.tones.frequency = {std::sqrt(2.0)};
  EXPECT_NE(keyed_refusal_of([&] { solve_drive(tones); }), "");
}

// The carrier of a square wave is that wave: its square is constant, without a ripple.
TEST(DriveByHand, TheCarrierOfASquareWavePullsAllTheTime) {
  DriveCase c = bare();
  c.drive.waveform = Waveform::Square;
  const DriveResult r = solve_drive(c);
  near(r.carrier.mean_force, r.network.gap.force_factor * 1e4);
  near(r.carrier.mean_force, r.series.mean_force);
  EXPECT_LT(r.carrier.ripple, 1e-9 * r.carrier.mean_force);
  near(r.carrier.gap_voltage, 100);
  near(r.carrier.current, r.series.peak_current);
}

// Every line of a square wave's friction: its square is constant, so the mean alone.
TEST(DriveByHand, LinesAreThoseOfTheFriction) {
  DriveCase c = bare();
  const DriveResult r = solve_drive(c);
  const double pull = r.network.gap.force_factor * 1e4;  // at 100 V
  ASSERT_EQ(r.lines.size(), 2u);
  EXPECT_EQ(r.lines[0].frequency, 0);
  near(r.lines[0].amplitude, 0.25 * (0.5 + pull / 2));
  near(r.lines[1].frequency, 2e3);
  near(r.lines[1].amplitude, 0.25 * pull / 2);
  // Recorded at 8 samples: up to half their rate.
  c.recording = {1e-3, {0, 50, 100, 50, 0, -50, -100, -50}};
  double highest = 0;
  for (const SpectrumLine& line : solve_drive(c).lines) highest = std::max(highest, line.frequency);
  near(highest, 4e3);
  // A constant source has lines up to its period's.
  c.recording = {};
  c.drive.waveform = Waveform::Dc;
  ASSERT_FALSE(solve_drive(c).lines.empty());
  near(solve_drive(c).lines[0].amplitude, 0.25 * (0.5 + pull));
}

TEST(DriveByHand, ASweepIsOfTheSineAtItsFrequencies) {
  DriveCase c = layered();
  c.sweep.frequency = {0, 50, 2e3};
  const DriveResult r = solve_drive(c);
  ASSERT_EQ(r.response.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const DriveResponse one = respond(r.network, DriveControl::Voltage, 100, c.sweep.frequency[i]);
    EXPECT_EQ(r.response[i].mean_force, one.mean_force);
    EXPECT_EQ(r.response[i].gap_voltage, one.gap_voltage);
  }
  EXPECT_EQ(r.carrier.mean_force, respond(r.network, DriveControl::Voltage, 100, 1e3).mean_force);
}

// The body's current, the source's voltage where one is given, air in the gap, 327 V in 2 um, and
// the film.
TEST(DriveByHand, LimitsAreThoseOfTheDriveAndOfTheAir) {
  DriveCase c = layered();
  c.drive.current_limit = 0.25e-3;
  const DriveResult r = solve_drive(c);
  ASSERT_EQ(r.checks.size(), 3u);
  EXPECT_EQ(r.checks[0].what, DriveLimit::BodyCurrent);
  EXPECT_EQ(r.checks[0].value, r.series.peak_current);
  EXPECT_EQ(r.checks[0].limit, 0.25e-3);
  EXPECT_EQ(r.checks[1].what, DriveLimit::GapVoltage);
  EXPECT_EQ(r.checks[1].value, r.series.peak_gap_voltage);
  EXPECT_EQ(r.checks[1].limit, 327);
  c.drive.source_compliance = 120;
  const DriveResult more = solve_drive(c);
  ASSERT_EQ(more.checks.size(), 4u);
  EXPECT_EQ(more.checks[1].what, DriveLimit::SourceVoltage);
  EXPECT_EQ(more.checks[1].value, more.series.peak_source_voltage);
  EXPECT_EQ(more.checks[1].limit, 120);
  EXPECT_TRUE((DriveCheck{DriveLimit::GapVoltage, 2, 2}.passes()));
  EXPECT_FALSE((DriveCheck{DriveLimit::GapVoltage, 2.1, 2}.passes()));
}

// 1 um of permittivity 2 and 3 um of 6 share the film's voltage evenly: the thin one has half of it
// over a micrometre, and holds 10 V/um. Eq. electrostatics.9
TEST(DriveByHand, AFilmIsHeldAgainstTheStrengthOfItsLayers) {
  DriveCase c = layered();
  c.surface.dielectric = {{"a", 1e-6, 2, 0, 10e6}, {"none", 0, 4, 0, 1}, {"b", 3e-6, 6, 0, 10e6}};
  const DriveResult r = solve_drive(c);
  const DriveCheck film = r.checks.back();
  EXPECT_EQ(film.what, DriveLimit::FilmVoltage);
  EXPECT_EQ(film.value, r.series.peak_film_voltage);
  near(film.limit, 10e6 * 2 * 1e-6);  // strength, permittivity, sum of d/eps
  EXPECT_NEAR(film.value / respond(r.network, DriveControl::Voltage, 100, 1e3).film_voltage, 1,
              2e-3);  // sampled peak
  EXPECT_FALSE(film.passes());
  // At 0 Hz a layer that conducts leaves all to the one that does not.
  c.surface.dielectric[0].resistivity = 1e8;
  c.drive.waveform = Waveform::Dc;
  near(solve_drive(c).checks.back().limit, 10e6 * 3e-6);
  c.surface.dielectric.clear();
  EXPECT_EQ(solve_drive(c).checks.back().what, DriveLimit::GapVoltage);
}

TEST(DriveByHand, OnsetsAreShearAndFrictionOfWhatSlides) {
  DriveCase c = layered();
  EXPECT_EQ(solve_drive(c).onset_off, 0);
  c.touch.real_area = 0.01e-6;
  c.touch.shear_strength = 5e6;
  const DriveResult r = solve_drive(c);
  near(r.onset_off, 0.05 + 0.25 * 0.5);
  near(r.onset_on, 0.05 + 0.25 * (0.5 + r.series.mean_force));
  near(r.onset_static, 0.05);
  EXPECT_GT(r.series.mean_force, 1e-3);
}

// Each mistake with its key; what lies at its border is none.
TEST(DriveByHand, MistakesOfAFileAreToldUnderTheirKeys) {
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({"drive.current=0 mA"}),
            "drive.current: expected a current above 0 mA under current control\n");
  EXPECT_EQ(refused({"drive.control=voltage"}), "drive.amplitude: expected a voltage above 0 V\n");
  EXPECT_EQ(refused({"drive.frequency=0 kHz", "drive.waveform=sine", "tones.frequency=[]"}),
            "drive.frequency: expected a frequency above 0 kHz, or waveform dc\n");
  EXPECT_EQ(refused({"drive.frequency=0 kHz", "drive.waveform=dc", "tones.frequency=[]"}), "");
  EXPECT_EQ(refused({"tones.frequency=[]"}),
            "drive.modulation_frequency: expected a frequency above 0 Hz, or tones.frequency, for "
            "am\n");
  EXPECT_EQ(refused({"tones.frequency=[]", "drive.modulation_frequency=10 Hz"}), "");
  EXPECT_EQ(refused({"tones.amplitude=[0.5, 0.5]"}),
            "tones.amplitude: expected one amplitude for each tone\n");
  EXPECT_EQ(refused({"tones.amplitude=[0.5, 0.25, 0.25]"}), "");
  EXPECT_EQ(refused({"tones.amplitude=[0.5, 0.5, 0.25]"}),
            "tones.amplitude: the amplitudes add to 1.25: the envelope would be negative, expected "
            "at most 1\n");
  EXPECT_EQ(refused({"tones.frequency=[\"10 Hz\", \"25 kHz\"]"}),
            "tones.frequency: expected tones below the carrier's frequency\n");
  EXPECT_EQ(refused({"tones.frequency=[\"10 Hz\", \"24.99 kHz\"]"}), "");
  const std::string chirp =
      "source.chirp_to: a chirp is a sine without tones: set drive.waveform = \"sine\", and no "
      "file\n";
  EXPECT_EQ(refused({"source.chirp_to=2 kHz"}), chirp);
  EXPECT_EQ(refused({"source.chirp_to=2 kHz", "drive.waveform=sine"}), chirp);  // tones
  EXPECT_EQ(refused({"source.chirp_to=2 kHz", "drive.waveform=square", "tones.frequency=[]"}),
            chirp);
  EXPECT_EQ(refused({"source.chirp_to=2 kHz", "drive.waveform=sine", "tones.frequency=[]",
                     "source.file=" + kFingertip}),
            chirp);
  EXPECT_EQ(refused({"source.chirp_to=2 kHz", "drive.waveform=sine", "tones.frequency=[]"}), "");
  EXPECT_EQ(refused({"drive.waveform=dc", "source.shunt=0 ohm", "gap.resistivity=0 ohm m",
                     "tones.frequency=[]"}),
            "gap.resistivity: a constant current through an insulating gap has no end: give the "
            "gap a resistivity or the source a shunt\n");
}

// What nobody says: the finger of Shultz 2018 on its oxide, its swipe.
TEST(DriveByHand, ACaseThatSaysNothingIsThePublishedFinger) {
  const DriveCase c;
  EXPECT_EQ(c.schema_version, 1);
  EXPECT_EQ(c.gap.distance, 1.06e-6);
  EXPECT_EQ(c.gap.resistivity, 4.8e8);
  EXPECT_EQ(c.gap.permittivity, 1);
  EXPECT_EQ(c.gap.relative_humidity, 0.55);
  EXPECT_EQ(c.gap.skins, 4);
  EXPECT_FALSE(c.gap.contact_spots);
  ASSERT_EQ(c.surface.dielectric.size(), 1u);
  EXPECT_EQ(c.surface.dielectric[0], (Dielectric{"oxide", 1e-6, 3.9, 1e14, 1e9}));
  EXPECT_EQ(c.skin.thickness, 200e-6);
  EXPECT_EQ(c.skin.permittivity, 2000);
  EXPECT_EQ(c.skin.resistivity, 2e4);
  EXPECT_EQ(c.touch.load, 1);
  EXPECT_EQ(c.touch.area, 30e-6);
  EXPECT_EQ(c.touch.coefficient, 0.2);
  EXPECT_EQ(c.touch.real_area, 0);
  EXPECT_EQ(c.touch.shear_strength, 9e6);
  EXPECT_EQ(c.source.shunt, 1e6);
  EXPECT_EQ(c.source.chirp_to, 0);
  EXPECT_EQ(c.source.chirp_time, 0.05);
  EXPECT_EQ(c.swipe.stroke, 10e-3);
  EXPECT_EQ(c.swipe.frequency, 3.8);
  EXPECT_EQ(c.swipe.duration, 1);
  EXPECT_EQ(c.swipe.stiffness, 800);
  EXPECT_EQ(c.swipe.filter, 150);
  EXPECT_EQ(c.swipe.stuck, 1);
  EXPECT_EQ(c.swipe.partial, 1);
  EXPECT_EQ(c.swipe.full, 0);
  EXPECT_EQ(DriveResult{}.area, 0);
  EXPECT_EQ(DriveResult{}.spots, 0);
  EXPECT_EQ(DriveResult{}.distortion, 0);
  EXPECT_EQ(DriveResult{}.onset_off + DriveResult{}.onset_on + DriveResult{}.onset_static, 0);
}

}  // namespace
}  // namespace papilla::tests::drive_by_hand_test
