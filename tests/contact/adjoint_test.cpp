#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"

namespace papilla {
namespace {

// Central differences of solutions exact to rounding (sparse solver) along a random surface.
TEST(Adjoint, AgreesWithFiniteDifferencesOfPressureGapAndSmoothedArea) {
  const Grid grid{64, 64, 6e-6, 6e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  const Heightmap along = random_surface({1, 3e-6, 0.8, 4e-7}, grid, 1, 8);
  const ContactOptions exact{.tolerance = 1e-13, .method = ContactMethod::Sparse};
  const double load = 1e4, length = 5e-9, step = 1e-14;
  const ContactSolution s = solve_contact(*kernel, skin.z, load, {}, exact);
  ASSERT_EQ(s.method, ContactMethod::Sparse);
  const auto moved = [&](double t) {
    std::vector<double> h = skin.z;
    for (std::size_t i = 0; i < h.size(); ++i) h[i] += t * along.z[i];
    return solve_contact(*kernel, h, load, {}, exact);
  };
  const ContactSolution up = moved(step), down = moved(-step);
  std::vector<double> weight(grid.size()), mean_gap(grid.size(), 1.0 / 4096), area;
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = std::sin(0.37 * static_cast<double>(i));
  smoothed_area(s, length, &area);
  const auto expect = [&](const ContactAdjoint& adjoint, double high, double low,
                          const char* what) {
    EXPECT_TRUE(adjoint.converged) << what;
    double slope = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) slope += adjoint.by_height[i] * along.z[i];
    EXPECT_NEAR(slope, (high - low) / (2 * step), 1e-4 * std::abs(slope)) << what;
  };
  const auto weighted = [&](const ContactSolution& x) {
    double sum = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) sum += weight[i] * x.pressure[i];
    return sum;
  };
  const auto gap = [](const ContactSolution& x) {
    double sum = 0;
    for (double g : x.gap) sum += g / 4096;
    return sum;
  };
  expect(contact_adjoint(*kernel, s, weight, {}), weighted(up), weighted(down), "pressure");
  expect(contact_adjoint(*kernel, s, {}, mean_gap), gap(up), gap(down), "mean gap");
  expect(contact_adjoint(*kernel, s, {}, area), smoothed_area(up, length),
         smoothed_area(down, length), "smoothed area");
}

// Lifting the whole surface changes nothing but the rigid shift.
TEST(Adjoint, AUniformHeightChangesNothing) {
  const Grid grid{90, 75, 9e-6, 7e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 3e-7}, grid, 1, 0);
  for (double hardness : {0.0, 2e6}) {
    const ContactSolution s =
        solve_contact(*kernel, skin.z, 3e5, {}, {.tolerance = 1e-9, .hardness = hardness});
    ASSERT_TRUE(s.converged()) << s.reason;
    std::vector<double> area;
    smoothed_area(s, 1e-8, &area);
    const ContactAdjoint adjoint = contact_adjoint(*kernel, s, {}, area, hardness);
    ASSERT_TRUE(adjoint.converged);
    double sum = 0, size = 0;
    for (double v : adjoint.by_height) {
      sum += v;
      size += std::abs(v);
    }
    EXPECT_NEAR(sum, 0, 1e-9 * size);
  }
}

}  // namespace
}  // namespace papilla
