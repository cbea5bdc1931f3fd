// Rows with errors in common against their covariance as a whole.
#include "optim/common_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "optim/posterior.h"
#include "tests/optim/linear_posterior.h"

namespace papilla::tests::common_errors_test {
namespace {

// Six rows and two errors, the last row having none.
Eigen::MatrixXd moves() {
  Eigen::MatrixXd out(6, 2);
  out << 1, 0.3, 2, -0.5, 0.7, 0.2, 1.5, 1, 0.4, -0.8, 0, 0;
  return out;
}
const std::vector<double> kMisses{0.3, -1.2, 2, 0.8, -0.4, 1.1};
const std::vector<double> kOpen{0.1, 0, 0.5, 2, 0, 0.3};
const double kFactor = 1.7;

Eigen::VectorXd vector_of(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}
Eigen::MatrixXd whole_covariance() {
  Eigen::MatrixXd out = kFactor * (Eigen::MatrixXd::Identity(6, 6) + moves() * moves().transpose());
  out.diagonal() += vector_of(kOpen);
  return out;
}
// ln of the density of the normal distribution with the rows in `which`, but for the constant that
// rows without common errors and nothing open have.
double log_density(const std::vector<Eigen::Index>& which) {
  const auto n = static_cast<Eigen::Index>(which.size());
  Eigen::MatrixXd c(n, n);
  Eigen::VectorXd m(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    m(i) = vector_of(kMisses)(which[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < n; ++j)
      c(i, j) = whole_covariance()(which[static_cast<std::size_t>(i)],
                                   which[static_cast<std::size_t>(j)]);
  }
  return -0.5 * (m.dot(c.inverse() * m) + std::log((c / kFactor).determinant()));
}

TEST(CommonErrors, GiveTheNormalDensityOfAllRowsAndWithoutAGroup) {
  const std::vector<RowTerms> terms =
      CommonErrors(moves()).terms(kMisses, kOpen, kFactor, {{0, 3}, {5}});
  ASSERT_EQ(terms.size(), 3u);
  EXPECT_NEAR(terms[0].log_likelihood(), log_density({0, 1, 2, 3, 4, 5}), 1e-12);
  EXPECT_NEAR(terms[1].log_likelihood(), log_density({1, 2, 4, 5}), 1e-12);
  EXPECT_NEAR(terms[2].log_likelihood(), log_density({0, 1, 2, 3, 4}), 1e-12);
}

TEST(CommonErrors, WhitenRowsToIndependentOnesAndColourThemAgain) {
  const CommonErrors common(moves());
  std::vector<double> whitened = kMisses;
  common.whiten(whitened);
  const Eigen::MatrixXd c = Eigen::MatrixXd::Identity(6, 6) + moves() * moves().transpose();
  EXPECT_NEAR(vector_of(whitened).squaredNorm(),
              vector_of(kMisses).dot(c.inverse() * vector_of(kMisses)), 1e-12);
  EXPECT_NEAR(common.terms(kMisses, {}, 1, {}).front().squares, vector_of(whitened).squaredNorm(),
              1e-12);
  common.colour(whitened);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(whitened[i], kMisses[i], 1e-12);
    EXPECT_NEAR(common.deviation(i),
                std::sqrt(c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))), 1e-12);
  }
}

TEST(CommonErrors, TakeOffThePrecisionWhatTheyLeaveOpen) {
  const Eigen::MatrixXd slopes = Linear(1).a;
  Eigen::VectorXd weights(6);
  for (Eigen::Index i = 0; i < 6; ++i)
    weights(i) = 1 / (kFactor + kOpen[static_cast<std::size_t>(i)]);
  weights(2) = 0;  // does not count
  Eigen::MatrixXd precision = slopes.transpose() * weights.asDiagonal() * slopes;
  Eigen::VectorXd pull = -(slopes.transpose() * weights.asDiagonal() * vector_of(kMisses));
  CommonErrors(moves()).take_off(precision, pull, slopes, vector_of(kMisses), weights, kFactor);
  Eigen::MatrixXd c = whole_covariance();
  c(2, 2) += 1e12;
  const Eigen::MatrixXd expected = slopes.transpose() * c.inverse() * slopes;
  const Eigen::VectorXd pulled = -(slopes.transpose() * c.inverse() * vector_of(kMisses));
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(pull(i), pulled(i), 1e-9);
    for (Eigen::Index j = 0; j < 3; ++j) EXPECT_NEAR(precision(i, j), expected(i, j), 1e-9);
  }
}

// Mean, covariance and the score of a group left out, of a linear model whose rows share errors.
TEST(CommonErrors, LeaveAPosteriorInClosedForm) {
  const Linear model(3);
  PosteriorOptions options = known(60);
  options.common = CommonErrors(moves());
  options.groups = {{0, 1}, {2, 3, 4, 5}};
  const Posterior p = sample_posterior(model.parameters, 6, model.misses(), options);
  const Eigen::MatrixXd c = Eigen::MatrixXd::Identity(6, 6) + moves() * moves().transpose();
  const Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(3, 3) / 4;
  const Eigen::VectorXd pulled = Eigen::VectorXd::Constant(3, 0.5 / 4);
  const Eigen::MatrixXd covariance =
      (model.a.transpose() * c.inverse() * model.a + prior).inverse();
  const Eigen::VectorXd mean = covariance * (model.a.transpose() * c.inverse() * model.y + pulled);
  for (Eigen::Index i = 0; i < 3; ++i) {
    double found = 0, variance = 0;
    for (const PosteriorSample& s : p.samples)
      found += s.weight * s.values[static_cast<std::size_t>(i)];
    for (const PosteriorSample& s : p.samples)
      variance += s.weight * square(s.values[static_cast<std::size_t>(i)] - found);
    EXPECT_NEAR(found, mean(i), 4 * std::sqrt(covariance(i, i) / p.effective)) << i;
    EXPECT_NEAR(variance, covariance(i, i), 6 * covariance(i, i) * std::sqrt(2 / p.effective)) << i;
  }
  // Rows 0 and 1 given the others: all rows are jointly normal.
  const Eigen::MatrixXd joint = model.a * prior.inverse() * model.a.transpose() + c;
  const Eigen::VectorXd miss = model.y - model.a * Eigen::VectorXd::Constant(3, 0.5);
  const Eigen::MatrixXd others = joint.bottomRightCorner(4, 4).inverse();
  const Eigen::MatrixXd mixed = joint.topRightCorner(2, 4);
  const Eigen::MatrixXd spread = joint.topLeftCorner(2, 2) - mixed * others * mixed.transpose();
  const Eigen::VectorXd off = miss.head(2) - mixed * others * miss.tail(4);
  EXPECT_NEAR(leave_out(p, {0, 0}).scores[0],
              -0.5 * off.dot(spread.inverse() * off) - 0.5 * std::log(spread.determinant()) -
                  std::log(2 * kPi),
              0.1);
}

}  // namespace
}  // namespace papilla::tests::common_errors_test
