// Errors that the rows of a fit have in common, beside those of their own: what they say together
// is less than what each says alone. Eq. calibration.12: docs/theory/calibration.md.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

// Of some rows with the covariance C = diag(f + open) + f A A': m' C^-1 m, and ln det C/f.
struct RowTerms {
  double squares = 0, log_size = 0;

  double log_likelihood() const { return -(squares + log_size) / 2; }
};

// Rows are in standard deviations of their own errors.
class CommonErrors {
 public:
  CommonErrors() = default;  // there are none
  // rows by errors: A, what one standard deviation of each error moves each row by. Rows with a
  // band have none.
  explicit CommonErrors(const Eigen::MatrixXd& moves);

  // Whole standard deviation of a row, in those of its own error.
  double deviation(std::size_t row) const;

  // In place of misses, a root of (1 + A A')^-1 times them: independent, of deviation 1.
  void whiten(std::span<double> misses) const { scale(misses, -0.5); }
  void colour(std::span<double> whitened) const { scale(whitened, 0.5); }

  // Of all rows, then without each group of them; open: a variance of each row besides, empty: 0.
  std::vector<RowTerms> terms(std::span<const double> misses, std::span<const double> open,
                              double variance_factor,
                              const std::vector<std::vector<std::size_t>>& groups) const;

  // What common errors take from the precision slopes' W slopes and from the pull -slopes' W misses
  // of parameters; weights: 1/(f + open), of rows that do not count 0.
  void take_off(Eigen::MatrixXd& precision, Eigen::VectorXd& pull, const Eigen::MatrixXd& slopes,
                const Eigen::VectorXd& misses, const Eigen::VectorXd& weights,
                double variance_factor) const;

 private:
  // Along each direction by its (1 + size^2) to this power.
  void scale(std::span<double> misses, double power) const;

  Eigen::MatrixXd directions_;  // of unit length, orthogonal: rows by errors
  Eigen::VectorXd sizes_;       // A A' = directions diag(sizes^2) directions'
  Eigen::MatrixXd moves_;       // directions diag(sizes)
};

}  // namespace papilla::optim
