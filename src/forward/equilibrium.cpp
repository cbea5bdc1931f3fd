#include "forward/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "numerics/reductions.h"

namespace papilla::forward {
namespace {

// A neighbour's slope is a guess: one that is too steep would step over the root.
constexpr double kSteepestGuess = 0.7;
// The mean steps by that of a law of one number between these slopes ...
constexpr double kSteepest = 0.95, kFlattest = -3;
// ... or by this share of the total load: droplets that come to bridge, and tractions whose shape
// is on its way, move T by so much without a step of the mean.
constexpr double kShort = 0.02;
// No step more than doubles the total load.
constexpr double kLongestStep = 1.0;
// The share of the attraction that is applied rises to 1 at the equilibrium. Where it falls again
// by this over a way that is longer than that, a fold lies behind.
constexpr double kFalls = 0.02, kPastFold = 0.1;
// States that are mixed; what they differ by counts where newer ones leave so much of its square.
constexpr std::size_t kStates = 4;
constexpr double kLeastNew = 1e-6;
// What a step counts whose places cancel in the mean.
constexpr double kOfMoves = 0.25;
// What the mean counts beside the places: it closes the gap everywhere.
constexpr double kMeanWeight = 100;

double mean(const std::vector<double>& v) { return sum(v) / static_cast<double>(v.size()); }

double mean_size(const std::vector<double>& v) {
  double sizes = 0;
  for (const double x : v) sizes += std::abs(x);
  return sizes / static_cast<double>(v.size());
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  return dot(a, b) / static_cast<double>(a.size()) + kMeanWeight * mean(a) * mean(b);
}

void subtract(double share, const std::vector<double>& other, std::vector<double>& from) {
  for (std::size_t i = 0; i < from.size(); ++i) from[i] -= share * other[i];
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  subtract(1, b, a);
  return a;
}

}  // namespace

std::vector<double> with_mean(std::vector<double> traction, double wanted) {
  const double size = mean_size(traction);
  if (size == 0) return traction;
  const double more = (wanted - mean(traction)) / size;
  for (double& t : traction) t += more * std::abs(t);
  return traction;
}

EquilibriumSearch::EquilibriumSearch(double load, State first, double slope, double tolerance)
    : load_(load), tolerance_(tolerance), slope_(std::clamp(slope, 0.0, kSteepestGuess)) {
  PAPILLA_CHECK(load > 0, "a load presses");
  PAPILLA_CHECK(first.applied.size() == first.attraction.size(), "a traction at each place");
  const double applied = mean(first.applied), attraction = mean(first.attraction);
  applied_ = with_mean(first.attraction, applied + (attraction - applied) / (1 - slope_));
  states_.push_back(std::move(first));
}

// Eq. coupling.15
std::vector<double> EquilibriumSearch::mixed() const {
  struct Way {
    std::vector<double> residual, attraction;
  };
  const auto of = [](const State& s) {
    return Way{difference(s.attraction, s.applied), s.attraction};
  };
  const Way newest = of(states_.back());
  Way out = newest;
  std::vector<Way> known;  // residuals at right angles
  for (auto state = states_.rbegin() + 1; state != states_.rend(); ++state) {
    const Way before = of(*state);
    Way way{difference(newest.residual, before.residual),
            difference(newest.attraction, before.attraction)};
    const auto take_away = [&](const Way& other, Way& from) {
      const double share =
          product(from.residual, other.residual) / product(other.residual, other.residual);
      subtract(share, other.residual, from.residual);
      subtract(share, other.attraction, from.attraction);
    };
    const double whole = product(way.residual, way.residual);
    for (const Way& other : known) take_away(other, way);
    if (!(product(way.residual, way.residual) > kLeastNew * whole)) continue;
    take_away(way, out);
    known.push_back(std::move(way));
  }
  return std::move(out.attraction);
}

EquilibriumSearch::Next EquilibriumSearch::found(std::vector<double> attraction) {
  const double a = mean(applied_), f = mean(attraction);
  if (!std::isfinite(f)) return Next::Jumped;
  const double a_before = mean(states_.back().applied), f_before = mean(states_.back().attraction);
  const double total = load_ + std::max(f, 0.0), moved = a - a_before, excess = f - a;
  if (std::abs(moved) > kShort * total) slope_ = std::clamp((f - f_before) / moved, 0.0, kSteepest);
  states_.push_back({std::move(applied_), std::move(attraction)});
  if (states_.size() > kStates) states_.erase(states_.begin());
  applied_ = mixed();
  const double step = mean(applied_) - a;
  // The mean alone may pause while the shape is on its way.
  const double moves = mean_size(difference(applied_, last().applied));
  residual_ = std::max(std::abs(step), kOfMoves * moves) / total;
  if (residual_ <= tolerance_) return Next::Settled;
  if (moved > kPastFold * total && f_before > a_before && excess > 0 && a_before > 0 &&
      a / f < (1 - kFalls) * a_before / f_before)
    return Next::Jumped;
  const auto [least, most] = std::minmax({excess / (1 - kSteepest), excess / (1 - kFlattest)});
  const double bounded = std::min(std::clamp(step, least - kShort * total, most + kShort * total),
                                  kLongestStep * (load_ + std::max(a, 0.0)));
  if (bounded != step) applied_ = with_mean(last().attraction, a + bounded);
  return Next::Ask;
}

}  // namespace papilla::forward
