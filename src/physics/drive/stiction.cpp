#include "physics/drive/stiction.h"

#include <cmath>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::drive {
namespace {

double correlation(std::span<const double> friction, std::span<const double> load,
                   std::span<const double> stimulus, double n) {
  const auto count = static_cast<double>(friction.size());
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0; i < friction.size(); ++i) {
    const double x = friction[i] * std::pow(load[i], n), y = stimulus[i];
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
  }
  const double spread = (sxx - sx * sx / count) * (syy - sy * sy / count);
  return spread > 0 ? (sxy - sx * sy / count) / std::sqrt(spread) : 0;
}

}  // namespace

double StictionMachine::update(double lateral, double normal) {
  if (normal < options_.minimum_load) {
    *this = StictionMachine(options_);
    return 0;
  }
  const double ratio = lateral / normal;
  const double rate = has_ratio_ ? (ratio - ratio_) / options_.step : 0;
  const double rate_before = rate_;
  ratio_ = ratio;
  rate_ = rate;
  has_ratio_ = true;
  if (std::abs(ratio) < options_.stuck_ratio) {
    if (state_ != SlipState::Stuck) largest_rate_ = 0;
    state_ = SlipState::Stuck;
    largest_rate_ = std::fmax(largest_rate_, std::abs(rate));
  } else if (state_ == SlipState::Stuck) {
    largest_rate_ = std::fmax(largest_rate_, std::abs(rate));
    if (std::abs(rate) < options_.rate_share * largest_rate_) state_ = SlipState::Partial;
  } else if (state_ == SlipState::Partial && rate_before * rate <= 0) {
    state_ = SlipState::Full;
  }
  switch (state_) {
    case SlipState::Idle:
      return 0;
    case SlipState::Stuck:
      return options_.stuck_current;
    case SlipState::Partial:
      return options_.partial_current;
    case SlipState::Full:
      return options_.full_current;
  }
  return 0;
}

LowPass::LowPass(double corner, double step) {
  PAPILLA_CHECK(corner > 0 && corner * step < 0.5, "a corner below half the rate of samples");
  const double k = std::tan(kPi * corner * step), damped = std::sqrt(2.0) * k;
  const double scale = 1 / (1 + damped + k * k);
  gain_ = k * k * scale;
  a1_ = 2 * (k * k - 1) * scale;
  a2_ = (1 - damped + k * k) * scale;
}

double LowPass::operator()(double value) {
  if (!started_) {
    in_ = out_ = {value, value};
    started_ = true;
  }
  const double next = gain_ * (value + 2 * in_[0] + in_[1]) - a1_ * out_[0] - a2_ * out_[1];
  in_ = {value, in_[0]};
  out_ = {next, out_[0]};
  return next;
}

std::vector<RubbingSample> rub(const RubbingFinger& finger, const StictionOptions& options,
                               const std::function<double(double)>& limit) {
  StictionMachine machine(options);
  std::vector<LowPass> filter;
  if (finger.filter > 0) filter.emplace_back(finger.filter, options.step);
  std::vector<RubbingSample> out;
  double force = 0, place = 0, current = 0;
  const auto steps = static_cast<int>(std::lround(finger.duration / options.step));
  for (int i = 0; i < steps; ++i) {
    const double time = i * options.step;
    const double next = finger.stroke * std::sin(2 * kPi * finger.frequency * time);
    const double moved = next - place, most = limit(current);
    place = next;
    // Dahl's law as it is solved where the limit is constant, as in a step of the machine.
    const double full = std::copysign(most, moved);
    force =
        most > 0 ? full + (force - full) * std::exp(-finger.stiffness * std::abs(moved) / most) : 0;
    const double felt = filter.empty() ? force : filter.front()(force);
    current = machine.update(felt, finger.load);
    out.push_back({time, place, force, machine.state(), current});
  }
  return out;
}

double stickiness_exponent(std::span<const double> friction, std::span<const double> load,
                           std::span<const double> stimulus, double low, double high) {
  PAPILLA_CHECK(
      friction.size() == load.size() && friction.size() == stimulus.size() && friction.size() >= 3,
      "one load and stimulus a friction");
  const auto at = [&](double n) { return correlation(friction, load, stimulus, n); };
  double best = low;  // coarse first: the correlation may have shoulders
  for (double n = low; n <= high + 1e-9; n += 0.05) {
    if (at(n) > at(best)) best = n;
  }
  low = std::fmax(low, best - 0.05);
  high = std::fmin(high, best + 0.05);
  while (high - low > 1e-4) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (at(a) < at(b)) {
      low = a;
    } else {
      high = b;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace papilla::drive
