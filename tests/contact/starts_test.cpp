// Where solves start from: the pixels that are watched, the coarser grid, the preconditioner.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/contact/candidates.h"
#include "physics/contact/solvers.h"

namespace papilla::tests::starts_test {
namespace {

using namespace papilla::contact;

const LayeredSolid kHalfSpace{1e6, 0, 0, 1e6, 0};  // E* = 1 MPa

// A roof that falls from its ridge by `slope` to either side along y.
RealArray roof(const Grid& grid, double slope) {
  RealArray gap(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      gap[grid.index(ix, iy)] = slope * grid.dy() * std::min(iy, grid.ny - iy);
  }
  return gap;
}

// Four times the 2 p / (E* slope) of Persson and Bush, each in pixels.
TEST(Candidates, OfARoofAreTheLowestFourTimesTheExpectedContact) {
  const Grid grid{64, 48, 8e-6, 9e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  for (const double slope : {0.1, 0.4}) {
    const RealArray gap = roof(grid, slope);
    std::vector<double> height(gap.begin(), gap.end());
    for (double& h : height) h = -h;
    // The difference across the period's end is left out along x, where the roof is level.
    const double rms = slope * std::sqrt(63.0 / 64);
    StandardProblem problem{kernel, height, {}, 1, 100.5 * 1e6 * rms / 8};
    const auto watched = watch_lowest(problem, gap, {1000, false});
    ASSERT_TRUE(watched);
    ASSERT_EQ(watched->size(), 100u);
    for (std::size_t k = 0; k < 100; ++k) {
      EXPECT_LE(gap[static_cast<std::size_t>((*watched)[k].first)],
                slope * grid.dy() * (1 + 1e-12));  // 64 of the ridge and 36 beside it
      EXPECT_EQ((*watched)[k].second, k <= 50);
    }
    EXPECT_TRUE(watch_lowest(problem, gap, {51, false}));
    EXPECT_FALSE(watch_lowest(problem, gap, {50, false}));
    EXPECT_EQ(watch_lowest(problem, gap, {50, true})->size(), 100u);
    EXPECT_EQ(watch_lowest(problem, gap, {30, true})->size(), 60u);
    problem.load *= 0.01;
    EXPECT_EQ(watch_lowest(problem, gap, {1000, false})->size(), 16u);  // never fewer
  }
}

TEST(Candidates, NearASolutionAreThreeTimesItsContactAndMoreUnderMoreLoad) {
  const Grid grid{64, 48, 8e-6, 9e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  const RealArray gap = roof(grid, 0.1);
  ContactSolution start;
  start.gap.assign(gap.begin(), gap.end());
  start.pressure.assign(grid.size(), 0.0);
  for (int ix = 0; ix < 20; ++ix) start.pressure[grid.index(ix, 0)] = 5;
  std::vector<double> height(grid.size(), 0.0);
  for (const double more : {0.5, 1.0, 1.55}) {
    const StandardProblem problem{kernel, height, {}, 1, more * 100};
    const auto watched = watch_near(problem, start, {200, false});
    ASSERT_TRUE(watched);
    ASSERT_EQ(watched->size(), more > 1 ? 93u : 60u);
    for (const auto& [pixel, touches] : *watched) EXPECT_EQ(touches, pixel < 20);
    EXPECT_FALSE(watch_near(problem, start, {29, false}));
  }
  start.pressure.assign(grid.size(), 0.0);
  EXPECT_FALSE(watch_near({kernel, height, {}, 1, 100}, start, {200, true}));
}

// Contact of a wave's crests is found on half the pixels already, and its load is that of the
// finer grid.
TEST(NestedStart, IsNearlyTheSolution) {
  const Grid grid{128, 64, 2e-6, 1e-6};
  const auto kernel = make_contact_kernel(grid, kHalfSpace);
  ASSERT_TRUE(kernel->coarse());
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      height[grid.index(ix, iy)] =
          1e-8 * std::cos(2 * kPi * grid.x(ix) / 1e-6) * std::cos(2 * kPi * grid.y(iy) / 1e-6);
  }
  const double mean = 8e3;
  const StandardProblem problem{*kernel, height, {}, 5e-9, mean * 8192};
  RealArray gap(grid.size());
  for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = -height[i];
  double pairs = 0;
  const std::vector<double> start = nested_start(problem, gap, 1e-6, pairs);
  EXPECT_GT(pairs, 0);
  const ContactSolution s = solve_contact(*kernel, height, mean, {}, {.tolerance = 1e-8});
  ASSERT_TRUE(s.converged());
  double load = 0, off = 0, all = 0;
  for (int iy = 0; iy < 64; iy += 2) {
    for (int ix = 0; ix < 128; ix += 2) {
      double here = 0, exact = 0;  // of the four that are one on the coarser grid
      for (int k = 0; k < 4; ++k) {
        const std::size_t i = grid.index(ix + k % 2, iy + k / 2);
        here += start[i];
        exact += s.pressure[i];
      }
      load += here / 8192;
      off += square(here - exact);
      all += square(exact);
    }
  }
  EXPECT_NEAR(load, mean, 1e-6 * mean);
  EXPECT_LT(std::sqrt(off / all), 0.2);
}

// The pressure that displaces one pixel alone, as a sum over the waves; each pixel stands in the
// table once, also where the grid is smaller than it.
TEST(Kernel, ThePreconditionersTableIsTheInverseOfTheComplianceAndHoldsNoPixelTwice) {
  const LayeredSolid solid{5e6, 0.3, 1e-7, 1e6, 0.45};
  for (const Grid& grid : {Grid{6, 9, 6e-7, 1.1e-6}, Grid{20, 12, 2e-6, 1e-6}}) {
    const ContactKernel kernel(grid, solid);
    const auto in_table = [](int d, int count) { return 2 * d < count + 1 && 2 * d > -count; };
    const auto at = [&](int dx, int dy) {
      double sum = 0;
      for (int ky = 0; ky < grid.ny; ++ky) {
        for (int kx = 0; kx < grid.nx; ++kx) {
          if (kx == 0 && ky == 0) continue;
          const double q = 2 * kPi *
                           std::hypot(std::min(kx, grid.nx - kx) / grid.lx,
                                      std::min(ky, grid.ny - ky) / grid.ly);
          sum += std::cos(2 * kPi * (kx * dx / double(grid.nx) + ky * dy / double(grid.ny))) /
                 compliance(solid, q);
        }
      }
      return sum / square(static_cast<double>(grid.size())) * static_cast<double>(grid.size());
    };
    const double self = at(0, 0);
    for (int dy = -ContactKernel::kReach; dy <= ContactKernel::kReach; ++dy) {
      for (int dx = -ContactKernel::kReach; dx <= ContactKernel::kReach; ++dx) {
        const bool held = in_table(dx, grid.nx) && in_table(dy, grid.ny);
        EXPECT_NEAR(kernel.stencil().weight(dx, dy), held ? at(dx, dy) : 0, 1e-6 * self)
            << dx << " " << dy;
      }
    }
  }
}

// Farther than `near` pixels no pixel is moved more than influence_beyond says, and one is by it.
TEST(Kernel, TheInfluenceBeyondIsTheLargestFarAway) {
  const Grid grid{40, 24, 4e-6, 3e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  double most = 0;
  for (int dy = 0; dy < grid.ny; ++dy) {
    for (int dx = 0; dx < grid.nx; ++dx) {
      if (std::min(dx, 40 - dx) > 8 || std::min(dy, 24 - dy) > 8)
        most = std::max(most, std::abs(kernel.influence(dx, dy)));
    }
  }
  EXPECT_EQ(kernel.influence_beyond(), most);
  EXPECT_EQ(ContactKernel::near(16), 7);
  EXPECT_EQ(ContactKernel::near(17), 8);
}

}  // namespace
}  // namespace papilla::tests::starts_test
