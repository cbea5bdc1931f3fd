// Recordings: which lines are numbers, which steps are even, and what lies between the rows.
#include <fmt/format.h>
#include <gtest/gtest.h>

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
std::string of_rows(const std::string& csv) {
  return refusal([&] { number_rows(csv, "f.csv", "time", "times"); });
}
using Rows = std::vector<std::vector<double>>;

TEST(Recordings, AreLinesOfNumbersBelowAHead) {
  EXPECT_EQ(number_rows("time,x\r\n1,2\r\n\n-3e-1,4.5\n", "f.csv", "time", ""),
            (Rows{{1, 2}, {-0.3, 4.5}}));
  EXPECT_EQ(number_rows("1,2,3\n4,5,6\n", "f.csv", "time", ""), (Rows{{1, 2, 3}, {4, 5, 6}}));
  // Two heads are a head and no line of numbers, but nothing that is measured.
  EXPECT_EQ(number_rows("time,a\ntime,b\n1,2\n3,4\n", "f.csv", "time", ""), (Rows{{1, 2}, {3, 4}}));
}

TEST(Recordings, TellWhichLineIsNone) {
  EXPECT_EQ(of_rows("a,b\n1,2\n3,4\n"), "f.csv:1:1: expected times, got \"a,b\"");
  EXPECT_EQ(of_rows("time\n1,2\n3,4\n"), "f.csv:1:1: expected times, got \"time\"");
  EXPECT_EQ(of_rows("time,b\n\n1,2\ntime,4\n"), "f.csv:4:1: expected times, got \"time,4\"");
  EXPECT_EQ(of_rows("1,2\n3,4,5\n"), "f.csv:2:1: expected times, got \"3,4,5\"");
  EXPECT_EQ(of_rows("1\n2\n"), "f.csv:1:1: expected times, got \"1\"");
  EXPECT_EQ(of_rows("1,2\n3,inf\n"), "f.csv:2:1: expected times, got \"3,inf\"");
  EXPECT_EQ(of_rows("1,2\n3,4x\n"), "f.csv:2:1: expected times, got \"3,4x\"");
  EXPECT_EQ(of_rows("1;2\n"),
            "f.csv:1:1: expected times, got \"1;2\"; the separator is a comma, decimals a point");
  EXPECT_EQ(of_rows("time,x\n1,2\n"), "f.csv:1:1: expected two lines of times or more");
  EXPECT_EQ(of_rows("1,2\n3,4\n"), "");
}

// The mean step is even where no step is off by more than a hundredth of it.
TEST(Recordings, AStepMayBeOffByAHundredth) {
  EXPECT_DOUBLE_EQ(even_step({{1, 0}, {1.5, 0}, {2, 0}}, "f"), 0.5);
  EXPECT_DOUBLE_EQ(even_step({{0, 0}, {0.991, 0}, {2, 0}, {3, 0}}, "f"), 1);
  EXPECT_EQ(refusal([] {
              even_step({{0, 0}, {1, 0}, {1.985, 0}, {3, 0}}, "f.csv");
            }),
            "f.csv:3:1: expected even steps of time, got 0.985 s among steps of 1 s");
  EXPECT_EQ(refusal([] {
              even_step({{0, 0}, {1.015, 0}, {2, 0}, {3, 0}}, "f.csv");
            }),
            "f.csv:2:1: expected even steps of time, got 1.015 s among steps of 1 s");
  EXPECT_EQ(refusal([] {
              even_step({{1, 0}, {1, 0}}, "f.csv");
            }),
            "f.csv:2:1: expected even steps of time, got 0 s among steps of 0 s");
  EXPECT_NE(refusal([] { even_step({{3, 0}, {2, 0}, {1, 0}}, "f.csv"); }), "");
}

// Three rows half a second apart repeat after a second and a half; four samples lie at 0, 3/4, 3/2
// and 9/4 of a row.
TEST(Recordings, AreOnePeriodStraightBetweenTheirRows) {
  const Signal s = recorded_signal("time,V\n1,10\n1.5,20\n2,-20\n", "f.csv");
  EXPECT_DOUBLE_EQ(s.period, 1.5);
  ASSERT_EQ(s.value.size(), 4u);
  EXPECT_DOUBLE_EQ(s.value[0], 10);
  EXPECT_DOUBLE_EQ(s.value[1], 17.5);
  EXPECT_DOUBLE_EQ(s.value[2], 0);
  EXPECT_DOUBLE_EQ(s.value[3], -12.5);  // a quarter of the way back to the first
  EXPECT_EQ(recorded_signal("0,1\n1,2\n2,3\n3,5\n", "f.csv").value,
            (std::vector<double>{1, 2, 3, 5}));
  EXPECT_EQ(refusal([] { recorded_signal("0,1,2\n1,2,3\n", "f.csv"); }),
            "f.csv:1:1: expected \"time,value\" in s and V or A");
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
  EXPECT_EQ(refusal([] { run_swipe("0,0,1,1\n1,0,1,1\n", "f.csv", driven(), 0); }),
            "f.csv:1:1: expected \"lateral,normal\" in N, or \"time,lateral,normal\"");
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

}  // namespace
}  // namespace papilla::tests::recordings_test
