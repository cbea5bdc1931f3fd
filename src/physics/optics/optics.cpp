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

// Amplitude of each pixel for phase `k` times height. Eq. optics.1
void screen(const Heightmap& h, PixelEdges edges, double low, double high, double k,
            std::vector<Complex>& t) {
  const Complex bottom = std::polar(1.0, k * low), top = std::polar(1.0, k * high);
  for (std::size_t i = 0; i < h.z.size(); ++i) {
    if (edges == PixelEdges::Sloped) {
      t[i] = std::polar(1.0, k * h.z[i]);
      continue;
    }
    const double share = high > low ? (h.z[i] - low) / (high - low) : 1;
    t[i] = bottom + share * (top - bottom);
  }
}

// Power of the orders whose angle is at most `sine`, by a separable transform of these alone.
struct Inside {
  double specular = 0, cone = 0;
};
Inside inside(const Grid& grid, const std::vector<Complex>& t, double wavelength, double sine) {
  const double radius = sine / wavelength;
  const int mx = static_cast<int>(radius * grid.lx), my = static_cast<int>(radius * grid.ly);
  Inside out;
  std::vector<Complex> rows(static_cast<std::size_t>(grid.ny)), turn(rows.size());
  for (int m = -mx; m <= mx; ++m) {
    std::vector<Complex> wave;
    for (int ix = 0; ix < grid.nx; ++ix)
      wave.push_back(std::polar(1.0, -2 * kPi * m * ix / grid.nx));
    for (int iy = 0; iy < grid.ny; ++iy) {
      Complex sum = 0;
      const Complex* row = &t[grid.index(0, iy)];
      for (int ix = 0; ix < grid.nx; ++ix) sum += row[ix] * wave[static_cast<std::size_t>(ix)];
      rows[static_cast<std::size_t>(iy)] = sum;
    }
    for (int n = -my; n <= my; ++n) {
      if (square(m / grid.lx) + square(n / grid.ly) > square(radius)) continue;
      Complex sum = 0;
      for (int iy = 0; iy < grid.ny; ++iy) {
        sum += rows[static_cast<std::size_t>(iy)] * std::polar(1.0, -2 * kPi * n * iy / grid.ny);
      }
      const double power = std::norm(sum / static_cast<double>(grid.size()));
      out.cone += power;
      if (m == 0 && n == 0) out.specular = power;
    }
  }
  return out;
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
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const double flat = fresnel(media.fill, media.index);
  std::vector<Complex> t(h.z.size());
  for (const double wavelength : wavelengths) {
    SpectrumPoint p;
    p.wavelength = wavelength;
    screen(h, edges, *low, *high, 2 * kPi * (media.index - media.fill) / wavelength, t);
    const Inside through = inside(h.grid, t, wavelength, std::sin(kHazeAngle));
    p.specular = through.specular;
    p.haze = std::max(0.0, 1 - through.cone);  // Eq. optics.2
    p.transmitted = through.specular * plate(flat, fresnel(1, media.index));
    // Eq. optics.3: the path back and forth at 60 deg in air, refracted into the fill.
    const double cosine = std::sqrt(1 - 0.75 / square(media.fill));
    screen(h, edges, *low, *high, 4 * kPi * media.fill * cosine / wavelength, t);
    p.gloss = inside(h.grid, t, wavelength, 0).specular;
    out.spectrum.push_back(p);
  }
  photopic_means(out);
  return out;
}

Optics effective_medium(double open, double depth, bool lines, const OpticalMedia& media,
                        const std::vector<double>& wavelengths) {
  Optics out;
  out.regime = "effective medium";
  const double e1 = square(media.fill), e2 = square(media.index);
  std::vector<double> layers;  // refractive index for each polarisation
  if (lines) {                 // Eq. optics.5: Rytov
    layers = {std::sqrt(open * e1 + (1 - open) * e2), 1 / std::sqrt(open / e1 + (1 - open) / e2)};
  } else {  // Bruggeman in the plane
    const double b = (2 * open - 1) * (e1 - e2);
    layers = {std::sqrt(0.5 * (b + std::sqrt(b * b + 4 * e1 * e2)))};
  }
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
    p.transmitted = plate(reflected, fresnel(1, media.index));
    p.gloss = flat > 0 ? reflected / flat : 1;
    out.spectrum.push_back(p);
  }
  photopic_means(out);
  return out;
}

}  // namespace papilla
