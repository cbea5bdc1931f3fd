// Recordings: which lines are numbers, which steps are even, and what lies between the rows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "cases/drive.h"
#include "cases/recording.h"

namespace papilla::tests::recordings_test {
namespace {

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 1u);
    return error.problems().front().text();
  }
  return "";
}
const RecordedColumns kColumns{
    {{"time", "s", false, {"t"}}, {"width", "m", false, {}}, {"load", "N", false, {}}},
    true,
    "widths"};
Recording recorded(const std::string& csv) { return read_recording(csv, "f.csv", kColumns); }
std::string of_rows(const std::string& csv) {
  return refusal([&] { recorded(csv); });
}
using Rows = std::vector<std::vector<double>>;

TEST(Recordings, AreLinesOfNumbersBelowAHead) {
  EXPECT_EQ(recorded("width,load\r\n1,2\r\n\n-3e-1,4.5\n").rows, (Rows{{1, 2}, {-0.3, 4.5}}));
  EXPECT_EQ(recorded("width,load\r\n1,2\r\n\n-3e-1,4.5\n").lines, (std::vector<int>{2, 4}));
  EXPECT_EQ(recorded("1,2,3\n4,5,6\n").rows, (Rows{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(recorded("\n1,2\n4,5\n").lines, (std::vector<int>{2, 3}));
}

TEST(Recordings, HaveTheOrderAndTheUnitsOfTheirHead) {
  const Rows rows{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(recorded("time,width,load\n1,2,3\n4,5,6\n").rows, rows);
  EXPECT_EQ(recorded("load,time,width\n3,1,2\n6,4,5\n").rows, rows);
  EXPECT_EQ(recorded("load [N],t_s,\"width (m)\"\n3,1,2\n6,4,5\n").rows, rows);
  EXPECT_EQ(recorded("\xEF\xBB\xBFload_kN,width_km\n3,2\n6,5\n").rows,
            (Rows{{2000, 3000}, {5000, 6000}}));
  EXPECT_EQ(of_rows("time,width,lod\n1,2,3\n4,5,6\n"),
            "f.csv:1:1: no column here: lod; expected widths, got \"time,width,lod\"");
  EXPECT_EQ(of_rows("\ntime,width\n1,2\n4,5\n"),
            "f.csv:2:1: no column of load; expected widths, got \"time,width\"");
  EXPECT_EQ(of_rows("width,width_m,load\n1,2,3\n4,5,6\n"),
            "f.csv:1:1: two columns of width; expected widths, got \"width,width_m,load\"");
  EXPECT_EQ(of_rows("width_V,load\n1,2\n4,5\n"),
            "f.csv:1:1: width_V: \"V\" is no unit of a length; write width_m; expected widths, got "
            "\"width_V,load\"");
}

TEST(Recordings, TellWhichLineIsNone) {
  EXPECT_EQ(of_rows("a,b\n1,2\n3,4\n"), "f.csv:1:1: expected widths, got \"a,b\"");
  EXPECT_EQ(of_rows("time\n1,2\n3,4\n"),
            "f.csv:1:1: no column of width; expected widths, got \"time\"");
  EXPECT_EQ(of_rows("width,load\n\n1,2\nwidth,4\n"), "f.csv:4:1: expected widths, got \"width,4\"");
  EXPECT_EQ(of_rows("1,2\n3,4,5\n"), "f.csv:2:1: expected widths, got \"3,4,5\"");
  EXPECT_EQ(of_rows("1\n2\n"), "f.csv:1:1: expected widths, got \"1\"");
  EXPECT_EQ(of_rows("1,2\n3,inf\n"), "f.csv:2:1: expected widths, got \"3,inf\"");
  EXPECT_EQ(of_rows("1,2\n3,4x\n"), "f.csv:2:1: expected widths, got \"3,4x\"");
  EXPECT_EQ(of_rows("1;2\n"),
            "f.csv:1:1: expected widths, got \"1;2\"; the separator is a comma, decimals a point");
  EXPECT_EQ(of_rows("width,load\n1,2\n"), "f.csv:1:1: expected two lines of widths or more");
  EXPECT_EQ(of_rows("1,2\n3,4\n"), "");
}

// The mean step is even where no step is off by more than a hundredth of it.
TEST(Recordings, AStepMayBeOffByAHundredth) {
  const auto step = [](const std::vector<double>& times) {
    std::string csv;
    for (const double time : times) csv += fmt::format("{},0,0\n", time);
    return even_step(recorded(csv), "f.csv");
  };
  EXPECT_DOUBLE_EQ(step({1, 1.5, 2}), 0.5);
  EXPECT_DOUBLE_EQ(step({0, 0.991, 2, 3}), 1);
  EXPECT_EQ(refusal([&] {
              step({0, 1, 1.985, 3});
            }),
            "f.csv:3:1: expected even steps of time, got 0.985 s among steps of 1 s");
  EXPECT_EQ(refusal([&] {
              step({0, 1.015, 2, 3});
            }),
            "f.csv:2:1: expected even steps of time, got 1.015 s among steps of 1 s");
  EXPECT_EQ(refusal([&] {
              step({1, 1});
            }),
            "f.csv:2:1: expected even steps of time, got 0 s among steps of 0 s");
  EXPECT_NE(refusal([&] { step({3, 2, 1}); }), "");
}

// Its own line of the file, below a head and lines without anything.
TEST(Recordings, NameTheLineOfAnUnevenStep) {
  EXPECT_EQ(refusal([] {
              even_step(recorded("time,width,load\n\n0,0,0\n1,0,0\n\n3,0,0\n4,0,0\n"), "f.csv");
            }),
            "f.csv:4:1: expected even steps of time, got 1 s among steps of 1.33333 s");
  EXPECT_EQ(refusal([] {
              recorded_signal("time,value\n0,1\n1,1\n2,1\n4,1\n", "f.csv", DriveControl::Voltage);
            }),
            "f.csv:3:1: expected even steps of time, got 1 s among steps of 1.33333 s");
}

// Three rows half a second apart repeat after a second and a half; four samples lie at 0, 3/4, 3/2
// and 9/4 of a row.
TEST(Recordings, AreOnePeriodStraightBetweenTheirRows) {
  const auto voltage = [](const std::string& csv) {
    return recorded_signal(csv, "f.csv", DriveControl::Voltage);
  };
  const Signal s = voltage("time,V\n1,10\n1.5,20\n2,-20\n");
  EXPECT_DOUBLE_EQ(s.period, 1.5);
  ASSERT_EQ(s.value.size(), 4u);
  EXPECT_DOUBLE_EQ(s.value[0], 10);
  EXPECT_DOUBLE_EQ(s.value[1], 17.5);
  EXPECT_DOUBLE_EQ(s.value[2], 0);
  EXPECT_DOUBLE_EQ(s.value[3], -12.5);  // a quarter of the way back to the first
  EXPECT_EQ(voltage("0,1\n1,2\n2,3\n3,5\n").value, (std::vector<double>{1, 2, 3, 5}));
  EXPECT_EQ(refusal([&] { voltage("0,1,2\n1,2,3\n"); }),
            "f.csv:1:1: expected \"time,value\" in s and V, got \"0,1,2\"");
}

// Microseconds and milliamperes, in either order, are the seconds and amperes of a bare head.
TEST(Recordings, OfASourceAreReadInTheirUnits) {
  const auto current = [](const std::string& csv) {
    return recorded_signal(csv, "f.csv", DriveControl::Current);
  };
  const std::string bare = "0,0.001\n1e-05,0.002\n2e-05,-0.003\n3e-05,0.004\n";
  const Signal expected = current("time,value\n" + bare);
  EXPECT_EQ(expected.value, current(bare).value);
  for (const char* csv : {"time_us,current_mA\n0,1\n10,2\n20,-3\n30,4\n",
                          "current [mA],time [us]\n1,0\n2,10\n-3,20\n4,30\n"}) {
    const Signal s = current(csv);
    EXPECT_DOUBLE_EQ(s.period, expected.period);
    ASSERT_EQ(s.value.size(), expected.value.size());
    for (std::size_t i = 0; i < s.value.size(); ++i)
      EXPECT_DOUBLE_EQ(s.value[i], expected.value[i]) << csv << i;
  }
  // A current is no voltage.
  EXPECT_EQ(refusal([] {
              recorded_signal("time_s,current_mA\n0,1\n1,2\n", "f.csv", DriveControl::Voltage);
            }),
            "f.csv:1:1: no column here: current_mA; expected \"time,value\" in s and V, got "
            "\"time_s,current_mA\"");
}

StictionOptions driven() {
  StictionOptions options;
  options.stuck_current = 4e-3;
  options.partial_current = 3e-3;
  options.full_current = 1e-3;
  return options;
}

// Ratios of 0, 0.05, 0.15, 0.19, 0.18, 0.17: stuck twice, still stuck while the rate is the
// largest, partial when it falls, full when it turns.
TEST(Recordings, OfForcesRunThroughTheStatesOfSlip) {
  const Swipe s = run_swipe("lateral,normal\n0,1\n0.1,2\n0.15,1\n0.19,1\n0.18,1\n0.17,1\n0,0.02\n",
                            "f", driven(), 150);
  ASSERT_EQ(s.steps.size(), 4u);
  const SlipState states[]{SlipState::Stuck, SlipState::Partial, SlipState::Full, SlipState::Idle};
  const double times[]{0, 3e-3, 4e-3, 6e-3}, currents[]{4e-3, 3e-3, 1e-3, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(s.steps[k].state, states[k]) << k;
    EXPECT_NEAR(s.steps[k].time, times[k], 1e-12);
    EXPECT_EQ(s.steps[k].current, currents[k]) << k;
  }
  EXPECT_NEAR(s.duration, 7e-3, 1e-12);
  EXPECT_NEAR(s.driven, 6e-3, 1e-12);
  EXPECT_TRUE(s.samples.empty());
}

TEST(Recordings, OfForcesAreReadInTheOrderAndUnitsOfTheirHead) {
  const auto same = [](const Swipe& a, const Swipe& b) {
    ASSERT_EQ(a.steps.size(), b.steps.size());
    for (std::size_t k = 0; k < a.steps.size(); ++k) {
      EXPECT_EQ(a.steps[k].state, b.steps[k].state) << k;
      EXPECT_EQ(a.steps[k].time, b.steps[k].time) << k;
    }
    EXPECT_EQ(a.duration, b.duration);
  };
  const auto swipe = [](const std::string& csv) { return run_swipe(csv, "f.csv", driven(), 0); };
  std::string plain, turned, milli, two = "normal_mN,lateral [N]\n", bare_two;
  for (int i = 0; i < 8; ++i) {
    const double lateral = std::min(0.06 * i, 0.2) + (i == 4 ? 0.01 : 0);
    plain += fmt::format("{},{},0.5\n", 1e-3 * i, lateral);
    turned += fmt::format("{},0.5,{}\n", 1e-3 * i, lateral);
    milli += fmt::format("{},{},500\n", i, 1e3 * lateral);
    two += fmt::format("500,{}\n", lateral);
    bare_two += fmt::format("{},0.5\n", lateral);
  }
  const Swipe expected = swipe("time,lateral,normal\n" + plain);
  EXPECT_GT(expected.steps.size(), 2u);
  same(swipe(plain), expected);
  same(swipe("time,normal,lateral\n" + turned), expected);
  same(swipe("time_ms,lateral_mN,normal_mN\n" + milli), expected);
  same(swipe(two), swipe(bare_two));
  EXPECT_EQ(refusal([&] { swipe("time,lateral,position\n" + plain); }),
            "f.csv:1:1: no column here: position; expected \"lateral,normal\" in N, or "
            "\"time,lateral,normal\" in s and N, got \"time,lateral,position\"");
  EXPECT_NE(refusal([&] { swipe("time,lateral\n" + bare_two); }), "");
}

// Taken every 2 ms, asked every 1 ms: the same swipe with its in-between values, of which the last
// row is one.
TEST(Recordings, WithTimesAreTakenAtTheMachinesSteps) {
  const Swipe every = run_swipe("0,0,1\n0.001,0.05,1\n0.002,0.1,1\n0.003,0.14,1\n0.004,0.18,1\n",
                                "f", driven(), 0),
              second = run_swipe("0,0,1\n0.002,0.1,1\n0.004,0.18,1\n", "f", driven(), 0);
  EXPECT_NEAR(every.duration, 5e-3, 1e-12);
  EXPECT_NEAR(second.duration, 5e-3, 1e-12);
  ASSERT_EQ(every.steps.size(), 2u);
  ASSERT_EQ(second.steps.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(every.steps[k].state, second.steps[k].state);
    EXPECT_EQ(every.steps[k].time, second.steps[k].time);
  }
  // The rate falls from 50 to 40 a second in the third step.
  EXPECT_NEAR(every.steps[1].time, 3e-3, 1e-12);
  // Loads are between their rows too: from 0.01 to 0.04 N the touch begins at 0.025 N, half way.
  const Swipe touched = run_swipe("0,0,0.01\n0.002,0,0.0401\n", "f", driven(), 0);
  ASSERT_EQ(touched.steps.size(), 2u);
  EXPECT_EQ(touched.steps[1].state, SlipState::Stuck);
  EXPECT_NEAR(touched.steps[1].time, 1e-3, 1e-12);
}

// A low-pass of 150 Hz needs more than 300 rows a second, one of 0 none.
TEST(Recordings, TakenTooSeldomForTheirFilterAreRefused) {
  const auto every = [](double step, double filter) {
    return refusal([&] {
      run_swipe(fmt::format("0,0,1\n{0:g},0,1\n{1:g},0,1\n", step, 2 * step), "f.csv", driven(),
                filter);
    });
  };
  EXPECT_EQ(every(4e-3, 150),
            "f.csv:1:1: taken every 4 ms, too seldom for a low-pass of 150 Hz: set swipe.filter "
            "below 125 Hz, or 0 where the forces are low-passed");
  EXPECT_EQ(every(4e-3, 124), "");
  EXPECT_NE(every(4e-3, 125), "");
  EXPECT_EQ(every(4e-3, 0), "");
  EXPECT_EQ(
      refusal([] { run_swipe("0,0,1,1\n1,0,1,1\n", "f.csv", driven(), 0); }),
      "f.csv:1:1: expected \"lateral,normal\" in N, or \"time,lateral,normal\" in s and N, got "
      "\"0,0,1,1\"");
}

// Both forces pass the filter: of a step in either, the filter's own answer is what counts.
TEST(Recordings, WithTimesPassTheFilter) {
  StictionOptions options = driven();
  options.minimum_load = 0.5;
  // The load falls from 1 to 0 N; Butterworth's low-pass falls to a half when?
  LowPass low(50, 1e-3);
  std::string csv;
  int fell = 0;
  for (int i = 0; i < 40; ++i) {
    csv += fmt::format("{:.3f},0,{}\n", 1e-3 * i, i < 10 ? 1 : 0);
    if (low(i < 10 ? 1 : 0) < 0.5 && fell == 0) fell = i;
  }
  const Swipe s = run_swipe(csv, "f", options, 50);
  ASSERT_EQ(s.steps.size(), 2u);
  EXPECT_GT(fell, 12);
  EXPECT_NEAR(s.steps[1].time, 1e-3 * fell, 1e-9);
  // The lateral force rises by 0.2 in 10 ms: it leaves the band of 0.1 later than it would.
  const auto left = [&](double filter) {
    std::string rising;
    for (int i = 0; i < 60; ++i)
      rising += fmt::format("{:.3f},{},1\n", 1e-3 * i, std::min(0.02 * std::max(0, i - 10), 0.2));
    return run_swipe(rising, "f", options, filter).steps.at(1).time;
  };
  EXPECT_NEAR(left(0), 20e-3 + 1e-3, 1e-9);  // level from 0.2 on
  EXPECT_GT(left(50), left(0));
}

// A swipe that is rendered: the finger's way and the pull of the carrier, as rub() has them.
TEST(Recordings, ARenderedSwipeIsThatOfItsFinger) {
  DriveCase c;
  c.drive.control = DriveControl::Current;
  c.drive.current = 5e-3;
  c.drive.frequency = 20e3;
  c.touch = {.load = 0.4, .coefficient = 0.3};
  c.swipe = {.stroke = 5e-3,
             .frequency = 3,
             .duration = 0.4,
             .stiffness = 900,
             .filter = 100,
             .stuck = 0.8,
             .partial = 0.6,
             .full = 0.2};
  Network network;
  network.gap = plane_gap(1e-6, 1, 1e7, 30e-6);
  const Swipe s = render_swipe(c, network);
  StictionOptions options;
  options.stuck_current = 4e-3;
  options.partial_current = 3e-3;
  options.full_current = 1e-3;
  RubbingFinger finger;
  finger.load = 0.4;
  finger.stroke = 5e-3;
  finger.frequency = 3;
  finger.duration = 0.4;
  finger.stiffness = 900;
  finger.filter = 100;
  const auto friction = [&](double frequency) {
    return [&network, frequency](double current) {
      const double gap_voltage = current * std::abs(network.gap.layer.impedance(frequency));
      return 0.3 * (0.4 + 0.5 * network.gap.force_factor * square(gap_voltage));
    };
  };
  const std::vector<RubbingSample> expected = rub(finger, options, friction(20e3));
  ASSERT_EQ(s.samples.size(), 400u);
  double driven = 0;
  std::size_t steps = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(s.samples[i].lateral, expected[i].lateral, 1e-9) << i;
    EXPECT_EQ(s.samples[i].state, expected[i].state) << i;
    EXPECT_NEAR(s.samples[i].current, expected[i].current, 1e-15) << i;
    if (expected[i].current > 0) driven += 1e-3;
    if (i > 0 && expected[i].state == expected[i - 1].state) continue;
    ASSERT_LT(steps, s.steps.size());
    EXPECT_EQ(s.steps[steps].time, expected[i].time);
    EXPECT_EQ(s.steps[steps].state, expected[i].state);
    EXPECT_NEAR(s.steps[steps].current, expected[i].current, 1e-15);
    ++steps;
  }
  EXPECT_EQ(s.steps.size(), steps);
  EXPECT_GT(steps, 4u);
  EXPECT_NEAR(s.driven, driven, 1e-9);
  EXPECT_EQ(s.duration, 0.4);
  // At 0 Hz the whole current is constant and crosses the gap's resistance.
  c.drive.waveform = Waveform::Dc;
  const Swipe dc = render_swipe(c, network);
  const double voltage = 4e-3 * 1e7;
  double most = 0;
  for (const RubbingSample& at : dc.samples) most = std::max(most, std::abs(at.lateral));
  EXPECT_GT(most, 0.9 * std::min(0.3 * network.gap.force_factor * square(voltage), 4.0));
}

// Under current the gap of a square wave has the voltage of a triangle, of a mean square of a
// third: pi^2/6 of the sine's pull.
TEST(Recordings, ARenderedSwipeHasTheCarrierOfItsDrive) {
  DriveCase c;
  c.drive.control = DriveControl::Current;
  c.drive.current = 4e-3;
  c.drive.frequency = 25e3;
  c.touch = {.load = 0.5, .coefficient = 0.2};
  c.swipe.full = 1;  // driven all along
  c.swipe.duration = 0.4;
  Network network;
  network.gap = plane_gap(1e-6, 1, kInfinity, 30e-6);
  const auto pull = [&] {  // at full slip
    double most = 0;
    const Swipe swipe = render_swipe(c, network);
    for (const RubbingSample& at : swipe.samples) most = std::max(most, std::abs(at.lateral));
    return most / c.touch.coefficient - c.touch.load;
  };
  const auto of_signal = [&](Waveform waveform) {
    const Signal cycle = source_signal(waveform, 4e-3, 25e3, {}, 1, 1 / 25e3, 4096);
    return force_series(network, DriveControl::Current, cycle).mean_force;
  };
  const double sine = pull();
  EXPECT_NEAR(sine, of_signal(Waveform::Sine), 1e-6 * sine);
  EXPECT_FALSE(render_swipe(c, network).without_tones);
  c.drive.waveform = Waveform::Square;
  EXPECT_NEAR(pull(), of_signal(Waveform::Square), 1e-6 * sine);
  EXPECT_NEAR(pull() / sine, square(kPi) / 6, 1e-3);
  // The machine's current is in the place of what tones make of the amplitude.
  c.drive.waveform = Waveform::Am;
  c.tones = {{10, 100}, {0.5, 0.5}};
  EXPECT_NEAR(pull(), sine, 1e-6 * sine);
  EXPECT_TRUE(render_swipe(c, network).without_tones);
}

// No carrier whose amplitude a machine could set.
TEST(Recordings, NoSwipeIsRenderedByARecordingOrAChirp) {
  DriveCase c;
  c.drive.control = DriveControl::Current;
  c.drive.current = 4e-3;
  Network network;
  network.gap = plane_gap(1e-6, 1, 1e7, 30e-6);
  EXPECT_EQ(refusal([&] { render_swipe(c, network); }), "");
  c.source.chirp_to = 30e3;
  EXPECT_NE(refusal([&] { render_swipe(c, network); }).find("source.chirp_to"), std::string::npos);
  c.source.chirp_to = 0;
  c.recording = {1e-3, {0, 4e-3, 0, -4e-3}};
  EXPECT_NE(refusal([&] { render_swipe(c, network); }).find("source.file"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::recordings_test
