#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/constants.h"
#include "physics/drive/network.h"
#include "physics/drive/signal.h"
#include "physics/drive/stiction.h"

namespace papilla::tests::drive_test {
namespace {

std::vector<std::vector<double>> table(const std::string& name) {
  std::ifstream file(std::string(PAPILLA_TEST_DATA) + "/drive/" + name);
  EXPECT_TRUE(file.good()) << name;
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0])) != 0)
      continue;
    std::vector<double> row;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) row.push_back(std::stod(cell));
    rows.push_back(row);
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

double relative(double a, double b) { return std::abs(a / b - 1); }

// Finger on coated glass of the impedance table.
Network table_network(double dielectric_resistance) {
  const double area = 30e-6;
  Network n;
  n.dielectric = {dielectric_resistance, kVacuumPermittivity * 3.9 * area / 1e-6};
  n.gap = plane_gap(1.1e-6, 1, 17e6, area);
  n.gap.layer.capacitance = 250e-12;
  n.skin = slab(200e-6, 2000, 2e4, area);
  return n;
}

TEST(Network, MatchesTheImpedanceTable) {
  const Network insulating = table_network(1e12), leaky = table_network(1e8);
  for (const auto& row : table("t41_impedance_force.csv")) {
    const double f = row[0];
    EXPECT_LT(relative(std::abs(insulating.gap.layer.impedance(f)), row[1]), 1e-4) << f;
    const auto peak = [&](const Network& n, DriveControl c, double amplitude) {
      const DriveResponse r = respond(n, c, amplitude, f);
      EXPECT_DOUBLE_EQ(r.mean_force, r.ripple);
      return r.mean_force + r.ripple;
    };
    EXPECT_LT(relative(peak(insulating, DriveControl::Voltage, 100), row[2]), 1e-3) << f;
    EXPECT_LT(relative(peak(leaky, DriveControl::Voltage, 100), row[3]), 1e-3) << f;
    EXPECT_LT(relative(peak(insulating, DriveControl::Current, 10e-6), row[4]), 1e-3) << f;
    const double ripple = 0.2 * respond(insulating, DriveControl::Current, 10e-6, f).ripple;
    EXPECT_LT(relative(ripple, row[5] * 1e-3), 1e-3) << f;
  }
}

// t40: the published numbers of Shultz et al. and what their own formulas give.
TEST(Network, PublishedNumbersComeOutOrAreSaidNotTo) {
  EXPECT_LT(relative(plane_gap(1e-6, 1, kInfinity, 1).force_factor * 1e4, 4.4271e4), 1e-4);
  const ImpedanceLayer gap{17e6, 250e-12};
  EXPECT_LT(relative(gap.corner_frequency(), 37.448), 1e-4);
  EXPECT_LT(relative(std::abs(gap.impedance(25e3)), 25465), 1e-4);
  EXPECT_LT(relative(4e-3 * std::abs(gap.impedance(25e3)), 101.9), 1e-3);
  EXPECT_LT(relative(kVacuumPermittivity * 30e-6 / 250e-12, 1.0625e-6), 1e-4);
  const double alpha = 0.2 * plane_gap(1.1e-6, 1, kInfinity, 30e-6).force_factor;
  EXPECT_LT(relative(alpha, 2.1953e-5), 1e-4);
  EXPECT_LT(relative(alpha * square(10e-6 * 17e6) / 2, 317.2e-3), 1e-3);
  EXPECT_LT(relative(alpha * square(101.86) / 2, 113.9e-3), 1e-3);
  // 7 N at 700 V on 32.17 mm2 is a gap of 3.157 um, not the printed 1.8 um, which would be 21.5 N.
  EXPECT_LT(relative(plane_gap(3.1574e-6, 1, kInfinity, 32.17e-6).force_factor * 700 * 700, 7),
            1e-3);
  EXPECT_LT(relative(plane_gap(1.8e-6, 1, kInfinity, 32.17e-6).force_factor * 700 * 700, 21.539),
            1e-3);
}

TEST(Network, LimitsAreResistiveAndCapacitiveDividers) {
  Network n = table_network(5e6);
  const double rd = 5e6, rg = 17e6, rs = n.skin.resistance;
  EXPECT_LT(
      relative(std::abs(transfer(n, DriveControl::Voltage, 0).gap_voltage), rg / (rd + rg + rs)),
      1e-12);
  const auto series = [](double a, double b, double c) { return 1 / (1 / a + 1 / b + 1 / c); };
  const double cg = n.gap.layer.capacitance;
  EXPECT_LT(relative(std::abs(transfer(n, DriveControl::Voltage, 1e9).gap_voltage),
                     series(n.dielectric.capacitance, cg, n.skin.capacitance) / cg),
            1e-9);
  // An ideal dielectric holds the whole constant voltage; with an insulating gap they share it.
  n.dielectric.resistance = kInfinity;
  EXPECT_EQ(respond(n, DriveControl::Voltage, 100, 0).mean_force, 0);
  EXPECT_EQ(respond(n, DriveControl::Voltage, 100, 0).current, 0);
  n.gap.layer.resistance = kInfinity;
  const double held = n.dielectric.capacitance / (n.dielectric.capacitance + cg);
  EXPECT_LT(std::abs(transfer(n, DriveControl::Voltage, 0).gap_voltage - held), 1e-12 * held);
}

TEST(Network, UnderCurrentOnlyTheGapMatters) {
  Network a = table_network(1e8), b = table_network(1e6);
  b.skin = slab(1e-3, 100, 1e5, 30e-6);
  for (double f : {1.0, 100.0, 25e3}) {
    EXPECT_DOUBLE_EQ(respond(a, DriveControl::Current, 1e-3, f).mean_force,
                     respond(b, DriveControl::Current, 1e-3, f).mean_force);
    EXPECT_EQ(respond(a, DriveControl::Current, 1e-3, f).current, 1e-3);  // all that is driven
  }
}

TEST(Network, AShuntTakesTheCurrentThatTheGapCannot) {
  Network n = table_network(kInfinity);
  n.shunt = 1e6;
  const Transfer dc = transfer(n, DriveControl::Current, 0);
  EXPECT_EQ(std::abs(dc.current), 0);
  EXPECT_DOUBLE_EQ(std::abs(dc.source_voltage), 1e6);
  const Transfer carrier = transfer(n, DriveControl::Current, 25e3);
  EXPECT_LT(relative(std::abs(carrier.current), 1), 0.03);
  // Kirchhoff.
  EXPECT_LT(std::abs(carrier.current + carrier.source_voltage / 1e6 - 1.0), 1e-12);
}

TEST(Network, ARoughGapOfOneHeightIsAPlaneGap) {
  const double u = 0.7e-6, h0 = 0.2e-6, area = 1e-5;
  const GapElement rough = rough_gap(1 / (u + h0), 1 / square(u + h0), h0, 1e7, area);
  const GapElement plane = plane_gap(u, 1, 1e7, area);
  EXPECT_LT(relative(rough.distance, u), 1e-12);
  EXPECT_LT(relative(rough.force_factor, plane.force_factor), 1e-12);
  EXPECT_LT(relative(rough.layer.capacitance, plane.layer.capacitance), 1e-12);
}

// Ideal square law: the gap is a resistor.
Network resistor() {
  Network n;
  n.gap = plane_gap(1e-6, 1, 1e6, 1e-5);
  n.gap.layer.capacitance = 1e-20;
  return n;
}

TEST(Modulation, DistortionLinesMatchTheTable) {
  const Modulation m{{10, 100, 1000}, {1. / 3, 1. / 3, 1. / 3}};
  for (double exponent : {1.0, 0.5}) {
    const Signal source = source_signal(Waveform::Am, 4e-3, 25e3, m, exponent, 0.1, 32768);
    const ForceSeries s = force_series(resistor(), DriveControl::Current, source);
    const double wanted = line_amplitude(s.force, 100);
    for (const auto& row : table("t42_am_distortion.csv")) {
      const double line = line_amplitude(s.force, row[0]) / wanted;
      if (exponent == 1) {
        EXPECT_NEAR(line, row[2], 1e-6) << row[0];
      } else {
        EXPECT_NEAR(line, row[3], 1e-9) << row[0];
      }
    }
    EXPECT_NEAR(total_distortion(s.force, m.frequency, 10e3), exponent == 1 ? 0.25 : 0, 1e-8);
    EXPECT_NEAR(s.mean_force / wanted, exponent == 1 ? 1.75 : 3, 1e-8);
  }
}

TEST(Modulation, ForceOfASineIsRectifiedPartPlusRippleAtTwiceTheFrequency) {
  const Signal source = source_signal(Waveform::Sine, 100, 5e3, {}, 1, 1. / 5e3, 64);
  const ForceSeries s = force_series(table_network(1e12), DriveControl::Voltage, source);
  const auto lines = spectrum_lines(s.force, 1e5, 1e-12);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].frequency, 0);
  EXPECT_NEAR(lines[1].frequency, 1e4, 1e-6);
  const DriveResponse r = respond(table_network(1e12), DriveControl::Voltage, 100, 5e3);
  EXPECT_LT(relative(lines[0].amplitude, r.mean_force), 1e-10);
  EXPECT_LT(relative(lines[1].amplitude, r.ripple), 1e-10);
  EXPECT_LT(relative(s.peak_current, r.current), 2e-3);  // sampled peak
}

// At 49 Hz half a period times the frequency is less than a half by rounding.
TEST(Modulation, ASquareWaveIsHalfUpAndHalfDown) {
  for (const double frequency : {25e3, 49.0, 98.0, 103.0}) {
    const Signal s = source_signal(Waveform::Square, 1, frequency, {}, 1, 1 / frequency, 4096);
    for (std::size_t i = 0; i < s.value.size(); ++i)
      ASSERT_EQ(s.value[i], i < 2048 ? 1 : -1) << frequency << " Hz " << i;
  }
}

TEST(Modulation, CommonPeriodIsTheShortest) {
  EXPECT_DOUBLE_EQ(common_period({10, 100, 25e3}), 0.1);
  EXPECT_DOUBLE_EQ(common_period({15e3, 25e3}), 1. / 5e3);
  EXPECT_EQ(common_period({1, std::sqrt(2.0)}), 0);
  EXPECT_EQ(common_period({0}), 1);
}

// A finger that drags a stiff spring to and fro: friction follows the Dahl law.
struct Swipe {
  std::vector<double> lateral;
  std::vector<SlipState> state;
  std::vector<double> current;
};
Swipe swipe(const StictionOptions& options) {
  Swipe out;
  StictionMachine machine(options);
  const double load = 0.5, friction = 0.25, stiffness = 800, frequency = 3.8;  // N, N, N/m, Hz
  double force = 0, before = 0, current = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 10e-3 * std::sin(2 * kPi * frequency * i * options.step);
    const double v = x - before;
    before = x;
    const double limit = friction * (1 + 0.5 * square(current / 8e-3));
    const int parts = 50;
    for (int k = 0; k < parts; ++k) {
      force += stiffness * (v / parts) * (1 - force / limit * (v > 0 ? 1 : -1));
    }
    current = machine.update(force, load);
    out.lateral.push_back(force);
    out.state.push_back(machine.state());
    out.current.push_back(current);
  }
  return out;
}

TEST(Stiction, ASwipeGoesFromStuckOverPartialToFullSlip) {
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  const Swipe s = swipe(options);
  std::vector<SlipState> sequence;
  for (std::size_t i = 0; i < s.state.size(); ++i) {
    if (sequence.empty() || sequence.back() != s.state[i]) sequence.push_back(s.state[i]);
    EXPECT_EQ(s.current[i] > 0, s.state[i] == SlipState::Stuck || s.state[i] == SlipState::Partial);
  }
  // 3.8 Hz for a second: seven reversals after the start.
  ASSERT_GE(sequence.size(), 18u);
  for (std::size_t i = 0; i + 1 < sequence.size(); ++i) {
    const SlipState next = sequence[i] == SlipState::Stuck     ? SlipState::Partial
                           : sequence[i] == SlipState::Partial ? SlipState::Full
                                                               : SlipState::Stuck;
    EXPECT_EQ(sequence[i + 1], next) << i;
  }
}

TEST(Stiction, ALightTouchClearsTheMemory) {
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  StictionMachine machine(options);
  EXPECT_EQ(machine.state(), SlipState::Idle);
  EXPECT_EQ(machine.update(0.2, 0.5), 0);  // already sliding at first touch: not known, no current
  EXPECT_EQ(machine.state(), SlipState::Idle);
  EXPECT_GT(machine.update(0.01, 0.5), 0);
  EXPECT_EQ(machine.state(), SlipState::Stuck);
  EXPECT_EQ(machine.update(0.01, 0.01), 0);
  EXPECT_EQ(machine.state(), SlipState::Idle);
}

TEST(Stiction, NoiseInTheStuckBandIsNoSlip) {
  StictionOptions options;
  options.stuck_current = 4e-3;
  StictionMachine machine(options);
  for (int i = 0; i < 100; ++i) {
    machine.update(0.02 * std::sin(1.7 * i), 0.5);
    EXPECT_EQ(machine.state(), SlipState::Stuck);
  }
}

TEST(Stiction, ExponentOfTheLoadIsRecovered) {
  for (double n : {-0.69, -0.74}) {
    std::vector<double> friction, load, stimulus;
    for (int i = 0; i < 160; ++i) {
      const double w = 0.2 + 0.8 * std::fmod(0.618 * i, 1.0);
      const double current = 2 + i % 7;
      load.push_back(w);
      stimulus.push_back(current * current);
      friction.push_back((0.1 + 0.01 * current * current) * std::pow(w, -n) *
                         (1 + 0.02 * std::sin(37.0 * i)));
    }
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus), n, 0.02);
  }
}

TEST(Onset, FrictionOfAPatchInStaticContactIsItsAdhesionAlone) {
  EXPECT_DOUBLE_EQ(onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 1), 0.09);
  EXPECT_DOUBLE_EQ(onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 0), 0.09 + 0.21);
}

TEST(Network, AnInsulatorIsItsCapacitance) {
  const ImpedanceLayer insulator{kInfinity, 2e-9};
  const std::complex<double> z = insulator.impedance(50);
  EXPECT_EQ(z.real(), 0);
  EXPECT_NEAR(z.imag(), -1 / (2 * kPi * 50 * 2e-9), 1e-6);
  EXPECT_EQ(insulator.impedance(0).real(), kInfinity);
  EXPECT_EQ(insulator.corner_frequency(), 0);
  // What leaks next to nothing is nearly the same.
  EXPECT_LT(std::abs(ImpedanceLayer{1e15, 2e-9}.impedance(50) / z - 1.0), 1e-5);
  const ImpedanceLayer layer = slab(2e-6, 3, 1e8, 5e-6);
  EXPECT_DOUBLE_EQ(layer.resistance, 4e7);
  EXPECT_DOUBLE_EQ(layer.capacitance, kVacuumPermittivity * 7.5);
  EXPECT_EQ(std::abs(slab(0, 3, 1e8, 5e-6).impedance(10)), 0);
}

// Dahl's law under a constant limit, while the finger moves one way: force = limit (1 - e^(-k x /
// limit)).
TEST(Rubbing, FrictionBuildsUpByDahlsLaw) {
  RubbingFinger finger;
  finger.frequency = 2;
  finger.duration = 0.1;
  StictionOptions options;
  options.step = 2e-3;
  options.stuck_current = 3e-3, options.partial_current = 2e-3;
  std::vector<double> asked;
  const auto samples = rub(finger, options, [&](double current) {
    asked.push_back(current);
    return 0.25;
  });
  ASSERT_EQ(samples.size(), 50u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double time = 2e-3 * static_cast<double>(i);
    const double place = 10e-3 * std::sin(4 * kPi * time);
    EXPECT_DOUBLE_EQ(samples[i].time, time);
    EXPECT_NEAR(samples[i].place, place, 1e-15);
    EXPECT_NEAR(samples[i].lateral, 0.25 * (1 - std::exp(-800 * place / 0.25)), 1e-12) << i;
    EXPECT_EQ(asked[i], i == 0 ? 0 : samples[i - 1].current);
    const double current = samples[i].state == SlipState::Stuck     ? 3e-3
                           : samples[i].state == SlipState::Partial ? 2e-3
                                                                    : 0;
    EXPECT_EQ(samples[i].current, current);
  }
  EXPECT_EQ(samples[0].state, SlipState::Stuck);
}

// Also where a step is hundreds of times the way to full slip; a limit of 0 is no friction.
TEST(Rubbing, FrictionStaysBelowItsLimitHoweverStiffTheSkin) {
  for (const double stiffness : {800.0, 1e4, 1e6}) {
    RubbingFinger finger;
    finger.stiffness = stiffness;
    double most = 0;
    for (const RubbingSample& at : rub(finger, {}, [](double) { return 0.3; })) {
      ASSERT_TRUE(std::isfinite(at.lateral)) << stiffness;
      ASSERT_LE(std::abs(at.lateral), 0.3) << stiffness;
      most = std::max(most, std::abs(at.lateral));
    }
    EXPECT_NEAR(most, 0.3, 1e-9) << stiffness;
    for (const RubbingSample& at : rub(finger, {}, [](double) { return 0.0; }))
      ASSERT_EQ(at.lateral, 0) << stiffness;
  }
}

// At 200 Hz a step of 1 ms is a fifth of a turn: up by 2 um, then back by 0.8 and 2.5 um.
TEST(Rubbing, ATurnIsFollowedExactly) {
  RubbingFinger finger;
  finger.stroke = 2e-6 / std::sin(0.4 * kPi);
  finger.frequency = 200;
  finger.duration = 4e-3;
  const auto samples = rub(finger, {}, [](double) { return 0.5e-3; });
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[0].lateral, 0);
  double force = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const double way = samples[i].place - samples[i - 1].place;
    EXPECT_EQ(way > 0, i == 1);
    const double full = way > 0 ? 0.5e-3 : -0.5e-3;
    force = full + (force - full) * std::exp(-800 * std::abs(way) / 0.5e-3);
    EXPECT_NEAR(samples[i].lateral, force, 1e-15) << i;
  }
  EXPECT_NEAR(samples[1].lateral, 0.5e-3 * (1 - std::exp(-3.2)), 1e-12);
}

// Each state by hand: rates per second of a ratio that is sampled every 0.1 s.
TEST(Stiction, StatesFollowTheRatioAndItsRate) {
  StictionOptions options;
  options.step = 0.1;
  options.stuck_current = 1, options.partial_current = 2, options.full_current = 3;
  StictionMachine machine(options);
  EXPECT_EQ(machine.update(0.04, 0.5), 1);   // 0.08: inside the band
  EXPECT_EQ(machine.update(0.08, 0.5), 1);   // 0.16, rate 0.8: the largest
  EXPECT_EQ(machine.update(0.117, 0.5), 1);  // 0.234, rate 0.74: not below 0.72
  EXPECT_EQ(machine.update(0.152, 0.5), 2);  // 0.304, rate 0.70
  EXPECT_EQ(machine.update(0.16, 0.5), 2);   // still rising
  EXPECT_EQ(machine.update(0.16, 0.5), 3);   // rises no more
  EXPECT_EQ(machine.update(0.2, 0.5), 3);    // whatever comes, until the band
  EXPECT_EQ(machine.update(-0.049, 0.5), 1);
  EXPECT_EQ(machine.update(-0.049, 0.024), 0);
  EXPECT_EQ(machine.state(), SlipState::Idle);
}

// Butterworth of second order: flat below, 3 dB at the corner, 40 dB a decade above.
TEST(LowPass, PassesWhatIsSlow) {
  const auto gain = [](double frequency) {
    LowPass filter(150, 1e-4);
    double most = 0;
    for (int i = 0; i < 20000; ++i) {
      const double out = filter(std::sin(2 * kPi * frequency * i * 1e-4));
      if (i > 10000) most = std::max(most, std::abs(out));
    }
    return most;
  };
  EXPECT_NEAR(gain(5), 1, 1e-3);
  EXPECT_NEAR(gain(150), std::sqrt(0.5), 2e-3);
  EXPECT_NEAR(gain(1500), 0.01, 0.002);
  LowPass rest(150, 1e-3);
  EXPECT_NEAR(rest(0.7), 0.7, 1e-12);
}

}  // namespace
}  // namespace papilla::tests::drive_test
