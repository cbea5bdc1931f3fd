#include "optim/least_squares.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"

namespace papilla {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
// Trust regions of the first step: nearly a Gauss-Newton step, and a short one.
constexpr double kFirstRegion = 1e4, kShortRegion = 1e-3;

// Parameters as the solver sees them: x = p or ln p, in units of `scale`.
class Coordinates {
 public:
  explicit Coordinates(const std::vector<FitParameter>& parameters) : parameters_(parameters) {
    for (const FitParameter& p : parameters) {
      const auto wrong = [&](const char* what) {
        throw InputError("parameter " + p.name + ": " + what);
      };
      if (!(p.low < p.high)) wrong("expected low < high");
      if (p.logarithmic && !(p.low > 0)) wrong("a logarithmic parameter needs a bound above 0");
      if (!(p.start >= p.low && p.start <= p.high)) wrong("the start lies outside the bounds");
      if (p.prior_sd < 0 || (p.logarithmic && p.prior_sd > 0 && p.prior <= 0))
        wrong("the prior makes no sense");
      const double low = raw(p, p.low), high = raw(p, p.high);
      double width = p.prior_sd;  // the range that counts as "not known"
      if (width == 0) width = 0.25 * (high - low);
      if (!std::isfinite(width)) width = std::max(std::abs(raw(p, p.start)), 1e-12);
      scale_.push_back(width);
    }
  }

  std::size_t size() const { return parameters_.size(); }
  double to(std::size_t i, double p) const { return raw(parameters_[i], p) / scale_[i]; }
  double from(std::size_t i, double x) const {
    const FitParameter& p = parameters_[i];
    const double v = p.logarithmic ? std::exp(x * scale_[i]) : x * scale_[i];
    return std::clamp(v, p.low, p.high);
  }
  double scale(std::size_t i) const { return scale_[i]; }
  bool has_prior(std::size_t i) const { return parameters_[i].prior_sd > 0; }
  double prior_residual(std::size_t i, double x) const {
    return (x - to(i, parameters_[i].prior)) * scale_[i] / parameters_[i].prior_sd;
  }
  double prior_slope(std::size_t i) const { return scale_[i] / parameters_[i].prior_sd; }
  const FitParameter& parameter(std::size_t i) const { return parameters_[i]; }

 private:
  static double raw(const FitParameter& p, double v) { return p.logarithmic ? std::log(v) : v; }

  const std::vector<FitParameter>& parameters_;
  std::vector<double> scale_;
};

// The data and the priors as one block of residuals with central differences. Fixed parameters keep
// their value (Ceres holds them by equal bounds poorly, so they are left out of the block).
class Model final : public ceres::CostFunction {
 public:
  Model(const Coordinates& coordinates, int data, const ResidualFunction& function,
        const LeastSquaresOptions& options, std::vector<double> x, std::vector<std::size_t> free,
        int& evaluations)
      : coordinates_(coordinates),
        data_(data),
        function_(function),
        options_(options),
        x_(std::move(x)),
        free_(std::move(free)),
        evaluations_(evaluations) {
    priors_ = 0;
    for (std::size_t i : free_) priors_ += coordinates_.has_prior(i);
    set_num_residuals(data_ + priors_);
    *mutable_parameter_block_sizes() = {static_cast<int>(free_.size())};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::vector<double> x = x_;
    for (std::size_t j = 0; j < free_.size(); ++j) x[free_[j]] = parameters[0][j];
    if (!data(x, residuals)) return false;
    int row = data_;
    for (std::size_t i : free_) {
      if (coordinates_.has_prior(i)) residuals[row++] = coordinates_.prior_residual(i, x[i]);
    }
    if (!jacobians || !jacobians[0]) return true;
    Eigen::MatrixXd jacobian;
    if (!differences(x, jacobian)) return false;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        jacobians[0], num_residuals(), static_cast<int>(free_.size()));
    out.setZero();
    out.topRows(data_) = jacobian;
    row = data_;
    for (std::size_t j = 0; j < free_.size(); ++j) {
      if (coordinates_.has_prior(free_[j]))
        out(row++, static_cast<int>(j)) = coordinates_.prior_slope(free_[j]);
    }
    return true;
  }

  // Whitened Jacobian of the data in the free parameters, per unit of x.
  bool differences(const std::vector<double>& x, Eigen::MatrixXd& jacobian) const {
    const int n = static_cast<int>(free_.size());
    jacobian.resize(data_, n);
    std::vector<char> ok(static_cast<std::size_t>(n), 1);
    parallel_for(
        n,
        [&](int j) {
          const std::size_t i = free_[static_cast<std::size_t>(j)];
          const FitParameter& p = coordinates_.parameter(i);
          // The step that balances the error of the difference with that of the function; one-sided
          // where a bound is nearer.
          double step = std::cbrt(options_.noise) * std::max(std::abs(x[i]), 1e-3);
          if (p.step > 0) {
            step = p.logarithmic ? p.step / coordinates_.scale(i) : p.step * std::abs(x[i]);
          }
          const double up = std::min(x[i] + step, coordinates_.to(i, p.high));
          const double down = std::max(x[i] - step, coordinates_.to(i, p.low));
          std::vector<double> a = x, b = x, ra(static_cast<std::size_t>(data_)), rb = ra;
          a[i] = up;
          b[i] = down;
          if (!data(a, ra.data()) || !data(b, rb.data())) {
            ok[static_cast<std::size_t>(j)] = 0;
            return;
          }
          for (int r = 0; r < data_; ++r) {
            const auto k = static_cast<std::size_t>(r);
            jacobian(r, j) = (ra[k] - rb[k]) / (up - down);
          }
        },
        options_.threads);
    evaluations_ += 2 * n;
    return std::all_of(ok.begin(), ok.end(), [](char v) { return v != 0; });
  }

 private:
  bool data(const std::vector<double>& x, double* residuals) const {
    std::vector<double> p(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) p[i] = coordinates_.from(i, x[i]);
    const std::span<double> out(residuals, static_cast<std::size_t>(data_));
    if (!function_(p, out)) return false;
    return std::all_of(out.begin(), out.end(), [](double r) { return std::isfinite(r); });
  }

  const Coordinates& coordinates_;
  int data_, priors_ = 0;
  const ResidualFunction& function_;
  const LeastSquaresOptions& options_;
  std::vector<double> x_;
  std::vector<std::size_t> free_;
  int& evaluations_;
};

struct Solution {
  std::vector<double> x;  // all parameters
  std::vector<double> residuals;
  double chi2 = 0, prior_chi2 = 0;
  bool converged = false;
  std::string message;
};

class Solver {
 public:
  Solver(const std::vector<FitParameter>& parameters, int data, const ResidualFunction& function,
         const LeastSquaresOptions& options)
      : coordinates_(parameters), data_(data), function_(function), options_(options) {}

  const Coordinates& coordinates() const { return coordinates_; }
  int& evaluations() { return evaluations_; }

  Solution solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations,
                 double region = kFirstRegion) {
    Solution out;
    std::vector<double> values;
    for (std::size_t i : free) values.push_back(x[i]);
    if (!free.empty()) {
      Model* model =
          new Model(coordinates_, data_, function_, options_, x, free, evaluations_);  // Ceres owns
      ceres::Problem problem;
      problem.AddResidualBlock(model, nullptr, values.data());
      for (std::size_t j = 0; j < free.size(); ++j) {
        const FitParameter& p = coordinates_.parameter(free[j]);
        const int k = static_cast<int>(j);
        if (std::isfinite(p.low))
          problem.SetParameterLowerBound(values.data(), k, coordinates_.to(free[j], p.low));
        if (std::isfinite(p.high))
          problem.SetParameterUpperBound(values.data(), k, coordinates_.to(free[j], p.high));
      }
      ceres::Solver::Options o;
      o.linear_solver_type = ceres::DENSE_QR;
      o.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
      o.initial_trust_region_radius = region;
      o.max_num_iterations = iterations;
      o.function_tolerance = options_.tolerance;
      o.parameter_tolerance = options_.tolerance;
      o.gradient_tolerance = 1e-30;  // the sum of squares decides: residuals have any scale
      o.max_num_consecutive_invalid_steps = 20;
      o.num_threads = 1;
      o.logging_type = ceres::SILENT;
      ceres::Solver::Summary summary;
      ceres::Solve(o, &problem, &summary);
      evaluations_ += summary.num_residual_evaluations;
      out.converged = summary.termination_type == ceres::CONVERGENCE;
      out.message = summary.message;
      for (std::size_t j = 0; j < free.size(); ++j) x[free[j]] = values[j];
    } else {
      out.converged = true;
    }
    out.x = x;
    std::vector<double> p(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) p[i] = coordinates_.from(i, x[i]);
    out.residuals.resize(static_cast<std::size_t>(data_));
    if (!function_(p, out.residuals)) out.converged = false;
    ++evaluations_;
    for (double r : out.residuals) out.chi2 += r * r;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!coordinates_.has_prior(i)) continue;
      const double r = coordinates_.prior_residual(i, x[i]);
      out.prior_chi2 += r * r;
    }
    return out;
  }

  bool jacobian(const std::vector<double>& x, const std::vector<std::size_t>& free,
                Eigen::MatrixXd& out) {
    const Model model(coordinates_, data_, function_, options_, x, free, evaluations_);
    return model.differences(x, out);
  }

 private:
  Coordinates coordinates_;
  int data_;
  const ResidualFunction& function_;
  const LeastSquaresOptions& options_;
  int evaluations_ = 0;
};

std::vector<std::size_t> all_but(std::size_t n, const std::vector<bool>& fixed) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < n; ++i) {
    if (!fixed[i]) out.push_back(i);
  }
  return out;
}

// Where the sum of squares with parameter i held and the others fitted again has risen by `rise`:
// from the best value towards a bound, by steps and then by halving. Eq. calibration.3
double profile_end(Solver& solver, const Solution& best, std::size_t i, double direction,
                   double rise, double first, const LeastSquaresOptions& options, bool& open) {
  const Coordinates& c = solver.coordinates();
  const FitParameter& p = c.parameter(i);
  const double bound = direction > 0 ? c.to(i, p.high) : c.to(i, p.low);
  std::vector<bool> fixed(c.size(), false);
  fixed[i] = true;
  const std::vector<std::size_t> free = all_but(c.size(), fixed);
  std::vector<double> start = best.x;
  const double least = best.chi2 + best.prior_chi2;
  const auto excess = [&](double x) {
    start[i] = x;
    const Solution s = solver.solve(start, free, options.profile_iterations);
    start = s.x;  // the next refit starts near
    return s.chi2 + s.prior_chi2 - least - rise;
  };
  double inside = best.x[i], outside = inside, value_in = -rise, value_out = 0;
  open = false;
  double step = first;
  for (;;) {
    outside = inside + direction * step;
    const bool last = direction > 0 ? outside >= bound : outside <= bound;
    if (last) outside = bound;
    if (outside == inside) {
      open = true;
      return bound;
    }
    value_out = excess(outside);
    if (value_out > 0) break;
    if (last) {
      open = true;
      return bound;
    }
    inside = outside;
    value_in = value_out;
    step *= 2;
  }
  for (int k = 0; k < 40 && std::abs(outside - inside) > 1e-3 * std::abs(outside - best.x[i]);
       ++k) {
    // Secant on the root of the rise, which is nearly straight; halved where that stalls.
    const double a = std::sqrt(std::max(0.0, value_in + rise)), b = std::sqrt(value_out + rise);
    double t = b > a ? (std::sqrt(rise) - a) / (b - a) : 0.5;
    t = k % 3 == 2 ? 0.5 : std::clamp(t, 0.02, 0.98);
    const double x = inside + t * (outside - inside);
    const double v = excess(x);
    if (std::abs(v) < 1e-3 * rise) return x;
    (v > 0 ? outside : inside) = x;
    (v > 0 ? value_out : value_in) = v;
  }
  return 0.5 * (inside + outside);
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
  Solver solver(parameters, residuals, function, options);
  const Coordinates& c = solver.coordinates();
  const std::size_t n = parameters.size();
  std::vector<double> start(n);
  for (std::size_t i = 0; i < n; ++i) start[i] = c.to(i, parameters[i].start);
  const std::vector<std::size_t> all = all_but(n, std::vector<bool>(n, false));
  int priors = 0;
  for (std::size_t i : all) priors += c.has_prior(i);

  struct Attempt {
    Solution solution;
    std::vector<bool> at_bound;
    Eigen::MatrixXd jacobian;
    bool has_jacobian = false;
    double sum() const { return solution.chi2 + solution.prior_chi2; }
  };
  const auto attempt = [&](double region) {
    Attempt out{solver.solve(start, all, options.iterations, region), std::vector<bool>(n), {}};
    Solution& s = out.solution;
    for (std::size_t i : all) {
      const double near = 1e-6 * std::max(1.0, std::abs(s.x[i]));
      out.at_bound[i] =
          s.x[i] - c.to(i, parameters[i].low) < near || c.to(i, parameters[i].high) - s.x[i] < near;
    }
    // Steps along bounds stop early: the others are fitted again with these held.
    if (std::find(out.at_bound.begin(), out.at_bound.end(), true) != out.at_bound.end()) {
      const Solution again = solver.solve(s.x, all_but(n, out.at_bound), options.iterations);
      if (again.chi2 + again.prior_chi2 <= out.sum()) s = again;
    }
    out.has_jacobian = solver.jacobian(s.x, all, out.jacobian);
    return out;
  };
  Attempt found = attempt(kFirstRegion);
  // The first step may leap to where the residuals no longer depend on a parameter, and no step
  // leads back from there: such a fit is tried again by short steps.
  const auto leapt = [&] {
    for (std::size_t i : all) {
      if (found.has_jacobian && !c.has_prior(i) && !found.at_bound[i] &&
          found.jacobian.col(static_cast<Eigen::Index>(i)).squaredNorm() <
              1e-12 * found.solution.chi2)
        return true;
    }
    return false;
  };
  if (leapt()) {
    Attempt other = attempt(kShortRegion);
    if (other.sum() < found.sum()) found = std::move(other);
  }
  const auto& best = found.solution;  // not bound at once: clang 14 captures no such names
  const auto& at_bound = found.at_bound;
  const auto& jacobian = found.jacobian;
  const bool has_jacobian = found.has_jacobian;

  LeastSquaresFit out;
  out.converged = best.converged;
  out.message = best.message;
  out.residuals = best.residuals;
  out.chi2 = best.chi2;
  out.prior_chi2 = best.prior_chi2;
  out.degrees_of_freedom = residuals + priors - static_cast<int>(n);
  const double reduced =
      out.degrees_of_freedom > 0 ? (best.chi2 + best.prior_chi2) / out.degrees_of_freedom : kInf;
  switch (options.variance) {
    case ResidualVariance::Known:
      break;
    case ResidualVariance::Estimated:
      out.variance_factor = std::isfinite(reduced) ? reduced : 1;
      break;
    case ResidualVariance::Inflated:
      out.variance_factor = std::isfinite(reduced) ? std::max(1.0, reduced) : 1;
      break;
  }

  // Covariance (J^T J + priors)^-1 by singular values of the stacked Jacobian, of the parameters
  // that are inside their bounds. Eq. calibration.2
  out.covariance.assign(n * n, 0);
  out.correlation.assign(n * n, 0);
  std::vector<double> se(n, kInf);
  if (has_jacobian) {
    const std::vector<std::size_t> inside = all_but(n, at_bound);
    const auto m = static_cast<Eigen::Index>(inside.size());
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(residuals + m, m);
    for (Eigen::Index j = 0; j < m; ++j) {
      const std::size_t i = inside[static_cast<std::size_t>(j)];
      stacked.col(j).head(residuals) = jacobian.col(static_cast<Eigen::Index>(i));
      if (c.has_prior(i)) stacked(residuals + j, j) = c.prior_slope(i);
    }
    if (m > 0) {
      const Eigen::VectorXd length = stacked.colwise().norm().cwiseMax(1e-300);
      const Eigen::MatrixXd scaled = stacked * length.cwiseInverse().asDiagonal();
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
      const Eigen::VectorXd inverse =
          svd.singularValues().cwiseMax(1e-150).cwiseAbs2().cwiseInverse();
      const Eigen::MatrixXd covariance =
          length.cwiseInverse().asDiagonal() *
          (svd.matrixV() * inverse.asDiagonal() * svd.matrixV().transpose()) *
          length.cwiseInverse().asDiagonal();
      for (Eigen::Index a = 0; a < m; ++a) {
        const std::size_t i = inside[static_cast<std::size_t>(a)];
        for (Eigen::Index b = 0; b < m; ++b) {
          const std::size_t k = inside[static_cast<std::size_t>(b)];
          out.covariance[i * n + k] =
              out.variance_factor * covariance(a, b) * c.scale(i) * c.scale(k);
          out.correlation[i * n + k] =
              covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
        }
        se[i] = std::sqrt(out.variance_factor * covariance(a, a));  // of x
      }
    }
    // What the data alone can tell apart. Eq. calibration.4
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeFullV);
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(n); ++k) {
      FitDirection d;
      d.singular_value = k < svd.singularValues().size() ? svd.singularValues()(k) : 0;
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(n); ++j)
        d.weights.push_back(svd.matrixV()(j, k));
      out.directions.push_back(std::move(d));
    }
  } else {
    out.converged = false;
    out.message += "; no Jacobian at the best values";
  }

  const double quantile =
      options.variance == ResidualVariance::Known || out.degrees_of_freedom < 1
          ? normal_quantile(0.5 + options.confidence / 2)
          : student_t_quantile(0.5 + options.confidence / 2, out.degrees_of_freedom);
  for (std::size_t i = 0; i < n; ++i) {
    const FitParameter& p = parameters[i];
    ParameterFit f;
    f.name = p.name;
    f.value = c.from(i, best.x[i]);
    f.at_bound = at_bound[i];
    const double unit = c.scale(i) * (p.logarithmic ? f.value : 1);
    f.se = std::isfinite(se[i]) ? se[i] * unit : 0;
    if (jacobian.size() > 0) {
      const double data = jacobian.col(static_cast<Eigen::Index>(i)).squaredNorm();
      const double prior = c.has_prior(i) ? c.prior_slope(i) * c.prior_slope(i) : 0;
      f.data_share = data + prior > 0 ? data / (data + prior) : 0;
    }
    if (options.profile_iterations > 0 && (f.at_bound || options.profiles)) {
      if (options.note) options.note("profile of " + p.name);
      const double rise = quantile * quantile * out.variance_factor;
      const double first = std::isfinite(se[i]) ? quantile * se[i] : 0.1;
      f.low = c.from(i, profile_end(solver, best, i, -1, rise, first, options, f.low_open));
      f.high = c.from(i, profile_end(solver, best, i, 1, rise, first, options, f.high_open));
    } else {
      const auto end = [&](double sign, double bound, bool& open) {
        const double x = best.x[i] + sign * quantile * se[i];
        const double limit = c.to(i, bound);
        open = sign > 0 ? x >= limit : x <= limit;
        return c.from(i, x);
      };
      f.low = end(-1, p.low, f.low_open);
      f.high = end(1, p.high, f.high_open);
    }
    out.parameters.push_back(f);
  }
  out.evaluations = solver.evaluations();
  return out;
}

}  // namespace papilla
