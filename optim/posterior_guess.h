// A guess of a posterior from what the model has answered so far, of all rows and with each group
// of them left out: where it is asked next. Eq. calibration.7, calibration.11:
// docs/theory/calibration.md.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/rooms.h"
#include "optim/bells.h"
#include "optim/posterior.h"
#include "optim/row_quadratics.h"
#include "optim/trust_region.h"

namespace papilla::optim {

// Coordinates in which a guess is a quadratic: z = root' (x - middle).
struct GuessUnits {
  Eigen::VectorXd middle;
  Eigen::MatrixXd root;
};

// What a guess is of; all of it has to outlive the guess.
struct GuessedPosterior {
  const FitCoordinates& coordinates;
  const std::vector<FitParameter>& parameters;
  const PosteriorOptions& options;  // its bands and groups
  double variance_factor = 1;

  double log_prior(const Eigen::VectorXd& x) const;
  // Of the priors; parameters without one by a quarter of their range.
  double prior_precision(std::size_t parameter) const;
  Eigen::VectorXd at(const std::vector<double>& values) const;
  Eigen::VectorXd within(Eigen::VectorXd x) const;  // the bounds
  bool inside(const Eigen::VectorXd& x) const;
};

class PosteriorGuess {
 public:
  static constexpr std::size_t kAllRows = static_cast<std::size_t>(-1);

  // trials: at least one that has an answer.
  PosteriorGuess(const GuessedPosterior& of, const std::vector<PosteriorTrial>& trials,
                 GuessUnits units);

  RowQuadratics::Rows rows(const Eigen::VectorXd& x) const { return rows_.rows(unit(x)); }

  // What all rows tell of the parameters there: the precision, without the priors.
  Eigen::MatrixXd information(const Eigen::VectorXd& x) const {
    return of_rows(x, kAllRows).precision;
  }

  // Logarithms of densities up to one constant: of all rows, then without each group.
  std::vector<double> log_densities(const Eigen::VectorXd& x) const;

  // Around the maximum from a start, without a group; `kAllRows`: of all rows.
  Bell bell(const Eigen::VectorXd& start, std::size_t without) const;

 private:
  Eigen::VectorXd unit(const Eigen::VectorXd& x) const {
    return units_.root.transpose() * (x - units_.middle);
  }
  double log_density(const Eigen::VectorXd& x, std::size_t without) const;
  // Of the rows, without the priors.
  struct Say {
    Eigen::MatrixXd precision;
    Eigen::VectorXd pull;
  };
  Say of_rows(const Eigen::VectorXd& x, std::size_t without) const;
  bool counts(std::size_t row, std::size_t without) const {
    return without == kAllRows || group_of_[row] != without;
  }

  const GuessedPosterior& of_;
  GuessUnits units_;
  std::vector<std::size_t> group_of_;  // [row]; kAllRows: of none
  RowQuadratics rows_;
};

// Sum over directions of singular_value^2 times their squares: J'J of the fit.
Eigen::MatrixXd information_of(const std::vector<FitDirection>& directions);

// The directions at a fit's best values by the regression on all that the model has answered, what
// that leaves open of a row taken for an error of it. rows: bands and common errors.
// Eq. calibration.13
std::vector<FitDirection> directions_by_trials(const std::vector<FitParameter>& parameters,
                                               const std::vector<PosteriorTrial>& trials,
                                               const PosteriorOptions& rows,
                                               const std::vector<double>& values,
                                               const LeastSquaresFit& by_differences);

}  // namespace papilla::optim
