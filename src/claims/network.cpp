// Claims of the papers on the Johnsen-Rahbek effect (J) and on broadband drive (B): one finger, one
// network of skin, gap and dielectric.
#include "physics/drive/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "claims/papers.h"
#include "physics/drive/signal.h"

namespace papilla::claims {
namespace {

// What the papers print.
namespace printed {
constexpr double kFingerArea = 30e-6;                               // [m^2]
constexpr double kGapResistance = 17e6, kGapCapacitance = 250e-12;  // [ohm], [F]
constexpr double kMu = 0.2;                                         // friction coefficient
constexpr double kCurrent = 4e-3, kCarrier = 25e3;                  // [A] peak, [Hz]

// A gap of 250 pF on 30 mm2; dielectric 1 um of 3.9 and skin 200 um of 2000, 2e4 ohm m.
Network network(double dielectric_resistance = 5e6) {
  Network n;
  n.dielectric = {dielectric_resistance, kVacuumPermittivity * 3.9 * kFingerArea / 1e-6};
  n.gap = plane_gap(kVacuumPermittivity * kFingerArea / kGapCapacitance, 1, kGapResistance,
                    kFingerArea);
  n.skin = slab(200e-6, 2000, 2e4, kFingerArea);
  return n;
}

// The law of force alone: a gap without capacitance.
Network without_capacitance() {
  Network n = network();
  n.gap.layer.capacitance = 1e-25;
  return n;
}

// Three tones of a third each, and the carrier that is modulated with them.
const Modulation& tones() {
  static const Modulation three{{10, 100, 1000}, {1. / 3, 1. / 3, 1. / 3}};
  return three;
}
Signal carrier(const Modulation& modulation, double exponent, double period = 0.1,
               std::size_t samples = 65536) {
  return source_signal(Waveform::Am, kCurrent, kCarrier, modulation, exponent, period, samples);
}
}  // namespace printed

Judgement plate_pressure(FingerModel&) {
  const double area = 1e-4;
  const double force = plane_gap(1e-6, 1, 1e6, area).force_factor * square(100);
  return agrees_if(off_by(force, 4.4) < 0.01, force, 0, fmt::format("{:.3f} N/cm2", force));
}

Judgement gap_of_seven_newtons(FingerModel&) {
  const double area = 32.17e-6, voltage = 100e-6 * 7e6, force = 7;
  const double gap = std::sqrt(kVacuumPermittivity * area / 2 / force) * voltage;
  const double stated = plane_gap(1.8e-6, 1, 7e6, area).force_factor * square(voltage);
  return {Verdict::PaperInconsistent, gap, 0, fmt::format("{:.3f} um", 1e6 * gap),
          fmt::format("its Eq. 7 with its own numbers; 1.8 um would pull {:.1f} N", stated)};
}

Judgement direct_current(FingerModel&) {
  const Network n = printed::network();
  const double ratio =
      printed::kGapResistance / (5e6 + printed::kGapResistance + n.skin.resistance);
  const double error = off_by(respond(n, DriveControl::Voltage, 100, 0).mean_force,
                              n.gap.force_factor * square(100 * ratio));
  return agrees_if(error < 1e-10, error, 0, fmt::format("relative difference {:.1g}", error),
                   "0 Hz against the resistive divider");
}

Judgement high_frequency(FingerModel&) {
  const Network n = printed::network();
  const double stack = 1e-6 / 3.9 + 200e-6 / 2000 + n.gap.distance;
  const double plates =
      kVacuumPermittivity * printed::kFingerArea * square(100) / (2 * square(stack));
  const double error = off_by(2 * respond(n, DriveControl::Voltage, 100, 1e12).mean_force, plates);
  return agrees_if(
      error < 1e-10, error, 0, fmt::format("relative difference {:.1g}", error),
      "1e12 Hz against F = eps0 A V^2 / (2 eps_g (sum d/eps)^2); printed is a quotient "
      "of sums");
}

Judgement insulator(FingerModel&) {
  const double force =
      respond(printed::network(kInfinity), DriveControl::Voltage, 100, 0).mean_force;
  return agrees_if(force == 0, force, 0, fmt::format("{:g} N", force));
}

Judgement current_drive(FingerModel&) {
  Network other = printed::network(1e9);
  other.skin = slab(1e-3, 100, 1e5, printed::kFingerArea);
  double error = 0;
  for (double f : {0.0, 10.0, 1e3, 25e3}) {
    error = std::max(
        error, off_by(respond(other, DriveControl::Current, 1e-3, f).mean_force,
                      respond(printed::network(), DriveControl::Current, 1e-3, f).mean_force));
  }
  return agrees_if(error < 1e-12, error, 0, fmt::format("relative difference {:.1g}", error),
                   "R_d 5 Mohm and 1 Gohm, two skins, 0 Hz to 25 kHz");
}

Judgement gap_corner(FingerModel&) {
  const double corner = printed::network().gap.layer.corner_frequency();
  return agrees_if(off_by(corner, 37) < 0.04, corner, 0, fmt::format("{:.2f} Hz", corner));
}

Judgement gap_distance(FingerModel&) {
  const double gap = printed::network().gap.distance;
  return agrees_if(off_by(gap, 1.1e-6) < 0.04, gap, 0, fmt::format("{:.3f} um", 1e6 * gap));
}

Judgement added_friction(FingerModel&) {
  const Network n = printed::network();
  const double alpha =
      printed::kMu * kVacuumPermittivity * printed::kFingerArea / (2 * square(n.gap.distance));
  double error = 0;
  for (double f : {1.0, 37.0, 25e3}) {
    const double formula = alpha * square(10e-6 * std::abs(n.gap.layer.impedance(f)));
    const DriveResponse r = respond(n, DriveControl::Current, 10e-6, f);
    error = std::max(error, off_by(printed::kMu * (r.mean_force + r.ripple), formula));
  }
  return agrees_if(error < 1e-12, alpha, 0,
                   fmt::format("alpha {:.3g} N/V2, relative difference {:.1g}", alpha, error),
                   "the crest of the force; its mean and its ripple are half of it each");
}

Judgement force_slope(FingerModel&) {
  const Network n = printed::network();
  const auto level = [&](double f) {
    return 20 * std::log10(respond(n, DriveControl::Current, 10e-6, f).ripple);
  };
  const double slope = level(1e4) - level(1e3);
  return agrees_if(std::abs(slope + 40) < 0.5, slope, 0, fmt::format("{:.2f} dB/decade", slope),
                   "1 to 10 kHz, current drive");
}

Judgement ripple_and_mean(FingerModel&) {
  const Signal source = source_signal(Waveform::Sine, 10e-6, 100, {}, 1, 0.01, 64);
  const ForceSeries s = force_series(printed::network(), DriveControl::Current, source);
  const auto lines = spectrum_lines(s.force, 3e3, 1e-10);
  const bool agrees = lines.size() == 2 && std::abs(lines[1].frequency - 200) < 1e-6 &&
                      off_by(lines[1].amplitude, lines[0].amplitude) < 1e-10;
  return agrees_if(
      agrees, lines.back().frequency, 0,
      fmt::format("{} lines: mean, and {:g} Hz of 100 Hz", lines.size(), lines.back().frequency));
}

ForceSeries force_of(const Network& network, const Signal& source) {
  return force_series(network, DriveControl::Current, source);
}

Judgement flat_response(FingerModel&) {
  const auto line = [](double f) {
    const Signal source = printed::carrier({{f}, {0.5}}, 0.5);
    return line_amplitude(force_of(printed::network(), source).force, f);
  };
  const double base = line(10);
  double span = 0;
  for (double f : {100.0, 300.0, 1000.0}) span = std::max(span, off_by(line(f), base));
  return agrees_if(
      span < 0.01, span, 0,
      fmt::format("10 Hz to 1 kHz within {:.2f} %; 5 kHz {:+.1f} %", 100 * span,
                  100 * (line(5e3) / base - 1)),
      "the carrier meets the gap's impedance, the modulation does not; what is left is "
      "its slope over the side bands");
}

Judgement distortion(FingerModel&) {
  // Through the network, so that the side bands' own slope is in it.
  const Signal straight = printed::carrier(printed::tones(), 1),
               root = printed::carrier(printed::tones(), 0.5);
  const ForceSeries plain = force_of(printed::network(), straight),
                    shaped = force_of(printed::network(), root);
  const double wanted = line_amplitude(plain.force, 100);
  const double sum = line_amplitude(plain.force, 110) / wanted;
  const double second = line_amplitude(plain.force, 200) / wanted;
  const auto distortion_of = [](const ForceSeries& s) {
    return total_distortion(s.force, printed::tones().frequency, 10e3);
  };
  const double ideal = distortion_of(force_of(printed::without_capacitance(), root));
  return agrees_if(off_by(sum, 1. / 6) < 0.01 && off_by(second, 1. / 12) < 0.01 && ideal < 1e-6,
                   sum, 0,
                   fmt::format("lines {:.4f} and {:.4f}; gamma = 1/2: {:.1g}, with the gap's slope "
                               "over the side bands {:.2g}",
                               sum, second, ideal, distortion_of(shaped)));
}

Judgement carrier_voltage(FingerModel&) {
  const DriveResponse r =
      respond(printed::network(), DriveControl::Current, printed::kCurrent, printed::kCarrier);
  return agrees_if(r.source_voltage < 150, r.source_voltage, 0,
                   fmt::format("{:.0f} V, of it gap {:.0f} V", r.source_voltage, r.gap_voltage),
                   "4 mA peak; the paper has 80 to 90 % in the gap");
}

Judgement chirp(FingerModel&) {
  const Signal source = printed::carrier({{15e3}, {1}}, 0.5, 1. / 5e3, 4096);
  const ForceSeries s = force_of(printed::without_capacitance(), source);
  std::string text;
  std::vector<double> found;
  for (const SpectrumLine& line : spectrum_lines(s.force, 2e5, 1e-9)) {
    if (line.frequency == 0) continue;
    found.push_back(line.frequency);
    text += fmt::format("{}{:g}", text.empty() ? "" : ", ", line.frequency * 1e-3);
  }
  const std::vector<double> expected{15e3, 35e3, 50e3, 65e3};
  bool agrees = found.size() == expected.size();
  for (std::size_t i = 0; agrees && i < found.size(); ++i) {
    agrees = std::abs(found[i] - expected[i]) < 1e-3;
  }
  return agrees_if(agrees, static_cast<double>(found.size()), 0, "lines at " + text + " kHz");
}

Judgement other_law(FingerModel&) {
  // Diamond-like carbon: quadratic below 1 mA, saturating above.
  const auto residue = [](double exponent) {
    Signal force = printed::carrier(printed::tones(), exponent);
    for (double& v : force.value) v = square(v) / (square(1e-3) + square(v));
    return total_distortion(force, printed::tones().frequency, 10e3);
  };
  const double plain = residue(1), shaped = residue(0.5);
  return agrees_if(
      shaped > plain, shaped / plain, 0,
      fmt::format("distortion {:.0f} % at 1/2, {:.0f} % at 1", 100 * shaped, 100 * plain),
      "force ~ I^2/(I^2 + (1 mA)^2), read off its description of the measured curve");
}

Claim johnsen_claim(const char* id, const char* statement, const char* band,
                    std::function<Judgement(FingerModel&)> judge) {
  return {id, "Johnsen-Rahbek", statement, band, false, std::move(judge)};
}

Claim broadband_claim(const char* id, const char* statement, const char* band,
                      std::function<Judgement(FingerModel&)> judge) {
  return {id, "broadband electroadhesion", statement, band, false, std::move(judge)};
}

}  // namespace

std::vector<Claim> network_claims() {
  return {
      johnsen_claim("J1", "100 V over 1 um: 4.4 N/cm2", "within 1 %", plate_pressure),
      johnsen_claim("J2", "7 N at 100 uA, 7 Mohm, 32.17 mm2: gap 1.8 um", "-",
                    gap_of_seven_newtons),
      johnsen_claim("J3", "direct current: resistances divide the voltage", "1e-10",
                    direct_current),
      johnsen_claim("J4", "high frequency: capacitances divide it (Eq. 11 restored)", "1e-10",
                    high_frequency),
      johnsen_claim("J5", "a perfect insulator gives no force at direct current", "exact",
                    insulator),
      johnsen_claim("J6", "under current drive dielectric and skin do not matter", "1e-12",
                    current_drive),
      broadband_claim("B1", "17 Mohm and 250 pF: 37 Hz", "within 4 %", gap_corner),
      broadband_claim("B2", "250 pF on 30 mm2: gap 1.1 um", "within 4 %", gap_distance),
      broadband_claim("B3", "added friction = alpha |I Z_gap|^2", "1e-12", added_friction),
      broadband_claim("B4", "force falls 40 dB/decade above the corner", "within 0.5 dB",
                      force_slope),
      broadband_claim("B5", "a sine makes a rectified part and a ripple at 2f", "exact",
                      ripple_and_mean),
      broadband_claim("B6", "with a modulated carrier the response is flat", "within 1 % to 1 kHz",
                      flat_response),
      broadband_claim("B7", "three tones: gamma = 1 adds lines of 1/6 and 1/12, gamma = 1/2 none",
                      "within 1 %; below 1e-6", distortion),
      broadband_claim("B8", "4 mA at 25 kHz needs less than 150 V", "below 150 V", carrier_voltage),
      broadband_claim("B9", "15 kHz on 25 kHz: lines at 15, 35, 50, 65 kHz", "exact", chirp),
      broadband_claim("B10", "where the law is not quadratic, gamma = 1/2 is worse than gamma = 1",
                      "sign", other_law),
  };
}

}  // namespace papilla::claims
