// ISO 25178 against closed forms: waves, ramps, Gaussian heights, surfaces of a known likeness.
#include "geometry/areal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/roughness.h"

namespace papilla::tests::areal_test {
namespace {

Heightmap map_of(const Grid& grid, const std::function<double(double x, double y)>& height) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = height(grid.x(ix), grid.y(iy));
  }
  return h;
}

constexpr Grid kGrid{400, 300, 40e-6, 30e-6};

// z = A cos(kx): Sq = A/sqrt 2, Sa = 2A/pi, Sku = 3/2, Sdq = A k / sqrt 2.
TEST(Areal, AWaveHasItsClosedForms) {
  const double a = 50e-9, wavelength = 5e-6, k = 2 * kPi / wavelength;
  const ArealParameters p =
      areal_parameters(map_of(kGrid, [&](double x, double) { return 3e-6 + a * std::cos(k * x); }));
  EXPECT_NEAR(p.sq, a / std::sqrt(2.0), 1e-4 * a);
  EXPECT_NEAR(p.sa, 2 * a / kPi, 1e-3 * a);
  EXPECT_NEAR(p.sz, 2 * a * std::cos(0.5 * k * kGrid.dx()), 1e-4 * a);  // pixel centres
  EXPECT_NEAR(p.ssk, 0, 1e-6);
  EXPECT_NEAR(p.sku, 1.5, 1e-3);
  // A difference over a pixel dx sees sin(k dx / 2) / (k dx / 2) of the slope.
  const double half = 0.5 * k * kGrid.dx();
  EXPECT_NEAR(p.sdq, a * k / std::sqrt(2.0) * std::sin(half) / half, 1e-3 * a * k);
  EXPECT_NEAR(p.sdr, 0.5 * p.sdq * p.sdq, 2e-3 * p.sdq * p.sdq);  // small slopes
  EXPECT_FALSE(p.sampling_limited);
  // Its autocorrelation cos(kx) is 0.2 at arccos(0.2) / k, and never falls along y.
  ASSERT_TRUE(p.sal);
  EXPECT_NEAR(*p.sal, std::acos(0.2) / k, 0.02 * wavelength);
  EXPECT_FALSE(p.str);
  EXPECT_NEAR(std::min(p.std, kPi - p.std), 0, 1e-2);
}

TEST(Areal, TheDirectionIsThatOfTheWave) {
  for (const double degrees : {30.0, 75.0, 120.0, 165.0}) {
    const double angle = degrees * kPi / 180, k = 2 * kPi / 3e-6;
    const ArealParameters p = areal_parameters(map_of(kGrid, [&](double x, double y) {
      return 20e-9 * std::cos(k * (x * std::cos(angle) + y * std::sin(angle)));
    }));
    EXPECT_NEAR(p.std * 180 / kPi, degrees, 0.5);
  }
}

// Along a side or between the sides, a wave of a fifth more amplitude decides.
TEST(Areal, TheStrongerOfTwoWavesHasTheDirection) {
  const double k = 2 * kPi / 3e-6;
  for (const double first : {0.0, 0.5, 1.0}) {
    for (const double second : {0.0, 0.5, 1.0}) {  // of a right angle
      if (first == second) continue;
      const auto wave = [&](double share, double x, double y) {
        return std::cos(k * (x * std::cos(0.5 * kPi * share) + y * std::sin(0.5 * kPi * share)));
      };
      const double found = areal_parameters(map_of(kGrid, [&](double x, double y) {
                             return 1e-8 * (1.2 * wave(first, x, y) + wave(second, x, y));
                           })).std;
      const double off = found - 0.5 * kPi * first;
      EXPECT_NEAR(off - kPi * std::round(off / kPi), 0, 0.02) << first << " " << second;
    }
  }
}

// Between the middles of twenty pixels the curve is a line, at its ends level: 0.4 of them from an
// end fall by 7.5 steps.
TEST(Areal, TheMaterialOfAFewPixelsEndsWithThem) {
  const ArealParameters p =
      areal_parameters(map_of({20, 1, 20e-6, 1e-6}, [](double x, double) { return 0.01 * x; }));
  EXPECT_NEAR(p.sk, 7.5 / 0.4 * 0.01e-6, 1e-12);
}

// Height above a share m of the material: a straight line has no peaks and no valleys.
TEST(Areal, ARampIsCoreAlone) {
  const ArealParameters p =
      areal_parameters(map_of(kGrid, [](double x, double) { return 0.01 * x; }));
  EXPECT_NEAR(p.sk, 0.01 * 40e-6, 0.01 * 0.2e-6);
  EXPECT_LT(p.spk, 0.005 * p.sk);
  EXPECT_LT(p.svk, 0.005 * p.sk);
  EXPECT_LT(p.smr1, 0.005);
  EXPECT_GT(p.smr2, 0.995);
}

// The quantile of a Gaussian by bisection of its distribution.
double quantile(double share) {
  double low = -8, high = 8;
  for (int i = 0; i < 80; ++i) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(-x / std::sqrt(2.0)) < share ? low : high) = x;
  }
  return 0.5 * (low + high);
}

// Gaussian heights: the flattest 40 % lie in the middle, Sk = (z(0.3) - z(0.7)) / 0.4 = 2.622 Sq;
// Spk = Svk = 2 (phi(c) - c (1 - Phi(c))) / (1 - Phi(c)) at c = Sk / 2.
TEST(Areal, GaussianHeightsHaveTheirMaterialShares) {
  const double sigma = 10e-9;
  Heightmap h{kGrid, std::vector<double>(kGrid.size())};
  const auto n = static_cast<double>(h.z.size());
  for (std::size_t i = 0; i < h.z.size(); ++i)  // in an order that is none
    h.z[i * 7919 % h.z.size()] = sigma * quantile((static_cast<double>(i) + 0.5) / n);
  const ArealParameters p = areal_parameters(h);
  const double c = 0.5 * (quantile(0.7) - quantile(0.3)) / 0.4;
  const double tail = 0.5 * std::erfc(c / std::sqrt(2.0));
  const double phi = std::exp(-0.5 * c * c) / std::sqrt(2 * kPi);
  EXPECT_NEAR(p.sk, 2 * c * sigma, 2e-3 * sigma);
  EXPECT_NEAR(p.smr1, tail, 1e-3);
  EXPECT_NEAR(p.smr2, 1 - tail, 1e-3);
  EXPECT_NEAR(p.spk, 2 * (phi - c * tail) / tail * sigma, 5e-3 * sigma);
  EXPECT_NEAR(p.svk, p.spk, 5e-3 * sigma);
  EXPECT_NEAR(p.sku, 3, 0.01);
}

// A sum of equal cosines of many directions has the Bessel function as its autocorrelation:
// J0(k r) = 0.2 at k r = 1.98. Stretched along y, its likeness is as stretched.
TEST(Areal, TheLikenessOfRingsIsTheirBesselFunction) {
  const Grid grid{512, 512, 51.2e-6, 51.2e-6};
  const double k = 2 * kPi / 2e-6;
  double root = 1.5;
  while (std::cyl_bessel_j(0.0, root) > 0.2) root += 1e-4;
  for (const double stretch : {1.0, 3.0}) {
    const Heightmap h = map_of(grid, [&](double x, double y) {
      double z = 0;
      for (int i = 0; i < 64; ++i) {
        const double angle = kPi * (i + 0.5) / 64;
        z += std::cos(k * (x * std::cos(angle) + y / stretch * std::sin(angle)) + 2.4 * i * i);
      }
      return 1e-9 * z;
    });
    const ArealParameters p = areal_parameters(h);
    ASSERT_TRUE(p.sal && p.str);
    EXPECT_NEAR(*p.sal, root / k, 0.03 * root / k) << stretch;
    EXPECT_NEAR(*p.str, 1 / stretch, 0.06 / stretch) << stretch;
  }
}

// The spectrum that a random surface is made from (Eq. geometry.3): its plateau from the sum over
// the modes of the reference patch, its slope below the roll-off.
TEST(Spectrum, OfARandomSurfaceIsTheOneItWasMadeFrom) {
  const Spectrum made{.rms = 20e-9, .roll_off = 4e-6, .hurst = 0.8, .cutoff = 0.4e-6};
  const auto shape = [&](double q) {
    return std::min(1.0, std::pow(q * made.roll_off / (2 * kPi), -3.6));
  };
  const double dq = 2 * kPi / made.reference_length;
  double sum = 0;
  for (int ky = -30; ky <= 30; ++ky) {
    for (int kx = -30; kx <= 30; ++kx) {
      const double k = std::hypot(kx, ky);
      if (k > 0 && k <= 30) sum += shape(k * dq) * dq * dq;
    }
  }
  const double plateau = made.rms * made.rms / sum;
  const Heightmap h = random_surface(made, {1024, 1024, 96e-6, 96e-6}, 3, 0);
  double logarithms = 0, count = 0;
  for (const SpectrumRing& ring : radial_spectrum(h)) {
    if (ring.wavelength > 8e-6 || ring.wavelength < 0.5e-6) continue;
    const double share = ring.density / (plateau * shape(2 * kPi / ring.wavelength));
    EXPECT_NEAR(share, 1, 0.3) << ring.wavelength;  // few modes a ring
    logarithms += std::log(share), count += 1;
  }
  EXPECT_GE(count, 11);
  EXPECT_NEAR(logarithms / count, 0, 0.06);
}

// A wave A cos(kx) bends by A k^2 / sqrt 2 along x; over all directions of an isotropic surface of
// the same power 3/8 of k^4 counts: a tip of half the radius sees it, one of twice does not.
TEST(Spectrum, ATipEndsTheBandWhereTheSurfaceBendsHalfAsMuch) {
  const Spectrum made{.rms = 30e-9, .roll_off = 2e-6, .hurst = 0.6, .cutoff = 0.1e-6};
  const Grid grid{512, 512, 24e-6, 24e-6};
  const Heightmap h = random_surface(made, grid, 5, 0);
  const std::vector<SpectrumRing> rings = radial_spectrum(h);
  EXPECT_DOUBLE_EQ(known_band(h, rings, 0).shortest, 2 * grid.dx());
  EXPECT_DOUBLE_EQ(known_band(h, rings, 0).longest, 6e-6);
  // The rms curvature of the map itself down to a wavelength: second differences of the filtered
  // spectrum, here by its closed form.
  const auto bends = [&](double shortest) {
    const double roll = 2 * kPi / made.roll_off, least = 2 * kPi / made.reference_length,
                 most = 2 * kPi / shortest;
    double variance = 0, curvature = 0;
    for (double q = least; q < 2 * kPi / made.cutoff; q *= 1.001) {
      const double c = q < roll ? 1 : std::pow(q / roll, -3.2);
      variance += 2 * kPi * q * 0.001 * q * c;
      if (q < most) curvature += 0.375 * 2 * kPi * q * 0.001 * q * std::pow(q, 4) * c;
    }
    return made.rms * std::sqrt(curvature / variance);
  };
  for (const double wavelength : {0.5e-6, 0.25e-6}) {
    const KnownBand band = known_band(h, rings, 0.5 / bends(wavelength));
    EXPECT_TRUE(band.by_tip);
    EXPECT_NEAR(band.shortest / wavelength, 1, 0.3);  // rings are a quarter wide
  }
  EXPECT_FALSE(known_band(h, rings, 0.1 / bends(0.1e-6)).by_tip);
}

TEST(Histogram, SharesOfEqualBinsSumToOne) {
  const std::vector<double> shares =
      height_histogram(map_of(kGrid, [](double x, double) { return x; }), 40);
  for (const double share : shares) EXPECT_NEAR(share, 1.0 / 40, 1e-9);
}

// Of x and y alone differ: which side is which, and which pixels are longer.
TEST(Areal, SidesThatAreSwappedSwapTheDirectionAlone) {
  const Grid grid{240, 130, 30e-6, 13e-6}, turned{130, 240, 13e-6, 30e-6};
  const double k = 2 * kPi / 3e-6;
  // One wave, a step, and 24 waves of many directions, so that it is unlike itself far away.
  const auto z = [&](double x, double y) {
    double sum = 15e-9 * std::cos(k * (0.8 * x + 0.6 * y)) + (x > 25e-6 && y < 4e-6 ? 60e-9 : 0);
    for (int i = 0; i < 24; ++i) {
      const double angle = kPi * (i + 0.3) / 24;
      sum += 8e-9 * std::cos((1 + 0.02 * i) * k * (x * std::cos(angle) + 2 * y * std::sin(angle)) +
                             2.4 * i * i);
    }
    return sum;
  };
  const Heightmap map = map_of(grid, z),
                  other = map_of(turned, [&](double x, double y) { return z(y, x); });
  const ArealParameters a = areal_parameters(map), b = areal_parameters(other);
  for (const auto member :
       {&ArealParameters::sa, &ArealParameters::sq, &ArealParameters::sz, &ArealParameters::sp,
        &ArealParameters::sv, &ArealParameters::ssk, &ArealParameters::sku, &ArealParameters::sdq,
        &ArealParameters::sdr, &ArealParameters::sk, &ArealParameters::spk, &ArealParameters::svk,
        &ArealParameters::smr1, &ArealParameters::smr2})
    EXPECT_NEAR(a.*member, b.*member, 1e-9 * std::abs(a.*member) + 1e-18);
  ASSERT_TRUE(a.sal && b.sal && a.str && b.str);
  EXPECT_NEAR(*a.sal, *b.sal, 1e-9 * *a.sal);
  EXPECT_NEAR(*a.str, *b.str, 1e-9);
  const auto wave = [&](double x, double y) { return 40e-9 * std::cos(k * (0.8 * x + 0.6 * y)); };
  const auto direction = [](const Heightmap& h) { return areal_parameters(h).std; };
  EXPECT_NEAR(direction(map_of(grid, wave)) +
                  direction(map_of(turned, [&](double x, double y) { return wave(y, x); })),
              0.5 * kPi, 1e-6);
  // Upside down, peaks are valleys.
  Heightmap down = map;
  for (double& v : down.z) v = 1e-6 - v;
  const ArealParameters d = areal_parameters(down);
  EXPECT_NEAR(d.sp, a.sv, 1e-15);
  EXPECT_NEAR(d.ssk, -a.ssk, 1e-9);
  EXPECT_NEAR(d.spk, a.svk, 0.01 * a.sk);
  EXPECT_NEAR(d.svk, a.spk, 0.01 * a.sk);
  EXPECT_NEAR(d.sk, a.sk, 1e-3 * a.sk);
  EXPECT_NEAR(*d.sal, *a.sal, 1e-9 * *a.sal);
  const std::vector<SpectrumRing> one = radial_spectrum(map), two = radial_spectrum(other);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(one[i].wavelength / two[i].wavelength, 1, 1e-12);
    EXPECT_NEAR(one[i].density / two[i].density, 1, 1e-9);
  }
}

// Slopes along x and y that differ: their squares add, and no difference crosses the border.
TEST(Areal, APlaneHasOneSlopeAndItsArea) {
  for (const Grid& grid : {kGrid, Grid{50, 90, 10e-6, 45e-6}}) {
    const ArealParameters p =
        areal_parameters(map_of(grid, [](double x, double y) { return 0.3 * x - 0.4 * y; }));
    EXPECT_NEAR(p.sdq, 0.5, 1e-9);
    EXPECT_NEAR(p.sdr, std::sqrt(1.25) - 1, 1e-9);
  }
}

// A profile has the slope along it.
TEST(Areal, OfASingleRowOrColumnTheSlopeIsAlongIt) {
  const auto plane = [](double x, double y) { return 0.3 * x - 0.4 * y; };
  for (const auto& [grid, slope] :
       {std::pair{Grid{90, 1, 9e-6, 0.1e-6}, 0.3}, {Grid{1, 90, 0.1e-6, 9e-6}, 0.4}}) {
    const ArealParameters p = areal_parameters(map_of(grid, plane));
    EXPECT_NEAR(p.sdq, slope, 1e-9);
    EXPECT_NEAR(p.sdr, std::sqrt(1 + slope * slope) - 1, 1e-9);
    EXPECT_FALSE(p.sampling_limited);
  }
  EXPECT_EQ(areal_parameters(map_of({1, 1, 1e-6, 1e-6}, plane)).sdq, 0);
}

// A step of a quarter of all heights in a pixel is more than its slope can be told from.
TEST(Areal, AStepOfAQuarterIsLimitedByItsPixels) {
  for (const auto& [step, limited] : {std::pair{0.24, false}, {0.26, true}}) {
    for (const bool along_x : {true, false}) {
      const ArealParameters p = areal_parameters(map_of(kGrid, [&](double x, double y) {
        const double share = along_x ? x / 40e-6 : y / 30e-6;
        return 1e-7 * (share * (1 - step) + (share > 0.5 ? step : 0));
      }));
      EXPECT_EQ(p.sampling_limited, limited) << step << along_x;
    }
  }
}

// Exponential heights -s ln m: the flattest 40 % are the last, their line meets the axis at
// s ln(1/0.6) / 0.4 = 1.277 s = Sk; what lies above it, a share exp(-1.277), is as high as all is:
// Spk = 2 s, and there are no valleys.
TEST(Areal, ExponentialHeightsHavePeaksAlone) {
  const double s = 10e-9;
  Heightmap h{kGrid, std::vector<double>(kGrid.size())};
  const auto n = static_cast<double>(h.z.size());
  for (std::size_t i = 0; i < h.z.size(); ++i)
    h.z[i * 7919 % h.z.size()] = -s * std::log((static_cast<double>(i) + 0.5) / n);
  const ArealParameters p = areal_parameters(h);
  const double core = std::log(1 / 0.6) / 0.4;
  EXPECT_NEAR(p.sk, core * s, 2e-3 * s);
  EXPECT_NEAR(p.smr1, std::exp(-core), 1e-3);
  EXPECT_NEAR(p.smr2, 1, 1e-3);
  EXPECT_NEAR(p.spk, 2 * s, 5e-3 * s);
  EXPECT_NEAR(p.svk, 0, 1e-3 * s);
  EXPECT_NEAR(p.ssk, 2, 0.01);
  EXPECT_NEAR(p.sku, 9, 0.1);
}

// Heights that know nothing of each other: equal power at every wavelength, variance times the
// area of a pixel over (2 pi)^2; down to two pixels of the longer side, up to the longer side.
TEST(Spectrum, OfNoiseIsTheSameInEveryRing) {
  const Grid grid{360, 300, 18e-6, 30e-6};
  Heightmap h{grid, std::vector<double>(grid.size())};
  RandomStream random(3, "noise of a test", 0);
  for (double& z : h.z) z = 5e-9 * random.normal();
  const double flat = square(5e-9) * grid.pixel_area() / square(2 * kPi);
  const std::vector<SpectrumRing> rings = radial_spectrum(h);
  ASSERT_GT(rings.size(), 18u);  // of log10(30 um / 0.2 um) 10 = 21.8
  EXPECT_LE(rings.size(), 23u);
  EXPECT_LE(rings.front().wavelength, 30e-6 * (1 + 1e-9));
  EXPECT_GE(rings.front().wavelength, 20e-6);
  EXPECT_GE(rings.back().wavelength, 0.2e-6 * (1 - 1e-9));
  EXPECT_LE(rings.back().wavelength, 0.26e-6);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    EXPECT_TRUE(i == 0 || rings[i].wavelength < rings[i - 1].wavelength);
    const double least = rings[i].wavelength;  // short waves are many, their mean is sharper
    const double scatter = least < 0.35e-6 ? 0.05 : least < 0.6e-6 ? 0.1 : least < 3e-6 ? 0.25 : 3;
    EXPECT_NEAR(rings[i].density / flat, 1, scatter) << least;
  }
  EXPECT_DOUBLE_EQ(known_band(h, rings, 0).longest, 4.5e-6);  // a quarter of the shorter side
  EXPECT_DOUBLE_EQ(known_band(h, rings, 0).shortest, 0.2e-6);
}

TEST(Histogram, HoldsTheLowestAndTheHighest) {
  const Heightmap two = map_of(kGrid, [](double x, double) { return x < 10e-6 ? -3e-6 : 1e-6; });
  std::vector<double> shares = height_histogram(two, 8);
  EXPECT_NEAR(shares.front(), 0.25, 1e-9);
  EXPECT_NEAR(shares.back(), 0.75, 1e-9);
  for (std::size_t i = 1; i < 7; ++i) EXPECT_EQ(shares[i], 0);
  EXPECT_NEAR(height_histogram(map_of(kGrid, [](double, double) { return 1.0; }), 5).front(), 1,
              1e-9);
}

}  // namespace
}  // namespace papilla::tests::areal_test
