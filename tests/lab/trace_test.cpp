// Records of a tribometer whose friction is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "lab/trace_reading.h"
#include "report/lab_trace.h"
#include "tests/lab/tribometer.h"
#include "tests/support/refusal.h"

namespace papilla::tests::trace_test {
namespace {

TraceReading read(const std::string& text) {
  const Trace trace = read_trace(text, "record.csv");
  return read_friction_of(trace, find_sliding(trace), "record.csv");
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& n : notes) {
    if (n.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(Record, GivesFrictionOffAndOnInsideItsErrors) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Tribometer t;
    t.seed = seed;
    const TraceReading r = read(t.record());
    EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
    EXPECT_NEAR(r.on, t.on, 0.01 * t.on);
    EXPECT_NEAR(r.load, t.load, 1e-3);
    EXPECT_NEAR(*r.relative_humidity, t.humidity, 1e-4);
    EXPECT_NEAR(r.voltage, t.voltage, 0.05 * t.voltage);
    EXPECT_LT(r.off_sd, 0.01 * t.off);
    inside += std::abs(r.off - t.off) < 2 * r.off_sd && std::abs(r.on - t.on) < 2 * r.on_sd;
  }
  EXPECT_GE(inside, 7);
}

TEST(Record, PartsDriftOfTheZeroFromThatOfTheFriction) {
  Tribometer t;
  t.zero = 0.05;
  t.zero_drift = 0.06;
  t.drift = 0.2;
  const TraceReading r = read(t.record());
  EXPECT_NEAR(r.off, t.off, 0.02 * t.off);
  EXPECT_NEAR(r.zero_drift, t.zero_drift, 0.05 * t.zero_drift);
  EXPECT_NEAR(r.drift, t.drift, 0.1 * t.drift);
  EXPECT_TRUE(says(r.notes, "the zero of the force drifts by 6"));
  EXPECT_TRUE(says(r.notes, "friction drifts by +"));
}

// The drive is on in every stroke forth and off in every stroke back.
Tribometer driven_forth() {
  Tribometer t;
  t.drive_period = 2 * t.stroke;
  t.zero = 0.003;
  t.zero_drift = 0;
  return t;
}

// Half a second after the strokes, at which the finger is off the surface.
std::string with_lifted_finger(const Tribometer& t) {
  std::string out = t.record();
  for (int i = 0; i < t.rate / 2; ++i)
    out += fmt::format("{:.6f},{},0,0,35,0\n", t.strokes * t.stroke + i / t.rate, t.zero);
  return out;
}

TEST(Record, IsRefusedWhereTheDriveIsOnInOneDirectionAlone) {
  EXPECT_EQ(refusal_of([] { read(driven_forth().record()); }),
            "record.csv: its strokes do not part friction from the zero of the force, as where the "
            "drive is on in one direction alone: record strokes of both directions with the drive "
            "on and with it off, or a part without touch");
}

TEST(Record, OfADriveInOneDirectionTakesTheZeroFromWhereNothingTouches) {
  const Tribometer t = driven_forth();
  const TraceReading r = read(with_lifted_finger(t));
  EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
  EXPECT_NEAR(r.on, t.on, 0.01 * t.on);
  EXPECT_TRUE(says(r.notes, "the zero of the force, 3 mN, is that before and after the touch"));
}

TEST(Record, FollowsTheDriveWithItsLag) {
  Tribometer t;
  t.lag = 0.1;
  const TraceReading r = read(t.record());
  EXPECT_NEAR(r.lag, t.lag, 0.03);
  EXPECT_NEAR(r.on, t.on, 0.01 * t.on);
  EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
}

TEST(Record, MarksStickSlipAndTakesItsMean) {
  Tribometer t;
  t.on = 0;
  t.slip = 0.03;
  const Trace trace = read_trace(t.record(), "record.csv");
  const Sliding sliding = find_sliding(trace);
  int sticks = 0;
  for (const Stroke& s : sliding.strokes) sticks += s.sticks();
  EXPECT_EQ(sticks, t.strokes);
  EXPECT_NEAR(sliding.strokes.front().slip, t.slip, 0.25 * t.slip);
  const TraceReading r = read_friction_of(trace, sliding, "record.csv");
  EXPECT_NEAR(r.off, t.off, 0.03 * t.off);
  EXPECT_TRUE(says(r.notes, "stick-slip in 12 of 12 strokes"));
  t.slip = 0;
  for (const Stroke& s : find_sliding(read_trace(t.record(), "")).strokes) EXPECT_FALSE(s.sticks());
}

TEST(Record, FindsTheOnsetWhereTheForceHasTurnedRound) {
  Tribometer t;
  t.on = 0;
  const Sliding sliding = find_sliding(read_trace(t.record(), ""));
  ASSERT_EQ(static_cast<int>(sliding.strokes.size()), t.strokes);
  for (const Stroke& s : sliding.strokes) {
    const double share =
        static_cast<double>(s.onset - s.all.begin) / static_cast<double>(s.all.size());
    EXPECT_LT(share, 0.05);
    EXPECT_GT(s.steady.size(), s.all.size() * 7 / 10);
  }
}

// The force itself never turns; the position does, whichever way it counts.
TEST(Record, GivesFrictionBelowTheZeroOfItsSensor) {
  Tribometer t;
  t.off = 0.08;
  t.on = 0.11;
  t.zero = 0.16;
  for (const int sense : {1, -1}) {
    Trace trace = read_trace(t.record(), "record.csv");
    for (double& x : trace.position) x *= sense;
    const Sliding sliding = find_sliding(trace);
    ASSERT_EQ(static_cast<int>(sliding.strokes.size()), t.strokes);
    for (std::size_t k = 0; k < sliding.strokes.size(); ++k) {
      const Stroke& s = sliding.strokes[k];
      EXPECT_EQ(s.direction, k % 2 == 0 ? 1 : -1);
      EXPECT_GT(s.steady.size(), s.all.size() * 7 / 10);
    }
    const TraceReading r = read_friction_of(trace, sliding, "record.csv");
    EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
    EXPECT_NEAR(r.on, t.on, 0.01 * t.on);
    EXPECT_FALSE(says(r.notes, "is taken as it is"));
  }
}

// At 10 kHz, strokes of 2 s with 50 mN; under a carrier of 1 kHz and 100 V 60 mN.
Trace record_with_carrier(int samples, double drive_begins) {
  Trace t;
  RandomStream random(1, "record with a carrier");
  for (int i = 0; i < samples; ++i) {
    const int direction = (i / 20000) % 2 == 0 ? 1 : -1;
    const double since = (i % 20000) / 1e4;  // of the stroke [s]
    const bool on = since >= drive_begins;
    t.time.push_back(i / 1e4);
    t.tangential.push_back(direction * (on ? 0.06 : 0.05) * (1 - std::exp(-since / 0.02)) +
                           2e-4 * random.normal());
    t.normal.push_back(0.2);
    t.voltage.push_back(on ? 100 * std::sin(2 * kPi * i / 10 + 0.5) : 0);
    t.position.push_back(0.01 * (direction > 0 ? since : 2 - since));
  }
  return t;
}

TEST(Record, KeepsFrictionBeforeTheDriveComesOnLateInEveryStroke) {
  const Trace trace = record_with_carrier(80000, 1);
  const TraceReading r = read_friction_of(trace, find_sliding(trace), "record.csv");
  EXPECT_NEAR(r.off, 0.05, 2e-4);
  EXPECT_NEAR(r.on, 0.06, 2e-4);
  EXPECT_FALSE(says(r.notes, "there is no modulation"));
}

TEST(Record, SaysWhetherItIsNeverWithoutTheDrive) {
  const auto notes = [](double drive_begins) {
    const Trace trace = record_with_carrier(80000, drive_begins);
    return read_friction_of(trace, find_sliding(trace), "record.csv").notes;
  };
  EXPECT_TRUE(says(notes(0), "never without the drive"));
  EXPECT_FALSE(says(notes(0.1), "never without the drive"));
  EXPECT_TRUE(says(notes(0.1), "no steady sliding without the drive"));
}

// Every 20th sample of it would be at one phase of the carrier: 48 V.
TEST(Record, SeesTheVoltageAtEveryPhaseOfItsCarrier) {
  EXPECT_NEAR(find_sliding(record_with_carrier(82000, 0)).voltage, 100, 2);
}

TEST(Record, SaysWhatItLeftOutAndAssumed) {
  Tribometer t;
  std::string text = t.record();
  // Times that are written too coarsely, a hole, a line that is cut.
  for (std::size_t at = text.find("\n3.000000"); at != std::string::npos;) {
    text.replace(at, 9, "\nx.000000");
    break;
  }
  text.resize(text.size() - 20);
  const TraceReading r = read(text);
  EXPECT_TRUE(says(r.notes, "1 sample without a number left out"));
  EXPECT_TRUE(says(r.notes, "the last line is cut off"));
  EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
}

TEST(Record, SpreadsTimesThatAreWrittenTooCoarsely) {
  Tribometer t;
  std::string coarse, text = t.record();
  std::size_t from = 0;
  for (std::size_t end; (end = text.find('\n', from)) != std::string::npos; from = end + 1) {
    std::string line = text.substr(from, end - from);
    if (const std::size_t dot = line.find('.'); from > 0 && dot != std::string::npos)
      line.erase(dot + 3, 4);  // hundredths of a second at a thousand samples
    coarse += line + "\n";
  }
  const TraceReading r = read(coarse);
  EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
  EXPECT_TRUE(says(r.notes, "share their time with the one before"));
}

TEST(Record, IsRefusedWhereNothingSlidesSteadily) {
  Tribometer t;
  t.rate = 15;  // thirty samples a stroke
  EXPECT_NE(refusal_of([&] { read(t.record()); }).find("sample faster, or make longer strokes"),
            std::string::npos);
}

// A sensor that counts what pulls as positive.
TEST(Record, IsRefusedWhereTheFingerPressesWithLessThanNothing) {
  Tribometer t;
  t.strokes = 2;
  t.load = -0.2;
  const std::string pulls = t.record();
  EXPECT_NE(refusal_of([&] { read(pulls); }).find("turn its sign"), std::string::npos);
  // A spike is no sign: of the record's last line, by ten times the load.
  t.load = 0.2;
  const std::string text = t.record();
  EXPECT_EQ(refusal_of([&] { read_trace(text + "99,0.1,-2,0,35,0\n", "r.csv"); }), "");
}

TEST(Record, IsRefusedForWrongUnitsAndDamage) {
  Tribometer t;
  t.strokes = 2;
  const std::string text = t.record();
  const auto with_header = [&](const std::string& header) {
    return header + text.substr(text.find('\n'));
  };
  EXPECT_NE(refusal_of([&] {
              read(
                  with_header("time_s,tangential_kg,normal_N,voltage_V,humidity_percent,"
                              "position_mm"));
            }).find("\"kg\" is no unit of a force; write tangential_N"),
            std::string::npos);
  EXPECT_NE(
      refusal_of([&] {
        read(with_header("time_s,tangential,normal_N,voltage_V,humidity_percent,position_mm"));
      }).find("a column without a unit: write tangential_N"),
      std::string::npos);
  EXPECT_NE(refusal_of([&] { read("time_s,tangential_N\n0,1\n"); }).find("normal"),
            std::string::npos);
  std::string broken = text;
  for (std::size_t i = 200; i < broken.size(); i += 300) broken[i] = '?';
  EXPECT_NE(refusal_of([&] { read(broken); }).find("the file is damaged"), std::string::npos);
  EXPECT_NE(refusal_of([&] { read(text + text.substr(text.find('\n') + 1)); }).find("falls after"),
            std::string::npos);
}

TEST(Record, SaysItsHeadInLettersOfAnySize) {
  const Trace trace = read_trace(Tribometer().record("# Humidity: 75 %\n# STATE = wet\n"), "r.csv");
  EXPECT_EQ(trace.said,
            (std::map<std::string, std::string>{{"humidity", "75 %"}, {"state", "wet"}}));
}

TEST(Record, TakesMillinewtonsAndSemicolons) {
  Tribometer t;
  t.strokes = 6;
  const TraceReading newtons = read(t.record());
  t.milliseconds = true;
  std::string text = t.record();
  const std::size_t head = text.find('\n');
  text = "time [ms];tangential [N];normal [N];voltage [V];humidity [%];position [mm]" +
         text.substr(head);
  std::replace(text.begin(), text.end(), ',', ';');
  const TraceReading r = read(text);
  EXPECT_NEAR(r.off, newtons.off, 0.02 * newtons.off);
}

// Linear in the samples, whatever else the machine does: the quickest of three runs of each, in
// turn, as other work only adds. A million take one to two seconds.
TEST(Record, OfFourTimesAsManySamplesTakesFourTimesAsLong) {
  Tribometer t;
  t.strokes = 20;
  const auto seconds_of = [&](const std::string& text, std::size_t samples) {
    const std::clock_t begin = std::clock();
    const Trace trace = read_trace(text, "record.csv");
    EXPECT_EQ(trace.size(), samples);
    const Sliding sliding = find_sliding(trace);
    const TraceReading r = read_friction_of(trace, sliding, "record.csv");
    EXPECT_LT(trace_svg(trace, sliding, r, "record.csv").size(), 400000u);
    const std::clock_t end = std::clock();
    EXPECT_NEAR(r.off, t.off, 0.01 * t.off);
    return static_cast<double>(end - begin) / CLOCKS_PER_SEC;
  };
  t.rate = 2500;
  const std::string fewer = t.record();
  t.rate = 10000;
  const std::string more = t.record();
  double of_fewer = std::numeric_limits<double>::infinity(), of_more = of_fewer;
  for (int run = 0; run < 3; ++run) {
    of_fewer = std::min(of_fewer, seconds_of(fewer, 100000));
    of_more = std::min(of_more, seconds_of(more, 400000));
  }
  EXPECT_LT(of_more, 1.5 * 4 * of_fewer);
}

TEST(Record, IsDrawnWithItsPlateausAboutTheZeroOfItsSensor) {
  Tribometer t;
  t.off = 0.08;
  t.on = 0.11;
  t.zero = 0.16;
  const Trace trace = read_trace(t.record(), "record.csv");
  const Sliding sliding = find_sliding(trace);
  const TraceReading r = read_friction_of(trace, sliding, "");
  EXPECT_NEAR(r.zero, t.zero + t.zero_drift / 2, 1e-3);
  const std::string svg = trace_svg(trace, sliding, r, "record");
  const double top = 62, bottom = 212;  // of the first panel
  int dashes = 0;
  for (std::size_t at = 0; (at = svg.find("stroke-dasharray", at)) != std::string::npos; ++at) {
    const double y = std::stod(svg.substr(svg.find(' ', svg.rfind('M', at)) + 1));
    EXPECT_GT(y, top);
    EXPECT_LT(y, bottom);
    ++dashes;
  }
  EXPECT_EQ(dashes, 2 * t.strokes);
}

TEST(Record, IsDrawnWithWhatWasFound) {
  Tribometer t;
  t.strokes = 4;
  const Trace trace = read_trace(t.record(), "record.csv");
  const Sliding sliding = find_sliding(trace);
  const std::string svg =
      trace_svg(trace, sliding, read_friction_of(trace, sliding, ""), "E01 <run & 2>");
  EXPECT_NE(svg.find("E01 &lt;run &amp; 2>"), std::string::npos);
  std::size_t steady = 0, onsets = 0;
  for (std::size_t at = 0; (at = svg.find("#dff0de", at)) != std::string::npos; ++at) ++steady;
  for (std::size_t at = 0; (at = svg.find("#c0392b", at)) != std::string::npos; ++at) ++onsets;
  EXPECT_EQ(steady, 4u * 3u);  // in each of three panels
  EXPECT_EQ(onsets, 4u);
}

}  // namespace
}  // namespace papilla::tests::trace_test
