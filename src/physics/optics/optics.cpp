#include "physics/optics/optics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>

#include "base/constants.h"

namespace papilla::optics {
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

// A medium as light of a given sine in air meets it: permittivity along the plane of incidence,
// across it, and along the normal. Eq. optics.8
struct Medium {
  double along, across, normal;
};
Medium plain(double index) { return {square(index), square(index), square(index)}; }

enum class Polarisation { S, P };  // the field across the plane of incidence, or in it
constexpr std::array<Polarisation, 2> kPolarisations{Polarisation::S, Polarisation::P};

// Wave number along the normal over that of vacuum.
double normal_wave(const Medium& m, Polarisation p, double sine) {
  return p == Polarisation::S ? std::sqrt(m.across - sine * sine)
                              : std::sqrt(m.along * (1 - sine * sine / m.normal));
}
double admittance(const Medium& m, Polarisation p, double sine) {
  const double w = normal_wave(m, p, sine);
  return p == Polarisation::S ? w : m.along / w;
}
// Amplitude of what a boundary sends back.
double reflection(const Medium& from, const Medium& to, Polarisation p, double sine) {
  const double a = admittance(from, p, sine), b = admittance(to, p, sine);
  return (a - b) / (a + b);
}

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

// No order within the cone is further from the undeviated one than this sine, from any direction.
const double kReach = 2 * std::sin(0.5 * kHazeAngle);

// Power of the orders within 2.5 deg of light that falls in with these sines along x and y. Eq.
// optics.2, 8
struct Inside {
  double specular = 0, cone = 0;
};
template <typename Power>
Inside inside(const Grid& grid, double wavelength, double sx, double sy, const Power& power) {
  const double radius = kReach / wavelength;
  const int mx = static_cast<int>(radius * grid.lx), my = static_cast<int>(radius * grid.ly);
  const double sz = std::sqrt(1 - sx * sx - sy * sy);
  Inside out;
  for (int m = -mx; m <= mx; ++m) {
    for (int n = -my; n <= my; ++n) {
      const double dx = m * wavelength / grid.lx, dy = n * wavelength / grid.ly;
      const double z2 = 1 - square(sx + dx) - square(sy + dy);
      if (z2 <= 0) continue;
      // Length of the difference of two directions, exact for small ones.
      const double dz = std::sqrt(z2) - sz;
      if (dx * dx + dy * dy + dz * dz > kReach * kReach) continue;
      const double p = power(m, n);
      out.cone += p;
      if (m == 0 && n == 0) out.specular = p;
    }
  }
  return out;
}

// Of a screen: the mean of its power over the planes of incidence x and y.
template <typename Power>
Inside both_planes(const Grid& grid, double wavelength, double sine, const Power& power) {
  const Inside x = inside(grid, wavelength, sine, 0, power);
  if (sine == 0) return x;
  const Inside y = inside(grid, wavelength, 0, sine, power);
  return {x.specular, 0.5 * (x.cone + y.cone)};
}

// The amplitudes exp(i k h) of a heightmap, for any phase k a metre of height. Eq. optics.1
class Screen {
 public:
  explicit Screen(const Heightmap& h) : h_(h), t_(h.z.size()) {}

  Inside power(double k, double wavelength, double sine) {
    for (std::size_t i = 0; i < h_.z.size(); ++i) t_[i] = std::polar(1.0, k * h_.z[i]);
    const Orders f = orders(h_.grid, t_, kReach / wavelength);
    return both_planes(h_.grid, wavelength, sine,
                       [&](int m, int n) { return std::norm(f.at(m, n)); });
  }
  // |mean amplitude|^2 alone.
  double specular(double k) const {
    Complex sum = 0;
    for (const double z : h_.z) sum += std::polar(1.0, k * z);
    return std::norm(sum / static_cast<double>(h_.z.size()));
  }

 private:
  const Heightmap& h_;
  std::vector<Complex> t_;
};

// 2 J1(x)/x and J0(x) for x up to a few.
double airy(double x) { return x < 1e-6 ? 1 - x * x / 8 : 2 * std::cyl_bessel_j(1, x) / x; }
double sinc(double x) { return x < 1e-6 ? 1 - x * x / 6 : std::sin(x) / x; }

// The cell that repeats: of lines a strip as narrow as no order along it asks.
Grid cell_of(const FeatureArray& a) {
  if (a.shape == FeatureArray::Shape::Line) return {1, 1, a.period, 1e-3 * a.period};
  return {1, 1, a.period, a.lattice == Lattice::Square ? a.period : std::sqrt(3.0) * a.period};
}

// The amplitudes of an array: 1 around its features, and inside each outline what the terrace there
// has more than the one around it. The transforms of the outlines know no wavelength. Eq. optics.9
class ArrayScreen {
 public:
  ArrayScreen(const FeatureArray& array, double shortest) : array_(array), cell_(cell_of(array)) {
    mx_ = static_cast<int>(kReach / shortest * cell_.lx);
    my_ = static_cast<int>(kReach / shortest * cell_.ly);
    for (int m = 0; m <= mx_; ++m) {
      for (int n = 0; n <= my_; ++n) {
        for (const Terrace& t : array.terraces) share_.push_back(share(t.width, m, n));
      }
    }
  }

  Inside power(double k, double wavelength, double sine) const {
    const std::vector<Complex> rises = rises_at(k);
    std::vector<double> powers;
    for (int m = 0; m <= mx_; ++m) {
      for (int n = 0; n <= my_; ++n) powers.push_back(std::norm(order(rises, m, n)));
    }
    // Orders of either sign are alike: the outlines are symmetric.
    return both_planes(cell_, wavelength, sine,
                       [&](int m, int n) { return powers[at(std::abs(m), std::abs(n))]; });
  }
  double specular(double k) const { return std::norm(order(rises_at(k), 0, 0)); }

 private:
  std::size_t at(int m, int n) const { return static_cast<std::size_t>(m * (my_ + 1) + n); }

  // Of the amplitude at each outline, for a phase k a metre of height.
  std::vector<Complex> rises_at(double k) const {
    std::vector<Complex> out;
    Complex around = 1;
    for (const Terrace& t : array_.terraces) {
      const Complex here = std::polar(1.0, k * t.height);
      out.push_back(here - around);
      around = here;
    }
    return out;
  }

  Complex order(const std::vector<Complex>& rises, int m, int n) const {
    const double* shares = &share_[rises.size() * at(m, n)];
    Complex f = m == 0 && n == 0 ? 1.0 : 0.0;
    for (std::size_t j = 0; j < rises.size(); ++j) f += shares[j] * rises[j];
    return f;
  }

  // Fourier coefficient of the inside of an outline, its phase left out.
  double share(double width, int m, int n) const {
    const double w = std::max(width, 0.0);
    if (array_.shape == FeatureArray::Shape::Line)
      return n == 0 ? w / array_.period * sinc(kPi * m * w / array_.period) : 0;
    const bool hexagonal = array_.lattice == Lattice::Hexagonal;
    if (hexagonal && (m + n) % 2 != 0) return 0;  // two features in the cell, half of it apart
    const double q = kPi * w * std::hypot(m / cell_.lx, n / cell_.ly);
    return (hexagonal ? 2 : 1) * 0.25 * kPi * w * w / cell_.area() * airy(q);
  }

  const FeatureArray& array_;
  Grid cell_;
  int mx_ = 0, my_ = 0;
  std::vector<double> share_;  // of each order and terrace, terraces fastest
};

// The layer in each plane of incidence that counts. Eq. optics.5
std::vector<Medium> layers(double open, bool lines, const OpticalMedia& media) {
  const double e1 = square(media.fill), e2 = square(media.index);
  const double mean = open * e1 + (1 - open) * e2;
  if (lines) {  // Rytov; across and along the grooves
    const double harmonic = 1 / (open / e1 + (1 - open) / e2);
    return {{harmonic, mean, mean}, {mean, harmonic, mean}};
  }
  const double b = (2 * open - 1) * (e1 - e2);  // Bruggeman in the plane
  const double round = 0.5 * (b + std::sqrt(b * b + 4 * e1 * e2));
  return {{round, round, mean}};
}

// Wave numbers along the normal over that of vacuum, for each plane of incidence and polarisation.
std::vector<double> normal_waves(double open, bool lines, const OpticalMedia& media, double sine) {
  std::vector<double> out;
  for (const Medium& layer : layers(open, lines, media)) {
    for (const Polarisation p : kPolarisations) out.push_back(normal_wave(layer, p, sine));
  }
  return out;
}

// Share of the power that the layer sends back, for each plane and polarisation.
std::vector<double> layer_reflection(double open, double depth, bool lines,
                                     const OpticalMedia& media, double wavelength, double sine) {
  std::vector<double> out;
  const Medium fill = plain(media.fill), glass = plain(media.index);
  for (const Medium& layer : layers(open, lines, media)) {
    for (const Polarisation p : kPolarisations) {
      const double r1 = reflection(fill, layer, p, sine), r2 = reflection(layer, glass, p, sine);
      const Complex turn =
          std::polar(1.0, 4 * kPi * normal_wave(layer, p, sine) * depth / wavelength);
      out.push_back(std::norm((r1 + r2 * turn) / (1.0 + r1 * r2 * turn)));
    }
  }
  return out;
}

// Share of the transmitted light that disorder sends beyond 2.5 deg: the layer's phase follows the
// local share of features, whose fluctuation has the spectrum of independent errors. Eq. optics.7
double disorder_haze(double open, double depth, Features features, const OpticalMedia& media,
                     const Disorder& disorder, double wavelength, double sine) {
  const double w = disorder.width, k = 2 * kPi / wavelength;
  const bool lines = features == Features::Lines;
  const double share = features == Features::Pillars ? 1 - open : open;
  if (w <= 0 || share <= 0 || share >= 1) return 0;
  constexpr double kStep = 1e-4;
  double slope = 0;  // mean square of d(wave number)/d(open) over planes and polarisations
  const auto up = normal_waves(std::min(1.0, open + kStep), lines, media, sine),
             down = normal_waves(std::max(0.0, open - kStep), lines, media, sine);
  for (std::size_t i = 0; i < up.size(); ++i)
    slope += square((up[i] - down[i]) / (2 * kStep)) / static_cast<double>(up.size());
  // Spectrum of the share: per feature F^2 (1 - exp(-q^2 d^2)) + (s w dF/dw)^2.
  const auto spectrum = [&](double q) {
    double f = 0, df = 0;  // of one feature, and its change with ln w
    if (lines) {
      const double x = 0.5 * q * w;
      f = w * sinc(x), df = w * std::cos(x);
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

void photopic_means(Optics& o, const Light& light) {
  o.haze = o.transmittance = o.gloss = o.colour_shift = 0;
  const double share = 1.0 / static_cast<double>(light.angles.size());
  for (std::size_t a = 0; a < light.angles.size(); ++a) {
    const auto begin =
        o.spectrum.begin() + static_cast<std::ptrdiff_t>(a * light.wavelengths.size());
    const std::vector<SpectrumPoint> points(
        begin, begin + static_cast<std::ptrdiff_t>(light.wavelengths.size()));
    double total = 0, haze = 0, transmittance = 0, gloss = 0;
    for (const SpectrumPoint& p : points) {
      const double weight = observer(p.wavelength)[1];
      total += weight;
      haze += weight * p.haze;
      transmittance += weight * p.transmitted;
      gloss += weight * p.gloss;
    }
    o.haze += share * haze / total;
    o.transmittance += share * transmittance / total;
    o.gloss += share * gloss / total;
    const auto seen = chromaticity(points, true), source = chromaticity(points, false);
    o.colour_shift += share * std::hypot(seen[0] - source[0], seen[1] - source[1]);
  }
}

// The 60 deg of a gloss meter.
const double kGlossSine = std::sqrt(0.75);

}  // namespace

const std::vector<double>& visible_wavelengths() {
  static const std::vector<double> list = [] {
    std::vector<double> out;
    for (int nm = 400; nm <= 720; nm += 20) out.push_back(1e-9 * nm);
    return out;
  }();
  return list;
}

namespace {

template <class AnyScreen>
Optics seen_through(AnyScreen& screen, const OpticalMedia& media, const Light& light) {
  Optics out;
  out.regime = OpticsRegime::PhaseScreen;
  const Medium air = plain(1), fill = plain(media.fill), glass = plain(media.index);
  for (const double angle : light.angles) {
    const double sine = std::sin(angle);
    double faces = 0;  // what a flat plate lets through
    for (const Polarisation p : kPolarisations) {
      faces += 0.5 * plate(square(reflection(fill, glass, p, sine)),
                           square(reflection(air, glass, p, sine)));
    }
    const double path =
        normal_wave(glass, Polarisation::S, sine) - normal_wave(fill, Polarisation::S, sine);
    for (const double wavelength : light.wavelengths) {
      SpectrumPoint p;
      p.wavelength = wavelength, p.angle = angle;
      const Inside through = screen.power(2 * kPi * path / wavelength, wavelength, sine);
      p.specular = through.specular;
      p.haze = std::max(0.0, 1 - through.cone);
      p.transmitted = through.specular * faces;
      // Eq. optics.3: the path back and forth, refracted into the fill.
      const double back = 2 * normal_wave(fill, Polarisation::S, kGlossSine);
      p.gloss = screen.specular(2 * kPi * back / wavelength);
      out.spectrum.push_back(p);
    }
  }
  photopic_means(out, light);
  return out;
}

}  // namespace

Optics phase_screen(const Heightmap& h, const OpticalMedia& media, const Light& light) {
  Screen screen(h);
  return seen_through(screen, media, light);
}

bool has_closed_form(const FeatureArray& array) {
  if (array.terraces.empty()) return false;
  const double outermost = array.terraces.front().width, innermost = array.terraces.back().width;
  return outermost <= array.period && innermost >= 0;
}

Optics array_screen(const FeatureArray& array, const OpticalMedia& media, const Light& light) {
  ArrayScreen screen(array, *std::min_element(light.wavelengths.begin(), light.wavelengths.end()));
  return seen_through(screen, media, light);
}

Optics effective_medium(double open, double depth, Features features, const OpticalMedia& media,
                        const Disorder& disorder, const Light& light) {
  Optics out;
  out.regime = OpticsRegime::EffectiveMedium;
  const bool lines = features == Features::Lines;
  const Medium air = plain(1), fill = plain(media.fill), glass = plain(media.index);
  const auto mean = [](const std::vector<double>& list) {
    return std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
  };
  double bare = 0;  // flat glass, seen by the gloss meter
  for (const Polarisation p : kPolarisations)
    bare += 0.5 * square(reflection(fill, glass, p, kGlossSine));
  for (const double angle : light.angles) {
    const double sine = std::sin(angle);
    for (const double wavelength : light.wavelengths) {
      SpectrumPoint p;
      p.wavelength = wavelength, p.angle = angle;
      p.haze = disorder_haze(open, depth, features, media, disorder, wavelength, sine);
      p.specular = 1 - p.haze;
      std::vector<double> through = layer_reflection(open, depth, lines, media, wavelength, sine);
      for (std::size_t i = 0; i < through.size(); ++i)
        through[i] = plate(through[i], square(reflection(air, glass, kPolarisations[i % 2], sine)));
      p.transmitted = p.specular * mean(through);
      p.gloss =
          bare > 0
              ? mean(layer_reflection(open, depth, lines, media, wavelength, kGlossSine)) / bare
              : 1;
      out.spectrum.push_back(p);
    }
  }
  photopic_means(out, light);
  return out;
}

}  // namespace papilla::optics
