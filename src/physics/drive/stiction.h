// Rendered stickiness: current only until the finger slips. A state machine on the ratio of lateral
// to normal force, one step per sample.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/rooms.h"

namespace papilla::drive {

enum class SlipState { Idle, Stuck, Partial, Full };  // Idle: too light a touch, or not yet known

struct StictionOptions {
  double step = 1e-3;           // [s] between samples; forces low-passed at 150 Hz before
  double minimum_load = 0.025;  // [N]
  double stuck_ratio = 0.1;     // |lateral/normal| below which the patch is stuck
  double rate_share = 0.9;      // partial slip: |rate| below this share of its largest since stuck
  double stuck_current = 0, partial_current = 0, full_current = 0;
};

// Start: Idle, no current. Below the minimum load: Idle, all memory cleared. |ratio| inside the
// band: Stuck. Stuck and outside the band, rate below its share of the largest: Partial. Partial
// and the rate changes sign: Full, until the ratio falls into the band again. One step to a further
// state a sample. Eq. drive.10
class StictionMachine {
 public:
  explicit StictionMachine(const StictionOptions& options) : options_(options) {}

  double update(double lateral, double normal);  // forces [N] -> current
  SlipState state() const { return state_; }

 private:
  StictionOptions options_;
  SlipState state_ = SlipState::Idle;
  bool has_ratio_ = false;
  double ratio_ = 0, rate_ = 0, largest_rate_ = 0;
};

// Butterworth's low-pass of second order, sample by sample; at rest at its first value. Eq.
// drive.17
class LowPass {
 public:
  LowPass(double corner, double step);  // [Hz], below half the rate of samples; [s]

  double operator()(double value);

 private:
  double gain_, a1_, a2_;
  bool started_ = false;
  std::array<double, 2> in_{}, out_{};  // the last and the one before
};

// A finger that drags to and fro over the surface, its friction building up by Dahl's law, and what
// the state machine makes of it. Eq. drive.18
struct RubbingFinger {
  double load = 0.5;       // [N]
  double stroke = 10e-3;   // amplitude of its way [m]
  double frequency = 3.8;  // [Hz]
  double stiffness = 800;  // of the skin, sideways [N/m]
  double filter = 0;       // corner of the low-pass before the machine [Hz]; 0: none
  double duration = 1;     // [s]
};
struct RubbingSample {
  double time, place, lateral;  // [s], [m], [N]
  SlipState state;
  double current;  // from then on [A]
};
// limit: friction at full slip under a current [A] -> [N], 0: nothing rubs. One sample a step of
// the options; no force is beyond the largest limit so far, whatever the stiffness.
std::vector<RubbingSample> rub(const RubbingFinger& finger, const StictionOptions& options,
                               const std::function<double(double)>& limit);

// Exponent n with the highest correlation of friction x load^n with a stimulus (current squared,
// or a judgement), in [low, high], to 1e-4. Eq. drive.11
double stickiness_exponent(std::span<const double> friction, std::span<const double> load,
                           std::span<const double> stimulus, double low = -2, double high = 1);

}  // namespace papilla::drive
