// How far a fitted parameter may be moved while the others follow: intervals where standard errors
// say nothing.
#pragma once

#include <vector>

#include "optim/trust_region.h"

namespace papilla {

// Where the sum of squares with parameter i held and the others fitted again has risen by `rise`.
// Eq. calibration.3
class FitProfile {
 public:
  // All of them have to outlive this. iterations: of each refit.
  FitProfile(TrustRegion& solver, const FitCoordinates& coordinates, const FitSolution& best,
             std::size_t i, double rise, int iterations);

  // From the best value towards a bound: steps, the first of which is `first`, and then the root
  // between the last two. open: the bound comes first.
  double end(double direction, double first, bool& open);

 private:
  struct Bracket {
    double inside, outside, value_in, value_out;  // values: the rise beyond the wanted one
  };

  double excess(double x);
  bool step_out(Bracket& bracket, double direction, double step, double bound);
  double root(Bracket bracket);

  TrustRegion& solver_;
  const FitCoordinates& coordinates_;
  const FitSolution& best_;
  std::size_t i_;
  double rise_;
  int iterations_;
  std::vector<std::size_t> free_;
  std::vector<double> start_;  // of the next refit
};

}  // namespace papilla
