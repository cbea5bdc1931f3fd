// A least sum of squares within bounds by Levenberg and Marquardt's steps: Ceres's
// (descent_ceres.cpp), in permissive builds our own (descent_own.cpp), as Debian's Ceres stands on
// parts of SuiteSparse that are under the GPL.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

class DescentModel {
 public:
  virtual ~DescentModel() = default;
  virtual int residuals() const = 0;
  // slopes: null, or row by row the derivatives of each residual. false: no answer there.
  virtual bool evaluate(const double* x, double* residuals, double* slopes) const = 0;
};

struct DescentOptions {
  int iterations = 50;
  double region = 1e4;       // radius of the first step
  double tolerance = 1e-12;  // on the relative change of the sum and of x
};

struct Descent {
  bool converged = false;
  std::string message;  // for people
  int evaluations = 0;
};

// Steps in a row that may end where the model has no answer: each is within a region at most half
// as large as that of the one before, so that the last is far below a millionth of the first.
inline constexpr int kMostInvalidSteps = 20;

// From x, which becomes the best found; bounds may be infinite.
Descent descend(const DescentModel& model, std::vector<double>& x, const std::vector<double>& low,
                const std::vector<double>& high, const DescentOptions& options);

}  // namespace papilla::optim
