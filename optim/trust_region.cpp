#include "optim/trust_region.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/constants.h"
#include "base/error.h"
#include "base/parallel.h"
#include "optim/descent.h"

namespace papilla::optim {
namespace {

// The smallest |x| that a step is relative to: x is in prior widths, so a thousandth of one.
constexpr double kLeastStepOf = 1e-3;
// Width of a parameter of no range, no prior and no start other than 0.
constexpr double kLeastWidth = 1e-12;

// The data and the priors as one block of residuals with central differences. Fixed parameters keep
// their value and are left out of the block.
class FitModel final : public DescentModel {
 public:
  FitModel(const FitCoordinates& coordinates, int data, const ResidualFunction& function,
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
  }

  int residuals() const override { return data_ + priors_; }

  bool evaluate(const double* parameters, double* residuals, double* slopes) const override {
    std::vector<double> x = x_;
    for (std::size_t j = 0; j < free_.size(); ++j) x[free_[j]] = parameters[j];
    if (!data(x, residuals)) return false;
    int row = data_;
    for (std::size_t i : free_) {
      if (coordinates_.has_prior(i)) residuals[row++] = coordinates_.prior_residual(i, x[i]);
    }
    if (!slopes) return true;
    Eigen::MatrixXd jacobian;
    if (!differences(x, jacobian)) return false;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        slopes, this->residuals(), static_cast<int>(free_.size()));
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
          const auto column = static_cast<std::size_t>(j);
          ok[column] = difference(x, free_[column], jacobian.col(j));
        },
        options_.threads);
    evaluations_ += 2 * n;
    return std::all_of(ok.begin(), ok.end(), [](char v) { return v != 0; });
  }

 private:
  // In parameter i: central, one-sided where a bound is nearer than the step.
  bool difference(const std::vector<double>& x, std::size_t i,
                  Eigen::Ref<Eigen::VectorXd> column) const {
    const FitParameter& p = coordinates_.parameter(i);
    // The step that balances the error of the difference with that of the function.
    double step = std::cbrt(options_.noise) * std::max(std::abs(x[i]), kLeastStepOf);
    if (p.step > 0) {
      // Of a parameter that is next to zero: of its prior's width, or of its range.
      const double width =
          coordinates_.has_prior(i)
              ? 1
              : kLeastStepOf * (coordinates_.to(i, p.high) - coordinates_.to(i, p.low));
      step = p.logarithmic ? p.step / coordinates_.scale(i)
                           : p.step * std::max(std::abs(x[i]), std::isfinite(width) ? width : 0);
    }
    const double up = std::min(x[i] + step, coordinates_.to(i, p.high));
    const double down = std::max(x[i] - step, coordinates_.to(i, p.low));
    std::vector<double> a = x, b = x, ra(static_cast<std::size_t>(data_)), rb = ra;
    a[i] = up;
    b[i] = down;
    if (!data(a, ra.data()) || !data(b, rb.data())) return false;
    for (int r = 0; r < data_; ++r) {
      const auto k = static_cast<std::size_t>(r);
      column(r) = (ra[k] - rb[k]) / (up - down);
    }
    return true;
  }

  bool data(const std::vector<double>& x, double* residuals) const {
    std::vector<double> p(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) p[i] = coordinates_.from(i, x[i]);
    const std::span<double> out(residuals, static_cast<std::size_t>(data_));
    if (!function_(p, out)) return false;
    return std::all_of(out.begin(), out.end(), [](double r) { return std::isfinite(r); });
  }

  const FitCoordinates& coordinates_;
  int data_, priors_ = 0;
  const ResidualFunction& function_;
  const LeastSquaresOptions& options_;
  std::vector<double> x_;
  std::vector<std::size_t> free_;
  int& evaluations_;
};

}  // namespace

std::vector<std::size_t> all_but(const std::vector<bool>& fixed) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) out.push_back(i);
  }
  return out;
}

FitCoordinates::FitCoordinates(const std::vector<FitParameter>& parameters)
    : parameters_(parameters) {
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
    if (!std::isfinite(width)) width = std::max(std::abs(raw(p, p.start)), kLeastWidth);
    scale_.push_back(width);
  }
}

double FitCoordinates::from(std::size_t i, double x) const {
  const FitParameter& p = parameters_[i];
  const double v = p.logarithmic ? std::exp(x * scale_[i]) : x * scale_[i];
  return std::clamp(v, p.low, p.high);
}

double FitCoordinates::prior_residual(std::size_t i, double x) const {
  return (x - to(i, parameters_[i].prior)) * scale_[i] / parameters_[i].prior_sd;
}

FitSolution TrustRegion::solve(std::vector<double> x, const std::vector<std::size_t>& free,
                               int iterations, double region) {
  FitSolution out;
  out.converged = free.empty() || descend(x, free, iterations, region, out.message);
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
  out.x = std::move(x);
  return out;
}

bool TrustRegion::descend(std::vector<double>& x, const std::vector<std::size_t>& free,
                          int iterations, double region, std::string& message) {
  if (iterations == 0) {
    message = "kept at its start";
    return true;
  }
  std::vector<double> values, low, high;
  for (std::size_t i : free) {
    const FitParameter& p = coordinates_.parameter(i);
    values.push_back(x[i]);
    low.push_back(std::isfinite(p.low) ? coordinates_.to(i, p.low) : -kInfinity);
    high.push_back(std::isfinite(p.high) ? coordinates_.to(i, p.high) : kInfinity);
  }
  const FitModel model(coordinates_, data_, function_, options_, x, free, evaluations_);
  const DescentOutcome done =
      descent().descend(model, values, low, high, {iterations, region, options_.tolerance});
  evaluations_ += done.evaluations;
  message = done.message;
  for (std::size_t j = 0; j < free.size(); ++j) x[free[j]] = values[j];
  return done.converged;
}

bool TrustRegion::jacobian(const std::vector<double>& x, const std::vector<std::size_t>& free,
                           Eigen::MatrixXd& out) {
  const FitModel model(coordinates_, data_, function_, options_, x, free, evaluations_);
  return model.differences(x, out);
}

}  // namespace papilla::optim
