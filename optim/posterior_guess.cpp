#include "optim/posterior_guess.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::optim {
namespace {

// Precision that a parameter without a prior gets beside its data, per square of a quarter of its
// range: the whole range lies within one standard deviation.
constexpr double kFlatPrecision = 0.25;
// Sums of squares above the least one, in variance factors, that double the noise of a trial.
constexpr double kFarTrial = 20;
// Steps to the maximum of a guess, at most; the last is shorter than this, in standard deviations.
constexpr int kMostSteps = 60;
constexpr double kSmallStep = 1e-3;
// Damping of the first step, of the curvature; what it falls and rises by.
constexpr double kDamping = 1e-2, kEased = 0.3, kRaised = 6;
constexpr double kMostDamping = 1e8;

// What the trials say: those far from the best one say less. A trial that one group of rows alone
// puts far is near where that group is left out.
RowQuadratics rows_of(const GuessedPosterior& of, const std::vector<PosteriorTrial>& trials,
                      const GuessUnits& units) {
  std::vector<Eigen::VectorXd> points;
  std::vector<std::vector<double>> answers;
  std::vector<double> sums;
  double least = kInfinity;
  for (const PosteriorTrial& trial : trials) {
    const Eigen::VectorXd x = of.at(trial.values);
    std::vector<double> misses = trial.answers;
    take_bands_off(misses, of.options.bands);
    double sum = kInfinity;
    for (const RowTerms& of_some : of.options.common.terms(misses, {}, 1, of.options.groups))
      sum = std::min(sum, of_some.squares);
    sum -= 2 * of.variance_factor * of.log_prior(x);
    if (!std::isfinite(sum)) continue;
    points.emplace_back(units.root.transpose() * (x - units.middle));
    answers.push_back(trial.answers);
    sums.push_back(sum);
    least = std::min(least, sum);
  }
  for (double& sum : sums) sum = 1 + (sum - least) / (kFarTrial * of.variance_factor);
  return RowQuadratics(points, answers, sums, of.options.bands);
}

}  // namespace

double GuessedPosterior::log_prior(const Eigen::VectorXd& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (coordinates.has_prior(i))
      sum += square(coordinates.prior_residual(i, x(static_cast<Eigen::Index>(i))));
  }
  return -sum / (2 * variance_factor);
}

double GuessedPosterior::prior_precision(std::size_t parameter) const {
  return coordinates.has_prior(parameter) ? square(coordinates.prior_slope(parameter))
                                          : kFlatPrecision;
}

Eigen::VectorXd GuessedPosterior::at(const std::vector<double>& values) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    x(static_cast<Eigen::Index>(i)) = coordinates.to(i, values[i]);
  return x;
}

Eigen::VectorXd GuessedPosterior::within(Eigen::VectorXd x) const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    double& v = x(static_cast<Eigen::Index>(i));
    v = std::clamp(v, coordinates.to(i, parameters[i].low), coordinates.to(i, parameters[i].high));
  }
  return x;
}

bool GuessedPosterior::inside(const Eigen::VectorXd& x) const { return within(x) == x; }

PosteriorGuess::PosteriorGuess(const GuessedPosterior& of,
                               const std::vector<PosteriorTrial>& trials, GuessUnits units)
    : of_(of), units_(std::move(units)), rows_(rows_of(of, trials, units_)) {
  group_of_.resize(trials.front().answers.size(), kAllRows);
  for (std::size_t g = 0; g < of.options.groups.size(); ++g) {
    for (const std::size_t row : of.options.groups[g]) group_of_[row] = g;
  }
}

std::vector<double> PosteriorGuess::log_densities(const Eigen::VectorXd& x) const {
  const RowQuadratics::Rows here = rows(x);
  const double prior = of_.log_prior(x);
  std::vector<double> out;
  for (const RowTerms& of_some : of_.options.common.terms(here.misses(), here.open(),
                                                          of_.variance_factor, of_.options.groups))
    out.push_back(prior + of_some.log_likelihood());
  return out;
}

double PosteriorGuess::log_density(const Eigen::VectorXd& x, std::size_t without) const {
  const std::vector<double> all = log_densities(x);
  return without == kAllRows ? all.front() : all[1 + without];
}

// What is open of a row makes it count for less.
PosteriorGuess::Say PosteriorGuess::of_rows(const Eigen::VectorXd& x, std::size_t without) const {
  const RowQuadratics::Rows near = rows(x);
  const Eigen::MatrixXd slopes = rows_.slopes(unit(x)) * units_.root.transpose();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(near.miss.size());
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (counts(static_cast<std::size_t>(k), without))
      weights(k) = 1 / (of_.variance_factor + near.variance(k));
  }
  const Eigen::MatrixXd weighted = slopes.transpose() * weights.asDiagonal();
  Say out{weighted * slopes, -(weighted * near.miss)};
  of_.options.common.take_off(out.precision, out.pull, slopes, near.miss, weights,
                              of_.variance_factor);
  return out;
}

// Damped steps of Gauss and Newton.
Bell PosteriorGuess::bell(const Eigen::VectorXd& start, std::size_t without) const {
  Eigen::VectorXd x = of_.within(start);
  double here = log_density(x, without), damping = kDamping;
  Eigen::MatrixXd precision;
  for (int step = 0; step < kMostSteps; ++step) {
    auto [of_data, pull] = of_rows(x, without);
    precision = std::move(of_data);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto p = static_cast<std::size_t>(i);
      precision(i, i) += of_.prior_precision(p) / of_.variance_factor;
      if (of_.coordinates.has_prior(p))
        pull(i) -= of_.coordinates.prior_residual(p, x(i)) * of_.coordinates.prior_slope(p) /
                   of_.variance_factor;
    }
    Eigen::MatrixXd damped = precision;
    damped.diagonal() *= 1 + damping;
    const Eigen::VectorXd next = of_.within(x + damped.llt().solve(pull));
    const double there = log_density(next, without);
    if (there > here) {
      const Eigen::VectorXd moved = next - x;
      x = next;
      here = there;
      damping *= kEased;
      if (moved.dot(precision * moved) < square(kSmallStep)) break;
    } else {
      damping *= kRaised;
      if (damping > kMostDamping) break;
    }
  }
  return {std::move(x), precision};
}

Eigen::MatrixXd information_of(const std::vector<FitDirection>& directions) {
  const auto n = static_cast<Eigen::Index>(directions.front().weights.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (const FitDirection& d : directions) {
    const Eigen::Map<const Eigen::VectorXd> v(d.weights.data(), n);
    out += square(d.singular_value) * v * v.transpose();
  }
  return out;
}

std::vector<FitDirection> directions_by_trials(const std::vector<FitParameter>& parameters,
                                               const std::vector<PosteriorTrial>& trials,
                                               const PosteriorOptions& rows,
                                               const std::vector<double>& values,
                                               const LeastSquaresFit& by_differences) {
  const FitCoordinates coordinates(parameters);
  const GuessedPosterior of{coordinates, parameters, rows, by_differences.variance_factor};
  Eigen::MatrixXd precision = information_of(by_differences.directions);
  for (Eigen::Index i = 0; i < precision.rows(); ++i)
    precision(i, i) += of.prior_precision(static_cast<std::size_t>(i));
  const Eigen::VectorXd x = of.at(values);
  const PosteriorGuess guess(of, trials, {x, precision.llt().matrixL()});
  // In units of the data alone, as differences are.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(of.variance_factor *
                                                              guess.information(x));
  std::vector<FitDirection> out;
  for (Eigen::Index k = precision.rows() - 1; k >= 0; --k) {
    const auto direction = solver.eigenvectors().col(k);
    out.push_back(
        {std::sqrt(std::max(solver.eigenvalues()(k), 0.0)), {direction.begin(), direction.end()}});
  }
  return out;
}

}  // namespace papilla::optim
