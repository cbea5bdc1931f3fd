// Arrays finer than the wavelength: a layer, and the haze of what is irregular in it.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "physics/optics/apertures.h"
#include "physics/optics/optics.h"

namespace papilla::optics {
namespace {

// The layer in each plane of incidence that counts; what absorbs has a positive imaginary part.
// Eq. optics.5
std::vector<Medium> layers(double open, bool lines, const OpticalMedia& media) {
  const Complex index(media.index, media.extinction);
  const Complex e1 = square(media.fill), e2 = index * index;
  const Complex mean = open * e1 + (1 - open) * e2;
  if (lines) {  // Rytov; across and along the grooves
    const Complex harmonic = 1.0 / (open / e1 + (1 - open) / e2);
    return {{harmonic, mean, mean}, {mean, harmonic, mean}};
  }
  // Bruggeman in the plane. Over the geometric mean the product of both roots is -1, and the one
  // whose phase lies between those of e1 and e2 has the positive real part.
  const Complex geometric = std::sqrt(e1 * e2);
  const Complex b = (2 * open - 1) * (e1 - e2) / geometric;
  const Complex round = 0.5 * geometric * (b + std::sqrt(b * b + 4.0));
  return {{round, round, mean}};
}

// Wave numbers along the normal over that of vacuum, for each plane of incidence and polarisation.
std::vector<Complex> normal_waves(double open, bool lines, const OpticalMedia& media, double sine) {
  std::vector<Complex> out;
  for (const Medium& layer : layers(open, lines, media)) {
    for (const Polarisation p : kPolarisations) out.push_back(normal_wave(layer, p, sine));
  }
  return out;
}

// Below the layer: the rest of a film that it is cut into, and what lies flat below.
std::vector<Sheet> below(const OpticalMedia& media, double depth, Features features) {
  std::vector<Sheet> out;
  if (media.cut_into_film()) {
    const double left = features == Features::Pillars ? media.thickness : media.thickness - depth;
    out.push_back({plain({media.index, media.extinction}), std::max(0.0, left)});
  }
  for (const Sheet& s : sheets_of(media.films)) out.push_back(s);
  return out;
}

// Shares of the power for each plane and polarisation, and what the face sends back from inside.
struct FaceShares {
  double reflected, transmitted, from_inside;
  Polarisation polarisation;

  // With a back face that reflects so much.
  double into_fill(double back) const {
    return reflected + square(transmitted) * back / (1 - from_inside * back);
  }
};
std::vector<FaceShares> face_shares(double open, double depth, Features features,
                                    const OpticalMedia& media, double wavelength, double sine) {
  std::vector<FaceShares> out;
  const Medium fill = plain(media.fill), glass = plain(media.glass());
  for (const Medium& layer : layers(open, features == Features::Lines, media)) {
    // Coats are counted as flat films on the layer.
    std::vector<Sheet> sheets = sheets_of(media.coats);
    sheets.push_back({layer, depth});
    for (const Sheet& s : below(media, depth, features)) sheets.push_back(s);
    const std::vector<Sheet> back(sheets.rbegin(), sheets.rend());
    for (const Polarisation p : kPolarisations) {
      const Amplitudes a = stack_amplitudes(fill, sheets, glass, p, sine, wavelength);
      const Amplitudes b = stack_amplitudes(glass, back, fill, p, sine, wavelength);
      out.push_back({std::norm(a.reflected), std::norm(a.transmitted), std::norm(b.reflected), p});
    }
  }
  return out;
}

// Share of the transmitted light that disorder sends beyond the cone: the layer's phase follows the
// local share of features, whose fluctuation has the spectrum of independent errors. Eq. optics.7
double disorder_haze(double open, double depth, Features features, const OpticalMedia& media,
                     const Disorder& disorder, double wavelength, double sine, double cone) {
  const double w = disorder.width, k = 2 * kPi / wavelength;
  const bool lines = features == Features::Lines;
  const double share = features == Features::Pillars ? 1 - open : open;
  if (w <= 0 || share <= 0 || share >= 1) return 0;
  constexpr double kStep = 1e-4;
  // Mean square of |d(wave number)/d(open)| over planes and polarisations; where the layer absorbs,
  // the amplitude follows the local share as well.
  double slope = 0;
  const auto up = normal_waves(std::min(1.0, open + kStep), lines, media, sine),
             down = normal_waves(std::max(0.0, open - kStep), lines, media, sine);
  for (std::size_t i = 0; i < up.size(); ++i)
    slope += std::norm((up[i] - down[i]) / (2 * kStep)) / static_cast<double>(up.size());
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
  const double span = 0.5 * kPi - cone;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = cone + (i + 0.5) * span / kSteps;
    const double q = k * std::sin(angle), dq = k * std::cos(angle) * span / kSteps;
    // Both sides of a line, or a ring, over the density of features.
    sum += spectrum(q) * dq * (lines ? 2 / (2 * kPi) : q / (2 * kPi));
  }
  const double density = lines ? share / w : share / (0.25 * kPi * w * w);
  // Of fine features the phase follows their local share; through each wide one light has the phase
  // and the loss of its own medium, alike for both polarisations of an isotropic one.
  const Complex between =
      normal_wave(plain({media.index, media.extinction}), Polarisation::S, sine) -
      normal_wave(plain(media.fill), Polarisation::S, sine);
  const double fine = square(k * depth) * slope;
  const double wide = std::norm(1.0 - std::exp(Complex(0, k * depth) * between));
  const double contrast = (1 - disorder.resolved) * fine + disorder.resolved * wide;
  return -std::expm1(-contrast * density * sum);
}

// Reads like a flat face: light is reflected undeviated. Eq. optics.11
double gloss_units(double open, double depth, Features features, const OpticalMedia& media,
                   const std::vector<PhotopicNode>& nodes, int degrees, bool black_back) {
  const double sine = std::sin(gloss_meter(degrees).angle);
  double sum = 0;
  for (const PhotopicNode& node : nodes) {
    const auto shares = face_shares(open, depth, features, media, node.wavelength, sine);
    for (const FaceShares& f : shares) {
      const double back = black_back ? 0
                                     : boundary_reflection(plain(media.back), plain(media.glass()),
                                                           f.polarisation, sine);
      const OuterFace outer(media.fill, f.polarisation, sine);
      const double below = f.into_fill(back);
      sum += node.weight / static_cast<double>(shares.size()) *
             (outer.reflected() + outer.twice(below) * below);
    }
  }
  return 100 * sum / face_reflection(kGlossStandard, sine);
}

}  // namespace

Optics effective_medium(double open, double depth, Features features, const OpticalMedia& media,
                        const Disorder& disorder, const Light& light) {
  Optics out;
  out.regime = OpticsRegime::EffectiveMedium;
  const double meter = std::sin(kPi / 3), clear = 1 - light.meters.inner_haze;
  const auto reflected = [&](double share, double height, double wavelength, double sine) {
    const auto shares = face_shares(share, height, features, media, wavelength, sine);
    return std::accumulate(shares.begin(), shares.end(), 0.0,
                           [](double sum, const FaceShares& f) { return sum + f.reflected; }) /
           static_cast<double>(shares.size());
  };
  const Light followed = light.followed(media.path());
  for (const double angle : followed.angles) {
    const double sine = std::sin(angle);
    for (const double wavelength : followed.wavelengths) {
      SpectrumPoint p;
      p.wavelength = wavelength, p.angle = angle;
      const double scattered = disorder_haze(open, depth, features, media, disorder, wavelength,
                                             sine, light.meters.cone);
      p.haze = 1 - clear * (1 - scattered);
      p.specular = 1 - scattered;
      const auto shares = face_shares(open, depth, features, media, wavelength, sine);
      p.total = 0;
      for (const FaceShares& f : shares) {
        const double back =
            boundary_reflection(plain(media.back), plain(media.glass()), f.polarisation, sine);
        p.total += f.transmitted * (1 - back) / (1 - f.from_inside * back) *
                   OuterFace(media.fill, f.polarisation, sine).once(f.into_fill(back)) /
                   static_cast<double>(shares.size());
      }
      p.transmitted = clear * p.specular * p.total;
      const double bare = reflected(0, 0, wavelength, meter);
      p.mirror = bare > 0 ? reflected(open, depth, wavelength, meter) / bare : 1;
      out.spectrum.push_back(p);
    }
  }
  photopic_means(out, followed);
  gather_rows(out, light);
  const std::vector<PhotopicNode> nodes = gloss_nodes(media, 2 * media.index * depth);
  const auto gloss = [&](int degrees) {
    return gloss_units(open, depth, features, media, nodes, degrees, light.meters.black_back);
  };
  out.gloss_20 = gloss(20), out.gloss = gloss(60), out.gloss_85 = gloss(85);
  return out;
}

}  // namespace papilla::optics
