// Bounded nonlinear least squares with priors: the best values, how sure they are, and which of
// them the data cannot tell apart. Equations calibration.N: docs/theory/calibration.md.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

struct FitParameter {
  std::string name;
  double start = 0;
  double low = 0, high = 0;        // bounds, low < high; may be infinite
  double prior = 0, prior_sd = 0;  // prior_sd 0: no prior; relative where logarithmic
  bool logarithmic = false;        // fitted as ln p (needs low > 0): p from e^low to e^high
  double step = 0;                 // of the differences, relative to the parameter; 0: by noise
};

// Residuals divided by their standard deviations; false: the model has no answer there.
using ResidualFunction = std::function<bool(std::span<const double> p, std::span<double> r)>;

enum class ResidualVariance {
  Known,      // residuals are whitened: standard errors as they are
  Estimated,  // standard errors times sqrt(chi2 / degrees of freedom)
  Inflated,   // the same, but never smaller than known
};

struct LeastSquaresFit;
struct FitDirection;

struct LeastSquaresOptions {
  int iterations = 200;
  // Relative error of the residuals as functions: sets the steps of the differences. 1e-15 for a
  // formula, larger for a simulation.
  double noise = 1e-15;
  double tolerance = 1e-12;  // on the relative change of the sum of squares
  ResidualVariance variance = ResidualVariance::Inflated;
  double confidence = 0.95;
  bool profiles = false;  // profile likelihood of every parameter, else only of those at a bound
  int profile_iterations = 30;  // of each refit; 0: no profiles
  // Given the fit with intervals by standard errors, says whether profiles are walked from it,
  // which cost many times the descent. Empty: they are.
  std::function<bool(const LeastSquaresFit&)> walks_profiles{};
  // Given the best values and the fit with its directions by differences there, says what the data
  // tell apart: of answers that jitter, differences are partly jitter. Empty: the differences.
  std::function<std::vector<FitDirection>(const std::vector<double>& values,
                                          const LeastSquaresFit& by_differences)>
      directions{};
  int threads = 1;  // that differences may use; the residual function must then be re-entrant
  std::function<void(const std::string&)> note;  // progress for people; may be empty
};

struct ParameterFit {
  std::string name;
  double value = 0;
  double se = 0;             // standard error; of a logarithmic parameter value * se(ln value)
  double low = 0, high = 0;  // confidence interval, within the bounds
  bool low_open = false;     // the interval ends at the bound, not at the data
  bool high_open = false;
  bool at_bound = false;  // then the interval comes from the profile of the likelihood
  // Of what is known of it, with the others free: 1 the data alone, 0 the prior alone.
  // Eq. calibration.2
  double data_share = 0;
};

// One singular direction of the whitened Jacobian of the data, in units of each parameter's prior
// width (a quarter of the range without a prior). Eq. calibration.4
struct FitDirection {
  // Standard deviations of the data per prior width; < 1: not identified.
  double singular_value = 0;
  std::vector<double> weights;  // one per parameter, unit length
};

struct LeastSquaresFit {
  bool converged = false;
  std::string message;
  std::vector<ParameterFit> parameters;
  std::vector<double> covariance, correlation;  // row-major; of the fitted (ln) parameters
  std::vector<FitDirection> directions;         // singular values falling
  std::vector<double> residuals;                // at the best values
  double chi2 = 0;                              // of the data
  double prior_chi2 = 0;
  int degrees_of_freedom = 0;  // residuals + priors - parameters
  double variance_factor = 1;  // what standard errors were multiplied by, squared
  int evaluations = 0;

  std::vector<double> values() const;
};

// Minimises sum r^2 + sum ((p - prior)/prior_sd)^2 within the bounds (Eq. calibration.1). Cost: 2 n
// + 1 evaluations per iteration, n parameters. Deterministic. Status in the result; throws
// InputError for parameters whose bounds or priors make no sense.
LeastSquaresFit least_squares(const std::vector<FitParameter>& parameters, int residuals,
                              const ResidualFunction& function,
                              const LeastSquaresOptions& options = {});

}  // namespace papilla::optim
