// Each loop of the field rules over several pixels at once gives what it gives pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "physics/electrostatics/electrode.h"
#include "physics/electrostatics/field.h"
#include "physics/electrostatics/screening.h"
#include "tests/electrostatics/oxide.h"
#include "tests/numerics/both_ways.h"

namespace papilla::tests::pixel_by_pixel_test {
namespace {

// A loop over its pixels ends within a vector; rows are neither whole vectors.
constexpr Grid kGrid{37, 23, 3.7e-6, 4.6e-6};

Gap rough_gap(double deepest) {
  Gap gap{kGrid, std::vector<double>(kGrid.size())};
  RandomStream random(3, "gap");
  for (double& h : gap.value) h = std::max(0.0, deepest * (random.uniform() - 0.2));
  return gap;
}

// Some wet pixels, and a drop that does not bridge.
Wetting some_water() {
  Wetting w;
  w.grid = kGrid;
  w.status = WettingStatus::Film;
  w.bridged.assign(kGrid.size(), 0);
  for (std::size_t i = 60; i < 90; ++i) w.bridged[i] = 1;
  Droplet d;
  d.x = 2e-6;
  d.y = 3e-6;
  d.state = DropletState::OnSubstrate;
  d.radius = 4e-7;
  d.height = 1e-7;
  w.droplets = {d};
  return w;
}

void expect_same_field(const FieldSolution& a, const FieldSolution& b, double rounding) {
  expect_alike(a.traction.value, b.traction.value, rounding, "traction");
  EXPECT_NEAR(a.mean_pressure, b.mean_pressure, rounding * a.mean_pressure);
  EXPECT_EQ(a.over_limit_area, b.over_limit_area);
  EXPECT_NEAR(a.over_limit_share, b.over_limit_share, rounding);
  EXPECT_NEAR(a.peak_air_field, b.peak_air_field, rounding * a.peak_air_field);
  EXPECT_NEAR(a.peak_oxide_field, b.peak_oxide_field, rounding * a.peak_oxide_field);
  EXPECT_EQ(a.iterations, b.iterations);
}

// Gaps up to 100 um reach beyond the minimum of Paschen's law, where each is asked for by itself.
TEST(PixelByPixel, ThePullOfColumnsIsTheSame) {
  int beyond = 0;
  for (const double deepest : {2e-7, 5e-6, 1e-4}) {
    for (const double volts : {60.0, 900.0}) {
      FieldProblem p = oxide(volts);
      p.skin_layer = {30e-9, 60e-9};
      const auto [together, apart] = both_ways(
          [&] { return solve_local_field(rough_gap(deepest), nullptr, some_water(), p); });
      expect_same_field(together, apart, 1e-13);
      beyond += together.over_limit_area > 0;
    }
  }
  EXPECT_GT(beyond, 2);
}

TEST(PixelByPixel, SpreadingFluxIsTheSame) {
  for (const auto& [tolerance, rounding] : {std::pair{1e-8, 1e-9}, {1e-3, 1e-4}}) {
    const auto [together, apart] = both_ways([&, &allowed = tolerance] {
      return solve_spread_field(rough_gap(3e-7), nullptr, some_water(), oxide(200), allowed);
    });
    EXPECT_GT(together.iterations, 1);
    expect_same_field(together, apart, rounding);
  }
}

TEST(PixelByPixel, ScreeningByWaterIsTheSame) {
  const Gap gap = rough_gap(5e-7);
  const auto [together, apart] =
      both_ways([&] { return air_screening_factor(gap, some_water(), true); });
  EXPECT_EQ(together, apart);
  const std::vector<double> potential(kGrid.size(), 0.4), film(kGrid.size(), 1e-7),
      reach(kGrid.size(), 3e-7);
  const WallFields wall{potential, film, reach, 2e-8};
  const auto [floating, floating_apart] =
      both_ways([&] { return air_screening_factor(gap, some_water(), true, &wall); });
  expect_alike(floating, floating_apart, 1e-6, "beside water with a potential of its own");
  const auto [films, films_apart] =
      both_ways([&] { return screening_factor(gap, some_water(), {2e-7}, true); });
  EXPECT_EQ(films, films_apart);
}

TEST(PixelByPixel, FilmsBelowATextureAreTheSame) {
  Heightmap surface{kGrid, std::vector<double>(kGrid.size())};
  for (std::size_t i = 0; i < surface.z.size(); ++i) surface.z[i] = i / 5 % 3 == 0 ? 0 : -4e-7;
  const std::vector<FilmLayer> layers{{FilmProcess::Conformal, 0, 3e-7, 3.9},
                                      {FilmProcess::Directional, 0.5, 2e-7, 7}};
  const auto [together, apart] = both_ways([&] { return CoveredSurface(surface, layers); });
  EXPECT_TRUE(together.walls);
  EXPECT_EQ(together.film, apart.film);
  EXPECT_EQ(together.dielectric, apart.dielectric);
  EXPECT_EQ(together.effective, apart.effective);
}

}  // namespace
}  // namespace papilla::tests::pixel_by_pixel_test
