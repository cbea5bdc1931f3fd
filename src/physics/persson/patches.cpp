#include "physics/persson/patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/quadrature.h"

namespace papilla::persson {

PatchPressures::PatchPressures(double stress_measure, double pressure, int nodes)
    : PatchPressures(stress_measure, std::vector<NominalPressure>{{pressure, 1}}, nodes) {}

PatchPressures::PatchPressures(double stress_measure, std::vector<NominalPressure> parts, int nodes)
    : measure_(stress_measure), parts_(std::move(parts)) {
  PAPILLA_CHECK(stress_measure > 0 && !parts_.empty(), "patches need roughness and a load");
  PAPILLA_CHECK(nodes >= 1 && nodes <= 64, "1 to 64 patch pressures");
  for (const NominalPressure& part : parts_)
    PAPILLA_CHECK(part.pressure > 0, "patches need roughness and a load");
  // In units of sqrt(M): density at s about x, each part on points of its own, as parts of little
  // roughness lie far apart. Discretised, then Stieltjes' recurrence and the eigenvalues of the
  // Jacobi matrix.
  const double root = std::sqrt(stress_measure);
  static const Quadrature unit = gauss_legendre(400, 0, 1);
  std::vector<double> point, weight;
  for (const NominalPressure& part : parts_) {
    constexpr double kReach = 7;  // beyond it the density is below 1e-21 of its peak
    const double x = part.pressure / root, low = std::max(0.0, x - kReach),
                 width = x + kReach - low;
    for (std::size_t i = 0; i < unit.nodes.size(); ++i) {
      const double s = low + width * unit.nodes[i];
      point.push_back(s);
      // exp(-(s-x)^2) - exp(-(s+x)^2) without cancellation
      weight.push_back(part.share * width * unit.weights[i] * std::exp(-square(s - x)) *
                       -std::expm1(-4 * s * x) / std::sqrt(kPi));
    }
  }
  const auto n = static_cast<Eigen::Index>(nodes);
  Eigen::VectorXd diagonal(n), off(std::max<Eigen::Index>(n - 1, 0));
  std::vector<double> before(weight.size(), 0), here(weight.size(), 1);
  double norm_before = 0, total = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    double norm = 0, moment = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      norm += weight[i] * square(here[i]);
      moment += weight[i] * square(here[i]) * point[i];
    }
    if (k == 0) total = norm;
    diagonal[k] = moment / norm;
    const double beta = k > 0 ? norm / norm_before : 0;
    if (k > 0) off[k - 1] = std::sqrt(beta);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double next = (point[i] - diagonal[k]) * here[i] - beta * before[i];
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
  double mean = 0, all = 0;
  for (const NominalPressure& part : parts_) {
    mean += part.share * part.pressure;
    all += part.share;
  }
  std::vector<double> pressures;
  for (const NominalPressure& part : parts_) pressures.push_back(p * part.pressure * all / mean);
  return share_at(pressures);
}

std::vector<double> PatchPressures::share_at(const std::vector<double>& p) const {
  PAPILLA_CHECK(p.size() == parts_.size(), "one pressure for each part");
  // Ratio of densities up to a factor that the load fixes: exponents from the largest ones, so that
  // none overflows and each node has a part that counts.
  const auto exponent = [&](double s, double pressure) { return -square(s - pressure) / measure_; };
  double most = -kInfinity, load = 0, carried = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    PAPILLA_CHECK(p[i] > 0, "patches need a load");
    load += parts_[i].share * p[i];
  }
  std::vector<double> share = share_, top(share.size(), -kInfinity);
  for (std::size_t k = 0; k < share.size(); ++k) {
    double now = -kInfinity;
    for (std::size_t i = 0; i < p.size(); ++i) {
      top[k] = std::max(top[k], exponent(pressure_[k], parts_[i].pressure));
      now = std::max(now, exponent(pressure_[k], p[i]));
    }
    most = std::max(most, now - top[k]);
  }
  for (std::size_t k = 0; k < share.size(); ++k) {
    const double s = pressure_[k];
    double now = 0, before = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const NominalPressure& part = parts_[i];
      now -= part.share * std::exp(exponent(s, p[i]) - top[k] - most) *
             std::expm1(-4 * s * p[i] / measure_);
      before -= part.share * std::exp(exponent(s, part.pressure) - top[k]) *
                std::expm1(-4 * s * part.pressure / measure_);
    }
    share[k] *= now / before;
    carried += share[k] * s;
  }
  for (double& w : share) w *= load / carried;
  return share;
}

}  // namespace papilla::persson
