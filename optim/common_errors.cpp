#include "optim/common_errors.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/constants.h"

namespace papilla::optim {
namespace {

// Errors that move no row by more than this share of its own deviation say nothing.
constexpr double kSmallError = 1e-3;

// Of the errors, given misses and weights of some rows.
struct Information {
  Eigen::MatrixXd precision;  // A' W A
  Eigen::VectorXd pull;       // A' W m
  double squares = 0, log_size = 0;

  explicit Information(Eigen::Index errors)
      : precision(Eigen::MatrixXd::Zero(errors, errors)), pull(Eigen::VectorXd::Zero(errors)) {}

  // sign: -1 takes a row off again.
  void add(double sign, double miss, double open, double factor, const Eigen::VectorXd& moves) {
    const double weight = sign / (factor + open);
    squares += weight * square(miss);
    log_size += sign * std::log1p(open / factor);
    if (moves.size() == 0) return;
    precision.selfadjointView<Eigen::Lower>().rankUpdate(moves, weight);
    pull += weight * miss * moves;
  }

  // By the matrix inversion lemma: small in the number of errors, not of rows.
  RowTerms terms(double factor) const {
    if (pull.size() == 0) return {squares, log_size};
    Eigen::MatrixXd whole = factor * precision;
    whole.diagonal().array() += 1;
    const Eigen::LLT<Eigen::MatrixXd> solver(whole);
    return {squares - factor * solver.matrixL().solve(pull).squaredNorm(),
            log_size + 2 * solver.matrixLLT().diagonal().array().log().sum()};
  }
};

}  // namespace

CommonErrors::CommonErrors(const Eigen::MatrixXd& moves) {
  if (moves.size() == 0) return;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(moves, Eigen::ComputeThinU);
  Eigen::Index kept = 0;
  while (kept < svd.singularValues().size() && svd.singularValues()(kept) > kSmallError) ++kept;
  directions_ = svd.matrixU().leftCols(kept);
  sizes_ = svd.singularValues().head(kept);
  moves_ = directions_ * sizes_.asDiagonal();
}

double CommonErrors::deviation(std::size_t row) const {
  if (sizes_.size() == 0) return 1;
  return std::sqrt(1 + moves_.row(static_cast<Eigen::Index>(row)).squaredNorm());
}

void CommonErrors::scale(std::span<double> misses, double power) const {
  if (sizes_.size() == 0) return;
  Eigen::Map<Eigen::VectorXd> m(misses.data(), static_cast<Eigen::Index>(misses.size()));
  const Eigen::VectorXd along = directions_.transpose() * m;
  m += directions_ * (((1 + sizes_.array().square()).pow(power) - 1) * along.array()).matrix();
}

// Eq. calibration.12
std::vector<RowTerms> CommonErrors::terms(
    std::span<const double> misses, std::span<const double> open, double variance_factor,
    const std::vector<std::vector<std::size_t>>& groups) const {
  Information all(sizes_.size());
  const auto add = [&](Information& to, double sign, std::size_t row) {
    to.add(sign, misses[row], open.empty() ? 0 : open[row], variance_factor,
           sizes_.size() == 0 ? Eigen::VectorXd()
                              : moves_.row(static_cast<Eigen::Index>(row)).transpose());
  };
  for (std::size_t row = 0; row < misses.size(); ++row) add(all, 1, row);
  std::vector<RowTerms> out{all.terms(variance_factor)};
  for (const std::vector<std::size_t>& group : groups) {
    Information others = all;
    for (const std::size_t row : group) add(others, -1, row);
    out.push_back(others.terms(variance_factor));
  }
  return out;
}

void CommonErrors::take_off(Eigen::MatrixXd& precision, Eigen::VectorXd& pull,
                            const Eigen::MatrixXd& slopes, const Eigen::VectorXd& misses,
                            const Eigen::VectorXd& weights, double variance_factor) const {
  if (sizes_.size() == 0) return;
  const Eigen::MatrixXd weighted = weights.asDiagonal() * moves_;
  Eigen::MatrixXd whole = variance_factor * (moves_.transpose() * weighted);
  whole.diagonal().array() += 1;
  const Eigen::MatrixXd mixed = weighted.transpose() * slopes;
  const Eigen::MatrixXd solved = variance_factor * whole.llt().solve(mixed);
  precision -= mixed.transpose() * solved;
  pull += solved.transpose() * (weighted.transpose() * misses);
}

}  // namespace papilla::optim
