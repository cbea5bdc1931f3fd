#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "physics/persson/persson.h"
#include "physics/persson/power_law.h"

namespace papilla {

double PowerSpectrum::at(double q) const {
  if (q < lowest() || q > highest()) return 0;
  return log_log(wave_number, density, q);
}

double PowerSpectrum::moment(int order, double low, double high) const {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < wave_number.size(); ++i) {
    const double a = std::max(low, wave_number[i]), b = std::min(high, wave_number[i + 1]);
    if (!(b > a)) continue;
    const double e =
        std::log(density[i + 1] / density[i]) / std::log(wave_number[i + 1] / wave_number[i]);
    // In units of the knot: steep pieces (steps) do not overflow.
    const double unit = wave_number[i];
    sum +=
        density[i] * std::pow(unit, order + 2) * power_integral(order + 1 + e, a / unit, b / unit);
  }
  return 2 * kPi * sum;
}

double PowerSpectrum::rms() const { return std::sqrt(moment(0, lowest(), highest())); }
double PowerSpectrum::slope() const { return std::sqrt(moment(2, lowest(), highest())); }

PowerSpectrum PowerSpectrum::scaled(double factor) const {
  PowerSpectrum result = *this;
  for (double& c : result.density) c *= factor;
  return result;
}

PowerSpectrum PowerSpectrum::between(double low, double high) const {
  low = std::max(low, lowest());
  high = std::min(high, highest());
  PAPILLA_CHECK(low < high, "empty band of a spectrum");
  PowerSpectrum result{{low}, {at(low)}};
  for (std::size_t i = 0; i < wave_number.size(); ++i) {
    if (wave_number[i] > low && wave_number[i] < high) {
      result.wave_number.push_back(wave_number[i]);
      result.density.push_back(density[i]);
    }
  }
  result.wave_number.push_back(high);
  result.density.push_back(at(high));
  return result;
}

PowerSpectrum self_affine_spectrum(double rms, double q_low, double q_roll_off, double q_cutoff,
                                   double hurst) {
  PAPILLA_CHECK(q_low > 0 && q_low <= q_roll_off && q_roll_off < q_cutoff, "wave numbers ascend");
  PowerSpectrum s;
  if (q_low < q_roll_off) {
    s.wave_number.push_back(q_low);
    s.density.push_back(1);
  }
  s.wave_number.insert(s.wave_number.end(), {q_roll_off, q_cutoff});
  s.density.insert(s.density.end(), {1, std::pow(q_cutoff / q_roll_off, -2 * (1 + hurst))});
  return s.scaled(square(rms / s.rms()));
}

PowerSpectrum wrist_spectrum() { return self_affine_spectrum(22e-6, 800, 5998.2, 1e8, 0.86); }

}  // namespace papilla
