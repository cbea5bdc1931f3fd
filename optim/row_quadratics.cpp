#include "optim/row_quadratics.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::optim {
namespace {

// Widths of the coefficients before any point, in residuals per power of the coordinates: the
// coordinates' unit moves a residual by about 1.
constexpr double kConstant = 10, kSlope = 2;
constexpr std::array<double, 3> kCurvatures{0.03, 0.1, 0.3};
// Of a residual about its quadratic, before its scale is taken from the errors themselves.
constexpr std::array<double, 3> kNoises{0.01, 0.05, 0.25};
// Least standard deviation of a residual about its quadratic: far below that of its datum.
constexpr double kLeastDeviation = 1e-3;

Eigen::VectorXd features(const Eigen::VectorXd& z) {
  const Eigen::Index n = z.size();
  Eigen::VectorXd out(1 + n + n * (n + 1) / 2);
  out(0) = 1;
  out.segment(1, n) = z;
  Eigen::Index k = 1 + n;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) out(k++) = z(i) * z(j);
  }
  return out;
}

struct Ridge {
  Eigen::MatrixXd coefficients, root;
  Eigen::VectorXd variance;
  double score = -std::numeric_limits<double>::infinity();
};

Ridge ridge(const Eigen::MatrixXd& design, const Eigen::MatrixXd& rows,
            const Eigen::VectorXd& widths, Eigen::Index slopes, double curvature, double noise) {
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(design.cols(), square(noise / curvature));
  prior(0) = square(noise / kConstant);
  prior.segment(1, slopes).setConstant(square(noise / kSlope));
  const Eigen::VectorXd inverse = widths.cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * design,
                        values = inverse.asDiagonal() * rows;
  Eigen::MatrixXd information = scaled.transpose() * scaled;
  information.diagonal() += prior;
  const Eigen::LLT<Eigen::MatrixXd> solver(information);
  Ridge out;
  out.root = solver.matrixL();
  out.coefficients = solver.solve(scaled.transpose() * values);
  const Eigen::MatrixXd half = solver.matrixL().solve(scaled.transpose());
  const Eigen::ArrayXd kept = 1 - half.colwise().squaredNorm().transpose().array();
  const Eigen::MatrixXd miss = values - scaled * out.coefficients;
  // Each point as predicted from the others: its error over sqrt(variance/kept) is normal.
  const auto count = static_cast<double>(rows.rows());
  out.variance = (miss.array().square().colwise() / kept).colwise().sum().transpose() / count;
  out.variance = out.variance.cwiseMax(square(kLeastDeviation));
  out.score = 0.5 * static_cast<double>(rows.cols()) * kept.log().sum() -
              0.5 * count * out.variance.array().log().sum();
  return out;
}

}  // namespace

RowQuadratics::RowQuadratics(const std::vector<Eigen::VectorXd>& points,
                             const std::vector<std::vector<double>>& residuals,
                             const std::vector<double>& widths) {
  PAPILLA_CHECK(!points.empty() && points.size() == residuals.size(), "points have residuals");
  const auto count = static_cast<Eigen::Index>(points.size());
  const auto row_count = static_cast<Eigen::Index>(residuals.front().size());
  Eigen::MatrixXd design(count, features(points.front()).size()), rows(count, row_count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    design.row(k) = features(points[at]).transpose();
    rows.row(k) = Eigen::Map<const Eigen::VectorXd>(residuals[at].data(), row_count).transpose();
  }
  const Eigen::Map<const Eigen::VectorXd> width(widths.data(), count);
  Ridge best;
  for (const double curvature : kCurvatures) {
    for (const double noise : kNoises) {
      Ridge tried = ridge(design, rows, width, points.front().size(), curvature, noise);
      if (tried.score > best.score) best = std::move(tried);
    }
  }
  coefficients_ = std::move(best.coefficients);
  root_ = std::move(best.root);
  variance_ = std::move(best.variance);
}

// Eq. calibration.11
double RowQuadratics::log_likelihood(const Eigen::VectorXd& point, double variance_factor) const {
  const Eigen::VectorXd f = features(point);
  const double open = 1 + root_.triangularView<Eigen::Lower>().solve(f).squaredNorm();
  const Eigen::VectorXd guess = coefficients_.transpose() * f;
  double out = 0;
  for (Eigen::Index k = 0; k < guess.size(); ++k) {
    const double variance = variance_(k) * open;
    out -= 0.5 * (std::log1p(variance / variance_factor) +
                  square(guess(k)) / (variance_factor + variance));
  }
  return out;
}

}  // namespace papilla::optim
