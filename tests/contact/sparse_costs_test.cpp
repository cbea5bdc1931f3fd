// What light contact costs and where the sparse solver gives up: transforms are counted, and the
// field that is left out far from a small change is no more than what is stated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "physics/contact/solvers.h"

namespace papilla::tests::sparse_costs_test {
namespace {

const LayeredSolid kSolid{3e6, 0.4, 3e-7, 1e6, 0.45};
constexpr Grid kGrid{96, 72, 6e-6, 5.4e-6};  // oblong pixels

std::vector<double> rough(std::uint64_t index) {
  return random_surface({1e-7, 6e-6, 0.8, 1e-6}, kGrid, 1, index).z;
}

double deviation(const std::vector<double>& v) {
  double sum = 0, squares = 0;
  for (const double x : v) sum += x, squares += x * x;
  const auto n = static_cast<double>(v.size());
  return std::sqrt(squares / n - square(sum / n));
}

// Gaps of the pressure returned, by the sum of every pixel's influence.
std::vector<double> exact_gaps(const ContactKernel& kernel, const std::vector<double>& height,
                               const std::vector<double>& traction, const ContactSolution& s) {
  RealArray u(s.pressure.begin(), s.pressure.end());
  for (std::size_t i = 0; i < traction.size(); ++i) u[i] -= traction[i];
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(u, u, scratch);
  std::vector<double> gap;
  for (std::size_t i = 0; i < u.size(); ++i) gap.push_back(u[i] - height[i] - s.shift);
  return gap;
}

// Up to 3e-4 of the heights' deviation the far field of the whole load is left out: no transform.
TEST(SparseCosts, ALoadThatMovesNothingFarAwayNeedsNoTransform) {
  const ContactKernel kernel(kGrid, kSolid);
  const auto n = static_cast<double>(kGrid.size());
  int touching = 0;
  for (std::uint64_t k = 0; k < 12; ++k) {
    const std::vector<double> h = rough(k);
    const double most = 3e-4 * deviation(h) / kernel.influence_beyond();  // sum of pressures
    for (const double share : {0.3, 0.999, 1.001}) {
      const ContactSolution s = solve_contact(kernel, h, share * most / n, {}, {.tolerance = 1e-3});
      ASSERT_TRUE(s.converged()) << s.reason;
      ASSERT_EQ(s.method, ContactMethod::Sparse);
      EXPECT_EQ(s.fft_pairs, share > 1 ? 1 : 0) << k;
      const std::vector<double> exact = exact_gaps(kernel, h, {}, s);
      const double blur = share < 1 ? share * most * kernel.influence_beyond() : 1e-15;
      double load = 0, worst = 0;
      for (std::size_t i = 0; i < h.size(); ++i) {
        load += s.pressure[i];
        touching += s.pressure[i] > 0;
        ASSERT_NEAR(s.gap[i], s.pressure[i] > 0 ? 0 : exact[i], 1.0001 * blur) << k << " " << i;
        if (s.pressure[i] > 0) worst = std::max(worst, std::abs(exact[i]));
        ASSERT_GT(exact[i], -1.0001 * blur);
      }
      EXPECT_LT(worst, 1e-15);  // those that are solved are so exactly
      EXPECT_NEAR(load, share * most, 1e-9 * most);
    }
  }
  EXPECT_GT(touching, 36);
}

// A blunt tip in a wide, deep field: pixels join the set pass by pass, and the gaps about them are
// those of the pressures in the end.
TEST(SparseCosts, PixelsThatJoinLaterLeaveNothingBehindInTheGaps) {
  const ContactKernel kernel(kGrid, kSolid);
  const auto n = static_cast<double>(kGrid.size());
  for (const int at : {50, 2}) {  // within and across the border
    std::vector<double> h(kGrid.size());
    for (int iy = 0; iy < kGrid.ny; ++iy) {
      for (int ix = 0; ix < kGrid.nx; ++ix) {
        const double x = std::remainder(ix - at, 96), y = std::remainder(iy - at - 0.3, 72);
        h[kGrid.index(ix, iy)] = x * x + y * y < 200 ? -1e-11 * (x * x + 1.3 * y * y) : -1e-6;
      }
    }
    const double most = 3e-4 * deviation(h) / kernel.influence_beyond(), load = 0.9 * most;
    const ContactSolution s = solve_contact(kernel, h, load / n, {}, {.tolerance = 1e-3});
    ASSERT_TRUE(s.converged()) << s.reason;
    EXPECT_EQ(s.method, ContactMethod::Sparse);
    EXPECT_EQ(s.fft_pairs, 0);
    EXPECT_GT(s.iterations, 0);
    const std::vector<double> exact = exact_gaps(kernel, h, {}, s);
    const double blur = load * kernel.influence_beyond();
    double energy = 0, carried = 0;
    int touching = 0;
    for (std::size_t i = 0; i < h.size(); ++i) {
      ASSERT_NEAR(s.gap[i], s.pressure[i] > 0 ? 0 : exact[i], 1.0001 * blur) << i;
      energy += 0.5 * s.pressure[i] * (exact[i] + h[i] + s.shift) * kGrid.pixel_area();
      carried += s.pressure[i];
      touching += s.pressure[i] > 0;
    }
    EXPECT_GT(touching, 20);
    EXPECT_NEAR(carried, load, 1e-9 * load);
    EXPECT_NEAR(s.elastic_energy, energy, 1e-9 * energy);
  }
}

// A stamp of as many pixels as a factorisation is worth, the cube root of 100 n, and of one more.
TEST(SparseCosts, AStampOfMorePixelsThanTheLimitGoesToTheDenseSolver) {
  const Grid grid{64, 64, 6.4e-6, 6.4e-6};
  const auto kernel = make_contact_kernel(grid, kSolid);  // 74 of 4096
  for (const int pixels : {74, 75}) {
    std::vector<double> stamp(grid.size(), -1e-6);
    for (int k = 0; k < pixels; ++k) stamp[grid.index(20 + k % 9, 20 + k / 9)] = 0;
    const ContactSolution s =
        solve_contact(*kernel, stamp, 50, {}, {.tolerance = 1e-6, .method = ContactMethod::Sparse});
    ASSERT_TRUE(s.converged()) << s.reason;
    EXPECT_EQ(s.method, pixels == 74 ? ContactMethod::Sparse : ContactMethod::Dense) << pixels;
    EXPECT_EQ(std::count_if(s.pressure.begin(), s.pressure.end(), [](double p) { return p > 0; }),
              pixels);
  }
}

// From a nearby solution: a transform of the pressures, a quarter of one on half the pixels for the
// tractions.
TEST(SparseCosts, AWarmStateTakesOneTransformAndAQuarterUnderTractions) {
  const ContactKernel kernel(kGrid, kSolid);
  ASSERT_TRUE(kernel.coarse());
  for (std::uint64_t k = 0; k < 4; ++k) {
    const std::vector<double> h = rough(k);
    const ContactOptions options{.tolerance = 1e-4};
    const ContactSolution first = solve_contact(kernel, h, 300, {}, options);
    ASSERT_EQ(first.method, ContactMethod::Sparse);
    const ContactSolution more = solve_contact(kernel, h, 360, {}, options, &first);
    EXPECT_EQ(more.method, ContactMethod::Sparse);
    EXPECT_EQ(more.fft_pairs, 1) << k;
    std::vector<double> traction(kGrid.size());
    for (int iy = 0; iy < kGrid.ny; ++iy) {
      for (int ix = 0; ix < kGrid.nx; ++ix)
        traction[kGrid.index(ix, iy)] = 60 * (1 + std::sin(2 * kPi * ix / 96)) * iy / 72;
    }
    const ContactSolution pulled = solve_contact(kernel, h, 300, traction, options, &first);
    EXPECT_EQ(pulled.method, ContactMethod::Sparse);
    EXPECT_EQ(pulled.fft_pairs, 1.25) << k;
    const ContactSolution cold = solve_contact(kernel, h, 300, traction, options);
    EXPECT_EQ(cold.method, ContactMethod::Sparse);
    double most = 0, apart = 0;
    for (std::size_t i = 0; i < h.size(); ++i) {
      most = std::max(most, cold.pressure[i]);
      apart = std::max(apart, std::abs(cold.pressure[i] - pulled.pressure[i]));
    }
    EXPECT_LT(apart, 1e-2 * most) << k;
    const std::vector<double> exact = exact_gaps(kernel, h, traction, pulled);
    for (std::size_t i = 0; i < h.size(); ++i)
      ASSERT_NEAR(pulled.gap[i], pulled.pressure[i] > 0 ? 0 : std::max(0.0, exact[i]),
                  3.1e-4 * deviation(h));
  }
}

// Without a coarser grid the tractions are met from the pressures of the start.
TEST(SparseCosts, WithoutACoarserGridTheStartsPressuresAreGoneOnFrom) {
  const Grid grid{60, 50, 6e-6, 5.4e-6};
  const ContactKernel kernel(grid, kSolid);
  ASSERT_FALSE(kernel.coarse());
  const std::vector<double> h = random_surface({1e-7, 6e-6, 0.8, 1e-6}, grid, 1, 2).z;
  std::vector<double> traction(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      traction[grid.index(ix, iy)] = 60 * (1 + std::sin(2 * kPi * ix / 60)) * iy / 50;
  }
  const ContactSolution first = solve_contact(kernel, h, 300, {}, {.tolerance = 1e-6});
  ASSERT_EQ(first.method, ContactMethod::Sparse);
  const ContactSolution warm = solve_contact(kernel, h, 300, traction, {.tolerance = 1e-6}, &first);
  ASSERT_EQ(warm.method, ContactMethod::Sparse);
  EXPECT_EQ(warm.fft_pairs, 2);  // of those pressures, and of what the tractions make of them
  const ContactSolution dense =
      solve_contact(kernel, h, 300, traction, {.tolerance = 1e-12, .method = ContactMethod::Dense});
  double most = 0, apart = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    most = std::max(most, dense.pressure[i]);
    apart = std::max(apart, std::abs(dense.pressure[i] - warm.pressure[i]));
  }
  EXPECT_LT(apart, 1e-2 * most);
  EXPECT_NEAR(warm.shift, dense.shift, 3e-4 * deviation(h));
  EXPECT_NEAR(warm.elastic_energy, dense.elastic_energy, 1e-3 * dense.elastic_energy);
  // Without tractions the pressures are found before the transform.
  const ContactSolution more = solve_contact(kernel, h, 330, {}, {.tolerance = 1e-6}, &first);
  EXPECT_EQ(more.method, ContactMethod::Sparse);
  EXPECT_EQ(more.fft_pairs, 1);
}

}  // namespace
}  // namespace papilla::tests::sparse_costs_test
