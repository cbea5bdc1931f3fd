// Hard cases of the contact solver: each ends in the right answer or in a clear status.
#include "physics/contact/contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "geometry/texture.h"

namespace papilla::tests::contact_test {
namespace {

const LayeredSolid kSkin{66e6, 0.5, 1e-6, 60e6, 0.5};

Grid square(int n) { return {n, n, 12e-6, 12e-6}; }

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// A sound answer: the load is carried, pressure and gap are not negative and exclude one another.
void expect_sound(const ContactSolution& s, double load) {
  ASSERT_TRUE(s.converged()) << s.reason;
  EXPECT_NEAR(mean(s.pressure), load, 1e-9 * load);
  for (std::size_t i = 0; i < s.gap.size(); ++i) {
    ASSERT_TRUE(std::isfinite(s.pressure[i]) && std::isfinite(s.gap[i]));
    ASSERT_GE(s.pressure[i], 0);
    ASSERT_GE(s.gap[i], 0);
    ASSERT_TRUE(s.pressure[i] == 0 || s.gap[i] == 0);
  }
}

std::vector<double> rough(const Grid& grid, double rms = 256e-9) {
  return random_surface({rms, 3.7e-6, 0.8, 400e-9}, grid, 7, 0).z;
}

TEST(HardContact, FlatOnFlatIsUniformPressureWithoutAGap) {
  const Grid grid = square(64);
  const ContactKernel kernel(grid, kSkin);
  const std::vector<double> height(grid.size(), 3e-9);
  const ContactSolution s = solve_contact(kernel, height, 0.4e6, {}, {});
  expect_sound(s, 0.4e6);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(s.pressure[i], 0.4e6, 1e-6 * 0.4e6);
    EXPECT_EQ(s.gap[i], 0);
  }
  EXPECT_NEAR(measure_area(kernel, s).raw, 1, 1e-12);
}

TEST(HardContact, SmoothSkinOnHolesTouchesTheLandOnly) {
  const Texture texture{HoleArray{}};
  const Grid grid = patch_grid(texture, 128);
  const ContactKernel kernel(grid, kSkin);
  const Heightmap holes = generate(texture, grid);
  const ContactSolution s = solve_contact(kernel, holes.z, 0.4e6, {}, {});
  expect_sound(s, 0.4e6);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (holes.z[i] < -300e-9) {
      EXPECT_EQ(s.pressure[i], 0);
    }
  }
  EXPECT_NEAR(measure_area(kernel, s).raw, 1 - facts(texture).open_share.value(), 0.03);
}

TEST(HardContact, ASinglePixelCarriesTheWholeLoad) {
  const Grid grid = square(64);
  const ContactKernel kernel(grid, kSkin);
  std::vector<double> height(grid.size(), 0);
  height[grid.index(20, 30)] = 1e-6;
  const double load = 1e2;
  const ContactSolution s = solve_contact(kernel, height, load, {}, {});
  expect_sound(s, load);
  EXPECT_NEAR(s.pressure[grid.index(20, 30)], load * static_cast<double>(grid.size()), 1e-6);
  const ContactArea area = measure_area(kernel, s);
  EXPECT_GT(area.near_edge, 0);
  EXPECT_LT(area.near_edge, 2 * area.raw);
  EXPECT_GT(area.se, 0.2 * area.near_edge);  // a pixel is no measure of an area
}

TEST(HardContact, ZeroPreloadIsAStatus) {
  const Grid grid = square(64);
  const ContactKernel kernel(grid, kSkin);
  const ContactSolution s = solve_contact(kernel, rough(grid), 0, {}, {});
  EXPECT_EQ(s.status, ContactStatus::NoLoad);
  EXPECT_EQ(measure_area(kernel, s).raw, 0);
  for (double g : s.gap) ASSERT_TRUE(std::isfinite(g) && g >= 0);
}

TEST(HardContact, PreloadClosesEveryGap) {
  const Grid grid = square(64);
  const ContactKernel kernel(grid, kSkin);
  const ContactSolution s = solve_contact(kernel, rough(grid), 1e10, {}, {});
  expect_sound(s, 1e10);
  EXPECT_EQ(measure_area(kernel, s).raw, 1);
  EXPECT_EQ(*std::max_element(s.gap.begin(), s.gap.end()), 0);
}

TEST(HardContact, HardnessReachedEverywhereIsAnAnswerAndBeyondItAStatus) {
  const Grid grid = square(32);
  const ContactKernel kernel(grid, kSkin);
  const std::vector<double> height = rough(grid);
  const double hardness = 10e6;
  const ContactSolution near =
      solve_contact(kernel, height, 0.98 * hardness, {}, {.hardness = hardness});
  ASSERT_TRUE(near.converged()) << near.reason;
  EXPECT_NEAR(mean(near.pressure), 0.98 * hardness, 1e-9 * hardness);
  EXPECT_LE(*std::max_element(near.pressure.begin(), near.pressure.end()), hardness * (1 + 1e-12));
  const ContactSolution past =
      solve_contact(kernel, height, 1.01 * hardness, {}, {.hardness = hardness});
  EXPECT_EQ(past.status, ContactStatus::Invalid);
  EXPECT_FALSE(past.reason.empty());
}

TEST(HardContact, StiffnessRatiosAndPoissonAndLayerLimits) {
  const Grid grid = square(64);
  const std::vector<double> height = rough(grid);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const LayeredSolid& solid :
       {LayeredSolid{6e3, 0.3, 1e-6, 60e6, 0.3}, LayeredSolid{60e10, 0.3, 1e-6, 60e6, 0.3},
        LayeredSolid{66e6, 0.5, 1e-6, 60e6, 0.5}, LayeredSolid{66e6, 0.3, 0, 60e6, 0.3},
        LayeredSolid{66e6, 0.3, infinite, 60e6, 0.3}}) {
    const ContactKernel kernel(grid, solid);
    const ContactSolution s = solve_contact(kernel, height, 0.05e6, {}, {});
    expect_sound(s, 0.05e6);
  }
  // Both limits of the thickness are half-spaces.
  const ContactSolution bulk = solve_contact(ContactKernel(grid, {66e6, 0.3, 0, 60e6, 0.3}), height,
                                             0.4e6, {}, {.tolerance = 1e-9});
  const ContactSolution layer = solve_contact(ContactKernel(grid, {60e6, 0.3, infinite, 1e3, 0.3}),
                                              height, 0.4e6, {}, {.tolerance = 1e-9});
  EXPECT_NEAR(bulk.shift, layer.shift, 1e-6 * std::abs(bulk.shift));
}

TEST(HardContact, OddPrimeAndOblongGridsCarryTheirLoad) {
  for (const Grid& grid :
       {Grid{63, 63, 12e-6, 12e-6}, Grid{61, 67, 12e-6, 13e-6}, Grid{128, 30, 12e-6, 3e-6},
        Grid{2, 97, 0.2e-6, 12e-6}, Grid{1, 64, 0.2e-6, 12e-6}}) {
    const ContactKernel kernel(grid, kSkin);
    std::vector<double> height(grid.size());
    for (int ix = 0; ix < grid.nx; ++ix) {
      for (int iy = 0; iy < grid.ny; ++iy) {
        height[grid.index(ix, iy)] = 50e-9 * std::cos(2 * kPi * grid.y(iy) / grid.ly) +
                                     20e-9 * std::cos(2 * kPi * grid.x(ix) / grid.lx);
      }
    }
    expect_sound(solve_contact(kernel, height, 0.4e6, {}, {}), 0.4e6);
  }
}

TEST(HardContact, NumbersThatAreNoneAreAStatus) {
  const Grid grid = square(32);
  const ContactKernel kernel(grid, kSkin);
  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<double> height = rough(grid);
    height[5] = bad;
    EXPECT_EQ(solve_contact(kernel, height, 1e5, {}, {}).status, ContactStatus::Invalid) << bad;
    EXPECT_EQ(solve_contact(kernel, rough(grid), bad, {}, {}).status, ContactStatus::Invalid)
        << bad;
    std::vector<double> traction(grid.size(), 0);
    traction[9] = bad;
    EXPECT_EQ(solve_contact(kernel, rough(grid), 1e5, traction, {}).status, ContactStatus::Invalid)
        << bad;
  }
}

}  // namespace
}  // namespace papilla::tests::contact_test
