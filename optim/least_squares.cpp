#include "optim/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "numerics/statistics.h"
#include "optim/fit_profile.h"
#include "optim/trust_region.h"

namespace papilla::optim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// A value this near its bound, relative to it or to a prior width, is at it: far above what the
// solver leaves, far below what data tell.
constexpr double kAtBound = 1e-6;
// A column of the whitened Jacobian below this share of chi squared: a step of a whole prior width
// moves the data by a millionth of what is left, so they do not depend on the parameter there.
constexpr double kNoDependence = 1e-12;
// Least length of a column, and least singular value of columns of length 1: where they are less,
// variances are to come out huge and not infinite.
constexpr double kLeastLength = 1e-300, kLeastSingular = 1e-150;

// First step of a profile in x, a tenth of a prior width, where no standard error says more.
constexpr double kFirstProfileStep = 0.1;

// A descent from the start, and what the best values show.
struct Attempt {
  FitSolution solution;
  std::vector<bool> at_bound;
  Eigen::MatrixXd jacobian;  // of the data, in all parameters
  bool has_jacobian = false;
};

Attempt attempt(TrustRegion& solver, const FitCoordinates& c, int iterations, double region) {
  const std::size_t n = c.size();
  const std::vector<std::size_t> all = all_but(std::vector<bool>(n, false));
  std::vector<double> start(n);
  for (std::size_t i = 0; i < n; ++i) start[i] = c.to(i, c.parameter(i).start);
  Attempt out{solver.solve(start, all, iterations, region), std::vector<bool>(n), {}};
  FitSolution& s = out.solution;
  for (std::size_t i = 0; i < n; ++i) {
    const double near = kAtBound * std::max(1.0, std::abs(s.x[i]));
    out.at_bound[i] =
        s.x[i] - c.to(i, c.parameter(i).low) < near || c.to(i, c.parameter(i).high) - s.x[i] < near;
  }
  // Steps along bounds stop early: the others are fitted again with these held.
  if (std::find(out.at_bound.begin(), out.at_bound.end(), true) != out.at_bound.end()) {
    const FitSolution again = solver.solve(s.x, all_but(out.at_bound), iterations);
    if (again.sum() <= s.sum()) s = again;
  }
  out.has_jacobian = solver.jacobian(s.x, all, out.jacobian);
  return out;
}

// Whether the first step leapt to where the residuals no longer depend on a parameter: no step
// leads back from there.
bool leapt(const Attempt& found, const FitCoordinates& c) {
  if (!found.has_jacobian) return false;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!c.has_prior(i) && !found.at_bound[i] &&
        found.jacobian.col(static_cast<Eigen::Index>(i)).squaredNorm() <
            kNoDependence * found.solution.chi2)
      return true;
  }
  return false;
}

Attempt best_attempt(TrustRegion& solver, const FitCoordinates& c, int iterations) {
  Attempt found = attempt(solver, c, iterations, kFirstRegion);
  if (!leapt(found, c)) return found;
  Attempt other = attempt(solver, c, iterations, kShortRegion);
  return other.solution.sum() < found.solution.sum() ? other : found;
}

double variance_factor(ResidualVariance variance, double sum, int degrees_of_freedom) {
  if (degrees_of_freedom <= 0) return 1;
  const double reduced = sum / degrees_of_freedom;
  if (!std::isfinite(reduced)) return 1;
  switch (variance) {
    case ResidualVariance::Known:
      return 1;
    case ResidualVariance::Estimated:
      return reduced;
    case ResidualVariance::Inflated:
      return std::max(1.0, reduced);
  }
  return 1;
}

// (J^T J + priors)^-1 by singular values of the stacked Jacobian, of the parameters `inside`, in
// coordinates x. Eq. calibration.2
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& jacobian, const FitCoordinates& c,
                                    const std::vector<std::size_t>& inside) {
  const auto m = static_cast<Eigen::Index>(inside.size());
  const Eigen::Index residuals = jacobian.rows();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(residuals + m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const std::size_t i = inside[static_cast<std::size_t>(j)];
    stacked.col(j).head(residuals) = jacobian.col(static_cast<Eigen::Index>(i));
    if (c.has_prior(i)) stacked(residuals + j, j) = c.prior_slope(i);
  }
  const Eigen::VectorXd length = stacked.colwise().norm().cwiseMax(kLeastLength);
  const Eigen::MatrixXd scaled = stacked * length.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd inverse =
      svd.singularValues().cwiseMax(kLeastSingular).cwiseAbs2().cwiseInverse();
  return length.cwiseInverse().asDiagonal() *
         (svd.matrixV() * inverse.asDiagonal() * svd.matrixV().transpose()) *
         length.cwiseInverse().asDiagonal();
}

Eigen::MatrixXd jacobian_of(const std::vector<FitDirection>& directions) {
  const auto n = static_cast<Eigen::Index>(directions.front().weights.size());
  Eigen::MatrixXd out(static_cast<Eigen::Index>(directions.size()), n);
  for (Eigen::Index k = 0; k < out.rows(); ++k) {
    const FitDirection& d = directions[static_cast<std::size_t>(k)];
    out.row(k) = d.singular_value * Eigen::Map<const Eigen::RowVectorXd>(d.weights.data(), n);
  }
  return out;
}

// Fills covariance and correlation of the parameters inside their bounds; returns the standard
// errors of x, infinite for the others.
std::vector<double> fill_covariance(const Attempt& found, const FitCoordinates& c,
                                    LeastSquaresFit& out) {
  const std::size_t n = c.size();
  std::vector<double> se(n, kInf);
  const std::vector<std::size_t> inside = all_but(found.at_bound);
  if (inside.empty()) return se;
  const Eigen::MatrixXd covariance = inverse_information(found.jacobian, c, inside);
  for (Eigen::Index a = 0; a < covariance.rows(); ++a) {
    const std::size_t i = inside[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < covariance.cols(); ++b) {
      const std::size_t k = inside[static_cast<std::size_t>(b)];
      out.covariance[i * n + k] = out.variance_factor * covariance(a, b) * c.scale(i) * c.scale(k);
      out.correlation[i * n + k] =
          covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
    se[i] = std::sqrt(out.variance_factor * covariance(a, a));
  }
  return se;
}

// What the data alone can tell apart. Eq. calibration.4
std::vector<FitDirection> directions(const Eigen::MatrixXd& jacobian) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeFullV);
  std::vector<FitDirection> out;
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
    FitDirection d;
    d.singular_value = k < svd.singularValues().size() ? svd.singularValues()(k) : 0;
    for (Eigen::Index j = 0; j < jacobian.cols(); ++j) d.weights.push_back(svd.matrixV()(j, k));
    out.push_back(std::move(d));
  }
  return out;
}

// Share of a parameter's prior variance that the data take away while all others inside their
// bounds are free: what the data say of it only together with others is no knowledge of it. Without
// a prior all that is known is of the data. Eq. calibration.2
double data_share(const Attempt& found, const FitCoordinates& c, std::size_t i) {
  if (!found.has_jacobian) return 0;
  if (!c.has_prior(i))
    return found.jacobian.col(static_cast<Eigen::Index>(i)).squaredNorm() > 0 ? 1 : 0;
  std::vector<bool> held = found.at_bound;
  held[i] = false;
  const std::vector<std::size_t> free = all_but(held);
  const auto at = std::find(free.begin(), free.end(), i) - free.begin();
  const double variance = inverse_information(found.jacobian, c, free)(at, at);
  return std::clamp(1 - variance * c.prior_slope(i) * c.prior_slope(i), 0.0, 1.0);
}

// Two-sided, in standard errors.
double interval_quantile(const LeastSquaresOptions& options, int degrees_of_freedom) {
  const double p = 0.5 + options.confidence / 2;
  return options.variance == ResidualVariance::Known || degrees_of_freedom < 1
             ? normal_quantile(p)
             : student_t_quantile(p, degrees_of_freedom);
}

// The interval by the standard error of x, cut at the bounds.
void interval_by_error(const FitCoordinates& c, std::size_t i, double x, double half_width,
                       ParameterFit& f) {
  const FitParameter& p = c.parameter(i);
  f.low_open = x - half_width <= c.to(i, p.low);
  f.high_open = x + half_width >= c.to(i, p.high);
  f.low = c.from(i, x - half_width);
  f.high = c.from(i, x + half_width);
}

}  // namespace

std::vector<double> LeastSquaresFit::values() const {
  std::vector<double> out;
  for (const ParameterFit& p : parameters) out.push_back(p.value);
  return out;
}

LeastSquaresFit least_squares(const std::vector<FitParameter>& parameters, int residuals,
                              const ResidualFunction& function,
                              const LeastSquaresOptions& options) {
  PAPILLA_CHECK(!parameters.empty() && residuals > 0, "a fit has parameters and residuals");
  const std::size_t n = parameters.size();
  const FitCoordinates c(parameters);
  TrustRegion solver(c, residuals, function, options);
  Attempt found = best_attempt(solver, c, options.iterations);
  const FitSolution& best = found.solution;

  LeastSquaresFit out;
  out.converged = best.converged;
  out.message = best.message;
  out.residuals = best.residuals;
  out.chi2 = best.chi2;
  out.prior_chi2 = best.prior_chi2;
  out.degrees_of_freedom = residuals - static_cast<int>(n);
  for (std::size_t i = 0; i < n; ++i) out.degrees_of_freedom += c.has_prior(i);
  out.variance_factor = variance_factor(options.variance, best.sum(), out.degrees_of_freedom);
  out.covariance.assign(n * n, 0);
  out.correlation.assign(n * n, 0);
  std::vector<double> se(n, kInf);  // of x
  if (found.has_jacobian) {
    out.directions = directions(found.jacobian);
    if (options.directions) {
      std::vector<double> values;
      for (std::size_t i = 0; i < n; ++i) values.push_back(c.from(i, best.x[i]));
      out.directions = options.directions(values, out);
      found.jacobian = jacobian_of(out.directions);
    }
    se = fill_covariance(found, c, out);
  } else {
    out.converged = false;
    out.message += "; no Jacobian at the best values";
  }

  const double quantile = interval_quantile(options, out.degrees_of_freedom);
  for (std::size_t i = 0; i < n; ++i) {
    ParameterFit f;
    f.name = parameters[i].name;
    f.value = c.from(i, best.x[i]);
    f.at_bound = found.at_bound[i];
    const double unit = c.scale(i) * (parameters[i].logarithmic ? f.value : 1);
    f.se = std::isfinite(se[i]) ? se[i] * unit : 0;
    f.data_share = data_share(found, c, i);
    interval_by_error(c, i, best.x[i], quantile * se[i], f);
    out.parameters.push_back(f);
  }
  out.evaluations = solver.evaluations();
  if (options.profile_iterations == 0 || (options.walks_profiles && !options.walks_profiles(out)))
    return out;
  for (std::size_t i = 0; i < n; ++i) {
    ParameterFit& f = out.parameters[i];
    if (!f.at_bound && !options.profiles) continue;
    if (options.note) options.note("profile of " + f.name);
    const double first = std::isfinite(se[i]) ? quantile * se[i] : kFirstProfileStep;
    FitProfile profile(solver, c, best, i, quantile * quantile * out.variance_factor,
                       options.profile_iterations);
    f.low = c.from(i, profile.end(-1, first, f.low_open));
    f.high = c.from(i, profile.end(1, first, f.high_open));
  }
  out.evaluations = solver.evaluations();
  return out;
}

}  // namespace papilla::optim
