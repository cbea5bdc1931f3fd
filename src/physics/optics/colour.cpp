#include "physics/optics/colour.h"

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

const std::vector<PhotopicNode>& photopic_nodes() {
  static const std::vector<PhotopicNode> list = [] {
    double sum = 0, mean = 0, second = 0;
    for (const double l : visible_wavelengths()) {
      const double y = observer(l)[1];
      sum += y, mean += y * l, second += y * l * l;
    }
    mean /= sum;
    const double spread = std::sqrt(second / sum - mean * mean);
    // Gauss and Hermite's rule of three nodes: exact for a normal weight and fifth powers.
    return std::vector<PhotopicNode>{{mean - std::sqrt(3.0) * spread, 1.0 / 6},
                                     {mean, 2.0 / 3},
                                     {mean + std::sqrt(3.0) * spread, 1.0 / 6}};
  }();
  return list;
}

}  // namespace papilla::optics
