// The surface below a layer and the film that columns see, against every pixel around.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/electrode.h"

namespace papilla::tests::electrode_shape_test {
namespace {

// Steps and slopes on oblong pixels, with one far lower and one far higher pixel at the seams.
Heightmap rough(const Grid& grid) {
  Heightmap h{grid, {}};
  RandomStream random(2, "rough electrode", static_cast<std::uint64_t>(grid.nx));
  for (std::size_t i = 0; i < grid.size(); ++i)
    h.z.push_back(random.uniform() < 0.5 ? 0 : -150e-9 * random.uniform());
  h.z[grid.index(0, grid.ny - 1)] = -400e-9;
  h.z[grid.index(grid.nx - 1, 0)] = 250e-9;
  return h;
}
constexpr Grid kGrids[] = {{23, 14, 2.3e-6, 2.1e-6}, {9, 30, 1.35e-6, 3e-6}};

// The shortest way around a period, in pixels.
int around(int d, int n) {
  const int w = wrap(d, n);
  return std::min(w, n - w);
}

// Eq. electrostatics.2, the lower of an ellipsoid over every pixel.
std::vector<double> eroded(const Heightmap& h, double thickness, double side) {
  const Grid& g = h.grid;
  std::vector<double> out;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      double least = h(ix, iy) - thickness;
      for (int jy = 0; jy < g.ny; ++jy) {
        for (int jx = 0; jx < g.nx; ++jx) {
          const double u =
              std::hypot(around(jx - ix, g.nx) * g.dx(), around(jy - iy, g.ny) * g.dy());
          if (u < side)
            least = std::min(least, h(jx, jy) - thickness * std::sqrt(1 - square(u / side)));
        }
      }
      out.push_back(least);
    }
  }
  return out;
}

TEST(ElectrodeShape, IsTheErosionByAnEllipsoidOverEveryPixel) {
  for (const Grid& grid : kGrids) {
    const Heightmap h = rough(grid);
    for (const auto& [thickness, side] :
         {std::pair{500e-9, 500e-9}, {300e-9, 480e-9}, {400e-9, 160e-9}, {200e-9, 0.0}}) {
      const std::vector<double> expected = eroded(h, thickness, side);
      const Heightmap below = below_layer(h, thickness, side);
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(below.z[i], expected[i], 1e-11) << grid.nx << ' ' << side << ' ' << i;
    }
    EXPECT_EQ(below_layer(h, 0, 300e-9).z, h.z);
  }
}

// Of the column half, of the shortest way to any place of the electrode half.
TEST(ElectrodeShape, ColumnsSeeTheNearestPlaceOfTheElectrodeAsWell) {
  for (const Grid& grid : kGrids) {
    const Heightmap h = rough(grid);
    const CoveredSurface covered(
        h, {{FilmProcess::Conformal, 0, 200e-9, 3.9}, {FilmProcess::Directional, 0.5, 300e-9, 6}});
    const Heightmap upper{grid, eroded(h, 300e-9, 150e-9)};
    const std::vector<double> electrode = eroded(upper, 200e-9, 200e-9);
    int nearer = 0;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const std::size_t i = grid.index(ix, iy);
        const double film = h.z[i] - electrode[i];
        double nearest = film;
        for (int jy = 0; jy < grid.ny; ++jy) {
          for (int jx = 0; jx < grid.nx; ++jx) {
            const double u = std::hypot(around(jx - ix, grid.nx) * grid.dx(),
                                        around(jy - iy, grid.ny) * grid.dy());
            nearest = std::min(nearest, std::hypot(u, h.z[i] - electrode[grid.index(jx, jy)]));
          }
        }
        const double column = (h.z[i] - upper.z[i]) / 6 + (upper.z[i] - electrode[i]) / 3.9;
        ASSERT_NEAR(covered.film[i], film, 1e-11);
        ASSERT_NEAR(covered.dielectric[i], column, 1e-11);
        // 1/D = (1/D_column + 1/D_nearest)/2.
        ASSERT_NEAR(1 / covered.effective[i] * column, 0.5 * (1 + film / nearest), 1e-4) << i;
        nearer += nearest < 0.99 * film;
      }
    }
    EXPECT_TRUE(covered.walls);
    EXPECT_GT(nearer, 50);
    EXPECT_EQ(covered.cut_through, 0);
  }
}

// By hand: 300 nm of 10 below 700 nm of 4, imprinted 600 nm deep, under 100 nm of 2 by steps.
TEST(ElectrodeShape, PlanarLayersHaveAFlatElectrodeWhateverLiesOnThem) {
  const Grid grid{40, 2, 4e-6, 0.2e-6};
  Heightmap h{grid, std::vector<double>(grid.size(), 0)};
  for (int iy = 0; iy < 2; ++iy) {
    for (int ix = 0; ix < 20; ++ix) h(ix, iy) = -600e-9;
  }
  const CoveredSurface covered(h, {{FilmProcess::Planar, 0, 300e-9, 10},
                                   {FilmProcess::Planar, 0, 700e-9, 4},
                                   {FilmProcess::Directional, 0, 100e-9, 2}});
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const bool floor = h.z[i] < 0;
    EXPECT_NEAR(covered.film[i], floor ? 500e-9 : 1100e-9, 1e-18);
    EXPECT_NEAR(covered.dielectric[i], 300e-9 / 10 + (floor ? 100e-9 : 700e-9) / 4 + 100e-9 / 2,
                1e-18);
    EXPECT_NEAR(covered.effective[i], covered.dielectric[i], 1e-18);
  }
  EXPECT_FALSE(covered.walls);
  EXPECT_EQ(covered.height.z, h.z);
}

// Where the texture goes deeper than its layer, a tenth of a nanometre counts and the electrode
// follows it down.
TEST(ElectrodeShape, BelowATextureThatCutsThroughLiesTheThinnestFilm) {
  const Grid grid{16, 16, 1.6e-6, 1.6e-6};
  Heightmap h{grid, std::vector<double>(grid.size(), 0)};
  for (int iy = 0; iy < 16; ++iy) h(5, iy) = -350e-9;
  const CoveredSurface covered(
      h, {{FilmProcess::Planar, 0, 200e-9, 5}, {FilmProcess::Planar, 0, 300e-9, 4}});
  EXPECT_EQ(covered.cut_through, 1.0 / 16);
  const std::size_t cut = grid.index(5, 7), land = grid.index(12, 7);
  EXPECT_NEAR(covered.film[cut], 150e-9, 1e-18);  // the whole layer below is still there
  EXPECT_NEAR(covered.dielectric[cut], 200e-9 / 5 + 1e-10 / 4, 1e-18);
  EXPECT_NEAR(covered.film[land], 500e-9, 1e-18);
  EXPECT_NEAR(covered.dielectric[land], 200e-9 / 5 + 300e-9 / 4, 1e-18);
  Heightmap deep = h;
  for (int iy = 0; iy < 16; ++iy) deep(5, iy) = -600e-9;
  const CoveredSurface through(deep, {{FilmProcess::Planar, 0, 500e-9, 4}});
  EXPECT_NEAR(through.film[cut], 1e-10, 1e-18);
  EXPECT_NEAR(through.dielectric[cut], 1e-10 / 4, 1e-18);
  EXPECT_EQ(through.cut_through, 1.0 / 16);
}

TEST(ElectrodeShape, TheLayersOfAFinishAreThoseOfItsProcess) {
  Surface surface;
  surface.process = FilmProcess::Directional;
  surface.step_coverage = 0.3;
  surface.dielectric.resize(2);
  surface.dielectric[0].thickness = 400e-9, surface.dielectric[0].permittivity = 3.9;
  surface.dielectric[1].thickness = 20e-9, surface.dielectric[1].permittivity = 2;
  surface.dielectric[1].process = LayerProcess::Conformal;
  const std::vector<FilmLayer> layers = film_layers(surface);
  ASSERT_EQ(layers.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(layers[k].process, k == 0 ? FilmProcess::Directional : FilmProcess::Conformal);
    EXPECT_EQ(layers[k].step_coverage, 0.3);
    EXPECT_EQ(layers[k].thickness, surface.dielectric[k].thickness);
    EXPECT_EQ(layers[k].permittivity, surface.dielectric[k].permittivity);
  }
}

}  // namespace
}  // namespace papilla::tests::electrode_shape_test
