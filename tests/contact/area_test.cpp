// The contact area between the pixels: against closed forms and against finer grids.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/roughness.h"
#include "geometry/texture.h"
#include "physics/contact/closed_forms.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"
#include "tests/support/one_pass.h"

namespace papilla::tests::area_test {
namespace {

TEST(Area, OfASphereIsHertzsWhereverItLiesBetweenThePixels) {
  const Grid grid{128, 128, 1, 1};
  const ContactKernel kernel(grid, {1, 0, 0, 1, 0});
  const Hertz sphere{1, 0.5};
  RandomStream random(1, "centre", 0);
  for (double pixels : {4.0, 6.0}) {
    const double a = pixels * grid.dx(), exact = kPi * a * a;
    const double force = 4 * cube(a) / (3 * sphere.radius);
    constexpr int kCentres = 12;
    double bias = 0, square_error = 0, stated = 0;
    for (int k = 0; k < kCentres; ++k) {
      const double x = 0.5 + grid.dx() * random.uniform(), y = 0.5 + grid.dy() * random.uniform();
      std::vector<double> height(grid.size());
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          height[grid.index(ix, iy)] =
              -(square(grid.x(ix) - x) + square(grid.y(iy) - y)) / (2 * sphere.radius);
        }
      }
      const ContactArea area =
          measure_area(kernel, solve_contact(kernel, height, force, {}, {.tolerance = 1e-9}));
      const double error = area.near_edge / exact - 1;
      bias += error / kCentres;
      square_error += square(error) / kCentres;
      stated += area.se / exact / kCentres;
      EXPECT_NEAR(area.perimeter, area.near_edge, 0.08 * exact);
    }
    EXPECT_LT(std::abs(bias), 0.006) << pixels;
    EXPECT_LT(std::sqrt(square_error), 0.01) << pixels;
    EXPECT_LT(std::sqrt(square_error), 1.2 * stated) << pixels;
  }
}

// A periodic surface begins nowhere: across the corner of the grid the area is the same.
TEST(Area, IsTheSameWhereverTheGridBegins) {
  const Grid grid{48, 40, 1, 1};
  const ContactKernel kernel(grid, {1, 0, 0, 1, 0});
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      height[grid.index(ix, iy)] = -square(grid.x(ix) - 0.52) - square(grid.y(iy) - 0.47);
  }
  const ContactSolution middle = solve_contact(kernel, height, 0.01, {}, {.tolerance = 1e-9});
  ContactSolution corner = middle;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const std::size_t from = grid.index(ix, iy),
                        to = grid.index((ix + grid.nx / 2) % grid.nx, (iy + grid.ny / 2) % grid.ny);
      corner.pressure[to] = middle.pressure[from];
      corner.gap[to] = middle.gap[from];
    }
  }
  ASSERT_GT(corner.pressure.front(), 0);
  const ContactArea here = measure_area(kernel, middle), there = measure_area(kernel, corner);
  EXPECT_NEAR(there.raw, here.raw, 1e-12);
  EXPECT_NEAR(there.near_edge, here.near_edge, 1e-9);
  EXPECT_NEAR(there.perimeter, here.perimeter, 1e-12);
  EXPECT_NEAR(there.se, here.se, 1e-9);
}

// The reference finger's skin: an area on 256^2 lies within the stated error of that on 1024^2, the
// change of area with the load agrees ten times better.
TEST(Area, OfRoughSkinAgreesWithAFinerGridWithinItsStatedError) {
  const Finger finger = one_pass_finger();
  const Skin& skin = finger.skin;
  const double mean = finger.patch_pressure(0.15);
  double area[2], ratio[2], se[2];
  for (int k = 0; k < 2; ++k) {
    const int n = k == 0 ? 256 : 1024;
    const Grid grid{n, n, 12e-6, 12e-6};
    const auto kernel =
        make_contact_kernel(grid, {skin.layer_modulus, skin.layer_poisson, skin.layer_thickness,
                                   skin.bulk_modulus, skin.bulk_poisson});
    const Heightmap h =
        random_surface({skin.rms, skin.roll_off, skin.hurst, skin.cutoff}, grid, 1, 0);
    const ContactSolution low = solve_contact(*kernel, h.z, mean, {}, {.tolerance = 1e-5});
    const ContactSolution high =
        solve_contact(*kernel, h.z, 1.3 * mean, {}, {.tolerance = 1e-5}, &low);
    const ContactArea a = measure_area(*kernel, low);
    area[k] = a.near_edge;
    se[k] = a.se;
    ratio[k] = measure_area(*kernel, high).near_edge / area[k];
  }
  EXPECT_LT(std::abs(area[0] - area[1]), 2 * se[0]);
  EXPECT_LT(se[0], 0.03 * area[0]);
  EXPECT_LT(se[1], 0.005 * area[1]);
  EXPECT_NEAR(ratio[0], ratio[1], 0.003 * ratio[1]);
}

// Contact in a few large pieces, one per particle.
TEST(Area, OfAParticleFilmAgreesWithAFinerGrid) {
  const Finger finger;
  const Skin& skin = finger.skin;
  const Texture film{ParticleFilm{}};
  double area[2], se = 0;
  for (int k = 0; k < 2; ++k) {
    const Grid grid = patch_grid(film, k == 0 ? 512 : 128);
    const auto kernel =
        make_contact_kernel(grid, {skin.layer_modulus, skin.layer_poisson, skin.layer_thickness,
                                   skin.bulk_modulus, skin.bulk_poisson});
    Heightmap h = generate(film, grid);
    const Heightmap rough =
        random_surface({0.05 * skin.rms, skin.roll_off, skin.hurst, skin.cutoff}, grid, 1, 0);
    for (std::size_t i = 0; i < h.z.size(); ++i) h.z[i] += rough.z[i];
    const ContactArea a =
        measure_area(*kernel, solve_contact(*kernel, h.z, finger.patch_pressure(0.15), {}, {}));
    area[k] = a.near_edge;
    se = a.se;
  }
  EXPECT_NEAR(area[1], area[0], 0.005 * area[0]);
  EXPECT_LT(std::abs(area[1] - area[0]), 2 * se);
}

// Everything flows: the area is the load over the hardness.
TEST(Area, UnderAHardnessCarriesTheLoad) {
  const Grid grid{128, 128, 12e-6, 12e-6};
  const ContactKernel kernel(grid, {200e6, 0.5, 1e-6, 200e6, 0.5});
  const Heightmap h = random_surface({256e-9, 6e-6, 0.8, 1.5e-6}, grid, 1, 0);
  const double hardness = 1e6, load = 0.2e6;
  const ContactSolution s =
      solve_contact(kernel, h.z, load, {}, {.tolerance = 1e-6, .hardness = hardness});
  ASSERT_TRUE(s.converged()) << s.reason;
  EXPECT_NEAR(measure_area(kernel, s, hardness).near_edge, load / hardness, 0.01 * load / hardness);
}

TEST(Area, OfALayerThinnerThanAPixelIsThatOfTheBulk) {
  const Grid grid{64, 64, 12e-6, 12e-6};
  const Heightmap h = random_surface({100e-9, 6e-6, 0.8, 1.5e-6}, grid, 1, 0);
  const ContactKernel thin(grid, {1e9, 0.3, 1e-15, 60e6, 0.3}), bulk(grid, {1, 0.3, 0, 60e6, 0.3});
  const ContactOptions options{.tolerance = 1e-9};
  const double exact = measure_area(bulk, solve_contact(bulk, h.z, 1e6, {}, options)).near_edge;
  EXPECT_NEAR(measure_area(thin, solve_contact(thin, h.z, 1e6, {}, options)).near_edge, exact,
              1e-3 * exact);
}

}  // namespace
}  // namespace papilla::tests::area_test
