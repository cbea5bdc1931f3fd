// The compliance of a solid on a grid: its symbol, the influence of one pixel, the way back, the
// coarser kernels, on grids of either transform.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/convolution.h"
#include "physics/contact/contact.h"

namespace papilla::tests::kernel_test {
namespace {

const LayeredSolid kSolid{5e6, 0.3, 1e-7, 1e6, 0.45};

TEST(Kernel, DefaultsAreAnIncompressibleHalfSpaceOnARigidOne) {
  EXPECT_EQ(LayeredSolid{}, (LayeredSolid{1, 0.5, 0, 1, 0.5, 0, 0.4, kInfinity}));
  const ContactOptions options;
  EXPECT_EQ(options.tolerance, 1e-5);
  EXPECT_EQ(options.hardness, 0);
  EXPECT_EQ(options.max_iterations, 1000);
  EXPECT_EQ(options.method, ContactMethod::Auto);
  const ContactSolution none;
  EXPECT_EQ(none.status, ContactStatus::NotRun);
  EXPECT_FALSE(none.converged());
  EXPECT_TRUE(none.shift == 0 && none.certificate == 0 && none.iterations == 0 &&
              none.fft_pairs == 0 && none.elastic_energy == 0);
  const ContactArea area;
  EXPECT_TRUE(area.raw == 0 && area.perimeter == 0 && area.near_edge == 0 && area.se == 0);
}

TEST(Kernel, OnlyTwoStatesAreSolutions) {
  ContactSolution s;
  for (const auto& [status, solved] : {std::pair{ContactStatus::NotRun, false},
                                       {ContactStatus::Converged, true},
                                       {ContactStatus::Stagnated, false},
                                       {ContactStatus::IterationLimit, false},
                                       {ContactStatus::NoLoad, true},
                                       {ContactStatus::Invalid, false}}) {
    s.status = status;
    EXPECT_EQ(s.converged(), solved);
  }
}

double wave_number(const Grid& grid, int kx, int ky) {
  return 2 * kPi *
         std::hypot(std::min(kx, grid.nx - kx) / grid.lx, std::min(ky, grid.ny - ky) / grid.ly);
}

// Oblong grids: of the fast convolution, of the transforms, of odd sides.
class KernelOn : public ::testing::TestWithParam<Grid> {};

TEST_P(KernelOn, ItsSymbolIsTheComplianceOfEachWave) {
  const Grid grid = GetParam();
  const ContactKernel kernel(grid, kSolid);
  const auto half = static_cast<std::size_t>(grid.nx / 2 + 1);
  ASSERT_EQ(kernel.symbol().size(), half * static_cast<std::size_t>(grid.ny));
  EXPECT_EQ(kernel.symbol()[0], 0);
  for (int ky = 0; ky < grid.ny; ++ky) {
    for (int kx = 0; kx <= grid.nx / 2; ++kx) {
      if (kx + ky == 0) continue;
      const double c = compliance(kSolid, wave_number(grid, kx, ky));
      EXPECT_NEAR(
          kernel.symbol()[static_cast<std::size_t>(ky) * half + static_cast<std::size_t>(kx)],
          c / static_cast<double>(grid.size()), 1e-12 * c)
          << kx << " " << ky;
    }
  }
}

// A pixel's pressure as a sum of waves.
TEST_P(KernelOn, TheInfluenceOfAPixelIsTheSumOfItsWaves) {
  const Grid grid = GetParam();
  const ContactKernel kernel(grid, kSolid);
  const auto at = [&](int dx, int dy) {
    double sum = 0;
    for (int ky = 0; ky < grid.ny; ++ky) {
      for (int kx = 0; kx < grid.nx; ++kx) {
        if (kx + ky == 0) continue;
        sum += compliance(kSolid, wave_number(grid, kx, ky)) *
               std::cos(2 * kPi * (kx * dx / double(grid.nx) + ky * dy / double(grid.ny)));
      }
    }
    return sum / static_cast<double>(grid.size());
  };
  const double self = at(0, 0);
  EXPECT_NEAR(kernel.self_compliance(), self, 1e-11 * self);
  for (const auto& [dx, dy] : {std::pair{0, 0},
                               {1, 0},
                               {0, 1},
                               {3, 2},
                               {grid.nx - 1, 5},
                               {grid.nx / 2, grid.ny / 2},
                               {2, grid.ny - 1}})
    EXPECT_NEAR(kernel.influence(dx, dy), at(dx, dy), 1e-11 * self) << dx << " " << dy;
  // The farthest within near() pixels, and what is beyond.
  const int near_x = ContactKernel::near(grid.nx), near_y = ContactKernel::near(grid.ny);
  double beyond = 0;
  for (int dy = 0; dy < grid.ny; ++dy) {
    for (int dx = 0; dx < grid.nx; ++dx) {
      if (std::min(dx, grid.nx - dx) > near_x || std::min(dy, grid.ny - dy) > near_y)
        beyond = std::max(beyond, std::abs(kernel.influence(dx, dy)));
    }
  }
  EXPECT_EQ(kernel.influence_beyond(), beyond);
}

TEST_P(KernelOn, PressesWhatItDisplacesBack) {
  const Grid grid = GetParam();
  const ContactKernel kernel(grid, kSolid);
  RandomStream random(6, "pressures", 0);
  RealArray p(grid.size()), u(grid.size());
  double mean = 0;
  for (double& v : p) {
    v = random.uniform();
    mean += v / static_cast<double>(grid.size());
  }
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(p, u, scratch);
  // Displacements as a sum over pixels, at a few of them.
  for (const std::size_t i : {std::size_t{0}, grid.size() / 3, grid.size() - 1}) {
    const int ix = static_cast<int>(i) % grid.nx, iy = static_cast<int>(i) / grid.nx;
    double sum = 0;
    for (int jy = 0; jy < grid.ny; ++jy) {
      for (int jx = 0; jx < grid.nx; ++jx)
        sum += kernel.influence(wrap(ix - jx, grid.nx), wrap(iy - jy, grid.ny)) *
               p[grid.index(jx, jy)];
    }
    EXPECT_NEAR(u[i], sum, 1e-11 * kernel.self_compliance());
  }
  kernel.press(u, scratch);
  for (std::size_t i = 0; i < p.size(); ++i) ASSERT_NEAR(u[i], p[i] - mean, 1e-11) << i;
}

INSTANTIATE_TEST_SUITE_P(Grids, KernelOn,
                         ::testing::Values(Grid{48, 32, 5e-6, 3e-6}, Grid{20, 14, 2e-6, 1.5e-6},
                                           Grid{15, 33, 1.6e-6, 3e-6}));

TEST(Kernel, NearIsEightPixelsOrLessThanHalfOfAFewer) {
  for (const auto& [count, near] :
       {std::pair{1, 0}, {2, 0}, {3, 1}, {4, 1}, {5, 2}, {15, 7}, {16, 7}, {17, 8}, {1000, 8}})
    EXPECT_EQ(ContactKernel::near(count), near) << count;
}

TEST(Kernel, OfEvenSidesFromSixtyFourOnHasACoarserOne) {
  const auto coarse = [](int nx, int ny) {
    const Grid grid{nx, ny, 3e-6, 2e-6};
    const ContactKernel kernel(grid, kSolid);
    EXPECT_EQ(kernel.grid(), grid);
    EXPECT_EQ(kernel.solid(), kSolid);
    if (!kernel.coarse()) return false;
    EXPECT_EQ(kernel.coarse()->grid(), (Grid{nx / 2, ny / 2, 3e-6, 2e-6}));
    EXPECT_EQ(kernel.coarse()->solid(), kSolid);
    return true;
  };
  EXPECT_TRUE(coarse(64, 64));
  EXPECT_TRUE(coarse(64, 66));
  EXPECT_TRUE(coarse(130, 64));
  EXPECT_FALSE(coarse(62, 64));
  EXPECT_FALSE(coarse(64, 62));
  EXPECT_FALSE(coarse(65, 64));
  EXPECT_FALSE(coarse(64, 67));
}

TEST(Kernel, OfTheSameGridAndSolidIsTheSame) {
  const Grid grid{16, 16, 1e-6, 1e-6};
  const auto kernel = make_contact_kernel(grid, kSolid);
  EXPECT_EQ(make_contact_kernel(grid, kSolid), kernel);
  LayeredSolid softer = kSolid;
  softer.counter_modulus = 1e6;
  EXPECT_NE(make_contact_kernel(grid, softer), kernel);
  EXPECT_NE(make_contact_kernel({16, 16, 1e-6, 2e-6}, kSolid), kernel);
}

// The 64 used last are kept, and no more.
TEST(Kernel, IsForgottenAfterSixtyFourOthers) {
  const auto made = [](int k) {
    return make_contact_kernel({4, 4, 1e-6 * (2 + k), 1e-6}, {1, 0.25, 0, 1, 0.25});
  };
  const std::weak_ptr<const ContactKernel> first = made(0);
  for (int k = 1; k < 64; ++k) made(k);
  EXPECT_FALSE(first.expired());
  made(64);
  EXPECT_TRUE(first.expired());
}

// The transform's scratch where it is the faster one, else a half spectrum.
TEST(Kernel, ItsScratchIsThatOfItsTransform) {
  EXPECT_EQ(ContactKernel({48, 32, 1e-6, 1e-6}, kSolid).scratch_size(),
            Convolution(48, 32).scratch_size());
  EXPECT_EQ(ContactKernel({20, 14, 1e-6, 1e-6}, kSolid).scratch_size(), 11u * 14);
}

TEST(Compliance, NeedsAWave) {
  EXPECT_THROW(compliance(kSolid, 0), InternalError);
  EXPECT_THROW(compliance(kSolid, -1), InternalError);
}

// Waves long against the layer feel the bulk, short ones the layer; no thickness is the bulk alone.
TEST(Compliance, OfNoLayerOrADeepOneIsOfOneSolid) {
  LayeredSolid s = kSolid;
  s.layer_thickness = 0;
  EXPECT_DOUBLE_EQ(compliance(s, 1e6), 2 * (1 - square(0.45)) / (1e6 * 1e6));
  s.layer_thickness = kInfinity;
  EXPECT_DOUBLE_EQ(compliance(s, 1e6), 2 * (1 - square(0.3)) / (5e6 * 1e6));
  s.layer_thickness = 20e-6;  // 20 waves deep: to rounding
  EXPECT_NEAR(compliance(s, 1e6) * 1e6, 2 * (1 - square(0.3)) / 5e6, 1e-18);
}

// Eq. contact.9: a film of the counter-body on what is a thousand million times stiffer.
TEST(Compliance, OfACounterBodyIsThatOfAFilmOnARigidOne) {
  LayeredSolid s = kSolid;
  s.counter_modulus = 2e6, s.counter_poisson = 0.35, s.counter_thickness = 3e-7;
  for (const double q : {1e5, 3e6, 1e7}) {
    const double film = compliance({2e6, 0.35, 3e-7, 2e15, 0.35}, q);
    EXPECT_NEAR(compliance(s, q), compliance(kSolid, q) + film, 1e-12 * film) << q;
  }
  s.counter_modulus = 0;
  EXPECT_EQ(compliance(s, 1e6), compliance(kSolid, 1e6));
}

}  // namespace
}  // namespace papilla::tests::kernel_test
