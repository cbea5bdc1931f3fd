// Rendered stickiness: current only until the finger slips. A state machine on the ratio of lateral
// to normal force, one step per sample.
#pragma once

#include <span>

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

// Exponent n with the highest correlation of friction x load^n with a stimulus (current squared,
// or a judgement), in [low, high], to 1e-4. Eq. drive.11
double stickiness_exponent(std::span<const double> friction, std::span<const double> load,
                           std::span<const double> stimulus, double low = -2, double high = 1);

}  // namespace papilla::drive
