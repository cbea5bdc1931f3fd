#include "geometry/roughness.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/fft.h"

namespace papilla::geometry {
namespace {

// Shape of C(q), 1 at the plateau.
double shape(const Spectrum& s, double q) {
  const double roll = 2 * kPi / s.roll_off, cut = 2 * kPi / s.cutoff;
  if (q > cut * (1 + 1e-12)) return 0;
  return q <= roll ? 1 : std::pow(q / roll, -2 * (1 + s.hurst));
}

// Plateau of the amplitude density: C0 (2 pi / L)^2 summed over the modes of the reference patch is
// rms^2. The sum over modes runs on rings, exact for the reference patch.
double plateau(const Spectrum& s) {
  const double dq = 2 * kPi / s.reference_length;
  const int most = static_cast<int>(s.reference_length / s.cutoff);
  double sum = 0;
  for (int ky = 0; ky <= most; ++ky) {
    for (int kx = 0; kx <= most; ++kx) {
      if (kx == 0 && ky == 0) continue;
      const double multiplicity = (kx > 0 ? 2 : 1) * (ky > 0 ? 2 : 1);
      sum += multiplicity * shape(s, dq * std::hypot(kx, ky));
    }
  }
  return sum > 0 ? s.rms * s.rms / (sum * dq * dq) : 0;
}

// Amplitudes of the modes on the half spectrum of Fft2d: root of their variance [m]; 0: none.
using Amplitudes = std::vector<double>;

// variance(q): of a mode of wave number q [m^2].
template <class Variance>
Amplitudes amplitudes_on(const Grid& grid, const Variance& variance) {
  const int half = grid.nx / 2 + 1;
  Amplitudes out(static_cast<std::size_t>(half) * grid.ny);
  const double dqx = 2 * kPi / grid.lx, dqy = 2 * kPi / grid.ly;
  for (int iy = 0; iy < grid.ny; ++iy) {
    const int ky = signed_mode(iy, grid.ny);
    if (2 * std::abs(ky) >= grid.ny) continue;
    for (int kx = 0; kx < half; ++kx) {
      if (2 * kx >= grid.nx || (kx == 0 && ky == 0)) continue;
      out[static_cast<std::size_t>(iy) * half + kx] =
          std::sqrt(variance(std::hypot(kx * dqx, ky * dqy)));
    }
  }
  return out;
}

Amplitudes mode_amplitudes(const Spectrum& s, const Grid& grid) {
  const double c0 = plateau(s) * (2 * kPi / grid.lx) * (2 * kPi / grid.ly);
  return amplitudes_on(grid, [&](double q) { return c0 * shape(s, q); });
}

// The same for every skin of a finger.
std::shared_ptr<const Amplitudes> known_amplitudes(const Spectrum& s, const Grid& grid) {
  using Key = std::tuple<Spectrum, Grid>;
  constexpr double kMostBytes = 64e6;
  static Cache<Key, Amplitudes> cache(32, kMostBytes);
  return cache.get({s, grid}, 0.5 * sizeof(double) * static_cast<double>(grid.size()),
                   [&] { return std::make_shared<const Amplitudes>(mode_amplitudes(s, grid)); });
}

// A phase [0, 2 pi) of the mode pair (k, -k), keyed by the one of the two with ky > 0 or kx > 0.
double mode_phase(std::uint64_t key, int kx, int ky) {
  const auto a = static_cast<std::uint64_t>(kx + (1 << 20));
  const auto b = static_cast<std::uint64_t>(ky + (1 << 20));
  return 2 * kPi * hash_uniform(key, a, b);
}

// The surface of these amplitudes, moved by the offset.
Heightmap with_random_phases(const Amplitudes& amplitudes, const Grid& grid, std::uint64_t key,
                             double offset_x, double offset_y) {
  Heightmap out{grid, {}};
  const auto fft = Fft2d::shared(grid.nx, grid.ny);
  SpectrumArray spectrum(fft->spectrum_size());
  const double dqx = 2 * kPi / grid.lx, dqy = 2 * kPi / grid.ly;
  for (int iy = 0; iy < grid.ny; ++iy) {
    const int ky = signed_mode(iy, grid.ny);
    for (int kx = 0; kx < fft->half(); ++kx) {
      const std::size_t mode = static_cast<std::size_t>(iy) * fft->half() + kx;
      if (amplitudes[mode] <= 0) continue;
      // Real field: the modes k and -k carry conjugate values; each has variance c.
      const bool upper = kx > 0 || ky > 0;
      const double phase = upper ? mode_phase(key, kx, ky) : -mode_phase(key, -kx, -ky);
      const double shift = kx * dqx * offset_x + ky * dqy * offset_y;
      // Pixel centres sit half a pixel in.
      const double centre =
          kPi * (static_cast<double>(kx) / grid.nx + static_cast<double>(ky) / grid.ny);
      spectrum[mode] = std::polar(amplitudes[mode], phase - shift + centre);
    }
  }
  RealArray z(grid.size());
  fft->inverse(spectrum.data(), z.data());
  out.z.assign(z.begin(), z.end());
  return out;
}

}  // namespace

Heightmap random_surface(const Spectrum& s, const Grid& grid, std::uint64_t seed,
                         std::uint64_t index, double offset_x, double offset_y) {
  if (s.rms <= 0) return {grid, std::vector<double>(grid.size(), 0)};
  return with_random_phases(*known_amplitudes(s, grid), grid,
                            RandomStream(seed, "skin", index).bits(), offset_x, offset_y);
}

RoughScale endless_scale(double rms, double correlation_length, double side) {
  // Mean of exp(-(x - x')^2/l^2) over pairs of places on a line of this side.
  const double a = side / correlation_length;
  const double line = (std::sqrt(kPi) * a * std::erf(a) + std::expm1(-a * a)) / (a * a);
  return {rms / std::sqrt(1 - line * line), correlation_length};
}

Heightmap random_surface(const std::vector<RoughScale>& scales, const Grid& grid,
                         std::uint64_t seed) {
  const double dqx = 2 * kPi / grid.lx, dqy = 2 * kPi / grid.ly;
  const Amplitudes amplitudes = amplitudes_on(grid, [&](double q) {
    double density = 0;  // spectrum over (2 pi)^2 [m^4]
    for (const RoughScale& s : scales)
      density += square(s.rms * s.correlation_length) / (4 * kPi) *
                 std::exp(-0.25 * square(q * s.correlation_length));
    return density * dqx * dqy;
  });
  return with_random_phases(amplitudes, grid, RandomStream(seed, "etch", 0).bits(), 0, 0);
}

Heightmap random_surface(const std::function<double(double)>& spectrum, const Grid& grid,
                         std::uint64_t seed) {
  const double cell = (2 * kPi / grid.lx) * (2 * kPi / grid.ly);
  return with_random_phases(amplitudes_on(grid, [&](double q) { return spectrum(q) * cell; }), grid,
                            RandomStream(seed, "spectrum", 0).bits(), 0, 0);
}

RoughnessParameters roughness_parameters(const Heightmap& h) {
  const Grid& g = h.grid;
  const auto n = static_cast<double>(g.size());
  double mean = 0;
  for (double z : h.z) mean += z;
  mean /= n;
  RoughnessParameters r{};
  double s2 = 0, s3 = 0, s4 = 0, slope2 = 0, sdr = 0, steepest = 0;
  for (double z0 : h.z) {
    const double z = z0 - mean;
    r.sa += std::abs(z) / n;
    s2 += z * z / n;
    s3 += z * z * z / n;
    s4 += z * z * z * z / n;
    r.sp = std::max(r.sp, z);
    r.sv = std::max(r.sv, -z);
  }
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      // Forward differences: slopes half a pixel on, four times nearer than central ones.
      const double zx = (h(wrap(ix + 1, g.nx), iy) - h(ix, iy)) / g.dx();
      const double zy = (h(ix, wrap(iy + 1, g.ny)) - h(ix, iy)) / g.dy();
      const double slope = zx * zx + zy * zy;
      slope2 += slope / n;
      sdr += (std::sqrt(1 + slope) - 1) / n;
      steepest = std::max({steepest, std::abs(zx) * g.dx(), std::abs(zy) * g.dy()});
    }
  }
  r.sq = std::sqrt(s2);
  r.ssk = s2 > 0 ? s3 / (s2 * r.sq) : 0;
  r.sku = s2 > 0 ? s4 / (s2 * s2) : 0;
  r.sz = r.sp + r.sv;
  r.sdq = std::sqrt(slope2);
  r.sdr = sdr;
  r.slopes_sampling_limited = r.sz > 0 && steepest > 0.25 * r.sz;
  return r;
}

}  // namespace papilla::geometry
