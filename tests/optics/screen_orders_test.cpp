// The phase screen of any heightmap, order by order, and its means over wavelength and angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/optics/optics.h"

namespace papilla::tests::screen_orders_test {
namespace {

using Complex = std::complex<double>;

constexpr Grid kGrid{20, 14, 41e-6, 29e-6};

Heightmap bumps() {
  Heightmap h{kGrid, {}};
  RandomStream random(17, "screen", 0);
  for (std::size_t i = 0; i < kGrid.size(); ++i) h.z.push_back(-300e-9 * random.uniform());
  return h;
}

// What leaves into order (m, n) of pixel amplitudes.
double power(const std::vector<Complex>& t, int m, int n) {
  Complex sum = 0;
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix)
      sum += t[kGrid.index(ix, iy)] * std::polar(1.0, -2 * kPi *
                                                          (static_cast<double>(m * ix) / kGrid.nx +
                                                           static_cast<double>(n * iy) / kGrid.ny));
  }
  return std::norm(sum / static_cast<double>(kGrid.size()));
}

// Of all orders those within 2.5 degrees of the undeviated direction, planes of incidence x and y.
double cone(const std::vector<Complex>& t, double wavelength, double angle) {
  double out = 0;
  for (int m = -9; m <= 9; ++m) {
    for (int n = -9; n <= 9; ++n) {
      for (const bool along : {true, false}) {
        const double s = std::sin(angle), c = std::cos(angle);
        const double x = (along ? s : 0) + m * wavelength / kGrid.lx,
                     y = (along ? 0 : s) + n * wavelength / kGrid.ly;
        const double z2 = 1 - x * x - y * y;
        if (z2 <= 0) continue;
        if ((along ? x : y) * s + std::sqrt(z2) * c > std::cos(2.5 * kPi / 180))
          out += 0.5 * power(t, m, n);
      }
    }
  }
  return out;
}

// Both faces of a plate under the fill, and the fill's own in air, mean over polarisations by
// Fresnel's sines and tangents.
double faces(double fill, double glass, double angle) {
  const double s = std::sin(angle);
  const double a = std::asin(s), f = std::asin(s / fill), g = std::asin(s / glass);
  const auto across = [&](double n1, double t1, double n2, double t2) {
    return square((n1 * std::cos(t1) - n2 * std::cos(t2)) /
                  (n1 * std::cos(t1) + n2 * std::cos(t2)));
  };
  const auto in = [&](double n1, double t1, double n2, double t2) {
    return square((n1 * std::cos(t2) - n2 * std::cos(t1)) /
                  (n1 * std::cos(t2) + n2 * std::cos(t1)));
  };
  double out = 0;
  for (const auto& [r1, r2, r3] :
       {std::tuple{across(fill, f, glass, g), across(1, a, glass, g), across(1, a, fill, f)},
        {in(fill, f, glass, g), in(1, a, glass, g), in(1, a, fill, f)}}) {
    const double plate = (1 - r1) * (1 - r2) / (1 - r1 * r2);
    out += 0.5 * plate * (1 - r3) / (1 - r3 * (1 - plate));
  }
  return out;
}

TEST(ScreenOrders, OfAnyHeightmapAreItsFourierCoefficients) {
  const Heightmap h = bumps();
  for (const auto& [fill, glass] : {std::pair{1.0, 1.5}, {1.3, 1.46}}) {
    const Light light{{430e-9, 640e-9}, {0.0, 0.6, 1.2}};
    const Optics o = phase_screen(h, {glass, fill}, light);
    EXPECT_EQ(o.regime, OpticsRegime::PhaseScreen);
    ASSERT_EQ(o.spectrum.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) {
      const SpectrumPoint& p = o.spectrum[k];
      EXPECT_EQ(p.angle, light.angles[k / 2]);
      EXPECT_EQ(p.wavelength, light.wavelengths[k % 2]);
      const double s2 = square(std::sin(p.angle));
      const double path = std::sqrt(glass * glass - s2) - std::sqrt(fill * fill - s2);
      std::vector<Complex> through, back;
      for (const double z : h.z) {
        through.push_back(std::polar(1.0, 2 * kPi * path * z / p.wavelength));
        back.push_back(std::polar(1.0, 4 * kPi * std::sqrt(fill * fill - 0.75) * z / p.wavelength));
      }
      EXPECT_NEAR(p.specular, power(through, 0, 0), 1e-9) << k;
      EXPECT_NEAR(p.haze, 1 - cone(through, p.wavelength, p.angle), 1e-9) << k;
      EXPECT_NEAR(p.transmitted, power(through, 0, 0) * faces(fill, glass, p.angle), 1e-9) << k;
      EXPECT_NEAR(p.mirror, power(back, 0, 0), 1e-9) << k;
    }
  }
}

TEST(ScreenOrders, SeventeenWavelengthsAreTheVisible) {
  const std::vector<double>& list = visible_wavelengths();
  ASSERT_EQ(list.size(), 17u);
  for (std::size_t i = 0; i < 17; ++i)
    EXPECT_NEAR(list[i], (400 + 20 * static_cast<double>(i)) * 1e-9, 1e-18);
  const Light light;
  EXPECT_EQ(light.wavelengths, list);
  EXPECT_EQ(light.angles, std::vector<double>{0});
  const OpticalMedia media;
  EXPECT_EQ(media.index, 1.46);  // fused silica
  EXPECT_EQ(media.fill, 1);
}

// The listing of Wyman, Sloan and Shirley, JCGT 2(2), 2013: inverse widths either side of a peak.
std::array<double, 3> observer(double nm) {
  const auto lobe = [&](double height, double peak, double left, double right) {
    const double t = (nm - peak) * (nm < peak ? left : right);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) -
              lobe(0.065, 501.1, 0.0490, 0.0382),
          lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
          lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

// Of any pair of wavelengths, at two angles: means weigh with the luminosity, the colour is that of
// what is undeviated.
TEST(ScreenOrders, MeansAreThoseOfTheObserver) {
  const Heightmap h = bumps();
  for (int nm = 405; nm < 720; nm += 11) {
    const Light light{{1e-9 * nm, 548e-9}, {0.0, 0.9}};
    const Optics o = phase_screen(h, {1.5, 1}, light);
    double haze = 0, transmittance = 0, total = 0, shift = 0;
    for (std::size_t a = 0; a < 2; ++a) {
      double weights = 0;
      std::array<double, 3> seen{}, source{};
      std::array<double, 3> sum{};
      for (std::size_t k = 0; k < 2; ++k) {
        const SpectrumPoint& p = o.spectrum[2 * a + k];
        const std::array<double, 3> eye = observer(1e9 * p.wavelength);
        weights += eye[1];
        sum[0] += eye[1] * p.haze, sum[1] += eye[1] * p.transmitted, sum[2] += eye[1] * p.total;
        for (std::size_t c = 0; c < 3; ++c) seen[c] += eye[c] * p.transmitted, source[c] += eye[c];
      }
      haze += sum[0] / weights / 2, transmittance += sum[1] / weights / 2;
      total += sum[2] / weights / 2;
      // u' = 4X/(X + 15Y + 3Z), v' = 9Y/(X + 15Y + 3Z).
      const auto uv = [](const std::array<double, 3>& c) {
        const double all = c[0] + 15 * c[1] + 3 * c[2];
        return std::pair{4 * c[0] / all, 9 * c[1] / all};
      };
      shift +=
          std::hypot(uv(seen).first - uv(source).first, uv(seen).second - uv(source).second) / 2;
    }
    EXPECT_NEAR(o.haze, haze, 1e-9) << nm;
    EXPECT_NEAR(o.transmittance, transmittance, 1e-9) << nm;
    EXPECT_NEAR(o.total_transmittance, total, 1e-9) << nm;
    EXPECT_NEAR(o.colour_shift, shift, 1e-9) << nm;
    EXPECT_TRUE(shift > 1e-4 || nm == 548 || nm > 690) << nm;
  }
}

}  // namespace
}  // namespace papilla::tests::screen_orders_test
