// Residuals as quadratics: exact where they are, unsure where no point is.
#include "optim/row_quadratics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "optim/posterior.h"

namespace papilla::tests::row_quadratics_test {
namespace {

struct Points {
  std::vector<Eigen::VectorXd> at;
  std::vector<std::vector<double>> residuals;
  std::vector<double> widths;
};

std::vector<double> rows_at(const Eigen::VectorXd& z) {
  return {0.4 + z(0) - 0.5 * z(1) + 0.2 * z(0) * z(1) - 0.1 * square(z(2)), 0.3 - 0.8 * z(2)};
}

Points drawn(int count) {
  RandomStream random(1, "points");
  Points out;
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd z(3);
    for (Eigen::Index i = 0; i < 3; ++i) z(i) = random.normal();
    out.at.push_back(z);
    out.residuals.push_back(rows_at(z));
    out.widths.push_back(1);
  }
  return out;
}

double exact(const Eigen::VectorXd& z, double factor) {
  double sum = 0;
  for (const double r : rows_at(z)) sum += square(r);
  return -sum / (2 * factor);
}

double log_likelihood(const RowQuadratics& guess, const Eigen::VectorXd& z, double factor) {
  const RowQuadratics::Rows rows = guess.rows(z);
  return CommonErrors().terms(rows.misses(), rows.open(), factor, {}).front().log_likelihood();
}

TEST(RowQuadratics, AreTheRowsThatAreQuadratic) {
  const Points points = drawn(40);
  const RowQuadratics guess(points.at, points.residuals, points.widths);
  for (const Points& others = drawn(60); const Eigen::VectorXd& z : others.at)
    EXPECT_NEAR(log_likelihood(guess, z, 1.5), exact(z, 1.5), 0.02);
}

// Far from every point the likelihood of a row is that of anything: it falls less than the
// quadratic of the coefficients known says.
TEST(RowQuadratics, AreUnsureWhereFewPointsAre) {
  const Points few = drawn(6);
  const RowQuadratics guess(few.at, few.residuals, few.widths);
  const Eigen::VectorXd far = Eigen::VectorXd::Constant(3, 6);
  EXPECT_GT(log_likelihood(guess, far, 1), exact(far, 1));
}

// 3 sinh is straight where it is compressed by 3 asinh(/3), and no quadratic as it is.
TEST(RowQuadratics, FollowAPowerWhereItsAnswersAreCompressed) {
  RandomStream random(2, "power");
  const auto power = [](double z) { return 3 * std::sinh(2 * z); };
  Points points;
  for (int k = 0; k < 40; ++k) {
    Eigen::VectorXd z(1);
    z(0) = random.normal();
    points.at.push_back(z);
    points.residuals.push_back({power(z(0))});
    points.widths.push_back(1);
  }
  const RowQuadratics guess(points.at, points.residuals, points.widths);
  for (const double z : {-1.2, 0.9, 1.6}) {
    const double answer = guess.rows(Eigen::VectorXd::Constant(1, z)).answer(0);
    EXPECT_NEAR(answer / power(z), 1, 0.1) << z;
  }
}

// Differences of the misses on both sides.
TEST(RowQuadratics, HaveTheSlopesOfTheirMisses) {
  const Points points = drawn(40);
  const RowQuadratics guess(points.at, points.residuals, points.widths, {{-0.1, 0.1}, {0, 0}});
  const Eigen::VectorXd z = Eigen::VectorXd::Constant(3, 0.7);
  const Eigen::MatrixXd slopes = guess.slopes(z);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::VectorXd step = 1e-4 * Eigen::VectorXd::Unit(3, i);
    const Eigen::VectorXd differences =
        (guess.rows(z + step).miss - guess.rows(z - step).miss) / 2e-4;
    for (Eigen::Index k = 0; k < 2; ++k)
      EXPECT_NEAR(slopes(k, i), differences(k), 1e-6 * (1 + std::abs(differences(k)))) << k << i;
  }
}

// A point that is said to be far off does not bend the others.
TEST(RowQuadratics, FollowPointsByTheirWidths) {
  Points points = drawn(40);
  points.residuals[5] = {100, -100};
  points.widths[5] = 1e5;
  const RowQuadratics guess(points.at, points.residuals, points.widths);
  const Eigen::VectorXd z = Eigen::VectorXd::Constant(3, 0.5);
  EXPECT_NEAR(log_likelihood(guess, z, 1), exact(z, 1), 0.05);
}

}  // namespace
}  // namespace papilla::tests::row_quadratics_test
