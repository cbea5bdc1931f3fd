// The equilibrium of a patch under attractions that its own gap decides: the search for it, in
// numbers alone. Eq. coupling.2
#pragma once

#include <array>
#include <vector>

#include "base/rooms.h"

namespace papilla::forward {

// Tractions of this shape with another mean; all of them 0: no shape.
std::vector<double> with_mean(std::vector<double> traction, double wanted);

// Share of the places that the load alone has to leave open for attraction to have a gap to close.
// Eq. coupling.2
constexpr double kLeastLeftOpen = 0.05;

// Whether attraction has closed a gap: of so many places those that touch under the load alone, and
// those that touch under both. What the load has closed itself no attraction pulled in, and where
// it leaves less than kLeastLeftOpen, closing that is no pull-in: its attraction is a part of all
// that acts on the patch, whatever the gap there. Eq. coupling.2
bool is_pulled_shut(double places, double under_load, double touching);

// Seeks the tractions t that the gap which they close attracts with: T(t) = t, on the branch that
// rises from t = 0. T is known where it is asked for: each state is a contact under t, whose gap
// gives T. What the states found so far would attract with where their residuals T - t cancel best
// is asked for next (Anderson), with bounds on the mean. Eq. coupling.15
class EquilibriumSearch {
 public:
  enum class Next {
    Ask,      // solve the state of applied()
    Settled,  // t is the equilibrium to the tolerance
    Jumped,   // the mean T > t and t/T falls: the voltage of a smaller gap is lower, it jumps shut
  };

  struct State {
    std::vector<double> applied, attraction;  // t, T(t) [Pa], as many as there are places
  };
  // load: what presses without attraction, > 0 [Pa]; first: a state that is known, below the
  // equilibrium; slope: dT/dt of the means as far as it is known of a neighbour (0: unknown);
  // tolerance: of t, relative to load + T.
  EquilibriumSearch(double load, State first, double slope, double tolerance);

  const std::vector<double>& applied() const { return applied_; }  // the next to be asked for
  Next found(std::vector<double> attraction);                      // T(applied())
  const State& last() const { return states_.back(); }             // the last that was found

  // Distance to the equilibrium after the last answer, relative to load + T.
  double residual() const { return residual_; }
  double slope() const { return slope_; }  // dT/dt of the means of the last two answers

 private:
  // States that are mixed.
  static constexpr std::size_t kStates = 4;
  using Weights = std::array<double, kStates>;

  void keep(State state);
  Weights weights() const;
  std::vector<double> mixed() const;

  double load_, tolerance_, slope_, residual_ = 1;
  std::vector<State> states_;                   // the newest last
  std::vector<std::vector<double>> residuals_;  // T - t of each
  std::array<Weights, kStates> products_{};     // of their residuals
  std::vector<double> applied_;
};

}  // namespace papilla::forward
