// A round film between a plane and a bowl against its closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/film.h"
#include "physics/capillary/threshold.h"

namespace papilla::tests::film_closed_forms_test {
namespace {

constexpr double kLowest = 40e-9, kBowl = 100e-6;  // gap in the middle, radius of curvature [m]

// On oblong patches of oblong pixels, so that no side stands for the other.
Gap bowl() {
  const Grid g{384, 128, 12e-6, 8e-6};
  Gap gap{g, std::vector<double>(g.size())};
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const double r2 = square(g.x(ix) - 0.5 * g.lx) + square(g.y(iy) - 0.5 * g.ly);
      gap.value[g.index(ix, iy)] = kLowest + r2 / (2 * kBowl);
    }
  }
  return gap;
}

struct RoundFilm {
  double radius, height, area, volume;
};
RoundFilm of_radius(double radius) {
  const double height = kLowest + radius * radius / (2 * kBowl), area = kPi * radius * radius;
  return {radius, height, area, 0.5 * area * (kLowest + height)};
}

TEST(RoundFilm, HasTheRetentionOfADiscOfItsWidth) {
  // Eq. capillary.14: (pi/4) gamma 2 r (cos theta_r - cos theta_a).
  const RoundFilm film = of_radius(2e-6);
  WaterProperties water;
  water.hysteresis = 0.3;
  const Wetting w = fill_threshold(bowl(), film.volume, water);
  const double expected = kPi / 4 * water.surface_tension * 2 * film.radius * 0.3;
  EXPECT_NEAR(w.retention, expected, 0.02 * expected);
}

TEST(RoundFilm, HasTheForceOfItsAreaAndItsRim) {
  const WaterProperties water;
  for (double radius : {1.5e-6, 3e-6}) {
    const RoundFilm film = of_radius(radius);
    const double expected =
        water.surface_tension *
        (wetting_gain(water.theta_skin, water.theta_substrate) * film.area / film.height +
         meniscus_factor(water.theta_skin, water.theta_substrate) * 2 * kPi * radius);
    EXPECT_NEAR(fill_threshold(bowl(), film.volume, water).capillary_force, expected,
                0.02 * expected);
  }
}

TEST(RoundFilm, WetsItsShareOfThePatch) {
  const Gap gap = bowl();
  const RoundFilm film = of_radius(2.5e-6);
  const double share = film.area / (12e-6 * 8e-6);
  EXPECT_NEAR(fill_threshold(gap, film.volume, {}).wetted_fraction, share, 0.01 * share);
  // A droplet in the bowl that has become a film of the same water.
  DropletOptions options;
  options.max_moves = 0;
  options.film_width = 0.1e-6;
  const Wetting w =
      settle_droplets(gap, {{0.5 * gap.grid.lx, 0.5 * gap.grid.ly, film.volume}}, {}, options);
  ASSERT_EQ(w.status, WettingStatus::Film);
  EXPECT_NEAR(w.wetted_fraction, share, 0.02 * share);
  double pixels = 0;
  for (auto wet : w.bridged) pixels += wet;
  EXPECT_NEAR(pixels / static_cast<double>(gap.grid.size()), w.wetted_fraction, 0.02 * share);
}

TEST(RoundFilm, ADropletThatBecameAFilmHasItsRetention) {
  const Gap gap = bowl();
  const RoundFilm film = of_radius(2.5e-6);
  DropletOptions options;
  options.max_moves = 0;
  options.film_width = 0.1e-6;
  const WaterProperties water;
  const Wetting w =
      settle_droplets(gap, {{0.5 * gap.grid.lx, 0.5 * gap.grid.ly, film.volume}}, water, options);
  ASSERT_EQ(w.status, WettingStatus::Film);
  const double expected = kPi / 4 * water.surface_tension * 2 * film.radius * water.hysteresis;
  EXPECT_NEAR(w.retention, expected, 0.03 * expected);
}

}  // namespace
}  // namespace papilla::tests::film_closed_forms_test
