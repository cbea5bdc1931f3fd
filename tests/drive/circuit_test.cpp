// The circuit by Kirchhoff's laws, its signals line by line, and the swipe by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "physics/drive/network.h"
#include "physics/drive/signal.h"
#include "physics/drive/stiction.h"

namespace papilla::tests::circuit_test {
namespace {

using Complex = std::complex<double>;

Network three(double shunt = kInfinity) {
  Network n;
  n.dielectric = {3e6, 2e-10};
  n.skin = {2e5, 7e-9};
  n.gap = {{17e6, 2.5e-10}, 1e-6, 3e-5};
  n.shunt = shunt;
  return n;
}

Complex impedance(const ImpedanceLayer& l, double f) {
  return 1.0 / Complex(1 / l.resistance, 2 * kPi * f * l.capacitance);
}

TEST(Circuit, DividesVoltageAndCurrentByKirchhoff) {
  for (const double shunt : {kInfinity, 2e6}) {
    for (const double f : {0.0, 40.0, 5e3}) {
      const Network n = three(shunt);
      const Complex gap = impedance(n.gap.layer, f),
                    all = gap + impedance(n.dielectric, f) + impedance(n.skin, f);
      // A voltage source does not feel the shunt.
      const Transfer v = transfer(n, DriveControl::Voltage, f);
      EXPECT_NEAR(std::abs(v.gap_voltage - gap / all), 0, 1e-12);
      EXPECT_EQ(v.source_voltage, Complex(1));
      EXPECT_NEAR(std::abs(v.current * all - 1.0), 0, 1e-12);
      EXPECT_NEAR(std::abs(v.film_voltage - impedance(n.dielectric, f) / all), 0, 1e-12);
      // The shunt is beside the three.
      const Complex into = std::isinf(shunt) ? 1 : shunt / (shunt + all);
      const Transfer i = transfer(n, DriveControl::Current, f);
      EXPECT_NEAR(std::abs(i.current - into), 0, 1e-12);
      EXPECT_NEAR(std::abs(i.gap_voltage / (gap * into) - 1.0), 0, 1e-12);
      EXPECT_NEAR(std::abs(i.source_voltage / (all * into) - 1.0), 0, 1e-12);
      EXPECT_NEAR(std::abs(i.film_voltage / (impedance(n.dielectric, f) * into) - 1.0), 0, 1e-12);
      // F = k V^2: its mean, and as much again at twice the frequency; at 0 Hz all of it.
      const DriveResponse r = respond(n, DriveControl::Voltage, 50, f);
      const double volts = 50 * std::abs(gap / all), peak = 3e-5 * volts * volts;
      EXPECT_NEAR(r.gap_voltage, volts, 1e-12 * volts);
      EXPECT_EQ(r.source_voltage, 50);
      EXPECT_NEAR(r.current, 50 / std::abs(all), 1e-12 * r.current);
      EXPECT_NEAR(r.mean_force, f > 0 ? peak / 2 : peak, 1e-12 * peak);
      EXPECT_NEAR(r.ripple, f > 0 ? peak / 2 : 0, 1e-12 * peak);
    }
  }
}

// Insulators hold a constant voltage by 1/C: of 200, 250 and 7000 pF those that insulate.
TEST(Circuit, InsulatorsShareAConstantVoltageByTheirElastances) {
  const double d = 1 / 200.0, g = 1 / 250.0, s = 1 / 7000.0;
  for (int which = 1; which < 8; ++which) {
    Network n = three();
    double all = 0;
    if ((which & 1) != 0) n.dielectric.resistance = kInfinity, all += d;
    if ((which & 2) != 0) n.gap.layer.resistance = kInfinity, all += g;
    if ((which & 4) != 0) n.skin.resistance = kInfinity, all += s;
    const Transfer t = transfer(n, DriveControl::Voltage, 0);
    EXPECT_NEAR(t.gap_voltage.real(), (which & 2) != 0 ? g / all : 0, 1e-12) << which;
    EXPECT_NEAR(t.film_voltage.real(), (which & 1) != 0 ? d / all : 0, 1e-12) << which;
    EXPECT_EQ(t.current, Complex(0)) << which;
    EXPECT_EQ(t.source_voltage, Complex(1)) << which;
    // A current has nowhere to go; with a shunt it all goes there.
    EXPECT_TRUE(std::isinf(transfer(n, DriveControl::Current, 0).source_voltage.real()));
    n.shunt = 2e6;
    const Transfer c = transfer(n, DriveControl::Current, 0);
    EXPECT_EQ(c.current, Complex(0));
    EXPECT_NEAR(c.source_voltage.real(), 2e6, 1e-3);
    EXPECT_NEAR(c.gap_voltage.real(), (which & 2) != 0 ? 2e6 * g / all : 0, 1e-3) << which;
  }
}

TEST(Circuit, LayersAndGapsAreTheirCapacitors) {
  const ImpedanceLayer l = slab(3e-6, 5, 2e7, 4e-6);
  EXPECT_NEAR(l.resistance, 1.5e7, 1e-6);
  EXPECT_NEAR(l.capacitance, kVacuumPermittivity * 20.0 / 3, 1e-24);
  EXPECT_NEAR(l.corner_frequency(), 1 / (2 * kPi * kVacuumPermittivity * 5 * 2e7), 1e-9);
  EXPECT_EQ((ImpedanceLayer{1e6, 0}).corner_frequency(), 0);
  EXPECT_EQ((ImpedanceLayer{kInfinity, 0}).impedance(50).real(), kInfinity);
  const GapElement g = plane_gap(2e-6, 3, 1e9, 4e-6);
  EXPECT_EQ(g.distance, 2e-6);
  EXPECT_EQ(g.layer.resistance, 1e9);
  EXPECT_NEAR(g.layer.capacitance, kVacuumPermittivity * 6, 1e-24);
  EXPECT_NEAR(g.force_factor, kVacuumPermittivity * 1.5e6, 1e-18);  // eps0 eps A/(2 d^2)
  // Half of a gap at 1 um, half at 3 um, under 1 um of layers: the means of 1/2, 1/4 and squares.
  const double inverse = 0.375e6, square_inverse = 0.5 * (0.25e12 + 0.0625e12);
  const GapElement r = rough_gap(inverse, square_inverse, 1e-6, 1e9, 4e-6);
  EXPECT_NEAR(r.distance, 8e-6 / 3 - 1e-6, 1e-15);
  EXPECT_EQ(r.layer.resistance, 1e9);
  EXPECT_NEAR(r.layer.capacitance, kVacuumPermittivity * 4e-6 / (5e-6 / 3), 1e-22);
  // The whole stack's force, of the gap's 5/8 of the voltage.
  EXPECT_NEAR(r.force_factor * square(5.0 / 8), 0.5 * kVacuumPermittivity * 4e-6 * square_inverse,
              1e-12 * r.force_factor);
}

// Eq. drive.22: a capacitor whose permittivity relaxes, beside its resistor.
TEST(Circuit, ALayerThatRelaxesStoresLessAndLosesAtItsFrequency) {
  ImpedanceLayer l{1e7, 2e-10};
  l.relaxation.law = RelaxationLaw::Debye;
  l.relaxation.infinite = 2;
  l.relaxation.time = 1e-4;
  l.permittivity = 10;
  const double f = 1 / (2 * kPi * 1e-4), omega = 1e4;
  // 1/Z = 1/R + j omega C (6 - 4j)/10.
  const Complex admittance = 1e-7 + Complex(0.4, 0.6) * omega * 2e-10;
  EXPECT_LT(std::abs(l.impedance(f) * admittance - 1.0), 1e-12);
  l.resistance = kInfinity;
  EXPECT_LT(std::abs(l.impedance(f) * Complex(0.4, 0.6) * omega * 2e-10 - 1.0), 1e-12);
  // In series beside the other layers.
  Network n = three();
  const Complex before = 1.0 / transfer(n, DriveControl::Voltage, f).current;
  n.relaxing = {l};
  const Complex with = 1.0 / transfer(n, DriveControl::Voltage, f).current;
  EXPECT_LT(std::abs(with - before - l.impedance(f)), 1e-6 * std::abs(with));
  const Complex film = impedance(n.dielectric, f) + l.impedance(f);
  EXPECT_LT(std::abs(transfer(n, DriveControl::Voltage, f).film_voltage * with - film),
            1e-9 * std::abs(film));
}

// Eq. drive.23: a sine of twice what the film holds; by hand <min(2 sin, 1)^2> = 2/3 + ... over
// a quarter cycle: up to 30 degrees 4 sin^2, then 1.
TEST(Circuit, AFilmThatSaturatesCutsTheWaveOnItsGap) {
  Network n = three();
  n.dielectric = {0, 0};
  n.skin = {0, 0};
  n.gap.force_factor = 3;
  n.gap.held = 1;
  const DriveResponse r = respond(n, DriveControl::Voltage, 2, 50);
  const double cut = kPi / 6, quarter = kPi / 2;
  const double mean = (2 * cut - std::sin(2 * cut) + quarter - cut) / quarter;
  EXPECT_NEAR(r.mean_force, 3 * mean, 1e-6);
  EXPECT_EQ(r.gap_voltage, 1);
  EXPECT_NEAR(respond(n, DriveControl::Voltage, 0.8, 50).mean_force, 3 * 0.32, 1e-12);
  EXPECT_NEAR(respond(n, DriveControl::Voltage, 0.8, 50).ripple, 3 * 0.32, 1e-12);
  EXPECT_NEAR(respond(n, DriveControl::Voltage, 5, 0).mean_force, 3, 1e-12);
  const ForceSeries s = force_series(n, DriveControl::Voltage,
                                     source_signal(Waveform::Sine, 2, 50, {}, 1, 0.02, 4096));
  EXPECT_NEAR(s.mean_force, 3 * mean, 1e-3);
  EXPECT_NEAR(s.peak_gap_voltage, 1, 1e-12);
  EXPECT_NEAR(s.peak_film_voltage, 1, 1e-9);  // the rest of 2 V
  EXPECT_NEAR(r.film_voltage, 1, 1e-12);
}

TEST(Signals, OfEveryWaveformAreWhatTheyAreCalled) {
  const Modulation two{{50, 150}, {0.4, 0.2}};
  EXPECT_NEAR(two.at(1e-3), 0.4 * std::sin(0.1 * kPi) + 0.2 * std::sin(0.3 * kPi), 1e-12);
  const double period = 0.02;
  const auto signal = [&](Waveform w, double exponent) {
    return source_signal(w, 3, 1000, two, exponent, period, 100);
  };
  for (const double exponent : {0.5, 1.0}) {
    const Signal am = signal(Waveform::Am, exponent), sine = signal(Waveform::Sine, exponent),
                 square_wave = signal(Waveform::Square, exponent),
                 dc = signal(Waveform::Dc, exponent);
    ASSERT_EQ(am.value.size(), 128u);  // the next power of two
    EXPECT_NEAR(am.step(), period / 128, 1e-15);
    for (std::size_t i = 0; i < 128; ++i) {
      const double t = period * static_cast<double>(i) / 128, turn = std::fmod(1000 * t, 1.0);
      const double wave = 3 * std::sin(2 * kPi * 1000 * t);
      EXPECT_NEAR(sine.value[i], wave, 1e-9);
      EXPECT_EQ(square_wave.value[i], turn < 0.5 ? 3 : -3) << i;
      EXPECT_EQ(dc.value[i], 3);
      EXPECT_NEAR(am.value[i], wave * std::pow((1 + two.at(t)) / 1.6, exponent), 1e-9) << i;
    }
  }
  // Deeper than full the envelope stays at nothing.
  const Signal deep = source_signal(Waveform::Am, 1, 1000, {{50}, {3}}, 0.5, period, 128);
  for (std::size_t i = 0; i < 128; ++i) {
    const double t = period * static_cast<double>(i) / 128;
    const double m = 1 + 3 * std::sin(100 * kPi * t);
    EXPECT_NEAR(deep.value[i], m > 0 ? std::sqrt(m / 4) * std::sin(2000 * kPi * t) : 0, 1e-9);
  }
}

// 5 + 3 cos at 2 a period + 4 sin at 5 + 0.001 cos at 9.
Signal lines() {
  Signal s{0.5, std::vector<double>(64)};
  for (std::size_t i = 0; i < 64; ++i) {
    const double turn = 2 * kPi * static_cast<double>(i) / 64;
    s.value[i] = 5 + 3 * std::cos(2 * turn) + 4 * std::sin(5 * turn) + 1e-3 * std::cos(9 * turn);
  }
  return s;
}

TEST(Signals, HaveTheirLinesUpToAFrequencyAndOfASize) {
  const Signal s = lines();
  const auto frequencies = [&](double highest, double threshold) {
    std::vector<double> out;
    for (const SpectrumLine& l : spectrum_lines(s, highest, threshold)) out.push_back(l.frequency);
    return out;
  };
  using List = std::vector<double>;
  EXPECT_EQ(frequencies(100, 1e-5), (List{0, 4, 10, 18}));  // beyond half the samples: all
  EXPECT_EQ(frequencies(100, 1e-3), (List{0, 4, 10}));      // of 4 the largest
  EXPECT_EQ(frequencies(10, 1e-5), (List{0, 4, 10}));
  EXPECT_EQ(frequencies(8.9, 1e-5), (List{0, 4}));
  EXPECT_EQ(frequencies(0.9, 1e-5), (List{0}));
  const std::vector<SpectrumLine> all = spectrum_lines(s, 100, 1e-5);
  const double amplitude[] = {5, 3, 4, 1e-3};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(all[k].amplitude, amplitude[k], 1e-9) << k;
    EXPECT_NEAR(line_amplitude(s, all[k].frequency), amplitude[k], 1e-9) << k;
  }
  EXPECT_NEAR(line_amplitude(s, 6), 0, 1e-9);
  EXPECT_EQ(line_amplitude(s, 66), 0);  // 33 of 32 lines
  Signal below = s;                     // the mean keeps its sign
  for (double& v : below.value) v -= 8;
  EXPECT_NEAR(spectrum_lines(below, 100, 1e-5)[0].amplitude, -3, 1e-9);
}

TEST(Signals, DistortionIsTheRootOfUnwantedOverWantedPower) {
  const Signal s = lines();
  EXPECT_NEAR(total_distortion(s, {10}, 100), std::sqrt(9 + 1e-6) / 4, 1e-9);
  EXPECT_NEAR(total_distortion(s, {4}, 100), std::sqrt(16 + 1e-6) / 3, 1e-9);
  EXPECT_NEAR(total_distortion(s, {4, 10}, 100), 1e-3 / 5, 1e-9);
  EXPECT_NEAR(total_distortion(s, {4}, 10), 4.0 / 3, 1e-9);
  EXPECT_NEAR(total_distortion(s, {4}, 9.4), 4.0 / 3, 1e-9);  // the line of 9.4 is that of 10
  EXPECT_NEAR(total_distortion(s, {4}, 8.9), 0, 1e-9);
  EXPECT_EQ(total_distortion(s, {}, 100), 0);  // nothing wanted, nothing to compare with
}

TEST(Signals, ACommonPeriodHoldsWholeTurnsOfAll) {
  EXPECT_NEAR(common_period({6, 10, 15}), 1, 1e-12);
  EXPECT_NEAR(common_period({15, 10, 6}), 1, 1e-12);
  EXPECT_NEAR(common_period({0, 40, 0}), 1.0 / 40, 1e-15);
  // 7 of the lowest; no more are looked for than asked.
  EXPECT_NEAR(common_period({7, 8}, 7), 1, 1e-12);
  EXPECT_EQ(common_period({7, 8}, 6), 0);
  EXPECT_EQ(common_period({}), 1);
}

// Two tones through a circuit: each by its own transfer, force by the square of their sum.
TEST(Signals, PassLineByLine) {
  const double period = 0.01;
  Signal source{period, std::vector<double>(256)};
  const auto time = [&](std::size_t i) { return period * static_cast<double>(i) / 256; };
  for (std::size_t i = 0; i < 256; ++i)
    source.value[i] =
        2 + 30 * std::cos(2 * kPi * 300 * time(i)) + 10 * std::sin(2 * kPi * 700 * time(i));
  for (const DriveControl control : {DriveControl::Voltage, DriveControl::Current}) {
    const Network n = three(2e6);
    const ForceSeries s = force_series(n, control, source);
    const auto passed = [&](Complex Transfer::*of, double t) {
      return 2 * (transfer(n, control, 0).*of).real() +
             (30.0 * (transfer(n, control, 300).*of) * std::polar(1.0, 2 * kPi * 300 * t)).real() +
             (10.0 * (transfer(n, control, 700).*of) * std::polar(1.0, 2 * kPi * 700 * t)).imag();
    };
    double most_gap = 0, most_source = 0, most_current = 0, most_film = 0, force = 0;
    for (std::size_t i = 0; i < 256; ++i) {
      const double gap = passed(&Transfer::gap_voltage, time(i)),
                   volts = passed(&Transfer::source_voltage, time(i)),
                   film = passed(&Transfer::film_voltage, time(i)),
                   amperes = passed(&Transfer::current, time(i));
      most_gap = std::max(most_gap, std::abs(gap));
      most_source = std::max(most_source, std::abs(volts));
      most_current = std::max(most_current, std::abs(amperes));
      most_film = std::max(most_film, std::abs(film));
      force += 3e-5 * gap * gap / 256;
      ASSERT_NEAR(s.gap_voltage.value[i] / gap, 1, 1e-6) << i;
      ASSERT_NEAR(s.force.value[i] / (3e-5 * gap * gap), 1, 2e-6) << i;
      ASSERT_NEAR(s.source_voltage.value[i] / volts, 1, 1e-6) << i;
      ASSERT_NEAR(s.current.value[i] / amperes, 1, 1e-6) << i;
    }
    EXPECT_NEAR(s.peak_gap_voltage / most_gap, 1, 1e-9);
    EXPECT_NEAR(s.peak_source_voltage / most_source, 1, 1e-9);
    EXPECT_NEAR(s.peak_current / most_current, 1, 1e-9);
    EXPECT_NEAR(s.peak_film_voltage / most_film, 1, 1e-9);
    EXPECT_NEAR(s.mean_force / force, 1, 1e-9);
    for (const Signal* out : {&s.gap_voltage, &s.force, &s.source_voltage, &s.current})
      EXPECT_EQ(out->period, period);
  }
}

// A square current of 4 mA beside a shunt of 1 Mohm that holds kilovolts: where it turns, what the
// shunt takes the other way flows through the body too.
TEST(Signals, TheBodyTakesOfAHeldCurrentWhatTheShuntDoesNot) {
  const Network n = three(1e6);
  const Signal source = source_signal(Waveform::Square, 4e-3, 1e3, {}, 1, 1e-3, 4096);
  const ForceSeries s = force_series(n, DriveControl::Current, source);
  for (std::size_t i = 0; i < source.value.size(); ++i)
    ASSERT_NEAR(s.current.value[i], source.value[i] - s.source_voltage.value[i] / 1e6, 1e-9) << i;
  EXPECT_GT(s.peak_current, 6e-3);
  // Without a shunt it is the source's, to the last bit.
  EXPECT_EQ(force_series(three(), DriveControl::Current, source).current.value, source.value);
}

TEST(Stickiness, TheExponentIsWhereTheCorrelationIsLargest) {
  // Friction that is the stimulus over the load's power: the correlation is 1 there, to 1e-4.
  for (const double n : {-1.83, -0.69, 0.0, 0.42, 0.97}) {
    std::vector<double> friction, load, stimulus;
    for (int i = 0; i < 60; ++i) {
      load.push_back(0.2 + 0.8 * std::fmod(0.618 * i, 1.0));
      stimulus.push_back(1 + i % 7);
      friction.push_back(stimulus.back() * std::pow(load.back(), -n));
    }
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus), n, 1e-4) << n;
    // Of an exponent beyond the range, its end.
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus, n + 0.13, n + 0.9), n + 0.13, 1e-4);
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus, n - 0.9, n - 0.13), n - 0.13, 1e-4);
    // One that is largest where the coarse search has no step.
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus, n - 0.524, n + 0.7), n, 1e-4);
    // Its size does not matter.
    for (double& f : friction) f *= 1e3;
    EXPECT_NEAR(stickiness_exponent(friction, load, stimulus), n, 1e-4) << n;
  }
}

// y = gain (x + 2 x1 + x2) - a1 y1 - a2 y2 by Eq. drive.17, from rest.
TEST(LowPass, OfAStepIsItsRecursion) {
  LowPass filter(150, 1e-3);
  const double k = std::tan(kPi * 0.15), all = 1 + std::sqrt(2.0) * k + k * k;
  std::array<double, 2> in{0.2, 0.2}, out{0.2, 0.2};
  EXPECT_NEAR(filter(0.2), 0.2, 1e-12);
  for (int i = 0; i < 40; ++i) {
    const double x = i < 20 ? 1 : -0.5;
    const double y = (k * k * (x + 2 * in[0] + in[1]) - 2 * (k * k - 1) * out[0] -
                      (1 - std::sqrt(2.0) * k + k * k) * out[1]) /
                     all;
    EXPECT_NEAR(filter(x), y, 1e-12) << i;
    in = {x, in[0]}, out = {y, out[0]};
  }
}

// The ratio goes up, down and through the band: rates are compared by their size.
TEST(Stiction, RatesAreComparedUnsigned) {
  StictionOptions options;
  options.step = 0.1;
  options.stuck_current = 1, options.partial_current = 2, options.full_current = 3;
  StictionMachine machine(options);
  EXPECT_EQ(machine.update(0.02, 0.5), 1);    // 0.04
  EXPECT_EQ(machine.update(-0.08, 0.5), 1);   // -0.16, rate -2: the largest
  EXPECT_EQ(machine.update(-0.175, 0.5), 1);  // -0.35, -1.9: not below 1.8
  EXPECT_EQ(machine.update(-0.26, 0.5), 2);   // -0.52, -1.7
  EXPECT_EQ(machine.update(-0.27, 0.5), 2);   // -0.54, still outwards
  EXPECT_EQ(machine.update(-0.25, 0.5), 3);   // turns
  // Back into the band the largest is forgotten: the rate of the way in is the first.
  EXPECT_EQ(machine.update(-0.04, 0.5), 1);  // -0.08, rate 4.2
  EXPECT_EQ(machine.update(0.04, 0.5), 1);   // 0.08, 1.6
  EXPECT_EQ(machine.update(0.2, 0.5), 2);    // 0.4, 3.2: below 0.9 of 4.2
  EXPECT_EQ(machine.state(), SlipState::Partial);
  // At the least load it still feels; just outside the band it is not stuck.
  StictionMachine edge(options);
  EXPECT_EQ(edge.update(0.0024, 0.025), 1);
  StictionMachine out(options);
  EXPECT_EQ(out.update(0.00251, 0.025), 0);
  EXPECT_EQ(out.state(), SlipState::Idle);
}

// To and fro once: the sign of the way turns Dahl's law, and the filter is what the machine feels.
TEST(Rubbing, BackwardsTheFrictionBuildsUpAgain) {
  RubbingFinger finger;
  finger.load = 0.4, finger.stroke = 4e-3, finger.frequency = 5, finger.stiffness = 500;
  finger.duration = 0.2;
  StictionOptions options;
  options.step = 1e-3;
  options.stuck_current = 2e-3, options.partial_current = 1e-3, options.full_current = 0.5e-3;
  for (const double corner : {0.0, 80.0}) {
    finger.filter = corner;
    const auto limit = [](double current) { return 0.2 + 40 * current; };
    const auto samples = rub(finger, options, limit);
    ASSERT_EQ(samples.size(), 200u);
    StictionMachine machine(options);
    LowPass filter(80, 1e-3);
    double force = 0, place = 0, current = 0, least = 0;
    for (std::size_t i = 0; i < 200; ++i) {
      const double time = 1e-3 * static_cast<double>(i);
      const double next = 4e-3 * std::sin(2 * kPi * 5 * time), most = limit(current);
      constexpr int kSteps = 20000;  // of Euler's rule
      for (int k = 0; k < kSteps; ++k) {
        const double dx = (next - place) / kSteps;
        force += 500 * (dx - std::abs(dx) * force / most);
      }
      place = next;
      current = machine.update(corner > 0 ? filter(force) : force, 0.4);
      ASSERT_NEAR(samples[i].time, time, 1e-12);
      ASSERT_NEAR(samples[i].place, place, 1e-12);
      ASSERT_NEAR(samples[i].lateral, force, 1e-6) << i;
      ASSERT_EQ(samples[i].state, machine.state()) << i;
      ASSERT_EQ(samples[i].current, current) << i;
      least = std::min(least, force);
    }
    EXPECT_LT(least, -0.15);
  }
  // A fresh finger has half a newton, 10 mm at 3.8 Hz, 800 N/m, one second and no filter.
  const RubbingFinger usual;
  EXPECT_EQ(usual.load, 0.5);
  EXPECT_EQ(usual.stroke, 10e-3);
  EXPECT_EQ(usual.frequency, 3.8);
  EXPECT_EQ(usual.stiffness, 800);
  EXPECT_EQ(usual.filter, 0);
  EXPECT_EQ(usual.duration, 1);
}

}  // namespace
}  // namespace papilla::tests::circuit_test
