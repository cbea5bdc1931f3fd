// A least sum of squares within bounds by Levenberg and Marquardt's steps, behind an interface
// (internal to optim): Ceres's, in the module papilla_descent.so (optim/modules/ceres.cpp), which
// is loaded by the first fit.
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

struct DescentOutcome {
  bool converged = false;
  std::string message;  // for people
  int evaluations = 0;
};

class Descent {
 public:
  virtual ~Descent() = default;
  // From x, which becomes the best found; bounds may be infinite.
  virtual DescentOutcome descend(const DescentModel& model, std::vector<double>& x,
                                 const std::vector<double>& low, const std::vector<double>& high,
                                 const DescentOptions& options) const = 0;
};

// Version of the classes above: the module of another build is refused.
constexpr int kDescentInterface = 1;

// Loads the module on the first call. Throws std::runtime_error where it does not load.
const Descent& descent();

}  // namespace papilla::optim
