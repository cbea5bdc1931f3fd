#include "physics/drive/signal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/fft.h"

namespace papilla::drive {
namespace {

// Spectrum scaled so that value = sum over k of c_k e^(2 pi i k t / T), half kept.
SpectrumArray transform(const std::vector<double>& value) {
  const auto fft = Fft2d::shared(static_cast<int>(value.size()), 1);
  RealArray real(value.begin(), value.end());
  SpectrumArray spectrum(fft->spectrum_size());
  fft->forward(real.data(), spectrum.data());
  for (auto& c : spectrum) c /= static_cast<double>(value.size());
  return spectrum;
}

std::vector<double> back(SpectrumArray spectrum, std::size_t samples) {
  const auto fft = Fft2d::shared(static_cast<int>(samples), 1);
  RealArray real(fft->real_size());
  fft->inverse(spectrum.data(), real.data());
  return {real.begin(), real.end()};
}

double peak(const std::vector<double>& value) {
  double most = 0;
  for (double v : value) most = std::max(most, std::abs(v));
  return most;
}

double amplitude_of(const SpectrumArray& spectrum, std::size_t k) {
  return (k == 0 ? 1 : 2) * std::abs(spectrum[k]);
}

std::size_t line_of(const Signal& signal, double frequency) {
  return static_cast<std::size_t>(std::lround(frequency * signal.period));
}

}  // namespace

double Modulation::at(double t) const {
  double sum = 0;
  for (std::size_t i = 0; i < frequency.size(); ++i) {
    sum += amplitude[i] * std::sin(2 * kPi * frequency[i] * t);
  }
  return sum;
}

double common_period(const std::vector<double>& frequencies, int most) {
  double lowest = kInfinity;
  for (double f : frequencies) {
    if (f > 0) lowest = std::min(lowest, f);
  }
  if (std::isinf(lowest)) return 1;
  for (int n = 1; n <= most; ++n) {
    const double period = n / lowest;
    const bool fits = std::all_of(frequencies.begin(), frequencies.end(), [&](double f) {
      const double turns = f * period;
      return std::abs(turns - std::round(turns)) <= 1e-9 * std::max(1.0, turns);
    });
    if (fits) return period;
  }
  return 0;
}

Signal source_signal(Waveform waveform, double amplitude, double frequency,
                     const Modulation& modulation, double exponent, double period,
                     std::size_t samples) {
  PAPILLA_CHECK(modulation.frequency.size() == modulation.amplitude.size(),
                "one amplitude per frequency");
  Signal out{period, std::vector<double>(std::bit_ceil(samples))};
  constexpr double kRounding = 1e-9;  // of a turn: an edge early by one sample would be a mean
  const double depth =
      std::accumulate(modulation.amplitude.begin(), modulation.amplitude.end(), 0.0);
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const double t = period * static_cast<double>(i) / static_cast<double>(out.value.size());
    const double wave = std::sin(2 * kPi * frequency * t);
    double v = amplitude;
    if (waveform == Waveform::Sine) v *= wave;
    if (waveform == Waveform::Square) v *= std::fmod(frequency * t + kRounding, 1.0) < 0.5 ? 1 : -1;
    if (waveform == Waveform::Am) {
      v *= wave * std::pow(std::max(0.0, (1 + modulation.at(t)) / (1 + depth)), exponent);
    }
    out.value[i] = v;
  }
  return out;
}

ForceSeries force_series(const Network& network, DriveControl control, const Signal& source) {
  const std::size_t n = source.value.size();
  const SpectrumArray spectrum = transform(source.value);
  double most = 0;
  for (const auto& c : spectrum) most = std::max(most, std::abs(c));
  SpectrumArray gap = spectrum, film = spectrum, voltage = spectrum, current = spectrum;
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    if (std::abs(spectrum[k]) <= 1e-15 * most) {  // rounding: no line, whatever the transfer
      gap[k] = film[k] = voltage[k] = current[k] = 0;
      continue;
    }
    const Transfer t = transfer(network, control, static_cast<double>(k) / source.period);
    gap[k] *= t.gap_voltage;
    film[k] *= t.film_voltage;
    voltage[k] *= t.source_voltage;
    current[k] *= t.current;
  }
  ForceSeries out;
  out.gap_voltage = {source.period, back(std::move(gap), n)};
  const double held = network.gap.held;
  std::vector<double> film_voltage = back(std::move(film), n);
  // What the gap does not take stands on the film. Eq. drive.23
  for (std::size_t i = 0; i < n; ++i) {
    double& v = out.gap_voltage.value[i];
    const double taken = std::clamp(v, -held, held);
    film_voltage[i] += v - taken;
    v = taken;
  }
  // What the source holds is taken as it is. A shunt takes a part of a held current, and the rest
  // alone flows through the body.
  const bool holds_voltage = control == DriveControl::Voltage;
  const bool holds_current = !holds_voltage && std::isinf(network.shunt);
  out.source_voltage = holds_voltage ? source : Signal{source.period, back(std::move(voltage), n)};
  out.current = holds_current ? source : Signal{source.period, back(std::move(current), n)};
  out.force = out.gap_voltage;
  for (double& f : out.force.value) f = network.gap.force_factor * f * f;
  out.peak_source_voltage = peak(out.source_voltage.value);
  out.peak_current = peak(out.current.value);
  out.peak_gap_voltage = peak(out.gap_voltage.value);
  out.peak_film_voltage = peak(film_voltage);
  out.mean_force =
      std::accumulate(out.force.value.begin(), out.force.value.end(), 0.0) / static_cast<double>(n);
  return out;
}

DriveResponse carrier_response(const Network& network, DriveControl control, Waveform waveform,
                               double amplitude, double frequency) {
  if (waveform != Waveform::Square)
    return respond(network, control, amplitude, waveform == Waveform::Dc ? 0 : frequency);
  constexpr std::size_t kSamples = 4096;  // of a cycle with edges
  const ForceSeries series =
      force_series(network, control,
                   source_signal(waveform, amplitude, frequency, {}, 1, 1 / frequency, kSamples));
  return {.gap_voltage = series.peak_gap_voltage,
          .source_voltage = series.peak_source_voltage,
          .current = series.peak_current,
          .mean_force = series.mean_force,
          .ripple = line_amplitude(series.force, 2 * frequency),
          .film_voltage = series.peak_film_voltage};
}

std::vector<SpectrumLine> spectrum_lines(const Signal& signal, double highest, double threshold) {
  const SpectrumArray spectrum = transform(signal.value);
  const std::size_t end = std::min(spectrum.size(), line_of(signal, highest) + 1);
  double most = 0;
  for (std::size_t k = 1; k < end; ++k) most = std::max(most, amplitude_of(spectrum, k));
  std::vector<SpectrumLine> lines{{0, spectrum[0].real()}};
  for (std::size_t k = 1; k < end; ++k) {
    const double amplitude = amplitude_of(spectrum, k);
    if (amplitude > 0 && amplitude >= threshold * most) {
      lines.push_back({static_cast<double>(k) / signal.period, amplitude});
    }
  }
  return lines;
}

double line_amplitude(const Signal& signal, double frequency) {
  const SpectrumArray spectrum = transform(signal.value);
  const std::size_t k = line_of(signal, frequency);
  return k < spectrum.size() ? amplitude_of(spectrum, k) : 0;
}

double total_distortion(const Signal& signal, const std::vector<double>& wanted, double highest) {
  const SpectrumArray spectrum = transform(signal.value);
  const std::size_t end = std::min(spectrum.size(), line_of(signal, highest) + 1);
  double good = 0, bad = 0;
  for (std::size_t k = 1; k < end; ++k) {
    const bool is_wanted = std::any_of(wanted.begin(), wanted.end(),
                                       [&](double f) { return line_of(signal, f) == k; });
    (is_wanted ? good : bad) += square(amplitude_of(spectrum, k));
  }
  return good > 0 ? std::sqrt(bad / good) : 0;
}

}  // namespace papilla::drive
