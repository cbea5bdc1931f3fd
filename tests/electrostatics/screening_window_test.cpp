// The fading around water pixel by pixel, against Eq. electrostatics.3 at the nearest image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/screening.h"

namespace papilla::tests::screening_window_test {
namespace {

// L/g of Eq. electrostatics.3 at x = d/g and i = g/a, both as it holds them.
double reach_of(double g, double d, double a) {
  const double x = std::min(d / g, 10.0), i = g / std::max(a, 0.25 * g);
  const double planar = 2 / kPi + 0.5051 * std::pow(x, 1.29761) / (1 + 0.24186 * x);
  return g * planar / (1 + 0.05027 * x * i / (1 + 0.07394 * i)) * (1 - 0.23027 * i / (1 + 2 * i));
}

TEST(ScreeningFit, IsThatOfItsEquationAndHeldBeyondIt) {
  for (const double x : {0.0, 0.1, 1.0, 5.0, 9.9}) {
    const double g = 120e-9, d = x * g;
    const double planar = g * (2 / kPi + 0.5051 * std::pow(x, 1.29761) / (1 + 0.24186 * x));
    EXPECT_NEAR(screening_length(g, d), planar, 1e-9 * planar) << x;
    for (const double a : {0.3, 1.0, 4.0}) {
      EXPECT_NEAR(screening_reach(g, d, a * g), reach_of(g, d, a * g), 1e-9 * g) << x << ' ' << a;
    }
    // A wide bridge is a straight wall.
    EXPECT_NEAR(screening_reach(g, d, 1e6 * g), planar, 1e-5 * planar) << x;
    // A thinner one than a quarter of the gap counts as that.
    EXPECT_EQ(screening_reach(g, d, 0.1 * g), screening_reach(g, d, 0.25 * g));
  }
  // Beyond ten gaps of oxide the length is that of ten.
  EXPECT_EQ(screening_length(1e-7, 5e-6), screening_length(1e-7, 1e-6));
  EXPECT_EQ(screening_reach(1e-7, 5e-6, 2e-7), screening_reach(1e-7, 1e-6, 2e-7));
  EXPECT_GT(screening_length(1e-7, 1e-6), screening_length(1e-7, 0.99e-6));
}

Droplet bridge(double x, double y, double radius, double edge_gap) {
  Droplet d;
  d.state = DropletState::Bridge;
  d.x = x, d.y = y, d.radius = radius, d.edge_gap = edge_gap;
  return d;
}

// tanh^2 of the distance from the rim over W, W^2 ln 2 + a W = a L + L^2/2; to four W, then 1.
double faded(const Grid& g, const Droplet& d, double thickness, int ix, int iy) {
  const double a = d.radius, reach = reach_of(d.edge_gap, thickness, a);
  const double ln2 = std::log(2.0), whole = a * reach + 0.5 * reach * reach;
  const double width = (-a + std::sqrt(a * a + 4 * ln2 * whole)) / (2 * ln2);
  EXPECT_NEAR(width * width * ln2 + a * width, whole, 1e-9 * whole);
  const double dx = std::remainder(g.x(ix) - d.x, g.lx), dy = std::remainder(g.y(iy) - d.y, g.ly);
  const double away = (std::hypot(dx, dy) - a) / width;
  return away <= 0 ? 0 : away < 4 ? square(std::tanh(away)) : 1;
}

TEST(ScreeningWindow, OfABridgeAnywhereIsTheProfileOfItsNearestImage) {
  const Grid grid{40, 27, 4e-6, 3.5e-6};
  const Gap gap{grid, std::vector<double>(grid.size(), 90e-9)};
  const double thickness = 150e-9;
  // In the middle, over each seam, in a corner; narrow, wide, and wider than the patch is long.
  for (const auto& [x, y, a, g] : {std::tuple{2.02e-6, 1.71e-6, 0.4e-6, 90e-9},
                                   {0.05e-6, 1.3e-6, 0.3e-6, 60e-9},
                                   {3.97e-6, 3.46e-6, 0.25e-6, 120e-9},
                                   {1.4e-6, 0.02e-6, 0.15e-6, 200e-9},
                                   {2.6e-6, 0.9e-6, 0.5e-6, 900e-9}}) {
    Wetting w;
    w.grid = grid;
    w.status = WettingStatus::Discs;
    w.bridges = 1;
    w.droplets = {bridge(x, y, a, g)};
    const std::vector<double> factor = screening_factor(gap, w, {thickness}, true);
    ASSERT_EQ(factor.size(), grid.size());
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        // tanh^2(4) = 0.9987 is where the profile is cut.
        const double expected = faded(grid, w.droplets[0], thickness, ix, iy);
        ASSERT_NEAR(factor[grid.index(ix, iy)], expected, 3e-5) << x << ' ' << ix << ' ' << iy;
      }
    }
    EXPECT_EQ(screening_factor(gap, w, {thickness}, false), std::vector<double>(grid.size(), 1.0));
  }
}

TEST(ScreeningWindow, FactorsMultiplyAndWetPixelsHaveNone) {
  const Grid grid{32, 32, 3.2e-6, 3.2e-6};
  const Gap gap{grid, std::vector<double>(grid.size(), 100e-9)};
  Wetting w;
  w.grid = grid;
  w.status = WettingStatus::Discs;
  w.bridges = 2;
  w.droplets = {bridge(1.2e-6, 1.6e-6, 0.2e-6, 100e-9), bridge(1.9e-6, 1.4e-6, 0.3e-6, 80e-9)};
  Droplet none = bridge(0.4e-6, 0.4e-6, 0.3e-6, 100e-9);  // does not bridge
  none.state = DropletState::OnSkin;
  w.droplets.push_back(none);
  Droplet film = bridge(2.8e-6, 2.8e-6, 0.3e-6, 100e-9);  // all film: no disc
  film.film = 1;
  w.droplets.push_back(film);
  w.bridged.assign(grid.size(), 0);
  w.bridged[grid.index(3, 30)] = 1;
  const std::vector<double> factor = screening_factor(gap, w, {60e-9}, true);
  for (int iy = 0; iy < 32; ++iy) {
    for (int ix = 0; ix < 32; ++ix) {
      const double both =
          faded(grid, w.droplets[0], 60e-9, ix, iy) * faded(grid, w.droplets[1], 60e-9, ix, iy);
      const std::size_t i = grid.index(ix, iy);
      ASSERT_NEAR(factor[i], w.bridged[i] ? 0 : both, 6e-5) << ix << ' ' << iy;
    }
  }
  // Nothing wet, nothing to screen; a mask alone takes its pixels.
  EXPECT_TRUE(screening_factor(gap, {}, {60e-9}, true).empty());
  Wetting mask;
  mask.grid = grid;
  mask.bridged = w.bridged;
  const std::vector<double> masked = screening_factor(gap, mask, {60e-9}, true);
  for (std::size_t i = 0; i < masked.size(); ++i) EXPECT_EQ(masked[i], w.bridged[i] ? 0 : 1);
  // The film alone, without a bridge that counts: by its mask.
  Wetting bridges = w;
  bridges.bridged.clear();
  bridges.status = WettingStatus::Film;
  EXPECT_EQ(screening_factor(gap, bridges, {60e-9}, true)[grid.index(19, 14)], 0);
}

// Of a film: the gap of each pixel over the planar length, far and near, in rows of any length.
TEST(ScreeningWindow, OfAFilmTheWidthIsThatOfThePixelsOwnGap) {
  for (const Grid& grid : {Grid{33, 9, 3.3e-6, 1.8e-6}, Grid{7, 26, 1.4e-6, 2.6e-6}}) {
    RandomStream random(4, "film", static_cast<std::uint64_t>(grid.nx));
    Gap gap{grid, std::vector<double>(grid.size())};
    Wetting w;
    w.grid = grid;
    w.status = WettingStatus::Film;
    w.bridged.assign(grid.size(), 0);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      gap.value[i] = std::pow(10, -9.2 + 3.4 * random.uniform());
      w.bridged[i] = random.uniform() < 0.03;
    }
    w.bridged[grid.index(grid.nx - 1, 0)] = 1;
    const double thickness = 40e-9;
    const std::vector<double> factor = screening_factor(gap, w, {thickness}, true);
    int partly = 0;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        double nearest = kInfinity;
        for (int jy = 0; jy < grid.ny; ++jy) {
          for (int jx = 0; jx < grid.nx; ++jx) {
            if (!w.bridged[grid.index(jx, jy)]) continue;
            nearest =
                std::min(nearest, std::hypot(std::remainder(grid.x(ix) - grid.x(jx), grid.lx),
                                             std::remainder(grid.y(iy) - grid.y(jy), grid.ly)));
          }
        }
        const double g = std::max(gap.value[grid.index(ix, iy)], 1e-9);
        const double x = nearest / screening_length(g, thickness);
        const double expected = x < 4 ? square(std::tanh(x)) : 1;
        ASSERT_NEAR(factor[grid.index(ix, iy)], expected, 2e-5) << ix << ' ' << iy;
        partly += expected > 0.1 && expected < 0.9;
      }
    }
    EXPECT_GT(partly, 10);
  }
}

// Pixels of film and pixels on their way, from the first to the last: the factor of the one times
// that of the other to the power of the largest share of film that a bridge still lacks.
TEST(ScreeningWindow, FilmAndWhatIsOnItsWayFadeByTheirOwnPixels) {
  const Grid grid{24, 10, 2.4e-6, 1e-6};
  const Gap gap{grid, std::vector<double>(grid.size(), 150e-9)};
  const std::size_t last = grid.size() - 1, first = 0;
  for (const auto& [film, way] :
       {std::pair{first, last}, {last, first}, {grid.index(7, 4), last}}) {
    Wetting w;
    w.grid = grid;
    w.status = WettingStatus::Film;
    w.bridged.assign(grid.size(), 0);
    w.film.assign(grid.size(), FilmPixel::None);
    w.film[film] = FilmPixel::Film, w.film[way] = FilmPixel::OnItsWay;
    w.droplets.resize(3);  // on a surface: no discs
    w.droplets[0].film = 0.3, w.droplets[1].film = 0.6, w.droplets[2].film = 1;
    w.bridged[film] = 1;
    const std::vector<double> factor = screening_factor(gap, w, {50e-9}, true);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const auto fades = [&](std::size_t from) {
        const auto nx = static_cast<std::size_t>(grid.nx);
        const auto place = [&](std::size_t k) {
          return std::pair{grid.x(static_cast<int>(k % nx)), grid.y(static_cast<int>(k / nx))};
        };
        const double x = std::hypot(std::remainder(place(i).first - place(from).first, grid.lx),
                                    std::remainder(place(i).second - place(from).second, grid.ly)) /
                         screening_length(150e-9, 50e-9);
        return x < 4 ? square(std::tanh(x)) : 1;
      };
      ASSERT_NEAR(factor[i], i == film ? 0 : fades(film) * std::pow(fades(way), 0.6), 5e-5) << i;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::screening_window_test
