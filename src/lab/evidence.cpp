#include "lab/evidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "optim/posterior.h"

namespace papilla::lab {
namespace {

// Draws that stand for a kernel, in pairs about its middle: so its mean is exact.
constexpr int kPairs = 4;
// Added to variances, a share of them: readings without scatter of their own would else make the
// covariance singular.
constexpr double kJitter = 1e-12;
// Of the range that a quantile lies in, which is some deviations wide: to 1e-11 of it.
constexpr int kHalvings = 36;

// What the kernels leave open of the worth of the designs: its root, lower triangle.
Eigen::MatrixXd worth_root(const Kernels& kernels, const Evidence& evidence) {
  const auto designs = static_cast<Eigen::Index>(kernels.worth.size());
  Eigen::MatrixXd left(designs, designs);
  for (Eigen::Index a = 0; a < designs; ++a) {
    for (Eigen::Index b = 0; b < designs; ++b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      left(a, b) = kernels.of_worth[i][j];
      for (std::size_t k = 0; k < evidence.size(); ++k)
        left(a, b) -= evidence.gain(i, k) * evidence.gain(j, k);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(left);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

void GrowingFactor::add(const std::vector<double>& of) {
  const std::size_t n = rows_.size();
  PAPILLA_CHECK(of.size() == n + 1, "a covariance with each before it");
  std::vector<double> row(of.begin(), of.end() - 1);
  row = solved(std::move(row));
  double rest = of.back() * (1 + kJitter);
  for (const double x : row) rest -= square(x);
  row.push_back(std::sqrt(std::max(rest, kJitter * of.back())));
  rows_.push_back(std::move(row));
}

std::vector<double> GrowingFactor::solved(std::vector<double> right) const {
  for (std::size_t i = 0; i < right.size(); ++i) {
    const std::vector<double>& row = rows_[i];
    double sum = right[i];
    for (std::size_t k = 0; k < i; ++k) sum -= row[k] * right[k];
    right[i] = sum / row[i];
  }
  return right;
}

Evidence::Evidence(const Ensemble& ensemble, const Kernels& kernels, const Instrument& instrument)
    : ensemble_(ensemble), kernels_(kernels), instrument_(instrument) {}

void Evidence::add(const Observation& o, double y, bool made) {
  std::vector<double> with;
  observations_.push_back(o);
  made_.push_back(made);
  for (const Observation& other : observations_) {
    const bool same = &other == &observations_.back();
    with.push_back(covariance(instrument_, o, other, same) +
                   kernels_.of_responses[o.row][other.row]);
  }
  factor_.add(with);
  const std::vector<double>& row = factor_.row(size() - 1);
  const double own = row.back();
  std::vector<double> residual(ensemble_.members());
  for (std::size_t m = 0; m < residual.size(); ++m) residual[m] = y - kernels_.responses[o.row][m];
  std::vector<double> gain(kernels_.worth.size());
  for (std::size_t d = 0; d < gain.size(); ++d) gain[d] = kernels_.of_worth_and_responses[d][o.row];
  for (std::size_t k = 0; k + 1 < size(); ++k) {
    for (std::size_t m = 0; m < residual.size(); ++m) residual[m] -= row[k] * residuals_[k][m];
    for (std::size_t d = 0; d < gain.size(); ++d) gain[d] -= row[k] * gains_[k][d];
  }
  for (double& r : residual) r /= own;
  for (double& g : gain) g /= own;  // Eq. lab.5
  residuals_.push_back(std::move(residual));
  gains_.push_back(std::move(gain));
}

void Evidence::add(const Observation& reading, double y) { add(reading, y, true); }

const std::vector<double>& Evidence::add_ahead(const Observation& reading) {
  add(reading, 0, false);
  return residuals_.back();
}

ExpectedReading Evidence::expected(const Observation& reading) const {
  Evidence with = *this;
  with.add_ahead(reading);
  ExpectedReading out{{}, weights(), with.factor_.row(size()).back()};
  // The whitened residual of a reading of 0 is that far below what its member expects.
  for (const double r : with.residuals_.back()) out.means.push_back(-out.deviation * r);
  return out;
}

double ExpectedReading::quantile(double p) const {
  const auto [least, largest] = std::minmax_element(means.begin(), means.end());
  const double beyond = deviation * std::abs(normal_quantile(p));
  double low = *least - beyond, high = *largest + beyond;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    double below = 0;
    for (std::size_t m = 0; m < means.size(); ++m)
      below += weights[m] * normal_cdf((middle - means[m]) / deviation);
    (below < p ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::vector<double> Evidence::log_likelihoods() const {
  std::vector<double> out(ensemble_.members(), 0);
  for (std::size_t k = 0; k < size(); ++k) {
    if (!made_[k]) continue;
    for (std::size_t m = 0; m < out.size(); ++m) out[m] -= square(residuals_[k][m]) / 2;
  }
  return out;  // Eq. lab.4
}

std::vector<double> Evidence::weights() const {
  std::vector<double> logs = log_likelihoods();
  for (std::size_t m = 0; m < logs.size(); ++m) logs[m] += std::log(ensemble_.weights[m]);
  return normalised(logs);
}

WorthAfter worth_after(const Ensemble& ensemble, const Kernels& kernels, const Evidence& evidence) {
  const Eigen::MatrixXd root = worth_root(kernels, evidence);
  const std::vector<double> weights = evidence.weights();
  WorthAfter out;
  out.worth.resize(kernels.worth.size());
  for (std::size_t m = 0; m < ensemble.members(); ++m) {
    RandomStream random(1, "lab kernel", m);
    for (int pair = 0; pair < kPairs; ++pair) {
      Eigen::VectorXd z(root.cols());
      for (Eigen::Index i = 0; i < z.size(); ++i) z(i) = random.normal();
      const Eigen::VectorXd move = root * z;
      for (const double sign : {1.0, -1.0}) {
        out.weights.push_back(weights[m] / (2 * kPairs));
        out.member.push_back(m);
        for (std::size_t d = 0; d < out.worth.size(); ++d) {
          double worth = kernels.worth[d][m] + sign * move(static_cast<Eigen::Index>(d));
          for (std::size_t k = 0; k < evidence.size(); ++k)
            worth += evidence.gain(d, k) * evidence.residuals(k)[m];
          out.worth[d].push_back(worth);
        }
      }
    }
  }
  return out;
}

}  // namespace papilla::lab
