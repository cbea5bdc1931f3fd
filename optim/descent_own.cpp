#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "optim/descent.h"

namespace papilla::optim {
namespace {

using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Marquardt {
 public:
  Marquardt(const DescentModel& model, const std::vector<double>& x, const std::vector<double>& low,
            const std::vector<double>& high, const DescentOptions& options)
      : model_(model),
        options_(options),
        low_(Eigen::Map<const Eigen::VectorXd>(low.data(), size(low))),
        high_(Eigen::Map<const Eigen::VectorXd>(high.data(), size(high))),
        x_(Eigen::Map<const Eigen::VectorXd>(x.data(), size(x)).cwiseMax(low_).cwiseMin(high_)),
        r_(model.residuals()),
        slopes_(model.residuals(), size(x)),
        region_(options.region) {}

  Descent run() {
    ++done_.evaluations;
    if (!model_.evaluate(x_.data(), r_.data(), slopes_.data()))
      return ended(false, "the model has no answer at the start");
    for (int i = 0, invalid = 0; i < options_.iterations; ++i) {
      if (r_.squaredNorm() == 0) return ended(true, "the sum of squares is 0");
      const Eigen::VectorXd step = (x_ + marquardt_step()).cwiseMax(low_).cwiseMin(high_) - x_;
      if (step.norm() <= options_.tolerance * (x_.norm() + options_.tolerance))
        return ended(true, "the parameters no longer change");
      const Eigen::VectorXd trial = x_ + step;
      Eigen::VectorXd r(r_.size());
      ++done_.evaluations;
      if (!model_.evaluate(trial.data(), r.data(), nullptr)) {
        if (++invalid >= kMostInvalidSteps) return ended(false, "no step has an answer");
        shrink();
        continue;
      }
      invalid = 0;
      const double before = r_.squaredNorm(), gain = before - r.squaredNorm();
      const double promised = before - (r_ + slopes_ * step).squaredNorm();
      if (!(gain > 0 && gain > 1e-3 * promised)) {
        if (std::abs(gain) <= options_.tolerance * before &&
            promised <= options_.tolerance * before)
          return ended(true, "the sum of squares no longer changes");
        shrink();
        continue;
      }
      x_ = trial;
      ++done_.evaluations;
      if (!model_.evaluate(x_.data(), r_.data(), slopes_.data()))
        return ended(false, "the model has no slopes");
      if (gain <= options_.tolerance * before)
        return ended(true, "the sum of squares no longer changes");
      grow(gain / promised);
    }
    return ended(false, "the iteration limit");
  }

  const Eigen::VectorXd& x() const { return x_; }

 private:
  static Eigen::Index size(const std::vector<double>& v) {
    return static_cast<Eigen::Index>(v.size());
  }

  // The least of |r + J s|^2 + |D s|^2 / region, D the norms of the columns; parameters that would
  // leave their bounds stay there.
  Eigen::VectorXd marquardt_step() const {
    const Eigen::Index m = slopes_.rows(), n = slopes_.cols();
    const Eigen::VectorXd gradient = slopes_.transpose() * r_;
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(m + n, n);
    stacked.topRows(m) = slopes_;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double square = slopes_.col(j).squaredNorm();
      stacked(m + j, j) = std::sqrt(std::clamp(square, 1e-6, 1e32) / region_);
      const bool held =
          (x_(j) <= low_(j) && gradient(j) > 0) || (x_(j) >= high_(j) && gradient(j) < 0);
      if (held) stacked.col(j).head(m).setZero();
    }
    Eigen::VectorXd right = Eigen::VectorXd::Zero(m + n);
    right.head(m) = -r_;
    return stacked.householderQr().solve(right);
  }

  void shrink() {
    region_ /= decrease_;
    decrease_ *= 2;
  }
  void grow(double ratio) {
    region_ = std::min(1e16, region_ / std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3)));
    decrease_ = 2;
  }

  Descent ended(bool converged, const char* message) {
    done_.converged = converged;
    done_.message = message;
    return done_;
  }

  const DescentModel& model_;
  const DescentOptions& options_;
  Eigen::VectorXd low_, high_, x_, r_;
  Slopes slopes_;
  double region_, decrease_ = 2;
  Descent done_;
};

}  // namespace

Descent descend(const DescentModel& model, std::vector<double>& x, const std::vector<double>& low,
                const std::vector<double>& high, const DescentOptions& options) {
  Marquardt solver(model, x, low, high, options);
  const Descent done = solver.run();
  std::copy(solver.x().begin(), solver.x().end(), x.begin());
  return done;
}

}  // namespace papilla::optim
