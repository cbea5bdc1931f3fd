// Signals over time: amplitude-modulated carriers, the force they make, and its spectrum. All are
// periodic; sampled over exactly one common period, so that spectra have lines and no leakage.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "physics/drive/network.h"

namespace papilla::drive {

// m(t) = sum of amplitude sin(2 pi frequency t); full depth where the amplitudes sum to 1.
struct Modulation {
  std::vector<double> frequency, amplitude;  // [Hz], relative

  double at(double t) const;
};

// One period of a signal, uniformly sampled.
struct Signal {
  double period = 0;  // [s]
  std::vector<double> value;

  double step() const { return period / static_cast<double>(value.size()); }
};

// Smallest common period [s] of the frequencies (to a relative 1e-9), or 0 when it holds more than
// `most` periods of the lowest.
double common_period(const std::vector<double>& frequencies, int most = 10000);

// Waveform of a peak amplitude over a period: sine, square, dc, or
// amplitude [(1 + m)/(1 + depth)]^exponent sin(2 pi f t). samples is rounded up to a power of two.
// Eq. drive.7
Signal source_signal(Waveform waveform, double amplitude, double frequency,
                     const Modulation& modulation, double exponent, double period,
                     std::size_t samples);

// Gap voltage, force F = factor V_gap^2 [N], source voltage, and the current through the body (of
// a current source what its shunt leaves) of a source signal. The network is linear, so each line
// of the source passes by its own transfer. Eq. drive.8
struct ForceSeries {
  Signal source_voltage, current, gap_voltage, force;
  double peak_source_voltage = 0, peak_current = 0, peak_gap_voltage = 0;
  double peak_film_voltage = 0;  // across the dielectric
  double mean_force = 0;
};
ForceSeries force_series(const Network& network, DriveControl control, const Signal& source);

// A carrier without modulation: `respond` of a sine (am too) or a constant, of a square wave the
// series of one cycle, with the line of its force at twice the frequency. Eqs. drive.5, drive.8
DriveResponse carrier_response(const Network& network, DriveControl control, Waveform waveform,
                               double amplitude, double frequency);

struct SpectrumLine {
  double frequency = 0;  // [Hz]
  double amplitude = 0;  // of the cosine; at 0 Hz the mean
};
// All lines up to `highest` whose amplitude is at least `threshold` times the largest of f > 0.
std::vector<SpectrumLine> spectrum_lines(const Signal& signal, double highest,
                                         double threshold = 1e-6);
double line_amplitude(const Signal& signal, double frequency);

// Root of the sum of squares of all lines in (0, highest] that are not wanted, over that of the
// wanted. Eq. drive.9
double total_distortion(const Signal& signal, const std::vector<double>& wanted, double highest);

}  // namespace papilla::drive
