// One descent of a least-squares problem by steps within a trust region: what `least_squares` makes
// its attempts, refits and profiles of.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/least_squares.h"

namespace papilla::optim {

// Parameters as the solver sees them: x = p or ln p, in units of each one's prior width, or of a
// quarter of its range without a prior.
class FitCoordinates {
 public:
  // Throws InputError for bounds or priors that make no sense. The parameters have to outlive this.
  explicit FitCoordinates(const std::vector<FitParameter>& parameters);

  std::size_t size() const { return parameters_.size(); }
  double to(std::size_t i, double p) const { return raw(parameters_[i], p) / scale_[i]; }
  double from(std::size_t i, double x) const;  // within the bounds
  double scale(std::size_t i) const { return scale_[i]; }
  bool has_prior(std::size_t i) const { return parameters_[i].prior_sd > 0; }
  double prior_residual(std::size_t i, double x) const;
  double prior_slope(std::size_t i) const { return scale_[i] / parameters_[i].prior_sd; }
  const FitParameter& parameter(std::size_t i) const { return parameters_[i]; }

 private:
  static double raw(const FitParameter& p, double v) { return p.logarithmic ? std::log(v) : v; }

  const std::vector<FitParameter>& parameters_;
  std::vector<double> scale_;
};

// The parameters that are not fixed, by their places.
std::vector<std::size_t> all_but(const std::vector<bool>& fixed);

struct FitSolution {
  std::vector<double> x;          // of all parameters
  std::vector<double> residuals;  // of the data
  double chi2 = 0, prior_chi2 = 0;
  bool converged = false;
  std::string message;

  double sum() const { return chi2 + prior_chi2; }
};

// Radii of the first step: nearly a Gauss-Newton step, and a short one.
inline constexpr double kFirstRegion = 1e4, kShortRegion = 1e-3;

class TrustRegion {
 public:
  // All of them have to outlive this. data: the number of residuals of the function.
  TrustRegion(const FitCoordinates& coordinates, int data, const ResidualFunction& function,
              const LeastSquaresOptions& options)
      : coordinates_(coordinates), data_(data), function_(function), options_(options) {}

  // The least sum of squares from x, with the parameters `free` moving and the others held.
  FitSolution solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations,
                    double region = kFirstRegion);
  // Jacobian of the data, whitened, in the parameters `free` per unit of x; false: no model near x.
  bool jacobian(const std::vector<double>& x, const std::vector<std::size_t>& free,
                Eigen::MatrixXd& out);
  int evaluations() const { return evaluations_; }

 private:
  bool descend(std::vector<double>& x, const std::vector<std::size_t>& free, int iterations,
               double region, std::string& message);

  const FitCoordinates& coordinates_;
  int data_;
  const ResidualFunction& function_;
  const LeastSquaresOptions& options_;
  int evaluations_ = 0;
};

}  // namespace papilla::optim
