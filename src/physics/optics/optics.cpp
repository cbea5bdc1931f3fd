#include "physics/optics/optics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "base/constants.h"

namespace papilla {
namespace {

using Complex = std::complex<double>;

// CIE 1931 colour matching, the fits of Wyman, Sloan and Shirley (JCGT 2, 2, 2013). Eq. optics.6
double lobe(double nm, double height, double peak, double left, double right) {
  return height * std::exp(-0.5 * square((nm - peak) * (nm < peak ? left : right)));
}
std::array<double, 3> observer(double wavelength) {
  const double l = 1e9 * wavelength;
  return {lobe(l, 0.362, 442.0, 0.0624, 0.0374) + lobe(l, 1.056, 599.8, 0.0264, 0.0323) -
              lobe(l, 0.065, 501.1, 0.0490, 0.0382),
          lobe(l, 0.821, 568.8, 0.0213, 0.0247) + lobe(l, 0.286, 530.9, 0.0613, 0.0322),
          lobe(l, 1.217, 437.0, 0.0845, 0.0278) + lobe(l, 0.681, 459.0, 0.0385, 0.0725)};
}

double fresnel(double from, double to) { return square((from - to) / (from + to)); }

// Both faces of a plate without interference. Eq. optics.4
double plate(double reflected1, double reflected2) {
  return (1 - reflected1) * (1 - reflected2) / (1 - reflected1 * reflected2);
}

// Coefficients F_mn of a pixel quantity for |m| <= mx, 0 <= n <= ny of a real one or all n, by a
// separable transform of these alone; m and n from the lowest, n fastest.
struct Orders {
  int mx = 0, my = 0;
  std::vector<Complex> f;
  Complex at(int m, int n) const {
    return f[static_cast<std::size_t>((m + mx) * (2 * my + 1) + n + my)];
  }
};
template <typename Number>
Orders orders(const Grid& grid, const std::vector<Number>& t, double radius) {
  Orders out{static_cast<int>(radius * grid.lx), static_cast<int>(radius * grid.ly), {}};
  const auto turns = [](int n) {
    std::vector<Complex> list(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
      list[static_cast<std::size_t>(i)] = std::polar(1.0, -2 * kPi * i / n);
    return list;
  };
  const std::vector<Complex> ex = turns(grid.nx), ey = turns(grid.ny);
  std::vector<Complex> rows(static_cast<std::size_t>(grid.ny));
  for (int m = -out.mx; m <= out.mx; ++m) {
    for (int iy = 0; iy < grid.ny; ++iy) {
      Complex sum = 0;
      const Number* row = &t[grid.index(0, iy)];
      for (int ix = 0, turn = 0; ix < grid.nx; ++ix) {
        sum += row[ix] * ex[static_cast<std::size_t>(turn)];
        turn = wrap(turn + m, grid.nx);
      }
      rows[static_cast<std::size_t>(iy)] = sum;
    }
    for (int n = -out.my; n <= out.my; ++n) {
      Complex sum = 0;
      for (int iy = 0, turn = 0; iy < grid.ny; ++iy) {
        sum += rows[static_cast<std::size_t>(iy)] * ey[static_cast<std::size_t>(turn)];
        turn = wrap(turn + n, grid.ny);
      }
      out.f.push_back(sum / static_cast<double>(grid.size()));
    }
  }
  return out;
}

// Power of the orders within a radius in wave numbers [1/m].
struct Inside {
  double specular = 0, cone = 0;
};
template <typename Power>
Inside inside(const Grid& grid, double radius, const Power& power) {
  const int mx = static_cast<int>(radius * grid.lx), my = static_cast<int>(radius * grid.ly);
  Inside out;
  for (int m = -mx; m <= mx; ++m) {
    for (int n = -my; n <= my; ++n) {
      if (square(m / grid.lx) + square(n / grid.ly) > square(radius)) continue;
      const double p = power(m, n);
      out.cone += p;
      if (m == 0 && n == 0) out.specular = p;
    }
  }
  return out;
}

// The amplitudes exp(i k h) of a heightmap, for any phase k a metre of height. Eq. optics.1
class Screen {
 public:
  Screen(const Heightmap& h, PixelEdges edges, double largest_radius) : h_(h), edges_(edges) {
    const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
    low_ = *low, high_ = *high;
    t_.resize(h.z.size());
    if (edges == PixelEdges::Sloped) return;
    std::vector<double> share(h.z.size());
    for (std::size_t i = 0; i < h.z.size(); ++i)
      share[i] = high_ > low_ ? (h.z[i] - low_) / (high_ - low_) : 1;
    share_ = orders(h.grid, share, largest_radius);
  }

  Inside power(double k, double radius) {
    if (edges_ == PixelEdges::TwoLevels) {
      // The share of the upper level knows no wavelength: its transform serves all.
      const Complex bottom = std::polar(1.0, k * low_), step = std::polar(1.0, k * high_) - bottom;
      return inside(h_.grid, radius, [&](int m, int n) {
        return std::norm((m == 0 && n == 0 ? bottom : 0.0) + share_.at(m, n) * step);
      });
    }
    for (std::size_t i = 0; i < h_.z.size(); ++i) t_[i] = std::polar(1.0, k * h_.z[i]);
    const Orders f = orders(h_.grid, t_, radius);
    return inside(h_.grid, radius, [&](int m, int n) { return std::norm(f.at(m, n)); });
  }

 private:
  const Heightmap& h_;
  PixelEdges edges_;
  double low_ = 0, high_ = 0;
  Orders share_;
  std::vector<Complex> t_;
};

// 2 J1(x)/x and J0(x) for x up to a few.
double airy(double x) { return x < 1e-6 ? 1 - x * x / 8 : 2 * std::cyl_bessel_j(1, x) / x; }

// Index of the layer for each polarisation. Eq. optics.5
std::vector<double> layer_indices(double open, bool lines, const OpticalMedia& media) {
  const double e1 = square(media.fill), e2 = square(media.index);
  if (lines) {  // Rytov
    return {std::sqrt(open * e1 + (1 - open) * e2), 1 / std::sqrt(open / e1 + (1 - open) / e2)};
  }
  const double b = (2 * open - 1) * (e1 - e2);  // Bruggeman in the plane
  return {std::sqrt(0.5 * (b + std::sqrt(b * b + 4 * e1 * e2)))};
}

// Share of the transmitted light that disorder sends beyond 2.5 deg: the layer's phase follows the
// local share of features, whose fluctuation has the spectrum of independent errors. Eq. optics.7
double disorder_haze(double open, double depth, Features features, const OpticalMedia& media,
                     const Disorder& disorder, double wavelength) {
  const double w = disorder.width, k = 2 * kPi / wavelength;
  const bool lines = features == Features::Lines;
  const double share = features == Features::Pillars ? 1 - open : open;
  if (w <= 0 || share <= 0 || share >= 1) return 0;
  constexpr double kStep = 1e-4;
  double slope = 0;  // mean square of d(index)/d(open) over polarisations
  const auto up = layer_indices(std::min(1.0, open + kStep), lines, media),
             down = layer_indices(std::max(0.0, open - kStep), lines, media);
  for (std::size_t i = 0; i < up.size(); ++i)
    slope += square((up[i] - down[i]) / (2 * kStep)) / static_cast<double>(up.size());
  // Spectrum of the share: per feature F^2 (1 - exp(-q^2 d^2)) + (s w dF/dw)^2.
  const auto spectrum = [&](double q) {
    double f = 0, df = 0;  // of one feature, and its change with ln w
    if (lines) {
      const double x = 0.5 * q * w;
      f = w * (x < 1e-6 ? 1 : std::sin(x) / x), df = w * std::cos(x);
    } else {
      const double area = 0.25 * kPi * w * w, x = 0.5 * q * w;
      f = area * airy(x), df = 2 * area * std::cyl_bessel_j(0, x);
    }
    return square(f) * -std::expm1(-square(q * disorder.displacement)) +
           square(disorder.scatter * df);
  };
  // Midpoints in the angle; q = k sin(angle).
  constexpr int kSteps = 64;
  const double span = 0.5 * kPi - kHazeAngle;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = kHazeAngle + (i + 0.5) * span / kSteps;
    const double q = k * std::sin(angle), dq = k * std::cos(angle) * span / kSteps;
    // Both sides of a line, or a ring, over the density of features.
    sum += spectrum(q) * dq * (lines ? 2 / (2 * kPi) : q / (2 * kPi));
  }
  const double density = lines ? share / w : share / (0.25 * kPi * w * w);
  return -std::expm1(-square(k * depth) * slope * density * sum);
}

// Chromaticity u', v' of a spectrum under equal energy.
std::array<double, 2> chromaticity(const std::vector<SpectrumPoint>& spectrum, bool through) {
  double x = 0, y = 0, z = 0;
  for (const SpectrumPoint& p : spectrum) {
    const auto [xbar, ybar, zbar] = observer(p.wavelength);
    const double light = through ? p.transmitted : 1;
    x += xbar * light, y += ybar * light, z += zbar * light;
  }
  const double sum = x + 15 * y + 3 * z;
  return sum > 0 ? std::array<double, 2>{4 * x / sum, 9 * y / sum} : std::array<double, 2>{0, 0};
}

void photopic_means(Optics& o) {
  double total = 0;
  o.haze = o.transmittance = o.gloss = 0;
  for (const SpectrumPoint& p : o.spectrum) {
    const double weight = observer(p.wavelength)[1];
    total += weight;
    o.haze += weight * p.haze;
    o.transmittance += weight * p.transmitted;
    o.gloss += weight * p.gloss;
  }
  o.haze /= total, o.transmittance /= total, o.gloss /= total;
  const auto light = chromaticity(o.spectrum, true), source = chromaticity(o.spectrum, false);
  o.colour_shift = std::hypot(light[0] - source[0], light[1] - source[1]);
}

}  // namespace

const std::vector<double>& visible_wavelengths() {
  static const std::vector<double> list = [] {
    std::vector<double> out;
    for (int nm = 400; nm <= 720; nm += 20) out.push_back(1e-9 * nm);
    return out;
  }();
  return list;
}

Optics phase_screen(const Heightmap& h, PixelEdges edges, const OpticalMedia& media,
                    const std::vector<double>& wavelengths) {
  Optics out;
  out.regime = "phase screen";
  const double flat = fresnel(media.fill, media.index);
  const double sine = std::sin(kHazeAngle);
  Screen screen(h, edges, sine / *std::min_element(wavelengths.begin(), wavelengths.end()));
  for (const double wavelength : wavelengths) {
    SpectrumPoint p;
    p.wavelength = wavelength;
    const Inside through =
        screen.power(2 * kPi * (media.index - media.fill) / wavelength, sine / wavelength);
    p.specular = through.specular;
    p.haze = std::max(0.0, 1 - through.cone);  // Eq. optics.2
    p.transmitted = through.specular * plate(flat, fresnel(1, media.index));
    // Eq. optics.3: the path back and forth at 60 deg in air, refracted into the fill.
    const double cosine = std::sqrt(1 - 0.75 / square(media.fill));
    p.gloss = screen.power(4 * kPi * media.fill * cosine / wavelength, 0).specular;
    out.spectrum.push_back(p);
  }
  photopic_means(out);
  return out;
}

Optics effective_medium(double open, double depth, Features features, const OpticalMedia& media,
                        const Disorder& disorder, const std::vector<double>& wavelengths) {
  Optics out;
  out.regime = "effective medium";
  const std::vector<double> layers = layer_indices(open, features == Features::Lines, media);
  for (const double wavelength : wavelengths) {
    SpectrumPoint p;
    p.wavelength = wavelength;
    double reflected = 0;
    for (const double n : layers) {
      const double r1 = (media.fill - n) / (media.fill + n),
                   r2 = (n - media.index) / (n + media.index);
      const Complex turn = std::polar(1.0, 4 * kPi * n * depth / wavelength);
      reflected +=
          std::norm((r1 + r2 * turn) / (1.0 + r1 * r2 * turn)) / static_cast<double>(layers.size());
    }
    const double flat = fresnel(media.fill, media.index);
    p.haze = disorder_haze(open, depth, features, media, disorder, wavelength);
    p.specular = 1 - p.haze;
    p.transmitted = p.specular * plate(reflected, fresnel(1, media.index));
    p.gloss = flat > 0 ? reflected / flat : 1;
    out.spectrum.push_back(p);
  }
  photopic_means(out);
  return out;
}

}  // namespace papilla
