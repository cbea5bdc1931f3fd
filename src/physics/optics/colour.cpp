#include "physics/optics/colour.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::optics {
namespace {

// The fits of Wyman, Sloan and Shirley (JCGT 2, 2, 2013).
double lobe(double nm, double height, double peak, double left, double right) {
  return height * std::exp(-0.5 * square((nm - peak) * (nm < peak ? left : right)));
}

}  // namespace

std::array<double, 3> observer(double wavelength) {
  const double l = 1e9 * wavelength;
  return {lobe(l, 0.362, 442.0, 0.0624, 0.0374) + lobe(l, 1.056, 599.8, 0.0264, 0.0323) -
              lobe(l, 0.065, 501.1, 0.0490, 0.0382),
          lobe(l, 0.821, 568.8, 0.0213, 0.0247) + lobe(l, 0.286, 530.9, 0.0613, 0.0322),
          lobe(l, 1.217, 437.0, 0.0845, 0.0278) + lobe(l, 0.681, 459.0, 0.0385, 0.0725)};
}

const std::vector<double>& visible_wavelengths() {
  static const std::vector<double> list = [] {
    std::vector<double> out;
    for (int nm = 400; nm <= 720; nm += 20) out.push_back(1e-9 * nm);
    return out;
  }();
  return list;
}

std::array<double, 2> chromaticity(const std::vector<double>& wavelengths,
                                   const std::vector<double>& powers) {
  double x = 0, y = 0, z = 0;
  for (std::size_t k = 0; k < wavelengths.size(); ++k) {
    const auto [xbar, ybar, zbar] = observer(wavelengths[k]);
    x += xbar * powers[k], y += ybar * powers[k], z += zbar * powers[k];
  }
  const double sum = x + 15 * y + 3 * z;
  return sum > 0 ? std::array<double, 2>{4 * x / sum, 9 * y / sum} : std::array<double, 2>{0, 0};
}

namespace {

// Of this many nodes for the weight ybar over 1/wavelength, which is sampled finer than any node is
// placed: the recurrence of its orthonormal polynomials (Stieltjes), whose Jacobi matrix has the
// nodes as eigenvalues (Golub and Welsch 1969).
std::vector<PhotopicNode> gauss_rule(Eigen::Index count) {
  const double first = visible_wavelengths().front(), last = visible_wavelengths().back();
  const Eigen::Index samples = 160 + 4 * count;
  Eigen::ArrayXd place(samples), weight(samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double wavelength =
        first + (last - first) * static_cast<double>(i) / static_cast<double>(samples - 1);
    place[i] = 1 / wavelength, weight[i] = observer(wavelength)[1];
  }
  weight /= weight.sum();
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(samples), here = Eigen::ArrayXd::Ones(samples);
  Eigen::VectorXd middle(count), beside(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    middle[k] = (weight * place * here * here).sum();
    Eigen::ArrayXd next = (place - middle[k]) * here;
    if (k > 0) next -= beside[k - 1] * before;
    beside[k] = std::sqrt((weight * next * next).sum());
    before = here, here = next / beside[k];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi;
  jacobi.computeFromTridiagonal(middle, beside.head(count - 1));
  std::vector<PhotopicNode> out;
  for (Eigen::Index k = 0; k < count; ++k)
    out.push_back({1 / jacobi.eigenvalues()[k], square(jacobi.eigenvectors()(0, k))});
  return out;
}

// Midpoints of equal steps of the wavelength. Fringes of this path come at most once a step where
// ybar is more than a few per cent, from 470 nm on, and those that are left over do so at one
// wavelength alone: none are counted as if they were none.
std::vector<PhotopicNode> equal_steps(double path) {
  constexpr double kMargin = 8e-6, kBlue = 470e-9;  // [m]
  const double first = visible_wavelengths().front(), last = visible_wavelengths().back();
  const int count = static_cast<int>(std::ceil((last - first) * (path + kMargin) / square(kBlue)));
  std::vector<PhotopicNode> out;
  double sum = 0;
  for (int k = 0; k < count; ++k) {
    const double wavelength = first + (last - first) * (k + 0.5) / count;
    out.push_back({wavelength, observer(wavelength)[1]});
    sum += out.back().weight;
  }
  for (PhotopicNode& node : out) node.weight /= sum;
  return out;
}

}  // namespace

std::vector<PhotopicNode> photopic_nodes(double path) {
  // The polynomials of many nodes lose their orthogonality, and equal steps take fewer.
  constexpr double kLongestOfGauss = 10e-6, kFewest = 3, kAtNone = 1.4, kOfPath = 2e6;  // 1/m
  if (path > kLongestOfGauss) return equal_steps(path);
  return gauss_rule(
      static_cast<Eigen::Index>(std::max(kFewest, std::ceil(kAtNone + kOfPath * path))));
}

std::vector<double> within_row(double wavelength, double path) {
  constexpr double kRow = 20e-9, kOfOne = 2e-6;
  const int count =
      static_cast<int>(std::max(1.0, std::ceil(std::min(path, kLongestPath) / kOfOne) - 1));
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(wavelength + kRow * ((k + 0.5) / count - 0.5));
  return out;
}

}  // namespace papilla::optics
