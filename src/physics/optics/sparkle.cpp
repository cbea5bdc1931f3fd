#include "physics/optics/sparkle.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/constants.h"
#include "physics/optics/apertures.h"
#include "physics/optics/transform.h"

namespace papilla::optics {
namespace {

using Complex = std::complex<double>;

// What subpixel and pupil leave of a wave of the pattern, its power. Eq. optics.13
double passed(double qx, double qy, const Panel& p) {
  const double pupil = airy(std::hypot(qx, qy) * p.pupil * p.depth);
  return square(pupil * sinc(0.5 * qx * p.width) * sinc(0.5 * qy * p.height));
}
// The same, mean over directions.
double passed(double q, const Panel& p) {
  constexpr int kSteps = 24;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double turn = 0.5 * kPi * (k + 0.5) / kSteps;
    sum += passed(q * std::cos(turn), q * std::sin(turn), p) / kSteps;
  }
  return sum;
}

double wave_number(const Panel& p) { return 2 * kPi / p.wavelength; }

// Longest wave of the pattern that is summed: beyond it a subpixel leaves nothing, or there is
// none.
double largest_wave(const std::vector<RoughScale>& scales, double phase, const Panel& p) {
  double scale = 0;
  for (const RoughScale& s : scales)
    scale = std::max(scale, 6 / s.correlation_length * (1 + std::abs(phase) * s.rms));
  return std::min(scale, 16 * 2 * kPi / std::min(p.width, p.height));
}

// sqrt of the integral of spectrum(q) over the waves of the pattern that pass.
template <class SpectrumOf>
double spread(double largest, const Panel& panel, const SpectrumOf& spectrum) {
  constexpr int kSteps = 96;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    // Closer together where subpixels pass most.
    const double u = (k + 0.5) / kSteps, q = largest * u * u, dq = largest * 2 * u / kSteps;
    sum += spectrum(q) * passed(q, panel) * q * dq / (2 * kPi);
  }
  return std::sqrt(sum);
}

// Heights of one scale as seen from x and from both x + s and x - s, over its variance and its
// part across: the second difference of exp(-x^2/l^2). Eq. optics.15
double second_difference(double x, double shift, double length) {
  const auto bell = [length](double u) { return std::exp(-square(u / length)); };
  return 2 * bell(x) - bell(x + shift) - bell(x - shift);
}

// Spectrum of the pattern of Gaussian heights at wave q. Eq. optics.15
class PatternSpectrum {
 public:
  PatternSpectrum(std::vector<RoughScale> scales, double phase, const Panel& panel)
      : scales_(std::move(scales)), phase_(phase), panel_(panel) {
    for (const RoughScale& s : scales_) longest_ = std::max(longest_, s.correlation_length);
    // Scales far finer than the longest and the subpixel only weaken its pattern.
    const double fine = std::min(longest_, std::min(panel.width, panel.height)) / 8;
    std::stable_partition(scales_.begin(), scales_.end(),
                          [&](const RoughScale& s) { return s.correlation_length >= fine; });
    for (const RoughScale& s : scales_) coarse_ += s.correlation_length >= fine;
    double strength = 0;
    for (std::size_t i = 0; i < coarse_; ++i) {
      shortest_ = std::min(shortest_, scales_[i].correlation_length);
      strength = std::max(strength, std::abs(phase_) * scales_[i].rms);
    }
    pitch_ = shortest_ / (5 * std::max(1.0, strength));
  }

  std::vector<RoughScale> coarse() const {
    return {scales_.begin(), scales_.begin() + static_cast<std::ptrdiff_t>(coarse_)};
  }

  double operator()(double q) const {
    const double shift = q * panel_.depth / wave_number(panel_);
    double loss = 0;  // half the variance of the phase difference over the shift
    for (std::size_t i = coarse_; i < scales_.size(); ++i)
      loss += square(phase_ * scales_[i].rms) *
              second_difference(0, shift, scales_[i].correlation_length);
    double at_zero = 0;
    for (std::size_t i = 0; i < coarse_; ++i)
      at_zero += square(phase_ * scales_[i].rms) *
                 second_difference(0, shift, scales_[i].correlation_length);
    return std::exp(-loss) * integral(q, shift, at_zero);
  }

 private:
  // Midpoints over x and y >= 0 of cos(q x) (exp(c(x, y) - c0) - exp(-c0)).
  double integral(double q, double shift, double at_zero) const {
    const double reach = 3.5 * longest_, step = std::min(pitch_, 0.5 / std::max(q, 1e-3 / reach));
    const int nx = static_cast<int>(std::ceil((reach + shift) / step)),
              ny = static_cast<int>(std::ceil(reach / step));
    std::vector<double> across(static_cast<std::size_t>(ny) * coarse_);
    for (int k = 0; k < ny; ++k) {
      for (std::size_t i = 0; i < coarse_; ++i)
        across[static_cast<std::size_t>(k) * coarse_ + i] =
            std::exp(-square((k + 0.5) * step / scales_[i].correlation_length));
    }
    std::vector<double> along(coarse_);
    const double rest = std::exp(-at_zero);
    double sum = 0;
    for (int m = 0; m < nx; ++m) {
      const double x = (m + 0.5) * step;
      for (std::size_t i = 0; i < coarse_; ++i)
        along[i] = square(phase_ * scales_[i].rms) *
                   second_difference(x, shift, scales_[i].correlation_length);
      double row = 0;
      for (int k = 0; k < ny; ++k) {
        double c = 0;
        for (std::size_t i = 0; i < coarse_; ++i)
          c += along[i] * across[static_cast<std::size_t>(k) * coarse_ + i];
        row += std::exp(c - at_zero) - rest;
      }
      sum += std::cos(q * x) * row;
    }
    return 4 * sum * step * step;
  }

  std::vector<RoughScale> scales_;  // the coarse ones first
  double phase_;
  Panel panel_;
  std::size_t coarse_ = 0;
  double longest_ = 0, shortest_ = kInfinity, pitch_ = 0;
};

std::vector<RoughScale> present(const std::vector<RoughScale>& scales) {
  std::vector<RoughScale> out;
  std::copy_if(scales.begin(), scales.end(), std::back_inserter(out),
               [](const RoughScale& s) { return s.rms > 0; });
  return out;
}

}  // namespace

double rough_sparkle(const std::vector<RoughScale>& scales, double step, const Panel& panel) {
  const std::vector<RoughScale> rough = present(scales);
  const double phase = wave_number(panel) * step;
  if (rough.empty() || phase == 0) return 0;
  const PatternSpectrum spectrum(rough, phase, panel);
  return spread(largest_wave(spectrum.coarse(), phase, panel), panel,
                [&](double q) { return std::max(0.0, spectrum(q)); });
}

double weak_sparkle(const std::vector<RoughScale>& scales, double step, const Panel& panel) {
  const std::vector<RoughScale> rough = present(scales);
  const double phase = wave_number(panel) * step;
  return spread(largest_wave(rough, 0, panel), panel, [&](double q) {
    double heights = 0;  // spectrum [m^4]
    for (const RoughScale& s : rough)
      heights += kPi * square(s.rms * s.correlation_length) *
                 std::exp(-0.25 * square(q * s.correlation_length));
    // Eq. optics.14: of a phase grating the light of q is 2 sin(q^2 z/2k) of its phase.
    const double talbot = std::sin(0.5 * q * q * panel.depth / wave_number(panel));
    return 4 * square(talbot * phase) * heights;
  });
}

// Eq. optics.16
double map_sparkle(const Heightmap& map, double step, const Panel& panel) {
  const Grid& g = map.grid;
  const double k = wave_number(panel);
  const auto qx = [&](int ix) { return 2 * kPi * (2 * ix > g.nx ? ix - g.nx : ix) / g.lx; };
  const auto qy = [&](int iy) { return 2 * kPi * (2 * iy > g.ny ? iy - g.ny : iy) / g.ly; };
  SpectrumArray t(g.size());
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = std::polar(1.0, k * step * map.z[i]);
  SpectrumArray f = coefficients(g, t);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix)
      f[g.index(ix, iy)] *=
          std::polar(1.0, -0.5 * (square(qx(ix)) + square(qy(iy))) * panel.depth / k);
  }
  SpectrumArray field = field_of(g, f);
  for (Complex& c : field) c = std::norm(c);
  const SpectrumArray pattern = coefficients(g, field);
  double sum = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      if (ix > 0 || iy > 0)
        sum += std::norm(pattern[g.index(ix, iy)]) * passed(qx(ix), qy(iy), panel);
    }
  }
  return std::sqrt(sum) / pattern[0].real();
}

}  // namespace papilla::optics
