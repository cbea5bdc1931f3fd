#include "optim/fit_profile.h"

#include <algorithm>
#include <cmath>

namespace papilla {
namespace {

constexpr double kPrecision = 1e-3;  // of an end, relative to its distance; of the rise
constexpr int kMostRefits = 40;      // for one end
constexpr int kHalvedEvery = 3;      // refits, where the secant stalls
constexpr double kInnermost = 0.02;  // least share of the bracket that a secant's step goes into it

}  // namespace

FitProfile::FitProfile(TrustRegion& solver, const FitCoordinates& coordinates,
                       const FitSolution& best, std::size_t i, double rise, int iterations)
    : solver_(solver),
      coordinates_(coordinates),
      best_(best),
      i_(i),
      rise_(rise),
      iterations_(iterations) {
  std::vector<bool> fixed(coordinates.size(), false);
  fixed[i] = true;
  free_ = all_but(fixed);
}

double FitProfile::end(double direction, double first, bool& open) {
  const FitParameter& p = coordinates_.parameter(i_);
  const double bound = coordinates_.to(i_, direction > 0 ? p.high : p.low);
  start_ = best_.x;
  Bracket bracket{best_.x[i_], best_.x[i_], -rise_, 0};
  open = !step_out(bracket, direction, first, bound);
  return open ? bound : root(bracket);
}

double FitProfile::excess(double x) {
  start_[i_] = x;
  const FitSolution s = solver_.solve(start_, free_, iterations_);
  start_ = s.x;  // the next refit starts near
  return s.sum() - best_.sum() - rise_;
}

// Doubled steps until the rise is reached; false where the bound is.
bool FitProfile::step_out(Bracket& b, double direction, double step, double bound) {
  for (;;) {
    b.outside = b.inside + direction * step;
    const bool last = direction > 0 ? b.outside >= bound : b.outside <= bound;
    if (last) b.outside = bound;
    if (b.outside == b.inside) return false;
    b.value_out = excess(b.outside);
    if (b.value_out > 0) return true;
    if (last) return false;
    b.inside = b.outside;
    b.value_in = b.value_out;
    step *= 2;
  }
}

// Secant on the root of the rise, which is nearly straight; halved where that stalls.
double FitProfile::root(Bracket b) {
  for (int k = 0; k < kMostRefits &&
                  std::abs(b.outside - b.inside) > kPrecision * std::abs(b.outside - best_.x[i_]);
       ++k) {
    const double low = std::sqrt(std::max(0.0, b.value_in + rise_));
    const double high = std::sqrt(b.value_out + rise_);
    double t = high > low ? (std::sqrt(rise_) - low) / (high - low) : 0.5;
    t = k % kHalvedEvery == kHalvedEvery - 1 ? 0.5 : std::clamp(t, kInnermost, 1 - kInnermost);
    const double x = b.inside + t * (b.outside - b.inside);
    const double v = excess(x);
    if (std::abs(v) < kPrecision * rise_) return x;
    (v > 0 ? b.outside : b.inside) = x;
    (v > 0 ? b.value_out : b.value_in) = v;
  }
  return 0.5 * (b.inside + b.outside);
}

}  // namespace papilla
