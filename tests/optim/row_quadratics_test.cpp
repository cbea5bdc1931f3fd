// Residuals as quadratics: exact where they are, unsure where no point is.
#include "optim/row_quadratics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"

namespace papilla::tests {
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

TEST(RowQuadratics, AreTheRowsThatAreQuadratic) {
  const Points points = drawn(40);
  const RowQuadratics guess(points.at, points.residuals, points.widths);
  for (const Points& others = drawn(60); const Eigen::VectorXd& z : others.at)
    EXPECT_NEAR(guess.log_likelihood(z, 1.5), exact(z, 1.5), 0.02);
}

// Far from every point the likelihood of a row is that of anything: it falls less than the
// quadratic of the coefficients known says.
TEST(RowQuadratics, AreUnsureWhereFewPointsAre) {
  const Points few = drawn(6);
  const RowQuadratics guess(few.at, few.residuals, few.widths);
  const Eigen::VectorXd far = Eigen::VectorXd::Constant(3, 6);
  EXPECT_GT(guess.log_likelihood(far, 1), exact(far, 1));
}

// A point that is said to be far off does not bend the others.
TEST(RowQuadratics, FollowPointsByTheirWidths) {
  Points points = drawn(40);
  points.residuals[5] = {100, -100};
  points.widths[5] = 1e5;
  const RowQuadratics guess(points.at, points.residuals, points.widths);
  const Eigen::VectorXd z = Eigen::VectorXd::Constant(3, 0.5);
  EXPECT_NEAR(guess.log_likelihood(z, 1), exact(z, 1), 0.05);
}

}  // namespace
}  // namespace papilla::tests
