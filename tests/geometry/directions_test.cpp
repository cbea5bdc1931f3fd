// Which waves decide the direction of a map, and its spectrum and likeness mode by mode and shift
// by shift, by sums that know no transform.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/areal.h"

namespace papilla::tests::directions_test {
namespace {

struct Wave {
  double amplitude, degrees, wavelength;
};

double direction_of(const Grid& grid, const std::vector<Wave>& waves) {
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      for (const auto& [amplitude, degrees, wavelength] : waves) {
        const double angle = degrees * kPi / 180, k = 2 * kPi / wavelength;
        h(ix, iy) += 1e-8 * amplitude *
                     std::cos(k * (grid.x(ix) * std::cos(angle) + grid.y(iy) * std::sin(angle)) +
                              0.01 * degrees);
      }
    }
  }
  return areal_parameters(h).std * 180 / kPi;
}

constexpr Grid kGrid{320, 240, 32e-6, 24e-6};

// Of a wave that is twenty degrees off nothing counts: what is within twelve does.
TEST(Directions, AreTheMiddleOfTwelveDegreesToEitherSide) {
  EXPECT_NEAR(direction_of(kGrid, {{1.2, 60, 0.8e-6}, {1, 80, 0.8e-6}}), 60, 0.3);
  EXPECT_NEAR(direction_of(kGrid, {{1, 60, 0.8e-6}, {1.2, 80, 0.8e-6}}), 80, 0.3);
  // Two at either side of 179 degrees: over the end of the half circle.
  const double both = direction_of(kGrid, {{1, 177, 0.8e-6}, {1, 1, 0.8e-6}});
  EXPECT_NEAR(both, 179, 0.5);
}

// Two of two degrees apart are within five and stronger together than one of 1.2 times either.
TEST(Directions, AreWhereFiveDegreesHaveTheMostPower) {
  EXPECT_NEAR(direction_of(kGrid, {{1, 29, 0.8e-6}, {1, 31, 0.8e-6}, {1.2, 100, 0.8e-6}}), 30, 0.5);
}

// Two periods of the shorter side are no direction, though stronger; nor are waves that the longer
// side of a pixel does not show, though the shorter does.
TEST(Directions, AreOfWavesOfThreePeriodsAtLeastAndTwoPixels) {
  EXPECT_NEAR(direction_of(kGrid, {{1.3, 90, 12e-6}, {1, 50, 0.8e-6}}), 50, 0.3);
  const Grid oblong{320, 120, 32e-6, 24e-6};  // 0.1 x 0.2 um
  EXPECT_NEAR(direction_of(oblong, {{2, 0, 0.3e-6}, {1, 50, 0.8e-6}}), 50, 0.3);
}

Heightmap random_map(const Grid& grid, std::uint64_t seed, int smooth) {
  RandomStream random(seed, "directions of a test", 0);
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (double& z : h.z) z = random.uniform(-1, 1);
  for (int round = 0; round < smooth; ++round) {
    const Heightmap old = h;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix)
        h(ix, iy) = 0.4 * old(ix, iy) + 0.4 * old(wrap(ix + 1, grid.nx), iy) +
                    0.2 * old(ix, wrap(iy + 1, grid.ny));
    }
  }
  return h;
}

// Eq. geometry.6 for 12 x 10 pixels of 0.5 x 0.8: every mode by its own sum, under a Hann window,
// in rings a tenth of a decade wide from the longer side on.
TEST(Spectra, AreThoseOfEveryModeByItsSum) {
  const Grid g{12, 10, 6, 8};
  const Heightmap h = random_map(g, 1, 1);
  const auto hann = [](int i, int n) { return 0.5 - 0.5 * std::cos(2 * kPi * (i + 0.5) / n); };
  double weight = 0, weighted = 0, squares = 0;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const double w = hann(ix, g.nx) * hann(iy, g.ny);
      weight += w, weighted += w * h(ix, iy), squares += w * w;
    }
  }
  const double longest = 8, shortest = 1.6;
  const auto count = static_cast<std::size_t>(1 + std::ceil(10 * std::log10(longest / shortest)));
  std::vector<double> density(count), logarithm(count), modes(count);
  for (int ky = -g.ny / 2 + 1; ky <= g.ny / 2; ++ky) {
    for (int kx = -g.nx / 2 + 1; kx <= g.nx / 2; ++kx) {
      if (kx == 0 && ky == 0) continue;
      std::complex<double> sum = 0;
      for (int iy = 0; iy < g.ny; ++iy) {
        for (int ix = 0; ix < g.nx; ++ix) {
          sum += hann(ix, g.nx) * hann(iy, g.ny) * (h(ix, iy) - weighted / weight) *
                 std::polar(1.0, -2 * kPi * (kx * ix / 12.0 + ky * iy / 10.0));
        }
      }
      const double wavelength = 1 / std::hypot(kx / g.lx, ky / g.ly);
      if (wavelength < shortest * (1 - 1e-9)) continue;
      const auto ring = static_cast<std::size_t>(
          std::clamp(std::floor(10 * std::log10(longest / wavelength) + 1e-9), 0.0, count - 1.0));
      density[ring] += g.area() / square(2 * kPi) * std::norm(sum) / (120 * squares);
      logarithm[ring] += std::log(wavelength);
      modes[ring] += 1;
    }
  }
  std::vector<SpectrumRing> wanted;
  for (std::size_t i = 0; i < count; ++i) {
    if (modes[i] > 0) wanted.push_back({std::exp(logarithm[i] / modes[i]), density[i] / modes[i]});
  }
  const std::vector<SpectrumRing> rings = radial_spectrum(h);
  ASSERT_EQ(rings.size(), wanted.size());
  ASSERT_GE(rings.size(), 5u);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    EXPECT_NEAR(rings[i].wavelength / wanted[i].wavelength, 1, 1e-10) << i;
    EXPECT_NEAR(rings[i].density / wanted[i].density, 1, 1e-9) << i;
  }
  EXPECT_TRUE(radial_spectrum({{2, 2, 2, 2}, {1, 2, 3, 4}}).empty());  // no wave of two pixels
}

// The mean product of heights a shift apart over those of none, over the pixels that both have.
double alike(const Heightmap& h, int sx, int sy) {
  double mean = 0, all = 0, sum = 0, count = 0;
  for (const double z : h.z) mean += z / static_cast<double>(h.z.size());
  for (const double z : h.z) all += square(z - mean) / static_cast<double>(h.z.size());
  for (int iy = std::max(0, -sy); iy < h.grid.ny - std::max(0, sy); ++iy) {
    for (int ix = std::max(0, -sx); ix < h.grid.nx - std::max(0, sx); ++ix) {
      sum += (h(ix, iy) - mean) * (h(ix + sx, iy + sy) - mean);
      count += 1;
    }
  }
  return sum / count / all;
}

// From no shift on to all neighbours that are alike by more than 0.2; the border by straight lines.
TEST(Likeness, IsThatOfEveryShiftByItsSum) {
  const Grid g{26, 20, 13, 16};  // pixels of 0.5 x 0.8
  int known = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const Heightmap h = random_map(g, seed, 3);
    std::set<std::pair<int, int>> seen{{0, 0}};
    std::vector<std::pair<int, int>> open{{0, 0}};
    double nearest = kInfinity, farthest = 0;
    bool leaves = false;
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      for (const auto& [u, v] : {std::pair{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
        if (std::abs(u) > 13 || std::abs(v) > 10) {
          leaves = true;
          continue;
        }
        const double inside = alike(h, x, y), outside = alike(h, u, v);
        if (outside > 0.2) {
          if (seen.insert({u, v}).second) open.emplace_back(u, v);
          continue;
        }
        const double t = (inside - 0.2) / (inside - outside);
        const double way = std::hypot(0.5 * (x + t * (u - x)), 0.8 * (y + t * (v - y)));
        nearest = std::min(nearest, way), farthest = std::max(farthest, way);
      }
    }
    const ArealParameters p = areal_parameters(h);
    ASSERT_TRUE(p.sal) << seed;
    EXPECT_NEAR(*p.sal, nearest, 1e-9) << seed;
    ASSERT_EQ(p.str.has_value(), !leaves) << seed;
    known += !leaves;
    EXPECT_NEAR(p.str.value_or(nearest / farthest), nearest / farthest, 1e-9) << seed;
  }
  EXPECT_GE(known, 3);
}

}  // namespace
}  // namespace papilla::tests::directions_test
