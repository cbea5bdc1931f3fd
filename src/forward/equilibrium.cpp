#include "forward/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "numerics/loops.h"
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
// What states differ by counts where newer ones leave so much of its square.
constexpr double kLeastNew = 1e-6;
// What a step counts whose places cancel in the mean.
constexpr double kOfMoves = 0.25;
// What the mean counts beside the places: it closes the gap everywhere.
constexpr double kMeanWeight = 100;

double mean_size(const std::vector<double>& v) {
  return sum_over(v.size(), [&](auto at) { return larger(at(v), -at(v)); }) /
         static_cast<double>(v.size());
}

double mean_distance(const std::vector<double>& a, const std::vector<double>& b) {
  return sum_over(a.size(), [&](auto at) { return larger(at(a) - at(b), at(b) - at(a)); }) /
         static_cast<double>(a.size());
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  return dot(a, b) / static_cast<double>(a.size()) + kMeanWeight * mean(a) * mean(b);
}

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

bool is_pulled_shut(double places, double under_load, double touching) {
  constexpr double kFull = 0.9;
  const double open = places - under_load;
  return open >= kLeastLeftOpen * places && touching - under_load > kFull * open;
}

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
  keep(std::move(first));
}

void EquilibriumSearch::keep(State state) {
  if (states_.size() == kStates) {
    states_.erase(states_.begin());
    residuals_.erase(residuals_.begin());
    for (std::size_t i = 1; i < kStates; ++i)
      std::copy(products_[i].begin() + 1, products_[i].end(), products_[i - 1].begin());
  }
  residuals_.push_back(difference(state.attraction, state.applied));
  states_.push_back(std::move(state));
  const std::size_t newest = states_.size() - 1;
  for (std::size_t i = 0; i <= newest; ++i)
    products_[i][newest] = products_[newest][i] = product(residuals_[i], residuals_[newest]);
}

// How much of each state the mixture has whose residual is the least; their sum is 1. Differences
// of states are sums over states too, so nothing here is as long as a map. Eq. coupling.15
EquilibriumSearch::Weights EquilibriumSearch::weights() const {
  const std::size_t newest = states_.size() - 1;
  const auto of = [&](const Weights& a, const Weights& b) {
    double out = 0;
    for (std::size_t i = 0; i <= newest; ++i) {
      for (std::size_t j = 0; j <= newest; ++j) out += a[i] * b[j] * products_[i][j];
    }
    return out;
  };
  Weights out{};
  out[newest] = 1;
  std::vector<Weights> known;  // differences whose residuals are at right angles
  const auto take_away = [&](const Weights& other, Weights& from) {
    const double share = of(from, other) / of(other, other);
    for (std::size_t i = 0; i <= newest; ++i) from[i] -= share * other[i];
  };
  for (std::size_t before = newest; before-- > 0;) {
    Weights way{};
    way[newest] = 1;
    way[before] = -1;
    const double whole = of(way, way);
    for (const Weights& other : known) take_away(other, way);
    if (!(of(way, way) > kLeastNew * whole)) continue;
    take_away(way, out);
    known.push_back(way);
  }
  return out;
}

// What the mixture would attract with.
std::vector<double> EquilibriumSearch::mixed() const {
  const Weights share = weights();
  std::vector<double> out(states_.back().applied.size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const std::vector<double>& attraction = states_[k].attraction;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += share[k] * attraction[i];
  }
  return out;
}

EquilibriumSearch::Next EquilibriumSearch::found(std::vector<double> attraction) {
  const double a = mean(applied_), f = mean(attraction);
  if (!std::isfinite(f)) return Next::Jumped;
  const double a_before = mean(states_.back().applied), f_before = mean(states_.back().attraction);
  const double total = load_ + std::max(f, 0.0), moved = a - a_before, excess = f - a;
  if (std::abs(moved) > kShort * total) slope_ = std::clamp((f - f_before) / moved, 0.0, kSteepest);
  keep({std::move(applied_), std::move(attraction)});
  applied_ = mixed();
  const double step = mean(applied_) - a;
  // The mean alone may pause while the shape is on its way.
  const double moves = mean_distance(applied_, last().applied);
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
