#include "forward/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/reductions.h"

namespace papilla::forward {
namespace {

// A neighbour's slope is a guess: one that is too steep would step over the root.
constexpr double kSteepestGuess = 0.7;
// A step by the chord of the last two answers, as long as it leads anywhere; the answer itself is
// the shortest step, but between two answers.
constexpr double kSteepestChord = 0.95, kFlattestChord = -3;
// Droplets that come to bridge and tractions whose shape is that of the gap before move F by some
// thousandths of the total load: over a shorter way than this share of it they would make the
// chord.
constexpr double kShortest = 0.02;
// The share of the attraction that is applied rises to 1 at the equilibrium. Where it falls again
// by this over a way that is longer than that, a fold lies behind.
constexpr double kFalls = 0.02, kPastFold = 0.1;
// No step more than doubles the total load.
constexpr double kLongestStep = 1.0;

}  // namespace

EquilibriumSearch::EquilibriumSearch(double load, const Answer& first, double slope,
                                     double tolerance)
    : load_(load),
      tolerance_(tolerance),
      slope_(std::clamp(slope, 0.0, kSteepestGuess)),
      last_(first) {
  PAPILLA_CHECK(load > 0, "a load presses");
  applied_ = first.applied + (first.attraction - first.applied) / (1 - slope_);
}

EquilibriumSearch::Next EquilibriumSearch::found(double attraction) {
  if (!std::isfinite(attraction)) return Next::Jumped;
  const double total = load_ + std::max(attraction, 0.0), moved = applied_ - last_.applied;
  const double excess = attraction - applied_, before = last_.attraction - last_.applied;
  const double straight = (attraction - last_.attraction) / moved;
  if (std::abs(moved) > kShortest * total) slope_ = std::clamp(straight, 0.0, kSteepestChord);
  // Between two answers on either side of the root the chord leads to what lies between them.
  const double chord = excess * before < 0 ? std::clamp(straight, kFlattestChord, slope_) : slope_;
  const double step = excess / (1 - chord);
  residual_ = std::abs(step) / total;
  if (residual_ <= tolerance_) return Next::Settled;
  const auto applied_share = [](const Answer& answer) {
    return answer.applied / answer.attraction;
  };
  if (moved > kPastFold * total && before > 0 && excess > 0 && last_.applied > 0 &&
      applied_share({applied_, attraction}) < (1 - kFalls) * applied_share(last_))
    return Next::Jumped;
  last_ = {applied_, attraction};
  applied_ += std::min(step, kLongestStep * (load_ + std::max(applied_, 0.0)));
  return Next::Ask;
}

std::vector<double> TractionShape::expected(const std::vector<double>& traction) {
  constexpr double kLargestShare = 0.8;
  std::vector<double> out = traction;
  const double level = sum(traction) / static_cast<double>(std::max<std::size_t>(out.size(), 1));
  if (level == 0) return out;
  std::vector<double> shape(traction.size()), step(traction.size());
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] = traction[i] / level;
  if (!last_.empty()) {
    double along = 0, before = 0;
    for (std::size_t i = 0; i < shape.size(); ++i) step[i] = shape[i] - last_[i];
    for (std::size_t i = 0; i < step_.size(); ++i) {
      along += step[i] * step_[i];
      before += square(step_[i]);
    }
    const double share = before > 0 ? std::clamp(along / before, 0.0, kLargestShare) : 0;
    const double more = share / (1 - share) * level;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double most = 2 * std::abs(out[i]);
      out[i] = std::clamp(out[i] + more * step[i], -most, most);
    }
    step_ = std::move(step);
  }
  last_ = std::move(shape);
  return out;
}

}  // namespace papilla::forward
