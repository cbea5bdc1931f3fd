#include "optim/bells.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/constants.h"
#include "optim/posterior.h"

namespace papilla::optim {
namespace {

// Tails of the proposal: wider than the bell that they stand around, so that no weight is far above
// the others (Geweke 1989).
constexpr int kFreedom = 7;

}  // namespace

Bell::Bell(Eigen::VectorXd at, const Eigen::MatrixXd& precision)
    : middle(std::move(at)), root(precision.llt().matrixL()) {
  log_size = root.diagonal().array().log().sum();
}

double Bell::squared_distance(const Eigen::VectorXd& x) const {
  return (root.transpose() * (x - middle)).squaredNorm();
}

double Bell::log_density(const Eigen::VectorXd& x) const {
  const auto n = static_cast<double>(x.size());
  return log_size - (kFreedom + n) / 2 * std::log1p(squared_distance(x) / kFreedom);
}

Eigen::VectorXd Bell::draw(RandomStream& random) const {
  Eigen::VectorXd z(middle.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) z(i) = random.normal();
  double squares = 0;
  for (int k = 0; k < kFreedom; ++k) squares += square(random.normal());
  return middle +
         root.transpose().triangularView<Eigen::Upper>().solve(z) * std::sqrt(kFreedom / squares);
}

Eigen::MatrixXd Bell::covariance() const {
  const Eigen::MatrixXd inverse = root.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(root.rows(), root.cols()));
  return inverse.transpose() * inverse;
}

void Bells::add(Bell bell, double log_share) {
  bells_.push_back(std::move(bell));
  log_shares_.push_back(log_share);
  log_all_ = log_sum(log_shares_);
}

std::vector<double> Bells::log_densities(const Eigen::VectorXd& x) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < bells_.size(); ++k)
    out.push_back(log_shares_[k] - log_all_ + bells_[k].log_density(x));
  return out;
}

double Bells::log_density(const Eigen::VectorXd& x) const { return log_sum(log_densities(x)); }

Eigen::VectorXd Bells::draw(RandomStream& random) const {
  double left = random.uniform();
  std::size_t k = 0;
  while (k + 1 < bells_.size() && left >= std::exp(log_shares_[k] - log_all_))
    left -= std::exp(log_shares_[k++] - log_all_);
  return bells_[k].draw(random);
}

}  // namespace papilla::optim
