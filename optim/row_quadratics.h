// Residuals as quadratics of the parameters, from what a model has answered so far: a guess of
// where a posterior is high, never its value. Eq. calibration.11: docs/theory/calibration.md.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

class RowQuadratics {
 public:
  // Points in coordinates whose origin is a minimum and whose unit is about a standard deviation of
  // the posterior; one vector of residuals, in standard deviations, per point; widths: of each
  // point's residuals' noise, relative (a point far off says less). Ridge and noise are chosen by
  // the errors of each point as predicted from the others.
  RowQuadratics(const std::vector<Eigen::VectorXd>& points,
                const std::vector<std::vector<double>>& residuals,
                const std::vector<double>& widths);

  // ln of the mean of exp(-sum r^2/2f) over what the quadratics leave open.
  double log_likelihood(const Eigen::VectorXd& point, double variance_factor) const;

 private:
  Eigen::MatrixXd coefficients_;  // features by rows
  Eigen::MatrixXd root_;          // lower: of the features' information
  Eigen::VectorXd variance_;      // of a point's residual where the features are known, per row
};

}  // namespace papilla::optim
