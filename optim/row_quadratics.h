// Rows of a model as quadratics of the parameters, from what it has answered so far: a guess of
// where a posterior is high, never its value. Eq. calibration.11: docs/theory/calibration.md.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

// Answers that the data do not tell from one another, in standard deviations from the datum.
struct RowBand {
  double low = 0, high = 0;

  double miss(double answer) const { return answer - std::clamp(answer, low, high); }
};

// In place of answers how far they are off their bands, one per row; no bands: of no width.
void take_bands_off(std::span<double> answers, const std::vector<RowBand>& bands);

// Answers of many standard deviations grow by their logarithm: how far off they are matters little.
double compressed(double answer);

class RowQuadratics {
 public:
  // Points in coordinates whose origin is a minimum and whose unit is about a standard deviation of
  // the posterior; one vector of answers, in standard deviations from the data, per point; widths:
  // of each point's answers' noise, relative (a point far off says less). Ridge and noise are
  // chosen by the errors of each point as predicted from the others, and so is whether a row's
  // large answers are compressed. bands: one per row; empty: of no width.
  RowQuadratics(const std::vector<Eigen::VectorXd>& points,
                const std::vector<std::vector<double>>& answers, const std::vector<double>& widths,
                std::vector<RowBand> bands = {});

  // The rows at a point: answers, from the bands, and what is open of them as variances.
  struct Rows {
    Eigen::VectorXd answer, miss, variance;

    std::size_t size() const { return static_cast<std::size_t>(answer.size()); }
    std::span<const double> misses() const { return {miss.data(), size()}; }
    std::span<const double> open() const { return {variance.data(), size()}; }
  };
  Rows rows(const Eigen::VectorXd& point) const;
  // Slopes of the misses there, rows by coordinates.
  Eigen::MatrixXd slopes(const Eigen::VectorXd& point) const;

 private:
  std::vector<RowBand> bands_;
  std::vector<bool> of_compressed_;  // a row's quadratic
  Eigen::MatrixXd coefficients_;     // features by rows
  Eigen::MatrixXd root_;             // lower: of the features' information
  Eigen::VectorXd variance_;         // of a point's answer where the features are known, per row
};

}  // namespace papilla::optim
