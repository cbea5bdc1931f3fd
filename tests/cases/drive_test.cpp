#include "cases/drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "report/drive.h"

namespace papilla::tests {
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
  ASSERT_EQ(r.checks.size(), 3u);
  EXPECT_FALSE(r.checks[0].passes());  // body current
  EXPECT_FALSE(r.checks[1].passes());  // source voltage
  EXPECT_TRUE(r.checks[2].passes());
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
  const Swipe swipe = run_swipe(csv, "forces.csv", options);
  ASSERT_EQ(swipe.steps.size(), 4u);
  EXPECT_EQ(swipe.steps[0].state, SlipState::Stuck);
  EXPECT_EQ(swipe.steps[1].state, SlipState::Partial);
  EXPECT_EQ(swipe.steps[2].state, SlipState::Full);
  EXPECT_EQ(swipe.steps[2].current, 0);
  EXPECT_NEAR(swipe.driven, swipe.steps[2].time + swipe.duration - swipe.steps[3].time, 2e-3);
  EXPECT_THROW(run_swipe("1,2\n1;2\n", "forces.csv", options), InputError);
}

TEST(DriveFile, TakesTheGapOfADesign) {
  const DriveResult r = solve_drive(read_drive_case(
      kFingertip, {"gap.design=" + kSamples + "a3h350.toml", "gap.skins=1", "drive.control=voltage",
                   "drive.waveform=sine", "drive.amplitude=200 V", "drive.frequency=5 kHz"}));
  EXPECT_GT(r.network.gap.distance, 50e-9);
  EXPECT_LT(r.network.gap.distance, 1e-6);
  EXPECT_GT(r.carrier.mean_force, 0);
  EXPECT_NEAR(r.area, 0.0063 * 45e-6 * (1 + 0.585 * 2 / 3), 1e-9);
  // A deeper, wider array opens the gap.
  const DriveResult deep = solve_drive(
      read_drive_case(kFingertip, {"gap.design=" + kSamples + "a4h600.toml", "gap.skins=1"}));
  EXPECT_GT(deep.network.gap.distance, r.network.gap.distance);
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

}  // namespace
}  // namespace papilla::tests
