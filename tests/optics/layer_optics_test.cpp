// Effective medium: the layer by characteristic matrices, its disorder by the integral written out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "physics/optics/optics.h"

namespace papilla::tests::layer_optics_test {
namespace {

using Complex = std::complex<double>;

// Permittivities along the plane of incidence, across it, along the normal. Eq. optics.5, 8
struct Layer {
  double along, across, normal;
};
std::vector<Layer> planes(double open, bool lines, double fill, double glass) {
  const double e1 = fill * fill, e2 = glass * glass, mean = open * e1 + (1 - open) * e2;
  if (lines) {
    const double harmonic = e1 * e2 / (open * e2 + (1 - open) * e1);
    return {{harmonic, mean, mean}, {mean, harmonic, mean}};
  }
  // Bruggeman by bisection: f (e1 - e)/(e1 + e) + (1 - f)(e2 - e)/(e2 + e) falls with e.
  double low = std::min(e1, e2), high = std::max(e1, e2);
  for (int k = 0; k < 100; ++k) {
    const double e = 0.5 * (low + high);
    (open * (e1 - e) / (e1 + e) + (1 - open) * (e2 - e) / (e2 + e) > 0 ? low : high) = e;
  }
  return {{low, low, mean}};
}

double wave(const Layer& l, bool s, double sine) {
  return s ? std::sqrt(l.across - sine * sine)
           : std::sqrt(l.along - l.along / l.normal * sine * sine);
}
double admittance(const Layer& l, bool s, double sine) {
  return s ? wave(l, s, sine) : l.along / wave(l, s, sine);
}
Layer isotropic(double index) { return {index * index, index * index, index * index}; }

// Power that comes back from a layer between fill and glass, by its characteristic matrix.
double reflected(const Layer& l, bool s, double sine, double depth, double wavelength, double fill,
                 double glass) {
  const double y0 = admittance(isotropic(fill), s, sine), y = admittance(l, s, sine),
               y2 = admittance(isotropic(glass), s, sine);
  const double turn = 2 * kPi * wave(l, s, sine) * depth / wavelength;
  const Complex i(0, 1);
  const Complex b = std::cos(turn) + i * std::sin(turn) * y2 / y,
                c = i * y * std::sin(turn) + y2 * std::cos(turn);
  return std::norm((y0 * b - c) / (y0 * b + c));
}

double bare(double from, double to, bool s, double sine) {
  const double a = admittance(isotropic(from), s, sine), b = admittance(isotropic(to), s, sine);
  return square((a - b) / (a + b));
}

TEST(LayerOptics, TransmitAndReflectAsTheirMatrices) {
  for (const Features features : {Features::Holes, Features::Pillars, Features::Lines}) {
    for (const auto& [open, depth, fill, glass] :
         {std::tuple{0.4, 90e-9, 1.0, 1.5}, {0.7, 210e-9, 1.2, 1.46}}) {
      const Light light{{450e-9, 620e-9}, {0.0, 0.5, 1.1}};
      const Optics o = effective_medium(open, depth, features, {glass, fill}, {}, light);
      EXPECT_EQ(o.regime, OpticsRegime::EffectiveMedium);
      ASSERT_EQ(o.spectrum.size(), 6u);
      const std::vector<Layer> layers = planes(open, features == Features::Lines, fill, glass);
      const auto mean = [&](auto&& of) {
        double sum = 0;
        for (const Layer& l : layers) sum += (of(l, true) + of(l, false)) / 2;
        return sum / static_cast<double>(layers.size());
      };
      for (std::size_t k = 0; k < 6; ++k) {
        const SpectrumPoint& p = o.spectrum[k];
        EXPECT_EQ(p.angle, light.angles[k / 2]);
        EXPECT_EQ(p.wavelength, light.wavelengths[k % 2]);
        EXPECT_EQ(p.haze, 0);
        EXPECT_EQ(p.specular, 1);
        const double sine = std::sin(p.angle);
        const double through = mean([&](const Layer& l, bool s) {
          const double r1 = reflected(l, s, sine, depth, p.wavelength, fill, glass),
                       r2 = bare(1, glass, s, sine), r3 = bare(1, fill, s, sine);
          const double plate = (1 - r1) * (1 - r2) / (1 - r1 * r2);
          return plate * (1 - r3) / (1 - r3 * (1 - plate));
        });
        EXPECT_NEAR(p.transmitted, through, 1e-9) << k;
        // At 60 degrees whatever the light, over the bare glass under the fill.
        const double meter = std::sqrt(3.0) / 2;
        const double back = mean([&](const Layer& l, bool s) {
          return reflected(l, s, meter, depth, p.wavelength, fill, glass);
        });
        const double of_glass =
            (bare(fill, glass, true, meter) + bare(fill, glass, false, meter)) / 2;
        EXPECT_NEAR(p.mirror, back / of_glass, 1e-9) << k;
      }
    }
  }
  // A fill of the glass's index leaves nothing to compare with.
  const Optics matched = effective_medium(0.5, 1e-7, Features::Holes, {1.5, 1.5});
  EXPECT_EQ(matched.spectrum.front().mirror, 1);
  // The fill's own face is left, of the same index.
  const double sine = std::sqrt(3.0) / 2;
  EXPECT_NEAR(matched.gloss, 100 * face_reflection(1.5, sine) / face_reflection(1.567, sine), 1e-9);
}

// Eq. optics.7 with 4000 steps for the integral and 1e-6 for the slope.
double disorder(double open, double depth, Features features, double glass, const Disorder& d,
                double wavelength, double sine) {
  const bool lines = features == Features::Lines;
  const double k = 2 * kPi / wavelength, w = d.width;
  double slope = 0;
  int count = 0;
  const auto up = planes(open + 1e-6, lines, 1, glass), down = planes(open - 1e-6, lines, 1, glass);
  for (std::size_t l = 0; l < up.size(); ++l) {
    for (const bool s : {true, false}) {
      slope += square((wave(up[l], s, sine) - wave(down[l], s, sine)) / 2e-6);
      ++count;
    }
  }
  slope /= count;
  const double from = k * std::sin(2.5 * kPi / 180);
  double sum = 0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    // q from the cone to k; the square root at its end is mild.
    const double q = from + (i + 0.5) * (k - from) / kSteps, dq = (k - from) / kSteps;
    const auto f = [&](double width) {
      return lines ? 2 * std::sin(0.5 * q * width) / q
                   : kPi * width / q * std::cyl_bessel_j(1, 0.5 * q * width);
    };
    const double by_width = (f(w * 1.00001) - f(w * 0.99999)) / 2e-5;
    const double density =
        square(f(w)) * (1 - std::exp(-square(q * d.displacement))) + square(d.scatter * by_width);
    sum += density * dq * (lines ? 1 / kPi : q / (2 * kPi));
  }
  const double share = features == Features::Pillars ? 1 - open : open;
  const double features_an_area = lines ? share / w : share / (kPi * w * w / 4);
  // A wide feature has the phase of its own medium: 4 sin^2 of half of it.
  const double own = wave(isotropic(glass), true, sine) - wave(isotropic(1), true, sine);
  const double contrast = (1 - d.resolved) * square(k * depth) * slope +
                          d.resolved * 4 * square(std::sin(0.5 * k * depth * own));
  return 1 - std::exp(-contrast * features_an_area * sum);
}

TEST(LayerOptics, HazeOfDisorderIsItsIntegral) {
  for (const Features features : {Features::Holes, Features::Pillars, Features::Lines}) {
    for (const Disorder& d : {Disorder{110e-9, 12e-9, 0},
                              {110e-9, 0, 0.08},
                              {90e-9, 8e-9, 0.05},
                              {90e-9, 8e-9, 0.05, 1},
                              {90e-9, 8e-9, 0.05, 0.5}}) {
      for (const double angle : {0.0, 0.7}) {
        const double expected = disorder(0.35, 250e-9, features, 1.5, d, 500e-9, std::sin(angle));
        const Optics o = effective_medium(0.35, 250e-9, features, {1.5, 1}, d, {{500e-9}, {angle}});
        EXPECT_GT(expected, 1e-4);
        EXPECT_NEAR(o.haze, expected, 2e-3 * expected) << static_cast<int>(features) << angle;
        EXPECT_NEAR(o.spectrum[0].haze, o.haze, 1e-15);
        EXPECT_NEAR(o.spectrum[0].specular, 1 - o.haze, 1e-12);
        const double clear =
            effective_medium(0.35, 250e-9, features, {1.5, 1}, {}, {{500e-9}, {angle}})
                .transmittance;
        EXPECT_NEAR(o.transmittance, (1 - o.haze) * clear, 1e-12);
      }
    }
  }
}

// (n + ik)^2 of the film that is cut: light along the normal by the matrices, Bruggeman by Newton.
TEST(LayerOptics, OfAnAbsorbingFilmTakesItsShare) {
  OpticalMedia media;
  media.index = 1.8, media.extinction = 0.2, media.thickness = 200e-9, media.plate_index = 1.46;
  constexpr double kOpen = 0.4, kDepth = 150e-9, kWavelength = 500e-9;
  const Complex e1 = 1, e2 = Complex(1.8, 0.2) * Complex(1.8, 0.2);
  const Complex mean = kOpen * e1 + (1 - kOpen) * e2,
                harmonic = 1.0 / (kOpen / e1 + (1 - kOpen) / e2);
  Complex round = mean;
  for (int k = 0; k < 50; ++k) {
    const Complex off = kOpen * (e1 - round) / (e1 + round) +
                        (1 - kOpen) * (e2 - round) / (e2 + round),
                  slope = -2.0 * (kOpen * e1 / ((e1 + round) * (e1 + round)) +
                                  (1 - kOpen) * e2 / ((e2 + round) * (e2 + round)));
    round -= off / slope;
  }
  for (const auto& [features, layers] :
       {std::pair{Features::Holes, std::vector{round}}, {Features::Lines, {harmonic, mean}}}) {
    const Light light{{kWavelength}};
    const SpectrumPoint p = effective_medium(kOpen, kDepth, features, media, {}, light).spectrum[0];
    double through = 0;
    for (const Complex& e : layers) {
      const Sheet layer{{e, e, e}, kDepth}, rest{plain({1.8, 0.2}), 50e-9};
      const auto of = [&](double from, const std::vector<Sheet>& sheets, double to) {
        return stack_amplitudes(plain(from), sheets, plain(to), Polarisation::S, 0, kWavelength);
      };
      const double back = bare(1, 1.46, true, 0);
      through += std::norm(of(1, {layer, rest}, 1.46).transmitted) * (1 - back) /
                 (1 - std::norm(of(1.46, {rest, layer}, 1).reflected) * back) /
                 static_cast<double>(layers.size());
    }
    EXPECT_NEAR(p.transmitted, through, 1e-9) << static_cast<int>(features);
    media.extinction = 0;
    EXPECT_LT(through,
              0.8 * effective_medium(kOpen, kDepth, features, media, {}, light).transmittance);
    media.extinction = 0.2;
  }
}

// Nothing to displace: no features, or nothing but them.
TEST(LayerOptics, NothingIsDisorderedWhereThereIsOneMedium) {
  for (const Features features : {Features::Holes, Features::Pillars, Features::Lines}) {
    for (const double open : {0.0, 1.0}) {
      EXPECT_EQ(
          effective_medium(open, 1e-7, features, {1.5, 1}, {100e-9, 10e-9, 0.1}, {{5e-7}}).haze, 0);
    }
    // Next to the ends the slope is taken on the side that there is.
    for (const double open : {2e-5, 1 - 2e-5}) {
      const double haze =
          effective_medium(open, 1e-7, features, {1.5, 1}, {100e-9, 10e-9, 0.1}, {{5e-7}}).haze;
      EXPECT_GT(haze, 0);
      EXPECT_LT(haze, 1e-3);
    }
  }
}

TEST(LayerOptics, EveryTheoryHasItsWords) {
  EXPECT_STREQ(text(OpticsRegime::Flat), "flat");
  EXPECT_STREQ(text(OpticsRegime::PhaseScreen), "phase screen");
  EXPECT_STREQ(text(OpticsRegime::EffectiveMedium), "effective medium");
  EXPECT_STREQ(text(OpticsRegime::Refused), "refused");
  Optics none;
  EXPECT_FALSE(none.refused());
  none.regime = OpticsRegime::Refused;
  EXPECT_TRUE(none.refused());
}

}  // namespace
}  // namespace papilla::tests::layer_optics_test
