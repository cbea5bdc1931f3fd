#include "cases/drive.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "design/design.h"
#include "forward/forward.h"
#include "numerics/statistics.h"
#include "report/drive.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::drive_test {
namespace {

const std::string kFingertip = PAPILLA_SOURCE_DIR "/designs/physics/fingertip_drive.toml";
const std::string kSamples = PAPILLA_SOURCE_DIR "/designs/m3_samples/";

TEST(DriveFile, GivesThePublishedVoltagesOfTheExample) {
  const DriveResult r = solve_drive(read_drive_case(kFingertip));
  // 4 mA at 25 kHz: below 150 V, four fifths of it in the gap or a little less.
  EXPECT_LT(r.carrier.source_voltage, 150);
  EXPECT_NEAR(r.carrier.gap_voltage, 101.9, 2);
  EXPECT_NEAR(r.network.gap.layer.corner_frequency(), 37.45, 0.1);
  for (const DriveCheck& check : r.checks)
    EXPECT_TRUE(check.passes()) << static_cast<int>(check.what);
  EXPECT_LT(r.distortion, 1e-3);
  EXPECT_EQ(r.response.size(), 5u);
  // The square law at exponent 1.
  const DriveResult plain =
      solve_drive(read_drive_case(kFingertip, {"drive.envelope_exponent=1.0"}));
  EXPECT_NEAR(plain.distortion, 0.25, 0.01);
}

TEST(DriveFile, ChecksNameWhatIsTooMuch) {
  const DriveResult r = solve_drive(
      read_drive_case(kFingertip, {"drive.current=12 mA", "drive.source_compliance=150 V"}));
  ASSERT_EQ(r.checks.size(), 4u);
  EXPECT_FALSE(r.checks[0].passes());  // body current
  EXPECT_FALSE(r.checks[1].passes());  // source voltage
  EXPECT_TRUE(r.checks[2].passes());
  EXPECT_TRUE(r.checks[3].passes());
  // A sine of 20 kV: across the film some kilovolts, of which it holds 100.
  const DriveResult high = solve_drive(read_drive_case(
      kFingertip,
      {"drive.control=voltage", "drive.waveform=sine", "drive.frequency=5 kHz",
       "drive.amplitude=20 kV", "tones.frequency=[]", "surface.dielectric.0.strength=100 V/um"}));
  EXPECT_EQ(high.checks.back().what, DriveLimit::FilmVoltage);
  EXPECT_NEAR(high.checks.back().limit, 100, 1e-9);
  EXPECT_GT(high.checks.back().value, 3000);
}

TEST(DriveFile, OnsetOfSlidingNeedsTheRealArea) {
  const DriveResult without = solve_drive(read_drive_case(kFingertip));
  EXPECT_EQ(without.onset_on, 0);
  const DriveResult r =
      solve_drive(read_drive_case(kFingertip, {"touch.real_area=0.02 mm2", "touch.load=0.5 N"}));
  const double adhesive = 9e6 * 0.02e-6;
  EXPECT_NEAR(r.onset_off, adhesive + 0.2 * 0.5, 1e-12);
  EXPECT_NEAR(r.onset_on, adhesive + 0.2 * (0.5 + r.series.mean_force), 1e-12);
  EXPECT_NEAR(r.onset_static, adhesive, 1e-12);
}

// Charge that has no way out piles up; each way out is enough.
TEST(DriveFile, AConstantCurrentNeedsAWay) {
  const auto refused = [](const std::vector<std::string>& more) {
    std::vector<std::string> overrides{"drive.control=current", "drive.waveform=dc",
                                       "gap.resistivity=0 ohm m", "source.shunt=0 ohm"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    try {
      read_drive_case(kFingertip, overrides);
    } catch (const InputError& error) {
      return std::string(error.what()).find("has no end") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused({}));
  EXPECT_FALSE(refused({"gap.resistivity=1e8 ohm m"}));
  EXPECT_FALSE(refused({"source.shunt=1 Mohm"}));
  EXPECT_FALSE(refused({"drive.waveform=sine"}));
  EXPECT_FALSE(refused({"drive.control=voltage", "drive.amplitude=100 V"}));
}

TEST(DriveFile, ASwipeIsDrivenUntilItSlipsFully) {
  // Stuck, then the lateral force rises, levels off and falls again.
  std::string csv = "lateral,normal\n";
  for (int i = 0; i < 480; ++i) {
    const double t = i / 400.0;
    csv += std::to_string(t < 0.1 ? 0.0 : 0.4 * std::sin(kPi * (t - 0.1))) + ",0.5\n";
  }
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  const Swipe swipe = run_swipe(csv, "forces.csv", options, 150);
  ASSERT_EQ(swipe.steps.size(), 4u);
  EXPECT_EQ(swipe.steps[0].state, SlipState::Stuck);
  EXPECT_EQ(swipe.steps[1].state, SlipState::Partial);
  EXPECT_EQ(swipe.steps[2].state, SlipState::Full);
  EXPECT_EQ(swipe.steps[2].current, 0);
  EXPECT_NEAR(swipe.driven, swipe.steps[2].time + swipe.duration - swipe.steps[3].time, 2e-3);
  EXPECT_THROW(run_swipe("1,2\n1;2\n", "forces.csv", options, 150), InputError);
}

std::string with_times(double rate, double noise) {
  std::string csv = "time,lateral,normal\n";
  for (int i = 0; i < static_cast<int>(1.13 * rate); ++i) {
    const double t = i / rate;
    const double slow = t < 0.1 ? 0.0 : 0.4 * std::sin(kPi * (t - 0.1));
    csv += std::to_string(t) + "," + std::to_string(slow + noise * std::sin(2 * kPi * 1300 * t)) +
           ",0.5\n";
  }
  return csv;
}

TEST(DriveFile, ARecordingAtAnotherRateIsLowPassedAndTakenEveryMillisecond) {
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  const Swipe clean = run_swipe(with_times(1000, 0), "forces.csv", options, 0);
  const Swipe noisy = run_swipe(with_times(5000, 0.001), "forces.csv", options, 150);
  ASSERT_EQ(clean.steps.size(), 4u);
  ASSERT_EQ(noisy.steps.size(), 4u);
  // The filter delays by 1.5 ms; what is left of the noise moves the turning points.
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(noisy.steps[k].time, clean.steps[k].time, 0.05) << k;
  EXPECT_NEAR(noisy.duration, 1.13, 2e-3);
  // As it came it would have slipped at once.
  const Swipe raw = run_swipe(with_times(5000, 0.001), "forces.csv", options, 0);
  EXPECT_LT(raw.steps[2].time, clean.steps[2].time - 0.1);
  EXPECT_THROW(run_swipe(with_times(200, 0), "forces.csv", options, 150), InputError);
  EXPECT_THROW(run_swipe("0,1,1\n0.001,1,1\n0.005,1,1\n", "f.csv", options, 0), InputError);
}

// Straight between its rows, a recording at a tenth of the rate says the same.
TEST(DriveFile, ARecordingIsStraightBetweenItsRows) {
  const auto recorded = [](int every) {  // [ms]
    std::string csv = "time,lateral,normal\n";
    const auto slow = [](int ten) {
      return std::max(0.0, 0.4 * std::sin(kPi * (0.01 * ten - 0.1)));
    };
    for (int ms = 0; ms <= 1100; ms += every) {
      const double part = 0.1 * (ms % 10);
      const double lateral = slow(ms / 10) * (1 - part) + slow(ms / 10 + 1) * part;
      csv += fmt::format("{:.3f},{:.9f},0.5\n", 1e-3 * ms, lateral);
    }
    return csv;
  };
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  const Swipe often = run_swipe(recorded(1), "forces.csv", options, 0);
  const Swipe seldom = run_swipe(recorded(10), "forces.csv", options, 0);
  ASSERT_GT(often.steps.size(), 2u);
  ASSERT_EQ(often.steps.size(), seldom.steps.size());
  for (std::size_t k = 0; k < often.steps.size(); ++k) {
    EXPECT_EQ(often.steps[k].state, seldom.steps[k].state) << k;
    EXPECT_NEAR(often.steps[k].time, seldom.steps[k].time, 1.5e-3) << k;
  }
  EXPECT_NEAR(often.duration, seldom.duration, 1.5e-3);
  EXPECT_NEAR(often.driven, seldom.driven, 3e-3);
}

TEST(DriveFile, ARenderedSwipeIsDrivenWhileItSticks) {
  const std::vector<std::string> free{"source.shunt=0 ohm"};
  const DriveCase c = read_drive_case(kFingertip, free);
  const Swipe swipe = render_swipe(c, solve_drive(c).network);
  EXPECT_EQ(swipe.samples.size(), 1000u);
  double driven_peak = 0, passes = 0;
  for (const RubbingSample& at : swipe.samples) {
    const bool sticks = at.state == SlipState::Stuck || at.state == SlipState::Partial;
    EXPECT_EQ(at.current, sticks ? c.drive.current : 0);
    if (sticks) driven_peak = std::max(driven_peak, std::abs(at.lateral));
    if (at.state == SlipState::Full) ++passes;
  }
  EXPECT_GT(passes, 100);
  // What is felt: friction under the whole pull of the carrier.
  const double pull = solve_drive(c).carrier.mean_force;
  EXPECT_NEAR(driven_peak, c.touch.coefficient * (c.touch.load + pull), 0.01 * driven_peak);
  EXPECT_NEAR(swipe.driven + 1e-3 * passes, swipe.duration, 0.01);
  EXPECT_THROW(
      render_swipe(read_drive_case(kFingertip, {"drive.control=voltage", "drive.amplitude=100 V"}),
                   Network{}),
      InputError);
  // A recorded swipe asks for a current too.
  EXPECT_THROW(swipe_machine(
                   read_drive_case(kFingertip, {"drive.control=voltage", "drive.amplitude=100 V"})),
               InputError);
  EXPECT_EQ(swipe_machine(c).stuck_current, c.swipe.machine(c.drive.current).stuck_current);
}

TEST(DriveFile, ARecordedSineIsTheSine) {
  const std::vector<std::string> sine{"drive.control=voltage", "drive.waveform=sine",
                                      "drive.amplitude=100 V", "drive.frequency=1 kHz",
                                      "tones.frequency=[]"};
  const DriveResult expected = solve_drive(read_drive_case(kFingertip, sine));
  std::string csv = "time,voltage\n";
  for (int i = 0; i < 1024; ++i)
    csv += fmt::format("{:.9g},{:.9g}\n", i / 1024e3, 100 * std::sin(2 * kPi * i / 1024.0));
  const std::string path = temporary("recorded_sine.csv");
  write_bytes(path, csv);
  std::vector<std::string> recorded = sine;
  recorded.push_back("source.file=" + path);
  const DriveResult r = solve_drive(read_drive_case(kFingertip, recorded));
  EXPECT_NEAR(r.series.mean_force, expected.series.mean_force, 1e-3 * expected.series.mean_force);
  EXPECT_NEAR(r.friction.period, 1e-3, 2e-6);
  write_bytes(path, "time,voltage\n0,1\n1e-6,x\n");
  EXPECT_THROW(read_drive_case(kFingertip, recorded), InputError);
}

// A recording replaces the tones of the case: nothing is modulated, and no line is wanted.
TEST(DriveFile, ARecordingHasNoTonesAndNoDistortion) {
  std::string csv = "time_us,current_mA\n";
  for (int i = 0; i < 64; ++i)
    csv += fmt::format("{:.9g},{:.9g}\n", 40 * i / 64.0, 4 * std::sin(2 * kPi * i / 64.0));
  const std::string path = temporary("recorded_carrier.csv");
  write_bytes(path, csv);
  const DriveCase c = read_drive_case(kFingertip, {"source.file=" + path});
  ASSERT_EQ(c.drive.waveform, Waveform::Am);
  const DriveResult r = solve_drive(c);
  EXPECT_TRUE(r.modulation.frequency.empty());
  EXPECT_EQ(r.distortion, 0);
  EXPECT_EQ(drive_text(c, r).find("distortion"), std::string::npos);
  EXPECT_NEAR(r.series.mean_force, r.carrier.mean_force, 1e-3 * r.carrier.mean_force);
  const DriveCase tones = read_drive_case(kFingertip);
  EXPECT_NE(drive_text(tones, solve_drive(tones)).find("distortion"), std::string::npos);
}

TEST(DriveFile, AChirpPullsAsItsFrequenciesDo) {
  const std::vector<std::string> sine{"drive.control=voltage", "drive.waveform=sine",
                                      "drive.amplitude=100 V", "drive.frequency=100 Hz",
                                      "tones.frequency=[]"};
  std::vector<std::string> chirp = sine;
  chirp.insert(chirp.end(), {"source.chirp_to=2 kHz", "source.chirp_time=200 ms"});
  const DriveResult r = solve_drive(read_drive_case(kFingertip, chirp));
  double mean_pull = 0;
  for (int k = 0; k < 200; ++k)
    mean_pull +=
        respond(r.network, DriveControl::Voltage, 100, 100 + 1900 * (k + 0.5) / 200).mean_force /
        200;
  EXPECT_NEAR(r.series.mean_force, mean_pull, 0.01 * mean_pull);
  EXPECT_THROW(read_drive_case(kFingertip, {"source.chirp_to=2 kHz"}), InputError);  // am
}

// Eq. drive.16: halves with the load, as contact stiffness does, and doubles with the resistivity.
TEST(DriveFile, ContactSpotsConductAsStifflyAsTheyPress) {
  const auto spots = [](const std::vector<std::string>& more) {
    std::vector<std::string> all{"gap.design=" + kSamples + "flat.toml", "gap.skins=2"};
    all.insert(all.end(), more.begin(), more.end());
    return solve_drive(read_drive_case(kFingertip, all));
  };
  const DriveResult one = spots({});
  // A rough contact is as stiff as its pressure over some half of its rms gap (Persson 2007): here
  // the finger's pressure over 0.1 to 10 um, whatever the rest of the network.
  const DriveCase c = read_drive_case(kFingertip, {"gap.design=" + kSamples + "flat.toml"});
  Finger finger = read_design(kSamples + "flat.toml").finger;
  finger.load = c.touch.load;
  const double modulus = finger.skin.layer_modulus *
                         finger.skin.modulus_factor(c.gap.relative_humidity) /
                         (1 - square(finger.skin.layer_poisson));
  const double stiffness = modulus * c.skin.resistivity / (2 * one.spots * one.area);
  EXPECT_LT(finger.patch_pressure(c.gap.relative_humidity) / stiffness, 10e-6);
  EXPECT_GT(finger.patch_pressure(c.gap.relative_humidity) / stiffness, 10e-9);
  // By the gaps under that pressure and under a twentieth more of it.
  double by_gaps = 0;
  for (int k = 0; k < 2; ++k) {
    double gap[2];
    for (const int more : {0, 1}) {
      const Design flat = read_design(kSamples + "flat.toml");
      Scene scene = scene_of(flat);
      scene.finger.load = c.touch.load;
      scene.drive.amplitude = 0;
      scene.finger.macro.load_share /= more ? 1.05 : 1;
      gap[more] = mean_estimate(picture_patch(scene, flat.texture, fidelity_of(flat),
                                              c.gap.relative_humidity, k)
                                    .fields.off.gap)
                      .value;
    }
    by_gaps += 0.05 * finger.patch_pressure(c.gap.relative_humidity) / (gap[0] - gap[1]) / 2;
  }
  EXPECT_NEAR(stiffness, by_gaps, 0.1 * by_gaps);
  EXPECT_NEAR(spots({"skin.resistivity=4e4 ohm m"}).spots / one.spots, 2, 1e-9);
  const DriveResult counted = spots({"gap.contact_spots=true"});
  EXPECT_NEAR(counted.network.gap.layer.resistance,
              1 / (1 / one.network.gap.layer.resistance + 1 / one.spots), 1e-9 * one.spots);
}

// The finger of the design, which has 0.2 N itself, presses with the load of the case.
TEST(DriveFile, TakesTheGapOfADesignAtItsOwnLoad) {
  const auto solved = [](const std::string& load) {
    return solve_drive(read_drive_case(
        kFingertip, {"gap.design=" + kSamples + "a3h350.toml", "gap.skins=1", "touch.load=" + load,
                     "drive.control=voltage", "drive.waveform=sine", "drive.amplitude=200 V",
                     "drive.frequency=5 kHz"}));
  };
  const DriveResult r = solved("0.2 N"), pressed = solved("1 N");
  EXPECT_GT(r.network.gap.distance, 50e-9);
  EXPECT_LT(r.network.gap.distance, 1e-6);
  EXPECT_GT(r.carrier.mean_force, 0);
  EXPECT_NEAR(r.area, 0.00728 * 45e-6 * (1 + 0.585 * 2 / 3), 1e-9);
  EXPECT_NEAR(pressed.area, std::pow(5, 0.52) * r.area, 1e-6 * r.area);
  EXPECT_LT(pressed.network.gap.distance, r.network.gap.distance);
  EXPECT_LT(pressed.spots, r.spots);
  // A deeper, wider array opens the gap.
  const DriveResult deep = solve_drive(
      read_drive_case(kFingertip, {"gap.design=" + kSamples + "a4h600.toml", "gap.skins=1"}));
  EXPECT_GT(deep.network.gap.distance, pressed.network.gap.distance);
  EXPECT_THROW(
      read_drive_case(kFingertip, {"gap.design=" + kSamples + "a4h600.toml", "touch.load=0 N"}),
      InputError);
}

TEST(DriveFile, DirectCurrentHoldsTheResistiveShare) {
  const DriveResult r = solve_drive(read_drive_case(
      kFingertip, {"drive.control=voltage", "drive.waveform=dc", "drive.amplitude=100 V",
                   "surface.dielectric.0.resistivity=5e6 ohm m"}));
  const Network& n = r.network;
  const double share = n.gap.layer.resistance /
                       (n.gap.layer.resistance + n.dielectric.resistance + n.skin.resistance);
  EXPECT_NEAR(r.carrier.gap_voltage, 100 * share, 1e-9);
  EXPECT_NEAR(r.series.mean_force, n.gap.force_factor * square(100 * share), 1e-9);
}

TEST(DriveFile, MistakesAreNamedWithTheirPlace) {
  EXPECT_THROW(read_drive_case(kFingertip, {"drive.current=0 mA"}), InputError);
  EXPECT_THROW(read_drive_case(kFingertip, {"tones.amplitude=[0.5]"}), InputError);
  EXPECT_THROW(read_drive_case(kFingertip, {"tones.amplitude=[0.5, 0.5, 0.5]"}), InputError);
  EXPECT_THROW(read_drive_case(kFingertip, {"tones.frequency=[\"30 kHz\"]"}), InputError);
  EXPECT_THROW(solve_drive(read_drive_case(kFingertip, {"tones.frequency=[\"9.99713 Hz\"]"})),
               InputError);
}

TEST(DriveFile, WritesTablesAndAPicture) {
  const DriveCase c = read_drive_case(kFingertip);
  const DriveResult r = solve_drive(c);
  const std::string svg = drive_svg(c, r);
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const std::string csv = drive_series_csv(r);
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            r.friction.value.size() + 1);
}

// Lines reach four times the carrier, or the end of a chirp, and no further.
TEST(DriveFile, LinesAreListedUpToFourTimesTheCarrier) {
  const std::vector<std::string> sine{"drive.control=voltage", "drive.waveform=square",
                                      "drive.amplitude=100 V", "drive.frequency=100 Hz",
                                      "tones.frequency=[]"};
  const auto highest = [](const std::vector<std::string>& overrides) {
    double out = 0;
    for (const SpectrumLine& line : solve_drive(read_drive_case(kFingertip, overrides)).lines)
      out = std::max(out, line.frequency);
    return out;
  };
  EXPECT_NEAR(highest(sine), 400, 1e-6);
  std::vector<std::string> chirp = sine;
  chirp[1] = "drive.waveform=sine";
  chirp.insert(chirp.end(), {"source.chirp_to=500 Hz", "source.chirp_time=100 ms"});
  EXPECT_NEAR(highest(chirp), 2000, 1e-6);
}

// The first sample counts: stuck for a millisecond, then too light a touch.
TEST(DriveFile, ASwipeBeginsWithItsFirstSample) {
  StictionOptions options;
  options.stuck_current = 4e-3;
  const Swipe swipe = run_swipe("lateral,normal\n0,0.5\n0,0.01\n0,0.01\n", "f.csv", options, 0);
  ASSERT_EQ(swipe.steps.size(), 2u);
  EXPECT_EQ(swipe.steps[0].time, 0);
  EXPECT_EQ(swipe.steps[0].state, SlipState::Stuck);
  EXPECT_EQ(swipe.steps[0].current, 4e-3);
  EXPECT_DOUBLE_EQ(swipe.steps[1].time, 1e-3);
  EXPECT_EQ(swipe.steps[1].state, SlipState::Idle);
  EXPECT_EQ(swipe.steps[1].current, 0);
  EXPECT_DOUBLE_EQ(swipe.driven, 1e-3);
  EXPECT_DOUBLE_EQ(swipe.duration, 3e-3);
  SwipeSettings shares;
  shares.stuck = 0.5, shares.partial = 0.25, shares.full = 0.125;
  EXPECT_EQ(shares.machine(8e-3).stuck_current, 4e-3);
  EXPECT_EQ(shares.machine(8e-3).partial_current, 2e-3);
  EXPECT_EQ(shares.machine(8e-3).full_current, 1e-3);
}

// Layer by layer: films by their thickness over permittivity, skin by its corner, the gap by the
// mean over its pixels (Eq. drive.3).
TEST(DriveFile, TheNetworkOfADesignIsThatOfItsLayers) {
  const std::string file = kSamples + "a3h350.toml";
  const DriveCase c = read_drive_case(
      kFingertip, {"gap.design=" + file, "gap.skins=2", "gap.resistivity=1e8 ohm m"});
  const DriveResult r = solve_drive(c);
  const Design d = read_design(file);
  const double rh = c.gap.relative_humidity;
  const double film = d.surface.equivalent_thickness(),
               skin = d.finger.electrical.equivalent_thickness(rh);
  EXPECT_NEAR(r.network.dielectric.capacitance, kVacuumPermittivity * r.area / film,
              1e-9 * r.network.dielectric.capacitance);
  EXPECT_NEAR(r.network.skin.capacitance, kVacuumPermittivity * r.area / skin,
              1e-9 * r.network.skin.capacitance);
  EXPECT_NEAR(r.network.skin.corner_frequency(), d.finger.electrical.corner_frequency,
              1e-9 * d.finger.electrical.corner_frequency);
  double inverse = 0, inverse_square = 0, count = 0;
  for (int k = 0; k < 2; ++k) {
    Scene scene = scene_of(d);
    scene.finger.load = c.touch.load;
    scene.drive.amplitude = 0;
    for (double g : picture_patch(scene, d.texture, fidelity_of(d), rh, k).fields.off.gap) {
      inverse += 1 / (std::max(g, 0.0) + film + skin);
      inverse_square += 1 / square(std::max(g, 0.0) + film + skin);
      ++count;
    }
  }
  const double distance = count / inverse - film - skin;
  EXPECT_NEAR(r.network.gap.distance, distance, 1e-6 * distance);
  EXPECT_NEAR(r.network.gap.layer.resistance, 1e8 * distance / r.area,
              1e-6 * r.network.gap.layer.resistance);
  EXPECT_NEAR(r.network.gap.force_factor,
              0.5 * kVacuumPermittivity * r.area * inverse_square / count *
                  square(1 + (film + skin) / distance),
              1e-6 * r.network.gap.force_factor);
}

// The file of a design of few pixels.
std::string few_pixels(const std::string& name, const std::string& touching) {
  const std::string path = temporary(name);
  write_bytes(path,
              "schema_version = 1\n[texture]\ntype = \"flat\"\n[surface]\n"
              "dielectric = [{ thickness = \"500 nm\", permittivity = 3.9 }]\n"
              "[accuracy]\nlevel = \"draft\"\ngrid = 32\n" +
                  touching);
  return path;
}
DriveCase gap_of(const std::string& design) {
  return read_drive_case(kFingertip, {"gap.design=" + design, "gap.skins=1"});
}

// By every closure: of the ridges' patches that touch, where they share the load.
TEST(DriveFile, TheAreaOfADesignCarriesTheLoadAtThePressureOfItsPatches) {
  for (const char* closure : {"uniform", "persson", "balance"}) {
    const std::string path =
        few_pixels("closure.toml", std::string("[model]\nclosure = \"") + closure + "\"\n");
    DriveCase c = gap_of(path);
    c.gap.contact_spots = true;
    const DriveResult r = solve_drive(c);
    const Design design = read_design(path);
    Scene scene = scene_of(design);
    scene.finger.load = 1;
    const double rh = c.gap.relative_humidity;
    const PatchPicture patch = picture_patch(scene, design.texture, fidelity_of(design), rh);
    EXPECT_NEAR(r.area * patch.pressure, 1, 1e-9) << closure;
    EXPECT_GT(r.spots, 0) << closure;
    EXPECT_GT(r.network.gap.layer.resistance, 0) << closure;
    EXPECT_LE(r.network.gap.layer.resistance, r.spots) << closure;
    EXPECT_GT(r.carrier.mean_force, 0) << closure;
  }
}

// A smooth pin leaves no gap, and no pin has the spots of skin.
TEST(DriveFile, WhatAPinHasNotIsRefused) {
  const std::string pin =
      "[environment]\nrelative_humidity = [\"50 %\"]\n[counterface]\ntype = \"pin\"\n"
      "load = \"1 N\"\nmodulus = \"1 GPa\"\npoisson = 0.3\ncoefficient = 0.2\nface = "
      "\"flat\"\narea = \"1 mm2\"\n";
  const auto refused = [](const DriveCase& c) { return refusal_of([&] { solve_drive(c); }); };
  EXPECT_NE(refused(gap_of(few_pixels("smooth_pin.toml", pin))).find("touch everywhere"),
            std::string::npos);
  DriveCase rough = gap_of(few_pixels("rough_pin.toml", pin + "roughness = { rms = \"1 um\" }\n"));
  EXPECT_EQ(solve_drive(rough).spots, 0);
  rough.gap.contact_spots = true;
  EXPECT_NE(refused(rough).find("a pin has none"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::drive_test
