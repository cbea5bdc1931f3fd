// Small maps against second methods: planes by their normal equations, walls by summing their
// section, cuts of a skin value by value, films by their count.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "geometry/areal.h"
#include "geometry/io/files.h"
#include "geometry/measured_map.h"
#include "geometry/plane.h"
#include "geometry/profile.h"
#include "geometry/textures/particle_film.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::small_maps_test {
namespace {

Heightmap random_map(const Grid& grid, std::uint64_t seed) {
  RandomStream random(seed, "small maps of a test", 0);
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (double& z : h.z) z = random.uniform(-1, 1);
  return h;
}

double determinant(const std::array<std::array<double, 3>, 3>& m) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum +=
        m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
  }
  return sum;
}

// Least squares over the pixels that are taken, by Cramer's rule.
Plane fitted(const Heightmap& h, const std::function<bool(int ix, int iy)>& taken) {
  std::array<std::array<double, 3>, 3> normal{};
  std::array<double, 3> right{};
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      if (!taken(ix, iy)) continue;
      const std::array<double, 3> row{1, h.grid.x(ix), h.grid.y(iy)};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) normal[i][k] += row[i] * row[k];
        right[i] += row[i] * h(ix, iy);
      }
    }
  }
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    auto replaced = normal;
    for (std::size_t k = 0; k < 3; ++k) replaced[k][i] = right[k];
    out[i] = determinant(replaced) / determinant(normal);
  }
  return {out[0], out[1], out[2]};
}

void expect_plane(const Plane& is, const Plane& wanted) {
  EXPECT_NEAR(is.a, wanted.a, 1e-10);
  EXPECT_NEAR(is.b, wanted.b, 1e-10);
  EXPECT_NEAR(is.c, wanted.c, 1e-10);
}

// Pixels of 1 x 2 whose centres lie on the border of the rectangle are in it.
TEST(Planes, OfARectangleAreTheLeastSquaresOfItsPixels) {
  const Heightmap h = random_map({8, 6, 8, 12}, 1);
  expect_plane(plane_of(h, 0, 0, 8, 12), fitted(h, [](int, int) { return true; }));
  const auto inside = [](int ix, int iy) { return ix >= 2 && ix <= 4 && iy >= 1 && iy <= 3; };
  const Plane part = fitted(h, inside);
  expect_plane(plane_of(h, 2.5, 3, 2, 4), part);        // centres 2.5 to 4.5, 3 to 7
  expect_plane(plane_of(h, 1.6, 1.1, 3.8, 7.8), part);  // up to 5.4 and 8.9
  EXPECT_NEAR(
      part.at(3.5, 5),
      [&] {
        double sum = 0;
        for (int iy = 1; iy <= 3; ++iy) {
          for (int ix = 2; ix <= 4; ++ix) sum += h(ix, iy) / 9;
        }
        return sum;
      }(),
      1e-12);
}

TEST(Planes, OfThePixelsThatCountAreTheLeastSquaresOfThose) {
  const Heightmap h = random_map({8, 6, 8, 12}, 2);
  RandomStream random(3, "small maps of a test", 0);
  std::vector<std::uint8_t> counts(48);
  for (auto& c : counts) c = random.uniform() < 0.6;
  const auto taken = [&](int ix, int iy) { return counts[h.grid.index(ix, iy)] != 0; };
  expect_plane(plane_of(h, 0, 0, 8, 12, &counts), fitted(h, taken));
  expect_plane(plane_of(h, 2.5, 3, 4, 6, &counts), fitted(h, [&](int ix, int iy) {
                 return taken(ix, iy) && ix >= 2 && ix <= 6 && iy >= 1 && iy <= 4;
               }));
  // Of none there is none.
  const std::vector<std::uint8_t> none(48);
  expect_plane(plane_of(h, 0, 0, 8, 12, &none), {});
}

TEST(Planes, OfOneColumnOrRowHaveNoSlopeAcross) {
  Heightmap h = random_map({8, 6, 8, 12}, 4);
  for (int iy = 0; iy < 6; ++iy) {
    for (int ix = 0; ix < 8; ++ix) h(ix, iy) = 0.5 + 2 * h.grid.x(ix) - 3 * h.grid.y(iy);
  }
  expect_plane(plane_of(h, 0, 0, 8, 12), {0.5, 2, -3});
  expect_plane(plane_of(h, 3, 0, 1, 12), {0.5 + 2 * 3.5, 0, -3});
  expect_plane(plane_of(h, 0, 4, 8, 2), {0.5 - 3 * 5, 2, 0});
  expect_plane(plane_of(h, 20, 0, 1, 1), {});
}

// Below the land at a distance from the edge: the arc of the rim, tangent to the land and to the
// wall, the wall, the floor.
double drop(double depth, double angle, double rim, double s) {
  const double t = s + rim * std::tan(0.5 * angle);
  if (t <= 0) return 0;
  const double end = rim * std::sin(angle);
  const double down = t < end ? rim - std::sqrt(rim * rim - t * t)
                              : rim * (1 - std::cos(angle)) + (t - end) * std::tan(angle);
  return std::min(depth, down);
}

TEST(Walls, AreTheMeanOfTheirSectionOverAPixel) {
  for (const auto& [depth, degrees, rim] : {std::tuple{1.0, 60.0, 0.0},
                                            {1.0, 60.0, 0.5},
                                            {1.0, 80.0, 2.0},
                                            {0.3, 75.0, 1.0},
                                            {0.2, 30.0, 1.0},
                                            {1.0, 45.0, 1.0}}) {
    const double angle = degrees * kPi / 180;
    const WallProfile wall(depth, angle, rim);
    for (const double pixel : {0.1, 0.7, 3.0}) {
      for (double s = -2; s < 3; s += 0.23) {
        double sum = 0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i)
          sum += drop(depth, angle, rim, s + ((i + 0.5) / kSteps - 0.5) * pixel) / kSteps;
        ASSERT_NEAR(wall.mean_drop(s, pixel), sum, 2e-5 * depth)
            << depth << " " << degrees << " " << rim << " " << pixel << " " << s;
      }
    }
  }
  EXPECT_EQ(WallProfile(0, kPi / 3, 0.1).mean_drop(1, 0.1), 0);
}

// Eq. geometry.7, rings of 8, 4, 2 and 1 um by hand: each adds 3/8 2 pi q (q - q before) q^4 C; the
// first has none before it. The tip ends the band where the root of the sum is above 1 / (2
// radius).
TEST(KnownBands, EndAtTheRingWhoseWavesBendHalfAsMuchAsTheTip) {
  const std::vector<SpectrumRing> rings{{8e-6, 3e-27}, {4e-6, 2e-27}, {2e-6, 1e-28}, {1e-6, 4e-29}};
  const Heightmap h{{64, 80, 16e-6, 24e-6}, {}};  // pixels of 0.25 and 0.3 um
  std::vector<double> bends;
  double sum = 0;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    const double q = 2 * kPi / rings[i].wavelength, before = 2 * kPi / rings[i - 1].wavelength;
    sum += 3.0 / 8 * 2 * kPi * q * (q - before) * q * q * q * q * rings[i].density;
    bends.push_back(std::sqrt(sum));
  }
  const KnownBand none = known_band(h, rings, 0);
  EXPECT_NEAR(none.longest, 4e-6, 1e-18);
  EXPECT_NEAR(none.shortest, 0.6e-6, 1e-18);
  EXPECT_FALSE(none.by_tip);
  for (std::size_t i = 0; i < 3; ++i) {
    const KnownBand just = known_band(h, rings, 0.5001 / bends[i]),
                    less = known_band(h, rings, 0.4999 / bends[i]);
    EXPECT_TRUE(just.by_tip);
    EXPECT_EQ(just.shortest, rings[i + 1].wavelength) << i;
    EXPECT_EQ(less.by_tip, i < 2) << i;
    EXPECT_NEAR(less.shortest, i < 2 ? rings[i + 2].wavelength : 0.6e-6, 1e-18) << i;
    EXPECT_EQ(just.longest, none.longest);
  }
  // Waves that the pixels do not show end nothing.
  const Heightmap coarse{{20, 20, 16e-6, 24e-6}, {}};  // 1.2 um: 2.4 at least
  EXPECT_FALSE(known_band(coarse, rings, 0.5001 / bends[1]).by_tip);
  EXPECT_TRUE(known_band(coarse, rings, 0.5001 / bends[0]).by_tip);
}

TEST(Histograms, ShareOutByHeight) {
  const Heightmap h{{10, 1, 1, 1}, {2, 3, 4, 5, 6, 2.99, 4.01, 6, 2, 5.5}};  // quarters of 2 to 6
  const std::vector<double> shares = height_histogram(h, 4);
  ASSERT_EQ(shares.size(), 4u);
  for (const auto& [bin, share] : {std::pair{0u, 0.3}, {1u, 0.1}, {2u, 0.2}, {3u, 0.4}})
    EXPECT_NEAR(shares[bin], share, 1e-12) << bin;
}

// --- a patch of a measured skin ---

// Between the centres of pixels by straight lines, beyond the last ones theirs.
double value_at(const Heightmap& h, double x, double y) {
  const auto along = [](double at, double pixel, int n) {
    const double u = std::clamp(at / pixel - 0.5, 0.0, n - 1.0);
    const int i = std::min(static_cast<int>(u), n - 2);
    return std::pair{i, u - i};
  };
  const auto [ix, s] = along(x, h.grid.dx(), h.grid.nx);
  const auto [iy, t] = along(y, h.grid.dy(), h.grid.ny);
  return (1 - s) * (1 - t) * h(ix, iy) + s * (1 - t) * h(ix + 1, iy) + (1 - s) * t * h(ix, iy + 1) +
         s * t * h(ix + 1, iy + 1);
}

// Eqs. geometry.4 and 5: the cut, its plane, the tenth of either side blended into what lies a
// period below it, its variance kept, mirrored or not; as the stream of the skin draws it.
TEST(SkinPatches, AreTheCutsOfTheMapThatTheirStreamDraws) {
  const Grid whole{60, 50, 30e-6, 20e-6}, grid{24, 30, 10e-6, 9e-6};
  Heightmap map = random_map(whole, 5);
  for (double& z : map.z) z *= 1e-8;
  const std::string file = temporary("skin.gsf");
  write_gsf(file, map, {});
  const Heightmap known = read_scan({file, 0}).map;  // levelled and mended
  bool turned_x = false, turned_y = false;
  for (std::uint64_t index = 0; index < 6; ++index) {
    RandomStream random(9, "skin map", index);
    const double bx = 1e-6, by = 0.9e-6;
    const double x0 = bx + random.uniform() * (30e-6 - 11e-6),
                 y0 = by + random.uniform() * (20e-6 - 9.9e-6);
    const bool mirror_x = random.uniform() < 0.5, mirror_y = random.uniform() < 0.5;
    turned_x = turned_x || mirror_x, turned_y = turned_y || mirror_y;
    const Plane plane = fitted(known, [&](int ix, int iy) {
      const double x = whole.x(ix), y = whole.y(iy);
      return x >= x0 && x <= x0 + 10e-6 && y >= y0 && y <= y0 + 9e-6;
    });
    const auto sample = [&](double x, double y) { return value_at(known, x, y) - plane.at(x, y); };
    const auto mixed = [](double share, double here, double below) {
      return ((1 - share) * here + share * below) / std::hypot(share, 1 - share);
    };
    const Heightmap patch = measured_skin(file, 0, grid, 9, index);
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const double x = grid.x(mirror_x ? grid.nx - 1 - ix : ix),
                     y = grid.y(mirror_y ? grid.ny - 1 - iy : iy);
        const double a = std::max(0.0, (x - 9e-6) / bx), b = std::max(0.0, (y - 8.1e-6) / by);
        const auto row = [&](double v) {
          return mixed(a, sample(x0 + x, y0 + v), sample(x0 + x - 10e-6, y0 + v));
        };
        ASSERT_NEAR(patch(ix, iy), mixed(b, row(y), row(y - 9e-6)), 1e-14)
            << index << " " << ix << " " << iy;
      }
    }
  }
  EXPECT_TRUE(turned_x && turned_y);
}

// --- films of particles ---

// Of equal ones the whole number that comes nearest to the coverage: of spheres that stand half
// out or more their own discs, of deeper ones their caps.
TEST(Films, HaveAsManyParticlesAsComeNearestToTheirCoverage) {
  const Grid grid{64, 64, 20e-6, 10e-6};
  for (const double embedding : {0.0, 0.5, 0.7, 0.9}) {
    const double cap = 2e-6 * (1 - embedding);
    const double disc =
        embedding <= 0.5 ? kPi * 1e-12 : kPi * (1e-12 - square(1e-6 - cap));  // pi (r^2 - h^2)
    for (const double count : {0.6, 1.4, 6.4, 6.6}) {
      const ParticleFilm film{.radius = 1e-6,
                              .radius_spread = 0,
                              .coverage = count * disc / grid.area(),
                              .embedding = embedding};
      EXPECT_EQ(place_particles(film, grid).size(),
                static_cast<std::size_t>(std::max(1L, std::lround(count))))
          << embedding << " " << count;
    }
  }
}

TEST(Films, OfLargeAndSmallParticlesBeginWithTheLargest) {
  const ParticleFilm film{.radius = 0.3e-6, .radius_spread = 0.5, .coverage = 0.3};
  const std::vector<Particle> all = place_particles(film, {64, 64, 12e-6, 12e-6});
  ASSERT_GT(all.size(), 50u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(all[i].radius, all[i - 1].radius);
  EXPECT_LE(all.front().radius, 1.7 * 0.3e-6 * (1 + 1e-12));
  EXPECT_GE(all.back().radius, 0.3 * 0.3e-6 * (1 - 1e-12));
  EXPECT_NEAR(all.front().radius, 1.7 * 0.3e-6, 1e-15);  // the bounds are met in so many draws
  EXPECT_NEAR(all.back().radius, 0.3 * 0.3e-6, 1e-15);
}

TEST(Films, ThatCannotBePlacedAreRefusedWithTheirNumbers) {
  const auto refusal = [](double side) -> std::string {
    return refusal_of([&] {
      place_particles({.radius = 3e-6, .radius_spread = 0, .coverage = 0.2},
                      {64, 64, side, 2 * side});
    });
  };
  // A disc as wide as the patch touches itself.
  EXPECT_EQ(refusal(6.01e-6), "");
  EXPECT_EQ(refusal(5.99e-6),
            "a coverage of 20 % with particles of 3 um radius cannot be reached on a patch of 5.99 "
            "um; lower the coverage or the spread of the radius");
}

}  // namespace
}  // namespace papilla::tests::small_maps_test
