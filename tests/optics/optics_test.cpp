#include "physics/optics/optics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <variant>

#include "base/constants.h"
#include "base/random.h"
#include "forward/appearance.h"
#include "geometry/roughness.h"
#include "numerics/fft.h"
#include "tests/support/glass.h"

namespace papilla::tests::optics_test {
namespace {

Texture holes(double period, double diameter, double depth) {
  HoleArray a;
  a.period = period, a.diameter = diameter, a.depth = depth, a.wall_angle = kPi / 2;
  return {a};
}

FeatureArray array_of(const Texture& texture) {
  return std::get<FeatureArray>(facts(texture).outline);
}

Optics green(double depth, double period = 6e-6) {
  return array_screen(array_of(holes(period, 0.75 * period, depth)), {1.5, 1}, {{550e-9}});
}

double binary_specular(double fill, double phase) {
  return 1 - 4 * fill * (1 - fill) * square(std::sin(0.5 * phase));
}

TEST(PhaseScreen, GivesTheClosedFormOfBinaryHoles) {
  const double fill = kPi * square(0.375);
  for (const double depth : {50e-9, 79e-9, 100e-9, 200e-9, 300e-9, 550e-9, 900e-9}) {
    const double phase = 2 * kPi * 0.5 * depth / 550e-9;
    const Optics o = green(depth);
    EXPECT_NEAR(o.spectrum[0].specular, binary_specular(fill, phase), 2e-4) << depth;
    EXPECT_NEAR(o.haze, 1 - binary_specular(fill, phase), 2e-4) << depth;
    // In reflection at 60 deg the phase is twice as large in air as (n - 1) makes it here.
    EXPECT_NEAR(o.spectrum[0].mirror, binary_specular(fill, 2 * kPi * depth / 550e-9), 1e-3);
  }
}

TEST(PhaseScreen, FivePerCentOfHazeIsReachedAt79Nanometres) {
  EXPECT_LT(green(79e-9).haze, 0.05);
  EXPECT_GT(green(80.5e-9).haze, 0.05);
  EXPECT_NEAR(green(550e-9).haze, 0.986, 0.001);
}

TEST(PhaseScreen, OrdersInsideTheConeAreNoHaze) {
  // Above 12.6 um the first orders of 550 nm are within 2.5 deg.
  const double outside = green(300e-9, 12.5e-6).haze, within = green(300e-9, 12.7e-6).haze;
  EXPECT_NEAR(outside - within, 4 * 0.089988, 2e-3);
}

// Every order of round holes by its closed form, its direction in space against the undeviated one.
TEST(PhaseScreen, ObliqueLightGivesTheSumOverTheOrdersOfItsCone) {
  constexpr double kWavelength = 550e-9, kDepth = 250e-9;
  for (const double period : {12.7e-6, 20e-6}) {
    for (const double degrees : {0.0, 30.0, 60.0}) {
      const double sine = std::sin(degrees * kPi / 180), radius = 0.375 * period;
      const double path = std::sqrt(2.25 - sine * sine) - std::sqrt(1 - sine * sine);
      const double step2 = 4 * square(std::sin(kPi * path * kDepth / kWavelength));
      const double fill = kPi * square(radius / period);
      double cone = 1 - fill * (1 - fill) * step2;
      const double specular = cone;
      for (int m = -3; m <= 3; ++m) {
        for (int n = -3; n <= 3; ++n) {
          if (m == 0 && n == 0) continue;
          const double q = 2 * kPi * std::hypot(m, n) / period * radius;
          const double power = square(fill * 2 * std::cyl_bessel_j(1, q) / q) * step2;
          for (const bool along : {true, false}) {  // planes of incidence x and y
            const double x = (along ? sine : 0) + m * kWavelength / period;
            const double y = (along ? 0 : sine) + n * kWavelength / period;
            const double z = std::sqrt(1 - x * x - y * y);
            const double cosine = (along ? x : y) * sine + z * std::sqrt(1 - sine * sine);
            if (cosine > std::cos(kHazeAngle)) cone += 0.5 * power;
          }
        }
      }
      const Texture texture = holes(period, 2 * radius, kDepth);
      const Optics o =
          array_screen(array_of(texture), {1.5, 1}, {{kWavelength}, {degrees * kPi / 180}});
      EXPECT_NEAR(o.spectrum[0].specular, specular, 3e-4) << period << " " << degrees;
      EXPECT_NEAR(o.haze, 1 - cone, 1e-3) << period << " " << degrees;
    }
  }
}

TEST(PhaseScreen, AFlatPlateLosesHalfThePolarisationAtBrewstersAngle) {
  // In the plane nothing is reflected; across it ((n^2 - 1)/(n^2 + 1))^2 at each face.
  const double r = square(1.25 / 3.25), expected = 0.5 * (1 + (1 - r) / (1 + r));
  const Light light{{550e-9}, {std::atan(1.5)}};
  const Heightmap flat{{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)};
  EXPECT_NEAR(phase_screen(flat, {1.5, 1}, light).transmittance, expected, 1e-12);
  for (const Features features : {Features::Holes, Features::Lines}) {
    for (const auto& [open, depth] : {std::pair{0.0, 100e-9}, {1.0, 100e-9}, {0.4, 0.0}}) {
      const Optics o = effective_medium(open, depth, features, {1.5, 1}, {}, light);
      EXPECT_NEAR(o.transmittance, expected, 1e-9);
      EXPECT_NEAR(o.spectrum[0].mirror, 1, 1e-9);
    }
  }
}

TEST(Appearance, IsTheMeanOverTheAnglesOfView) {
  const Texture texture = holes(6e-6, 4.5e-6, 100e-9);
  const auto haze = [&](std::vector<double> angles) {
    return appearance(texture, glass_of(1.5), view_from(std::move(angles))).haze;
  };
  EXPECT_NEAR(haze({0.0, 1.0}), 0.5 * (haze({0.0}) + haze({1.0})), 1e-12);
  EXPECT_GT(haze({1.0}), haze({0.0}));  // the path through the glass grows
  // Oblique light is diffracted by finer arrays.
  EXPECT_EQ(appearance(holes(0.25e-6, 0.1e-6, 0.1e-6), glass_of(1.5), {}).regime,
            OpticsRegime::EffectiveMedium);
  EXPECT_EQ(appearance(holes(0.25e-6, 0.1e-6, 0.1e-6), glass_of(1.5), view_from({1.0})).regime,
            OpticsRegime::Refused);
}

TEST(PhaseScreen, MatchedFillRemovesHaze) {
  const Texture texture = holes(6e-6, 4.5e-6, 500e-9);
  const Optics o = appearance(texture, glass_of(1.5), filled_with(1.5));
  EXPECT_NEAR(o.haze, 0, 1e-12);
  EXPECT_NEAR(o.transmittance, 0.96 / 1.04, 1e-9);  // a plate of it
}

TEST(PhaseScreen, GivesTheSeriesOfGaussianRoughness) {
  // Correlation exp(-r^2/L^2): a sum of waves that a spectrum of that shape draws.
  constexpr int kPixels = 256, kWaves = 400;
  // At this side 213 orders lie inside the cone, whose area is 212.7 orders: no bias of its rim.
  constexpr double kSide = 103.75e-6, kLength = 4e-6, kWavelength = 550e-9;
  const auto transform = numerics::Fft2d::shared(kPixels, kPixels);
  for (const double rms : {80e-9, 200e-9}) {
    double specular = 0, haze = 0;
    constexpr int kDraws = 24;
    for (int draw = 0; draw < kDraws; ++draw) {
      RandomStream random(7, "optics test", static_cast<std::uint64_t>(draw));
      numerics::SpectrumArray spectrum(transform->spectrum_size());
      numerics::RealArray heights(transform->real_size());
      for (int w = 0; w < kWaves; ++w) {
        // The spectrum is Gaussian with variance 2/L^2 each way; periodic: whole numbers of waves.
        const auto waves = [&] {
          return static_cast<int>(
              std::lround(random.normal() * std::sqrt(2.0) / kLength * kSide / (2 * kPi)));
        };
        const int m = waves(), n = waves();
        const std::complex<double> wave =
            std::polar(rms / std::sqrt(2.0 * kWaves), 2 * kPi * random.uniform());
        // A real wave is a pair of conjugates; the transform keeps those of m >= 0.
        const auto add = [&](int x, int y, std::complex<double> a) {
          if (x >= 0)
            spectrum[static_cast<std::size_t>((y + kPixels) % kPixels * transform->half() + x)] +=
                a;
        };
        add(m, n, wave);
        add(-m, -n, std::conj(wave));
      }
      transform->inverse(spectrum.data(), heights.data());
      const Heightmap h{{kPixels, kPixels, kSide, kSide}, {heights.begin(), heights.end()}};
      const Optics o = phase_screen(h, {1.5, 1}, {{kWavelength}});
      specular += o.spectrum[0].specular / kDraws;
      haze += o.haze / kDraws;
    }
    const double s = square(2 * kPi * 0.5 * rms / kWavelength);
    double series = 0, term = std::exp(-s);
    for (int k = 1; k < 60; ++k) {
      term *= s / k;
      series += term * std::exp(-square(kPi * kLength * std::sin(kHazeAngle) / kWavelength) / k);
    }
    EXPECT_NEAR(haze, series, 0.03 * series) << rms;
    EXPECT_NEAR(specular, std::exp(-s), 0.03) << rms;
  }
}

TEST(EffectiveMedium, QuarterWaveLayerOfTheGeometricMeanReflectsNothing) {
  // Grooves share their index between polarisations only near equal indices; use round holes.
  const OpticalMedia glass{1.5, 1};
  // Bruggeman for eps = 1.5: f (1 - e)/(1 + e) + (1 - f)(2.25 - e)/(2.25 + e) = 0.
  const double e = 1.5, a = (1 - e) / (1 + e), b = (2.25 - e) / (2.25 + e);
  const double open = b / (b - a);
  const double n = std::sqrt(e);
  const Optics o = effective_medium(open, 550e-9 / (4 * n), Features::Holes, glass, {}, {{550e-9}});
  EXPECT_NEAR(o.transmittance, 0.96, 1e-12);
  EXPECT_EQ(o.haze, 0);
  // Nothing open, all open, and no depth are the bare glass.
  for (const auto& [f, depth] : {std::pair{0.0, 100e-9}, {1.0, 100e-9}, {0.4, 0.0}}) {
    for (const Features features : {Features::Holes, Features::Lines})
      EXPECT_NEAR(effective_medium(f, depth, features, glass).transmittance, 0.96 / 1.04, 1e-9);
  }
}

// Holes of 100 nm every 200 nm, displaced and scattered at random: every propagating order of a
// patch summed hole by hole. Weak contrast, where the layer's phase is that of the filled share.
TEST(EffectiveMedium, HazeOfDisorderIsTheSumOverRandomHoles) {
  constexpr int kCells = 40, kDraws = 12;
  constexpr double kPeriod = 200e-9, kDiameter = 100e-9, kDepth = 200e-9, kWavelength = 550e-9;
  const OpticalMedia weak{1.02, 1};
  const double side = kCells * kPeriod, k = 2 * kPi / kWavelength;
  const double open = 0.25 * kPi * square(kDiameter / kPeriod);
  for (const auto& [displacement, scatter] : {std::pair{15e-9, 0.0}, {0.0, 0.1}}) {
    double mean = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      RandomStream random(3, "disorder test", static_cast<std::uint64_t>(draw));
      std::vector<std::array<double, 3>> holes;
      for (int i = 0; i < kCells * kCells; ++i) {
        const double x = i % kCells * kPeriod + displacement * random.normal();
        const double y = i / kCells * kPeriod + displacement * random.normal();
        holes.push_back({x, y, 0.5 * kDiameter * (1 + scatter * random.normal())});
      }
      const int most = static_cast<int>(side / kWavelength);
      double sum = 0;
      for (int m = 0; m <= most; ++m) {  // the other half is its mirror
        for (int n = m == 0 ? 1 : -most; n <= most; ++n) {
          const double qx = 2 * kPi * m / side, qy = 2 * kPi * n / side, q = std::hypot(qx, qy);
          if (q > k || q < k * std::sin(kHazeAngle)) continue;
          std::complex<double> f = 0;
          for (const auto& [x, y, r] : holes) {
            f += kPi * r * r * 2 * std::cyl_bessel_j(1, q * r) / (q * r) *
                 std::polar(1.0, qx * x + qy * y);
          }
          sum += 2 * std::norm(f / square(side));
        }
      }
      mean += sum * square(k * kDepth * 0.02) / kDraws;
    }
    const Optics o = effective_medium(open, kDepth, Features::Holes, weak,
                                      {kDiameter, displacement, scatter}, {{kWavelength}});
    EXPECT_NEAR(o.haze, mean, 0.04 * mean) << displacement << " " << scatter;
    EXPECT_GT(mean, 0);
  }
  // Twice the displacement, four times the haze; none without disorder.
  const auto haze = [&](double d) {
    return effective_medium(0.2, 100e-9, Features::Lines, {1.5, 1}, {50e-9, d, 0}).haze;
  };
  EXPECT_NEAR(haze(4e-9) / haze(2e-9), 4, 0.02);
  EXPECT_EQ(haze(0), 0);
}

TEST(Appearance, ChoosesTheTheoryByThePeriod) {
  const Surface glass = glass_of(1.5);
  EXPECT_EQ(appearance(holes(6e-6, 3e-6, 0), glass, {}).regime, OpticsRegime::Flat);
  EXPECT_NEAR(appearance(holes(6e-6, 3e-6, 0), glass, {}).transmittance, 0.96 / 1.04, 1e-12);
  EXPECT_EQ(appearance(holes(0.2e-6, 0.1e-6, 0.1e-6), glass, {}).regime,
            OpticsRegime::EffectiveMedium);
  const Texture between = holes(0.6e-6, 0.3e-6, 0.1e-6);
  EXPECT_EQ(appearance(between, glass, {}).regime, OpticsRegime::Rigorous);
  View scalar;
  scalar.lattices = LatticeTheory::Scalar;
  for (const View& view : {scalar, view_from({0, 0.5})}) {
    EXPECT_EQ(appearance(between, glass, view).regime, OpticsRegime::Refused);
    EXPECT_FALSE(appearance(between, glass, view).warning.empty());
  }
  const Optics wide = appearance(holes(6e-6, 3e-6, 100e-9), glass, {});
  EXPECT_EQ(wide.regime, OpticsRegime::PhaseScreen);
  EXPECT_TRUE(wide.warning.empty());
  EXPECT_FALSE(appearance(holes(3e-6, 1.5e-6, 100e-9), glass, {}).warning.empty());
}

TEST(Appearance, ColourOfADeepArrayIsSeen) {
  // At 900 nm depth the haze is 0, 0.29, 0.67 at 450, 550, 650 nm.
  const Texture texture = holes(6e-6, 4.5e-6, 900e-9);
  const Optics o = array_screen(array_of(texture), {1.5, 1}, {{450e-9, 550e-9, 650e-9}});
  EXPECT_NEAR(o.spectrum[0].haze, 0.000, 1e-3);
  EXPECT_NEAR(o.spectrum[1].haze, 0.288, 1e-3);
  EXPECT_NEAR(o.spectrum[2].haze, 0.668, 1e-3);
  const Optics photopic = appearance(texture, glass_of(1.5), {});
  EXPECT_NEAR(photopic.haze, 0.333, 3e-3);
  EXPECT_GT(photopic.colour_shift, 0.02);
  EXPECT_NEAR(appearance(holes(6e-6, 4.5e-6, 100e-9), glass_of(1.5), {}).haze, 0.0767, 5e-4);
}

// The orders of grooves with straight walls by hand: over a wall the phase is linear, and so is
// that of the order, so every piece of the section has a closed integral.
std::complex<double> order_of_grooves(const Grating& t, double k, int m) {
  const double run = t.depth / std::tan(t.wall_angle), q = 2 * kPi * m / t.period;
  const auto piece = [&](double from, double to, double z_from, double z_to) {
    if (to <= from) return std::complex<double>(0);
    const double half = 0.5 * (k * (z_to - z_from) - q * (to - from));
    const double middle = 0.5 * (k * (z_to + z_from) - q * (to + from));
    return std::polar((to - from) / t.period, middle) *
           (std::abs(half) > 1e-9 ? std::sin(half) / half : 1);
  };
  const double half = 0.5 * t.width, edge = 0.5 * t.period;
  return piece(-edge, -half, 0, 0) + piece(-half, run - half, 0, -t.depth) +
         piece(run - half, half - run, -t.depth, -t.depth) + piece(half - run, half, -t.depth, 0) +
         piece(half, edge, 0, 0);
}

// A step at mid-wall in place of the wall gave 9 to 28 % more haze.
TEST(Appearance, OfSlopedWallsIsThatOfTheirOwnProfile) {
  for (const double period : {5.41e-6, 16e-6}) {
    for (const double degrees : {20.0, 30.0, 45.0, 60.0, 80.0, 90.0}) {
      Grating t;
      t.period = period, t.width = 0.4 * period, t.depth = 349e-9;
      t.wall_angle = degrees * kPi / 180;
      const Optics seen = array_screen(array_of({t}), {1.46, 1}, {{550e-9}});
      double cone = 0;
      for (int m = -4; m <= 4; ++m) {
        const double sine = m * 550e-9 / period;
        if (std::abs(std::asin(sine)) > kHazeAngle) continue;
        cone += std::norm(order_of_grooves(t, 2 * kPi * 0.46 / 550e-9, m));
      }
      EXPECT_NEAR(seen.haze, 1 - cone, 2e-3 * (1 - cone)) << period << " " << degrees;
    }
  }
}

// What a design shows is what its map shows, for holes and pillars too, with rims.
TEST(Appearance, OfAnArrayIsThatOfItsOwnMap) {
  const Light green{{550e-9}};
  const auto expect_same = [&](const Texture& texture, double period) {
    const Optics map =
        phase_screen(generate(texture, patch_grid(texture, 512, period)), {1.46, 1}, green);
    const Optics seen = array_screen(array_of(texture), {1.46, 1}, green);
    EXPECT_NEAR(seen.haze, map.haze, 0.01 * map.haze) << period;
    EXPECT_NEAR(seen.transmittance, map.transmittance, 0.01 * map.transmittance) << period;
    EXPECT_NEAR(seen.gloss, map.gloss, 1) << period;  // GU
  };
  for (const double degrees : {30.0, 45.0, 70.0}) {
    for (const double rim : {0.0, 150e-9}) {
      HoleArray hole;
      hole.period = 6e-6, hole.diameter = 3e-6, hole.depth = 300e-9;
      hole.wall_angle = degrees * kPi / 180, hole.edge_radius = rim;
      expect_same({hole}, 6e-6);
      PillarArray pillar;
      pillar.lattice = Lattice::Hexagonal;
      pillar.period = 7e-6, pillar.diameter = 3e-6, pillar.height = 250e-9;
      pillar.wall_angle = hole.wall_angle, pillar.edge_radius = rim;
      expect_same({pillar}, 7e-6);
    }
  }
}

// Walls that reach those of their neighbours: slopes everywhere.
TEST(Appearance, WhereWallsMeetIsThatOfTheHeights) {
  PillarArray close;
  close.period = 6e-6, close.diameter = 4e-6, close.height = 600e-9, close.wall_angle = 0.3;
  EXPECT_FALSE(has_closed_form(array_of({close})));
  const Optics map = phase_screen(generate({close}, patch_grid({close}, 192, 6e-6)), {1.46, 1});
  EXPECT_NEAR(appearance({close}, glass_of(1.46), {}).haze, map.haze, 0.01 * map.haze);
}

}  // namespace
}  // namespace papilla::tests::optics_test
