#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/persson/persson.h"

namespace papilla::persson {

ContactShares plastic_shares(double pressure, double stress_measure, double yield) {
  ContactShares shares;
  const double p = pressure / yield;
  if (p >= 1) return {0, 1};
  const double th = kPi * kPi * stress_measure / (4 * square(yield));
  if (th < 1) {  // images in the absorbing walls at 0 and yield: converges at once for small spread
    const double root = std::sqrt(stress_measure) / yield;
    const auto hits = [&](double distance) {  // share that reached the wall at this distance first
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        sum += std::erfc((2 * k + distance) / root) - std::erfc((2 * k + 2 - distance) / root);
      }
      return sum;
    };
    shares.plastic = hits(1 - p);
    shares.elastic = std::max(0.0, 1 - hits(p) - shares.plastic);
    return shares;
  }
  shares.plastic = p;
  for (int n = 1; n <= 12; ++n) {
    const double decay = 2 / (n * kPi) * std::sin(n * kPi * p) * std::exp(-n * n * th);
    shares.plastic += n % 2 ? -decay : decay;
    if (n % 2) shares.elastic += 2 * decay;
  }
  return shares;
}

PowerSpectrum plastic_smoothing(const PowerSpectrum& spectrum, const MeanFieldSolid& solid,
                                double yield, double pressure, double kappa) {
  MeanFieldOptions options;
  options.kappa = kappa;
  const MeanField field(spectrum, solid, options);
  const double step = std::log(spectrum.highest() / spectrum.lowest()) / options.intervals;
  PowerSpectrum result;
  const auto keep = [&](double q) {
    const double m = field.stress_measure(q);
    const double yielded = m > 0 ? plastic_shares(pressure, m, yield).plastic : 0.0;
    const double factor = 1 - std::pow(yielded / (pressure / yield), 6);
    if (factor < 1e-9) return false;
    result.wave_number.push_back(q);
    result.density.push_back(factor * spectrum.at(q));
    return true;
  };
  bool open = keep(spectrum.lowest());
  for (std::size_t i = 0; open && i + 1 < spectrum.wave_number.size(); ++i) {
    const double a = spectrum.wave_number[i], b = spectrum.wave_number[i + 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::log(b / a) / step)));
    for (int k = 1; open && k <= pieces; ++k) {
      open = keep(k == pieces ? b : a * std::pow(b / a, double(k) / pieces));
    }
  }
  return result;
}

}  // namespace papilla::persson
