// Claims of the theory papers: mean-field electroadhesion (P), Johnsen-Rahbek (J), broadband drive
// (B), stiction (S). Each uses the numbers that its paper prints, and no others.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/constants.h"
#include "base/statistics.h"
#include "claims/reproduce.h"
#include "physics/drive/network.h"
#include "physics/drive/signal.h"
#include "physics/drive/stiction.h"
#include "physics/persson/persson.h"

namespace papilla {
namespace {

// ---- Mean field: what the paper prints. The spectrum is fitted to its four numbers (claim P18).
namespace printed {
constexpr double kPressure = 10e3, kFiniteSize = 10e3;  // [Pa]
constexpr double kAmplitude = 100, kStrong = 200;       // [V]
constexpr double kThickness = 0.2e-6;                   // h0 [m]
constexpr double kShear = 8e6;                          // [Pa]
constexpr double kYield = 50e6;                         // [Pa]
constexpr double kArea = 1e-4;                          // nominal [m^2]; not printed, cancels in mu

MeanFieldSolid solid(double modulus = 40e6) { return {modulus, 0.5, 200e-6, 10e3, 0.5}; }
double rms(double amplitude) { return amplitude / std::numbers::sqrt2; }
}  // namespace printed

const MeanField& skin_field(ClaimInputs& in) {
  const std::function<MeanField()> make = [] {
    return MeanField(wrist_spectrum(), printed::solid());
  };
  return in.once("mean field", make);
}

// The empirical factor of the area also stretches the mean gap, which the pure theory has right
// within 10 %.
const MeanField& gap_field(ClaimInputs& in) {
  const std::function<MeanField()> make = [] {
    return MeanField(wrist_spectrum(), printed::solid(), {.kappa = kPurePersson});
  };
  return in.once("mean field of gaps", make);
}

PullState pull_of(const MeanField& field, double amplitude, double pressure = printed::kPressure,
                  double thickness = printed::kThickness) {
  return solve_pull(field, pressure, printed::rms(amplitude), thickness);
}

// Values that must fall (or rise) along a list, as a claim of signs.
Judgement trend(const std::vector<double>& values, bool rises, const char* unit, double scale,
                std::string reason) {
  bool agrees = true;
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) agrees = agrees && (rises ? values[i] > values[i - 1] : values[i] < values[i - 1]);
    text += fmt::format("{}{:.4g}", i ? ", " : "", scale * values[i]);
  }
  return agrees_if(agrees, values.back() / values.front(), 0,
                   text + (*unit ? std::string(" ") + unit : ""), std::move(reason));
}

Judgement contact_area(ClaimInputs&) {
  // E* = 40 MPa and rms slope 1, homogeneous.
  const PowerSpectrum wrist = wrist_spectrum();
  const MeanField field(wrist.scaled(1 / square(wrist.slope())), {40e6, 0, 0, 40e6, 0});
  const double area = field.area(printed::kPressure);
  return agrees_if(std::abs(area / 5e-4 - 1) <= 0.05, area, 0, fmt::format("{:.3g}", area),
                   "kappa = 2; the paper's Eq. 7 is misprinted, its limit Eq. 8 is used");
}

Judgement dielectric_thickness(ClaimInputs&) {
  const double oxide = 1e-6 / 3.9, dry = 200e-6 / 3000, moist = 200e-6 / 1e4;
  const auto rounds = [](double value, double to) { return std::abs(value - to) < 0.5e-8; };
  return agrees_if(rounds(oxide, 0.26e-6) && rounds(dry, 0.07e-6) && rounds(moist, 0.02e-6), oxide,
                   0,
                   fmt::format("{:.3f}, {:.3f}, {:.3f} um", 1e6 * oxide, 1e6 * dry, 1e6 * moist));
}

Judgement relaxation(ClaimInputs&) {
  const StepResponse step{1e-6 / 3.9, 200e-6, 2000, 2e4};
  const double bare = kVacuumPermittivity * 2e4 * 2000;
  return agrees_if(bare >= 3e-4 && bare <= 5e-4, bare, 0,
                   fmt::format("{:.3g} s; with the gap in series {:.3g} s (u = 1 um), {:.3g} s "
                               "(u = 0)",
                               bare, step.relaxation_time(1e-6), step.relaxation_time(0)));
}

Judgement stress_range(ClaimInputs& in) {
  const GapDistribution gaps = skin_field(in).gaps(printed::kPressure);
  const double top = 0.5 * kVacuumPermittivity * square(printed::rms(printed::kAmplitude));
  const auto stress_above = [&](double share) {  // stress exceeded on this share of the area
    double low = 1e-12, high = 1e-2;
    for (int i = 0; i < 80; ++i) {
      const double mid = std::sqrt(low * high);
      (gaps.cumulative(mid) < share ? low : high) = mid;
    }
    return top / square(low + printed::kThickness);
  };
  const double least = stress_above(0.95), most = stress_above(0.05);
  return agrees_if(least >= 1 && most <= 100, stress_above(0.5), 0,
                   fmt::format("5 / 50 / 95 % quantiles {:.2g} / {:.2g} / {:.2g} Pa", least,
                               stress_above(0.5), most));
}

Judgement stress_peak(ClaimInputs& in) {
  const GapDistribution gaps = skin_field(in).gaps(printed::kPressure);
  std::vector<double> at;
  for (double u = 1e-12; u < 1e-5; u *= 1.05) at.push_back(u);
  const auto points =
      stress_distribution(gaps, printed::rms(printed::kAmplitude), printed::kThickness, at);
  const auto best = std::max_element(
      points.begin(), points.end(),
      [](const StressPoint& a, const StressPoint& b) { return a.per_decade < b.per_decade; });
  const double top =
      kVacuumPermittivity * square(printed::kAmplitude) / (4 * square(printed::kThickness));
  return agrees_if(
      std::abs(best->stress / top - 1) < 0.05, best->stress, 0,
      fmt::format("largest share a decade at {:.3g} Pa, limit {:.3g} Pa", best->stress, top));
}

Judgement finite_size(ClaimInputs& in) {
  // Pressure at which the mean gap equals the height of the highest asperity of the area.
  const MeanField& field = gap_field(in);
  const double roll_off = field.spectrum().wave_number[1];
  const double cells = printed::kArea * square(roll_off / (2 * kPi));
  const double lowest = normal_quantile(1 - 1 / cells);  // one independent height a wavelength
  double highest = 1;  // one region above it: A q^2/2 u e^(-u^2/2) / (2 pi)^(3/2) = 1
  for (int i = 0; i < 60; ++i) {
    highest = std::sqrt(
        2 * std::log(printed::kArea * square(roll_off) / 2 * highest / std::pow(2 * kPi, 1.5)));
  }
  const auto pressure_at = [&](double heights) {
    double low = 1, high = 1e7;
    for (int i = 0; i < 60; ++i) {
      const double mid = std::sqrt(low * high);
      (field.mean_gap(mid) > heights * field.spectrum().rms() ? low : high) = mid;
    }
    return low;
  };
  const double few = pressure_at(lowest), many = pressure_at(highest);
  const double value = std::sqrt(few * many);
  return agrees_if(value >= 5e3 && value <= 2e4, value, 0,
                   fmt::format("{:.2g} Pa ({:.2g} to {:.2g})", value, many, few),
                   fmt::format("mean gap = highest asperity of 1 cm2, {:.1f} to {:.1f} rms by two "
                               "counts of asperities",
                               lowest, highest));
}

Judgement friction_without_load(ClaimInputs& in) {
  const FrictionPoint point =
      friction_at(skin_field(in), 0, printed::kArea, printed::kShear, printed::rms(100),
                  printed::kThickness, printed::kFiniteSize);
  return agrees_if(point.friction > 0, point.friction, 0,
                   fmt::format("{:.3g} N at 100 V on 1 cm2", point.friction),
                   "with the gaps of the finite body below p_c");
}

Judgement friction_law(ClaimInputs& in) {
  const MeanField& field = skin_field(in);
  const auto friction = [&](double load, double amplitude) {
    return friction_at(field, load, printed::kArea, printed::kShear, printed::rms(amplitude),
                       printed::kThickness, printed::kFiniteSize);
  };
  const double base = friction(0.5, 0).friction;
  const double exponent =
      std::log((friction(0.5, 200).friction - base) / (friction(0.5, 100).friction - base)) /
      std::log(2.0);
  const double light = friction(0.2, 200).coefficient, heavy = friction(2, 200).coefficient;
  return agrees_if(std::abs(exponent - 2) <= 0.1 && heavy < light, exponent, 0,
                   fmt::format("exponent {:.3f}; mu(200 V) {:.2f} at 0.2 N, {:.2f} at 2 N; mu(0 V) "
                               "{:.3f}",
                               exponent, light, heavy, friction(1, 0).coefficient));
}

Judgement area_and_modulus(ClaimInputs&) {
  std::vector<double> areas;
  for (double modulus : {1e6, 10e6, 100e6}) {
    areas.push_back(pull_of(MeanField(wrist_spectrum(), printed::solid(modulus)), 100).area);
  }
  return trend(areas, false, "", 1, "A/A0 at 1, 10, 100 MPa, 100 V");
}

Judgement area_and_roughness(ClaimInputs&) {
  std::vector<double> areas;
  for (double factor : {0.25, 1.0, 4.0}) {
    areas.push_back(
        pull_of(MeanField(wrist_spectrum().scaled(factor), printed::solid()), 100).area);
  }
  return trend(areas, false, "", 1, "A/A0 with the spectrum times 1/4, 1, 4, 100 V");
}

Judgement area_and_skin_thickness(ClaimInputs&) {
  std::vector<double> areas, unforced;
  for (double thickness : {100e-6, 200e-6, 400e-6}) {
    MeanFieldSolid solid = printed::solid();
    solid.layer_thickness = thickness;
    const MeanField field(wrist_spectrum(), solid);
    // The stratum corneum is also a dielectric: d2/eps2 with the dry permittivity 3000.
    areas.push_back(pull_of(field, 200, printed::kPressure, 1e-6 / 3.9 + thickness / 3000).area);
    unforced.push_back(field.area(printed::kPressure));
  }
  return trend(
      areas, false, "", 1,
      fmt::format("A/A0 at 100, 200, 400 um, 200 V; without voltage it changes by {:.2g} %",
                  100 * std::abs(unforced.back() / unforced.front() - 1)));
}

Judgement area_and_dielectric(ClaimInputs& in) {
  std::vector<double> areas;
  for (double thickness : {0.1e-6, 0.3e-6, 1e-6}) {
    areas.push_back(pull_of(skin_field(in), 200, printed::kPressure, thickness).area);
  }
  return trend(areas, false, "", 1, "A/A0 at h0 = 0.1, 0.3, 1 um, 200 V");
}

Judgement area_and_load(ClaimInputs& in) {
  std::vector<double> areas;
  for (double pressure : {3e3, 10e3, 30e3}) {
    areas.push_back(pull_of(skin_field(in), 100, pressure).area);
  }
  return trend(areas, true, "", 1, "A/A0 at 3, 10, 30 kPa, 100 V");
}

PowerSpectrum smoothed(double modulus, double kappa = 2) {
  return plastic_smoothing(wrist_spectrum(), printed::solid(modulus), printed::kYield,
                           printed::kPressure, kappa);
}

Judgement area_and_plasticity(ClaimInputs&) {
  const MeanField elastic(wrist_spectrum(), printed::solid(1e9));
  const MeanField plastic(smoothed(1e9), printed::solid(1e9));
  return trend({pull_of(elastic, 100).area, pull_of(plastic, 100).area}, true, "", 1,
               "A/A0 at 1 GPa, elastic and with 50 MPa hardness, 100 V");
}

double area_ratio(const MeanField& field, double frequency, double gap_resistivity) {
  const SkinDielectric skin;
  const std::complex<double> h0 =
      series_thickness(1e-6 / 8, 200e-6, skin, frequency, gap_resistivity);
  const double pressure = 0.5 / printed::kArea;
  return solve_pull(field, pressure, printed::rms(100), h0, printed::kFiniteSize).area /
         field.area(pressure);
}

Judgement frequency_trend(ClaimInputs& in) {
  std::vector<double> ratios;
  for (double f : {10e3, 1e3, 100.0, 1.0}) ratios.push_back(area_ratio(skin_field(in), f, 0));
  return trend(ratios, true, "", 1,
               "A_on/A_off at 10 kHz, 1 kHz, 100 Hz, 1 Hz; skin from the printed anchors, not the "
               "measured curve");
}

Judgement conducting_gap(ClaimInputs& in) {
  std::vector<double> ratios;
  for (double resistivity : {0.0, 1e7, 1e5}) {
    ratios.push_back(area_ratio(skin_field(in), 1, resistivity));
  }
  return trend(ratios, false, "", 1,
               "A_on/A_off at 1 Hz, gap insulating, 1e7, 1e5 ohm m; a reading of Fig. 19b");
}

Judgement roughness(ClaimInputs&) {
  const PowerSpectrum wrist = wrist_spectrum();
  const double soft = smoothed(100e6, kPurePersson).rms(), hard = smoothed(1e9, kPurePersson).rms();
  const bool agrees = std::abs(wrist.rms() / 22e-6 - 1) < 0.02 &&
                      std::abs(wrist.slope() / 0.91 - 1) < 0.02 &&
                      std::abs(soft / 22e-6 - 1) < 0.02 && std::abs(hard / 20e-6 - 1) < 0.02;
  Judgement j =
      agrees_if(agrees, wrist.rms(), 0,
                fmt::format("rms {:.2f} um, slope {:.3f}; smoothed {:.2f} um (100 MPa), "
                            "{:.2f} um (1 GPa)",
                            1e6 * wrist.rms(), wrist.slope(), 1e6 * soft, 1e6 * hard),
                fmt::format("roll-off and cut-off of the spectrum were fitted to these numbers by "
                            "the pure theory; with kappa = 2 the last is {:.1f} um",
                            1e6 * smoothed(1e9).rms()));
  if (agrees) j.verdict = Verdict::Fitted;
  return j;
}

Judgement mean_gap(ClaimInputs& in) {
  const double gap = gap_field(in).mean_gap(printed::kPressure);
  const double stress = kVacuumPermittivity * square(printed::kAmplitude) / (4 * square(10e-6));
  return {Verdict::PaperInconsistent, gap, 0, fmt::format("{:.0f} um at 10 kPa", 1e6 * gap),
          fmt::format("10 um would give {:.0f} Pa, against its own 1-100 Pa (P4)", stress)};
}

Judgement plastic_area(ClaimInputs&) {
  // Elastic area with the smoothed spectrum against elastic plus yielded area with the original.
  double worst = 0;
  for (double modulus : {100e6, 1e9}) {
    const MeanFieldSolid solid = printed::solid(modulus);
    const MeanField original(wrist_spectrum(), solid), smooth(smoothed(modulus), solid);
    for (double q = 2e3; q < smooth.spectrum().highest(); q *= 1.3) {
      const ContactShares shares =
          plastic_shares(printed::kPressure, original.stress_measure(q), printed::kYield);
      worst = std::max(
          worst,
          std::abs(smooth.area(printed::kPressure, q) / (shares.elastic + shares.plastic) - 1));
    }
  }
  return agrees_if(worst < 0.02, worst, 0, fmt::format("within {:.2g} %", 100 * worst),
                   "100 MPa and 1 GPa, all magnifications");
}

Judgement corner(ClaimInputs&) {
  const double omega = 1 / (kVacuumPermittivity * 6e4 * 5000);
  return {Verdict::PaperInconsistent, omega, 0,
          fmt::format("{:.0f} 1/s, {:.0f} Hz", omega, omega / (2 * kPi)),
          "from its own permittivity 5000 and resistivity 6e4 ohm m"};
}

Judgement double_frequency(ClaimInputs&) {
  // Stress of every gap is the square of the voltage: lines of V^2 for a sine.
  const Signal voltage = source_signal(Waveform::Sine, 100, 1, {}, 1, 1, 64);
  Signal stress = voltage;
  for (double& v : stress.value) v *= v;
  const auto lines = spectrum_lines(stress, 32, 1e-12);
  const bool agrees = lines.size() == 2 && lines[1].frequency == 2 &&
                      std::abs(lines[1].amplitude / lines[0].amplitude - 1) < 1e-12;
  return agrees_if(agrees, lines[1].frequency, 0,
                   fmt::format("lines at 0 and {:g} f, equal", lines[1].frequency));
}

// ---- Johnsen-Rahbek and broadband: what the papers print.
namespace printed {
constexpr double kFingerArea = 30e-6;  // [m^2]
constexpr double kGapResistance = 17e6, kGapCapacitance = 250e-12;
constexpr double kMu = 0.2;

// A gap of 250 pF on 30 mm2; dielectric 1 um of 3.9 and skin 200 um of 2000, 2e4 ohm m.
Network network(double dielectric_resistance) {
  Network n;
  n.dielectric = {dielectric_resistance, kVacuumPermittivity * 3.9 * kFingerArea / 1e-6};
  n.gap = plane_gap(kVacuumPermittivity * kFingerArea / kGapCapacitance, 1, kGapResistance,
                    kFingerArea);
  n.skin = slab(200e-6, 2000, 2e4, kFingerArea);
  return n;
}
}  // namespace printed

double off_by(double a, double b) { return std::abs(a / b - 1); }

Judgement plate_pressure(ClaimInputs&) {
  const double area = 1e-4;
  const double force = plane_gap(1e-6, 1, 1e6, area).force_factor * square(100);
  return agrees_if(off_by(force, 4.4) < 0.01, force, 0, fmt::format("{:.3f} N/cm2", force));
}

Judgement gap_of_seven_newtons(ClaimInputs&) {
  const double area = 32.17e-6, voltage = 100e-6 * 7e6, force = 7;
  const double gap = std::sqrt(kVacuumPermittivity * area / 2 / force) * voltage;
  const double stated = plane_gap(1.8e-6, 1, 7e6, area).force_factor * square(voltage);
  return {Verdict::PaperInconsistent, gap, 0, fmt::format("{:.3f} um", 1e6 * gap),
          fmt::format("its Eq. 7 with its own numbers; 1.8 um would pull {:.1f} N", stated)};
}

Judgement direct_current(ClaimInputs&) {
  const Network n = printed::network(5e6);
  const double ratio =
      printed::kGapResistance / (5e6 + printed::kGapResistance + n.skin.resistance);
  const double error = off_by(respond(n, DriveControl::Voltage, 100, 0).mean_force,
                              n.gap.force_factor * square(100 * ratio));
  return agrees_if(error < 1e-10, error, 0, fmt::format("relative difference {:.1g}", error),
                   "0 Hz against the resistive divider");
}

Judgement high_frequency(ClaimInputs&) {
  const Network n = printed::network(5e6);
  const double stack = 1e-6 / 3.9 + 200e-6 / 2000 + n.gap.distance;
  const double plates =
      kVacuumPermittivity * printed::kFingerArea * square(100) / (2 * square(stack));
  const double error = off_by(2 * respond(n, DriveControl::Voltage, 100, 1e12).mean_force, plates);
  return agrees_if(
      error < 1e-10, error, 0, fmt::format("relative difference {:.1g}", error),
      "1e12 Hz against F = eps0 A V^2 / (2 eps_g (sum d/eps)^2); printed is a quotient "
      "of sums");
}

Judgement insulator(ClaimInputs&) {
  const double force =
      respond(printed::network(kInfinity), DriveControl::Voltage, 100, 0).mean_force;
  return agrees_if(force == 0, force, 0, fmt::format("{:g} N", force));
}

Judgement current_drive(ClaimInputs&) {
  Network other = printed::network(1e9);
  other.skin = slab(1e-3, 100, 1e5, printed::kFingerArea);
  double error = 0;
  for (double f : {0.0, 10.0, 1e3, 25e3}) {
    error = std::max(
        error, off_by(respond(other, DriveControl::Current, 1e-3, f).mean_force,
                      respond(printed::network(5e6), DriveControl::Current, 1e-3, f).mean_force));
  }
  return agrees_if(error < 1e-12, error, 0, fmt::format("relative difference {:.1g}", error),
                   "R_d 5 Mohm and 1 Gohm, two skins, 0 Hz to 25 kHz");
}

Judgement gap_corner(ClaimInputs&) {
  const double corner = printed::network(5e6).gap.layer.corner_frequency();
  return agrees_if(off_by(corner, 37) < 0.04, corner, 0, fmt::format("{:.2f} Hz", corner));
}

Judgement gap_distance(ClaimInputs&) {
  const double gap = printed::network(5e6).gap.distance;
  return agrees_if(off_by(gap, 1.1e-6) < 0.04, gap, 0, fmt::format("{:.3f} um", 1e6 * gap));
}

Judgement added_friction(ClaimInputs&) {
  const Network n = printed::network(5e6);
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

Judgement force_slope(ClaimInputs&) {
  const Network n = printed::network(5e6);
  const auto level = [&](double f) {
    return 20 * std::log10(respond(n, DriveControl::Current, 10e-6, f).ripple);
  };
  const double slope = level(1e4) - level(1e3);
  return agrees_if(std::abs(slope + 40) < 0.5, slope, 0, fmt::format("{:.2f} dB/decade", slope),
                   "1 to 10 kHz, current drive");
}

Judgement ripple_and_mean(ClaimInputs&) {
  const Signal source = source_signal(Waveform::Sine, 10e-6, 100, {}, 1, 0.01, 64);
  const ForceSeries s = force_series(printed::network(5e6), DriveControl::Current, source);
  const auto lines = spectrum_lines(s.force, 3e3, 1e-10);
  const bool agrees = lines.size() == 2 && std::abs(lines[1].frequency - 200) < 1e-6 &&
                      off_by(lines[1].amplitude, lines[0].amplitude) < 1e-10;
  return agrees_if(
      agrees, lines.back().frequency, 0,
      fmt::format("{} lines: mean, and {:g} Hz of 100 Hz", lines.size(), lines.back().frequency));
}

// Friction under three tones of a third each on a 25 kHz carrier, square law of the gap voltage.
ForceSeries three_tones(double exponent) {
  const Modulation m{{10, 100, 1000}, {1. / 3, 1. / 3, 1. / 3}};
  const Signal source = source_signal(Waveform::Am, 4e-3, 25e3, m, exponent, 0.1, 65536);
  return force_series(printed::network(5e6), DriveControl::Current, source);
}

Judgement flat_response(ClaimInputs&) {
  const auto line = [](double f) {
    const Signal source = source_signal(Waveform::Am, 4e-3, 25e3, {{f}, {0.5}}, 0.5, 0.1, 65536);
    return line_amplitude(force_series(printed::network(5e6), DriveControl::Current, source).force,
                          f);
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

Judgement distortion(ClaimInputs&) {
  // Through the network, so that the side bands' own slope is in it.
  const ForceSeries plain = three_tones(1), shaped = three_tones(0.5);
  const double wanted = line_amplitude(plain.force, 100);
  const double sum = line_amplitude(plain.force, 110) / wanted;
  const double second = line_amplitude(plain.force, 200) / wanted;
  // The law itself: a gap without capacitance.
  Network ideal = printed::network(5e6);
  ideal.gap.layer.capacitance = 1e-25;
  const Modulation m{{10, 100, 1000}, {1. / 3, 1. / 3, 1. / 3}};
  const Signal source = source_signal(Waveform::Am, 4e-3, 25e3, m, 0.5, 0.1, 65536);
  const double rest =
      total_distortion(force_series(ideal, DriveControl::Current, source).force, m.frequency, 10e3);
  return agrees_if(
      off_by(sum, 1. / 6) < 0.01 && off_by(second, 1. / 12) < 0.01 && rest < 1e-6, sum, 0,
      fmt::format("lines {:.4f} and {:.4f}; gamma = 1/2: {:.1g}, with the gap's slope "
                  "over the side bands {:.2g}",
                  sum, second, rest, total_distortion(shaped.force, m.frequency, 10e3)));
}

Judgement carrier_voltage(ClaimInputs&) {
  const DriveResponse r = respond(printed::network(5e6), DriveControl::Current, 4e-3, 25e3);
  return agrees_if(r.source_voltage < 150, r.source_voltage, 0,
                   fmt::format("{:.0f} V, of it gap {:.0f} V", r.source_voltage, r.gap_voltage),
                   "4 mA peak; the paper has 80 to 90 % in the gap");
}

Judgement chirp(ClaimInputs&) {
  Network ideal = printed::network(5e6);
  ideal.gap.layer.capacitance = 1e-25;
  const Signal source = source_signal(Waveform::Am, 4e-3, 25e3, {{15e3}, {1}}, 0.5, 1. / 5e3, 4096);
  const ForceSeries s = force_series(ideal, DriveControl::Current, source);
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

Judgement other_law(ClaimInputs&) {
  // Diamond-like carbon: quadratic below 1 mA, saturating above.
  const Modulation m{{10, 100, 1000}, {1. / 3, 1. / 3, 1. / 3}};
  const auto residue = [&](double exponent) {
    Signal force = source_signal(Waveform::Am, 4e-3, 25e3, m, exponent, 0.1, 65536);
    for (double& v : force.value) v = square(v) / (square(1e-3) + square(v));
    return total_distortion(force, m.frequency, 10e3);
  };
  const double plain = residue(1), shaped = residue(0.5);
  return agrees_if(
      shaped > plain, shaped / plain, 0,
      fmt::format("distortion {:.0f} % at 1/2, {:.0f} % at 1", 100 * shaped, 100 * plain),
      "force ~ I^2/(I^2 + (1 mA)^2), read off its description of the measured curve");
}

// ---- Stiction.

Judgement onset(ClaimInputs&) {
  const double stuck = onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 1);
  const double sliding = onset_friction(9e6, 1e-8, 0.3, 0.5, 0.2, 0);
  const bool agrees = off_by(stuck, 0.09) < 1e-12 && off_by(sliding, 0.3) < 1e-12;
  return agrees_if(agrees, sliding, 0, "the formula; its limits alpha = 0 and 1");
}

Judgement slip_states(ClaimInputs&) {
  StictionOptions options;
  options.stuck_current = options.partial_current = 4e-3;
  StictionMachine machine(options);
  // A finger drags to and fro at 3.8 Hz, 10 mm; friction builds up by Dahl's law.
  const double load = 0.5, stiffness = 800;
  double force = 0, place = 0, current = 0;
  int cycles = 0, wrong = 0;
  SlipState state = SlipState::Idle;
  for (int i = 0; i < 1000; ++i) {
    const double next = 10e-3 * std::sin(2 * kPi * 3.8 * i * options.step);
    const double step = (next - place) / 50;
    place = next;
    const double limit = 0.25 * (1 + 0.5 * square(current / 8e-3));
    for (int k = 0; k < 50; ++k)
      force += stiffness * step * (1 - force / limit * (step > 0 ? 1 : -1));
    current = machine.update(force, load);
    if (machine.state() == state) continue;
    const SlipState expected = state == SlipState::Stuck     ? SlipState::Partial
                               : state == SlipState::Partial ? SlipState::Full
                                                             : SlipState::Stuck;
    if (machine.state() != expected) ++wrong;
    state = machine.state();
    if (state == SlipState::Full) ++cycles;
    if ((current > 0) == (state == SlipState::Full)) ++wrong;
  }
  return agrees_if(wrong == 0 && cycles >= 6, cycles, 0,
                   fmt::format("{} swipes of 1 s in order, {} wrong steps", cycles, wrong),
                   "with the defects of the printed pseudo-code mended");
}

Judgement stickiness(ClaimInputs&) {
  std::string text;
  double worst = 0;
  for (double n : {-0.69, -0.74}) {
    std::vector<double> friction, load, stimulus;
    for (int i = 0; i < 160; ++i) {
      const double current = 2 + i % 7;
      load.push_back(0.2 + 0.8 * std::fmod(0.618 * i, 1.0));
      stimulus.push_back(square(current));
      friction.push_back((0.1 + 0.01 * square(current)) * std::pow(load.back(), -n) *
                         (1 + 0.02 * std::sin(37.0 * i)));
    }
    const double found = stickiness_exponent(friction, load, stimulus);
    worst = std::max(worst, std::abs(found - n));
    text += fmt::format("{}{:.3f}", text.empty() ? "" : ", ", found);
  }
  return {Verdict::NotTestable, worst, 0, "planted exponents found: " + text,
          "needs subjects; the fit finds planted exponents within 0.02"};
}

}  // namespace

std::vector<Claim> theory_claims() {
  const std::string mean_field = "mean-field electroadhesion", johnsen = "Johnsen-Rahbek",
                    broadband = "broadband electroadhesion", sticky = "stiction rendering";
  const auto claim = [](const std::string& source, const char* id, const char* statement,
                        const char* band, std::function<Judgement(ClaimInputs&)> judge) {
    return Claim{id, source, statement, band, false, std::move(judge)};
  };
  return {
      claim(mean_field, "P1", "A/A0 = 5e-4 at 10 kPa, 40 MPa, rms slope 1", "within 5 %",
            contact_area),
      claim(mean_field, "P2", "d1/eps1 = 0.26 um, d2/eps2 = 0.07 and 0.02 um",
            "rounds to the printed digits", dielectric_thickness),
      claim(mean_field, "P3", "charge relaxation 3e-4 s", "3e-4 to 5e-4 s", relaxation),
      claim(mean_field, "P4", "most of the area sees 1 to 100 Pa", "5 and 95 % quantiles inside",
            stress_range),
      claim(mean_field, "P5", "the force comes from stresses near eps0 V0^2/(4 h0^2)",
            "peak within 5 %", stress_peak),
      claim(mean_field, "P6", "finite size matters below about 1e4 Pa", "0.5e4 to 2e4 Pa",
            finite_size),
      claim(mean_field, "P7", "with voltage, friction stays finite as the load vanishes", "> 0",
            friction_without_load),
      claim(mean_field, "P8",
            "friction with tau = 8 MPa: effect ~ V^2; coefficient under 200 V falls with load",
            "exponent 1.9 to 2.1 below p_c; sign", friction_law),
      claim(mean_field, "P9", "area falls with the skin's modulus", "sign", area_and_modulus),
      claim(mean_field, "P10", "area falls with roughness", "sign", area_and_roughness),
      claim(mean_field, "P11", "area falls with the stratum corneum's thickness", "sign",
            area_and_skin_thickness),
      claim(mean_field, "P12", "area falls with h0", "sign", area_and_dielectric),
      claim(mean_field, "P13", "area rises with load", "sign", area_and_load),
      claim(mean_field, "P14", "plasticity raises the area at 1 GPa", "sign", area_and_plasticity),
      claim(mean_field, "P15", "A_on/A_off rises as the frequency falls", "sign", frequency_trend),
      claim(mean_field, "P16", "with a conducting gap it falls at low frequency", "sign",
            conducting_gap),
      claim(mean_field, "P17", "the force oscillates at twice the frequency", "exact",
            double_frequency),
      claim(mean_field, "P18",
            "roughness: rms 22 um, slope 0.91, H = 0.86; smoothed rms 22 and 20 um", "within 2 %",
            roughness),
      claim(mean_field, "P19", "mean gap about 10 um", "-", mean_gap),
      claim(mean_field, "P20", "elastic area with the smoothed spectrum = elastic + yielded area",
            "2 % at every magnification", plastic_area),
      claim(mean_field, "P21", "the skin conducts below 200 1/s or 30 Hz", "-", corner),
      claim(johnsen, "J1", "100 V over 1 um: 4.4 N/cm2", "within 1 %", plate_pressure),
      claim(johnsen, "J2", "7 N at 100 uA, 7 Mohm, 32.17 mm2: gap 1.8 um", "-",
            gap_of_seven_newtons),
      claim(johnsen, "J3", "direct current: resistances divide the voltage", "1e-10",
            direct_current),
      claim(johnsen, "J4", "high frequency: capacitances divide it (Eq. 11 restored)", "1e-10",
            high_frequency),
      claim(johnsen, "J5", "a perfect insulator gives no force at direct current", "exact",
            insulator),
      claim(johnsen, "J6", "under current drive dielectric and skin do not matter", "1e-12",
            current_drive),
      claim(broadband, "B1", "17 Mohm and 250 pF: 37 Hz", "within 4 %", gap_corner),
      claim(broadband, "B2", "250 pF on 30 mm2: gap 1.1 um", "within 4 %", gap_distance),
      claim(broadband, "B3", "added friction = alpha |I Z_gap|^2", "1e-12", added_friction),
      claim(broadband, "B4", "force falls 40 dB/decade above the corner", "within 0.5 dB",
            force_slope),
      claim(broadband, "B5", "a sine makes a rectified part and a ripple at 2f", "exact",
            ripple_and_mean),
      claim(broadband, "B6", "with a modulated carrier the response is flat", "within 1 % to 1 kHz",
            flat_response),
      claim(broadband, "B7", "three tones: gamma = 1 adds lines of 1/6 and 1/12, gamma = 1/2 none",
            "within 1 %; below 1e-6", distortion),
      claim(broadband, "B8", "4 mA at 25 kHz needs less than 150 V", "below 150 V",
            carrier_voltage),
      claim(broadband, "B9", "15 kHz on 25 kHz: lines at 15, 35, 50, 65 kHz", "exact", chirp),
      claim(broadband, "B10", "where the law is not quadratic, gamma = 1/2 is worse than gamma = 1",
            "sign", other_law),
      claim(sticky, "S1", "friction at onset: tau0 A + beta (W + F_e)(1 - alpha)", "formula",
            onset),
      claim(sticky, "S2", "stuck, partial, full slip; current only before full slip",
            "every step in order", slip_states),
      claim(sticky, "S3", "friction x load^n with n = -0.69 (force), -0.74 (judgement)", "-",
            stickiness),
  };
}

}  // namespace papilla
