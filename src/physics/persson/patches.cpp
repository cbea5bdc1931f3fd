#include "physics/persson/patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/quadrature.h"

namespace papilla::persson {

PatchPressures::PatchPressures(double stress_measure, double pressure, int nodes)
    : measure_(stress_measure), nominal_(pressure) {
  PAPILLA_CHECK(stress_measure > 0 && pressure > 0, "patches need roughness and a load");
  PAPILLA_CHECK(nodes >= 1 && nodes <= 64, "1 to 64 patch pressures");
  // In units of sqrt(M): density at s about x. Discretised, then Stieltjes' recurrence and the
  // eigenvalues of the Jacobi matrix.
  const double root = std::sqrt(stress_measure), x = pressure / root;
  const Quadrature fine = gauss_legendre(400, std::max(0.0, x - 7), x + 7);
  std::vector<double> weight(fine.nodes.size());
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double s = fine.nodes[i];
    // exp(-(s-x)^2) - exp(-(s+x)^2) without cancellation
    weight[i] =
        fine.weights[i] * std::exp(-square(s - x)) * -std::expm1(-4 * s * x) / std::sqrt(kPi);
  }
  const auto n = static_cast<Eigen::Index>(nodes);
  Eigen::VectorXd diagonal(n), off(std::max<Eigen::Index>(n - 1, 0));
  std::vector<double> before(weight.size(), 0), here(weight.size(), 1);
  double norm_before = 0, total = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    double norm = 0, moment = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      norm += weight[i] * square(here[i]);
      moment += weight[i] * square(here[i]) * fine.nodes[i];
    }
    if (k == 0) total = norm;
    diagonal[k] = moment / norm;
    const double beta = k > 0 ? norm / norm_before : 0;
    if (k > 0) off[k - 1] = std::sqrt(beta);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double next = (fine.nodes[i] - diagonal[k]) * here[i] - beta * before[i];
      before[i] = here[i];
      here[i] = next;
    }
    norm_before = norm;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off);
  for (Eigen::Index k = 0; k < n; ++k) {
    pressure_.push_back(root * solver.eigenvalues()[k]);
    share_.push_back(total * square(solver.eigenvectors()(0, k)));
  }
}

std::vector<double> PatchPressures::share_at(double p) const {
  PAPILLA_CHECK(p > 0, "patches need a load");
  // Ratio of densities up to a factor that the load fixes; the largest is 1, so that none
  // overflows.
  std::vector<double> share = share_;
  const auto exponent = [&](double s) { return 2 * s * (p - nominal_) / measure_; };
  const double most = std::max(exponent(pressure_.front()), exponent(pressure_.back()));
  double carried = 0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    const double s = pressure_[k];
    share[k] *= std::exp(exponent(s) - most) * std::expm1(-4 * s * p / measure_) /
                std::expm1(-4 * s * nominal_ / measure_);
    carried += share[k] * s;
  }
  for (double& w : share) w *= p / carried;
  return share;
}

}  // namespace papilla::persson
