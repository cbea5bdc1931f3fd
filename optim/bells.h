// Mixtures of Student distributions, which draws of a posterior are proposed by. Eq. calibration.7:
// docs/theory/calibration.md.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/random.h"
#include "base/rooms.h"

namespace papilla::optim {

// A Student distribution around a point, in the coordinates of a fit.
struct Bell {
  Eigen::VectorXd middle;
  Eigen::MatrixXd root;  // lower triangle: precision = root root'
  double log_size = 0;   // log of the root's determinant

  Bell(Eigen::VectorXd at, const Eigen::MatrixXd& precision);

  double squared_distance(const Eigen::VectorXd& x) const;
  double log_density(const Eigen::VectorXd& x) const;  // up to a constant of the dimensions
  Eigen::VectorXd draw(RandomStream& random) const;
  Eigen::MatrixXd covariance() const;
};

class Bells {
 public:
  // Shares need not sum to 1.
  void add(Bell bell, double log_share);
  const std::vector<Bell>& all() const { return bells_; }

  std::vector<double> log_densities(const Eigen::VectorXd& x) const;  // by shares
  double log_density(const Eigen::VectorXd& x) const;
  Eigen::VectorXd draw(RandomStream& random) const;

 private:
  std::vector<Bell> bells_;
  std::vector<double> log_shares_;
  double log_all_ = 0;  // of the shares
};

}  // namespace papilla::optim
