#include "geometry/spectra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/constants.h"
#include "numerics/fft.h"

namespace papilla::geometry {
namespace {

constexpr int kRingsPerDecade = 10;

// Rings of all maps have common centres: 10^(k / 10) metres.
int ring_of(double wavelength) {
  return static_cast<int>(std::lround(kRingsPerDecade * std::log10(wavelength)));
}
double centre_of(int ring) { return std::pow(10.0, static_cast<double>(ring) / kRingsPerDecade); }

struct Sum {
  double density = 0;
  std::size_t modes = 0;
};

// Lines of n values a step apart, each less its mean under the window. Eq. geometry.11
template <class Value>
void add_lines(int lines, int n, double step, const Value& value, std::map<int, Sum>& out) {
  if (n < 8) return;
  const auto fft = Fft2d::shared(n, 1);
  std::vector<double> window(static_cast<std::size_t>(n));
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2 * kPi * (i + 0.5) / n);
    window[static_cast<std::size_t>(i)] = w;
    sum += w, squares += w * w;
  }
  RealArray line(fft->real_size());
  SpectrumArray modes(fft->spectrum_size());
  std::vector<double> power(modes.size(), 0);
  for (int k = 0; k < lines; ++k) {
    double mean = 0;
    for (int i = 0; i < n; ++i) mean += window[static_cast<std::size_t>(i)] * value(k, i) / sum;
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      line[at] = window[at] * (value(k, i) - mean);
    }
    fft->forward(line.data(), modes.data());
    for (std::size_t m = 0; m < modes.size(); ++m) power[m] += std::norm(modes[m]) / lines;
  }
  for (std::size_t m = 1; m < power.size(); ++m) {
    const double wavelength = n * step / static_cast<double>(m);
    Sum& ring = out[ring_of(wavelength)];
    ring.density += step * power[m] / squares;
    ++ring.modes;
  }
}

// Wave numbers [1/m] and medians [m^3] of both surfaces.
constexpr std::array<std::pair<double, double>, 12> kSmoother{{{62831.85, 1.448e-21},
                                                               {161988.4, 6.615e-22},
                                                               {430493.8, 4.187e-22},
                                                               {1.221730e6, 7.431e-23},
                                                               {3.072748e6, 2.905e-24},
                                                               {1.256637e7, 9.618e-25},
                                                               {3.374403e7, 5.568e-25},
                                                               {8.482300e7, 8.348e-26},
                                                               {1.355704e8, 1.365e-26},
                                                               {2.193191e8, 1.928e-28},
                                                               {6.134710e8, 2.206e-29},
                                                               {1.620291e9, 6.565e-31}}};
constexpr std::array<std::pair<double, double>, 12> kRougher{{{61979.02, 1.547e-17},
                                                              {164404.1, 8.432e-18},
                                                              {418879.0, 8.023e-19},
                                                              {1.118989e6, 3.548e-20},
                                                              {2.966885e6, 5.227e-22},
                                                              {1.256637e7, 1.439e-24},
                                                              {3.374758e7, 3.808e-25},
                                                              {8.988024e7, 6.639e-26},
                                                              {1.338318e8, 9.997e-27},
                                                              {2.261947e8, 9.100e-28},
                                                              {6.148869e8, 5.774e-29},
                                                              {1.668214e9, 7.076e-30}}};

template <std::size_t N>
double median_at(const std::array<std::pair<double, double>, N>& points, double wave_number) {
  if (wave_number < points.front().first || wave_number > points.back().first) return 0;
  const auto above = std::find_if(points.begin() + 1, points.end() - 1,
                                  [&](const auto& p) { return p.first >= wave_number; });
  const auto below = above - 1;
  const double share = std::log(wave_number / below->first) / std::log(above->first / below->first);
  return below->second * std::pow(above->second / below->second, share);
}

}  // namespace

std::vector<LineRing> line_spectrum(const Heightmap& h) {
  std::map<int, Sum> sums;
  const Grid& g = h.grid;
  add_lines(
      g.ny, g.nx, g.dx(), [&](int iy, int ix) { return h(ix, iy); }, sums);
  add_lines(
      g.nx, g.ny, g.dy(), [&](int ix, int iy) { return h(ix, iy); }, sums);
  std::vector<LineRing> out;
  for (auto it = sums.rbegin(); it != sums.rend(); ++it)
    out.push_back(
        {centre_of(it->first), it->second.density / static_cast<double>(it->second.modes)});
  return out;
}

std::vector<JointRing> joint_spectrum(const std::vector<MapSpectrum>& maps) {
  std::map<int, std::vector<double>> logs;
  for (const MapSpectrum& map : maps) {
    for (const LineRing& ring : map.rings) {
      const bool known =
          ring.wavelength <= map.band.longest && ring.wavelength >= map.band.shortest;
      if (known && ring.density > 0)
        logs[ring_of(ring.wavelength)].push_back(std::log(ring.density));
    }
  }
  std::vector<JointRing> out;
  for (auto it = logs.rbegin(); it != logs.rend(); ++it) {
    const auto n = static_cast<double>(it->second.size());
    double mean = 0, square_sum = 0;
    for (const double v : it->second) mean += v / n;
    for (const double v : it->second) square_sum += square(v - mean);
    out.push_back({centre_of(it->first), std::exp(mean),
                   n > 1 ? std::exp(std::sqrt(square_sum / (n - 1))) : 1, it->second.size()});
  }
  return out;
}

double joint_rms(const std::vector<JointRing>& rings) {
  double sum = 0;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    const JointRing &low = rings[i - 1], &high = rings[i];
    const double from = 2 * kPi / low.wavelength, to = 2 * kPi / high.wavelength;
    // A power of q between two centres, p; of p = -1 the logarithm.
    const double power = std::log(high.density / low.density) / std::log(to / from);
    constexpr double kLogarithm = 1e-6;
    sum += std::abs(power + 1) < kLogarithm
               ? low.density * from * std::log(to / from)
               : (high.density * to - low.density * from) / (power + 1);
  }
  return std::sqrt(sum / kPi);
}

Consensus consensus_at(double wavelength) {
  const double q = 2 * kPi / wavelength;
  return {median_at(kSmoother, q), median_at(kRougher, q)};
}

}  // namespace papilla::geometry
