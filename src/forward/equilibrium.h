// The equilibrium of a patch under attractions that its own gap decides: the search for it, in
// numbers alone. Eq. coupling.2
#pragma once

#include <vector>

#include "base/rooms.h"

namespace papilla::forward {

// Seeks the mean attraction a that the gap which it closes attracts with: F(a) = a, on the branch
// that rises from a = 0. F is known where it is asked for: each state is a contact under a, whose
// gap gives F. A secant on the residual F - a, which stays below the root where F bends upwards,
// as it does for a closing gap.
class EquilibriumSearch {
 public:
  enum class Next {
    Ask,      // solve the state of applied()
    Settled,  // a is the equilibrium to the tolerance
    Jumped,   // F > a and a/F falls: the voltage of a smaller gap is lower, it jumps shut
  };

  struct Answer {
    double applied = 0, attraction = 0;  // a, F(a)
  };
  // load: what presses without attraction, > 0; first: a state that is known, below the
  // equilibrium; slope: dF/da as far as it is known of a neighbour (0: unknown); tolerance: of a,
  // relative to load + a.
  EquilibriumSearch(double load, const Answer& first, double slope, double tolerance);

  double applied() const { return applied_; }  // the next to be asked for
  Next found(double attraction);               // F(applied())

  // Distance to the equilibrium after the last answer, relative to load + a.
  double residual() const { return residual_; }
  double slope() const { return slope_; }  // dF/da of the last two answers

 private:
  double load_, tolerance_, applied_, slope_, residual_ = 1;
  Answer last_;
};

// Where the shape of the tractions is going from state to state: spots beside contact close over
// several of them, each time by about the same share of the way before (Aitken). Eq. coupling.15
class TractionShape {
 public:
  // The newest tractions [Pa] at the end of their way; nowhere more than twice as strong.
  std::vector<double> expected(const std::vector<double>& traction);

 private:
  std::vector<double> last_, step_;  // tractions over their mean, and how they moved
};

}  // namespace papilla::forward
