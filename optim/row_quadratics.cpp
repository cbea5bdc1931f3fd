#include "optim/row_quadratics.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::optim {
namespace {

// Widths of the coefficients before any point, in answers per power of the coordinates: the
// coordinates' unit moves an answer by a few standard deviations at most.
constexpr double kConstant = 10, kSlope = 3;
constexpr std::array<double, 4> kCurvatures{0.03, 0.1, 0.3, 1};
// Of an answer about its quadratic, before its scale is taken from the errors themselves.
constexpr std::array<double, 3> kNoises{0.01, 0.05, 0.25};
// Least standard deviation of an answer about its quadratic: far below that of its datum.
constexpr double kLeastDeviation = 1e-3;
// Answers of more standard deviations than this grow by their logarithm where a row is compressed:
// how far off such a point is matters little, and a power of a parameter becomes nearly straight.
constexpr double kCompressed = 3;
// No quadratic is followed to answers beyond kCompressed e^20.
constexpr double kFarthest = 20;

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

// d features/d z_i, times the coefficients of each row: rows by coordinates.
Eigen::MatrixXd slopes_of(const Eigen::MatrixXd& coefficients, const Eigen::VectorXd& z) {
  const Eigen::Index n = z.size();
  Eigen::MatrixXd out = coefficients.middleRows(1, n).transpose();
  Eigen::Index k = 1 + n;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j, ++k) {
      out.col(i) += coefficients.row(k).transpose() * z(j);
      out.col(j) += coefficients.row(k).transpose() * z(i);
    }
  }
  return out;
}

struct Ridge {
  Eigen::MatrixXd coefficients, root;
  Eigen::VectorXd variance;
  Eigen::VectorXd scores;  // of each row
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
  out.scores = 0.5 * kept.log().sum() - 0.5 * count * out.variance.array().log();
  return out;
}

}  // namespace

void take_bands_off(std::span<double> answers, const std::vector<RowBand>& bands) {
  for (std::size_t k = 0; k < bands.size(); ++k) answers[k] = bands[k].miss(answers[k]);
}

double compressed(double answer) { return kCompressed * std::asinh(answer / kCompressed); }

RowQuadratics::RowQuadratics(const std::vector<Eigen::VectorXd>& points,
                             const std::vector<std::vector<double>>& answers,
                             const std::vector<double>& widths, std::vector<RowBand> bands)
    : bands_(std::move(bands)) {
  PAPILLA_CHECK(!points.empty() && points.size() == answers.size(), "points have answers");
  const auto count = static_cast<Eigen::Index>(points.size());
  const auto row_count = static_cast<Eigen::Index>(answers.front().size());
  if (bands_.empty()) bands_.resize(answers.front().size());
  // Every row as it is, then compressed.
  Eigen::MatrixXd design(count, features(points.front()).size()), rows(count, 2 * row_count);
  const Eigen::Map<const Eigen::VectorXd> width(widths.data(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    design.row(k) = features(points[at]).transpose();
    const Eigen::Map<const Eigen::RowVectorXd> plain(answers[at].data(), row_count);
    rows.row(k) << plain, plain.unaryExpr(&compressed);
  }
  // What a density of compressed answers is to be multiplied with to be one of answers.
  const Eigen::VectorXd stretched =
      -(rows.rightCols(row_count).array() / kCompressed).cosh().log().colwise().sum();
  Ridge best;
  double most = -std::numeric_limits<double>::infinity();
  for (const double curvature : kCurvatures) {
    for (const double noise : kNoises) {
      Ridge tried = ridge(design, rows, width, points.front().size(), curvature, noise);
      tried.scores.tail(row_count) += stretched;
      const double score =
          tried.scores.head(row_count).cwiseMax(tried.scores.tail(row_count)).sum();
      if (score > most) most = score, best = std::move(tried);
    }
  }
  coefficients_.resize(best.coefficients.rows(), row_count);
  variance_.resize(row_count);
  for (Eigen::Index k = 0; k < row_count; ++k) {
    of_compressed_.push_back(best.scores(row_count + k) > best.scores(k));
    const Eigen::Index from = of_compressed_.back() ? row_count + k : k;
    coefficients_.col(k) = best.coefficients.col(from);
    variance_(k) = best.variance(from);
  }
  root_ = std::move(best.root);
}

// Eq. calibration.11
RowQuadratics::Rows RowQuadratics::rows(const Eigen::VectorXd& point) const {
  const Eigen::VectorXd f = features(point);
  const double open = 1 + root_.triangularView<Eigen::Lower>().solve(f).squaredNorm();
  Rows out{coefficients_.transpose() * f, Eigen::VectorXd(variance_.size()), variance_ * open};
  for (Eigen::Index k = 0; k < out.answer.size(); ++k) {
    if (of_compressed_[static_cast<std::size_t>(k)]) {
      const double w = std::clamp(out.answer(k) / kCompressed, -kFarthest, kFarthest);
      out.answer(k) = kCompressed * std::sinh(w);
      out.variance(k) *= square(std::cosh(w));
    }
    out.miss(k) = bands_[static_cast<std::size_t>(k)].miss(out.answer(k));
  }
  return out;
}

Eigen::MatrixXd RowQuadratics::slopes(const Eigen::VectorXd& point) const {
  Eigen::MatrixXd out = slopes_of(coefficients_, point);
  const Eigen::VectorXd answer = rows(point).answer;
  for (Eigen::Index k = 0; k < out.rows(); ++k) {
    const RowBand& band = bands_[static_cast<std::size_t>(k)];
    if (of_compressed_[static_cast<std::size_t>(k)])
      out.row(k) *= std::hypot(1, answer(k) / kCompressed);
    if (band.low < band.high && band.miss(answer(k)) == 0) out.row(k).setZero();
  }
  return out;
}

}  // namespace papilla::optim
