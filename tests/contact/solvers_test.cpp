// The sparse and the dense solver, load and approach control, the hardness cap, warm starts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"

namespace papilla::tests::solvers_test {
namespace {

// The paper's uniform preload: light contact, 2-4e-4 of the patch.
struct Light {
  Grid grid{256, 256, 12e-6, 12e-6};
  std::shared_ptr<const ContactKernel> kernel =
      make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  Heightmap skin(std::uint64_t index) const {
    return random_surface({330e-9, 12e-6, 0.8, 50e-9}, grid, 3, index);
  }
};

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += square(a[i] - b[i]);
    norm += square(b[i]);
  }
  return std::sqrt(squares / norm);
}

TEST(Sparse, LightContactIsSolvedToRoundingInFewPairs) {
  const Light light;
  for (std::uint64_t k = 0; k < 3; ++k) {
    const Heightmap skin = light.skin(k);
    for (double load : {5e3, 15e3, 30e3}) {
      const ContactSolution s = solve_contact(*light.kernel, skin.z, load, {}, {.tolerance = 1e-8});
      EXPECT_EQ(s.method, ContactMethod::Sparse);
      EXPECT_TRUE(s.converged()) << s.reason;
      EXPECT_LE(s.fft_pairs, 2);
      const ContactSolution dense = solve_contact(
          *light.kernel, skin.z, load, {}, {.tolerance = 1e-11, .method = ContactMethod::Dense});
      EXPECT_EQ(dense.method, ContactMethod::Dense);
      EXPECT_TRUE(dense.converged()) << dense.reason;
      EXPECT_LT(difference(s.pressure, dense.pressure), 1e-4);
      EXPECT_EQ(measure_area(*light.kernel, s).raw, measure_area(*light.kernel, dense).raw);
      EXPECT_NEAR(s.elastic_energy, dense.elastic_energy, 1e-7 * dense.elastic_energy);
      const ContactSolution more =
          solve_contact(*light.kernel, skin.z, 1.1 * load, {}, {.tolerance = 1e-8}, &s);
      EXPECT_EQ(more.method, ContactMethod::Sparse);
      EXPECT_LE(more.fft_pairs, 2);
    }
  }
}

// Sum of p v less the least that the load could do, from the pressure and the tractions alone.
double certificate(const ContactKernel& kernel, const std::vector<double>& height,
                   const std::vector<double>& traction, const ContactSolution& s) {
  RealArray u(s.pressure.begin(), s.pressure.end());
  for (std::size_t i = 0; i < traction.size(); ++i) u[i] -= traction[i];
  SpectrumArray scratch(kernel.scratch_size());
  kernel.displace(u, u, scratch);
  double work = 0, load = 0, low = kInfinity, squares = 0;
  const double level = mean(height);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double v = u[i] - height[i];
    work += s.pressure[i] * v;
    load += s.pressure[i];
    low = std::min(low, v);
    squares += square(height[i] - level);
    // The gap returned is that of the pressure returned.
    EXPECT_NEAR(s.gap[i], s.pressure[i] > 0 ? 0 : std::max(0.0, v - s.shift), 3e-10);
  }
  return (work - low * load) / (load * std::sqrt(squares / static_cast<double>(u.size())));
}

TEST(Sparse, StatesUnderTractionsTakeOnePairOfTheirOwnGridAndAreCertified) {
  const Light light;
  const Heightmap skin = light.skin(0);
  const ContactOptions options{.tolerance = 1e-8};
  const ContactSolution dry = solve_contact(*light.kernel, skin.z, 15e3, {}, options);
  ContactSolution previous = dry;
  double pairs = 0;
  for (int k = 1; k <= 6; ++k) {
    std::vector<double> traction(light.grid.size());
    for (std::size_t i = 0; i < traction.size(); ++i) {
      traction[i] = (dry.gap[i] < 20e-9 * k ? 4.6e6 / k : 0) + 4e-9 / square(dry.gap[i] + 128e-9);
    }
    const ContactSolution s =
        solve_contact(*light.kernel, skin.z, 15e3, traction, options, &previous);
    EXPECT_EQ(s.method, ContactMethod::Sparse);
    EXPECT_TRUE(s.converged()) << s.reason;
    EXPECT_LE(certificate(*light.kernel, skin.z, traction, s), s.certificate + 1e-12);
    const ContactSolution dense =
        solve_contact(*light.kernel, skin.z, 15e3, traction,
                      {.tolerance = 1e-11, .method = ContactMethod::Dense}, &previous);
    EXPECT_NEAR(certificate(*light.kernel, skin.z, traction, dense), dense.certificate, 1e-13);
    EXPECT_LT(difference(s.pressure, dense.pressure), 1e-4);
    EXPECT_NEAR(s.elastic_energy, dense.elastic_energy, 1e-6 * dense.elastic_energy);
    pairs += s.fft_pairs;
    previous = s;
  }
  EXPECT_LE(pairs, 10);
}

// Pixels, sides and tractions that differ along x and y: rows are not taken for columns.
TEST(Sparse, OnOblongPixelsItIsTheDenseSolution) {
  const Grid grid{160, 96, 12e-6, 9e-6};
  const auto kernel = make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  const Heightmap skin = random_surface({330e-9, 12e-6, 0.8, 100e-9}, grid, 3, 2);
  std::vector<double> traction(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      traction[grid.index(ix, iy)] = 8e3 * (1 + std::sin(2 * kPi * ix / grid.nx)) * iy / grid.ny;
  }
  const ContactOptions tight{.tolerance = 1e-11, .method = ContactMethod::Dense};
  ContactSolution previous = solve_contact(*kernel, skin.z, 15e3, {}, {.tolerance = 1e-8});
  EXPECT_EQ(previous.method, ContactMethod::Sparse);
  EXPECT_LT(difference(previous.pressure, solve_contact(*kernel, skin.z, 15e3, {}, tight).pressure),
            1e-4);
  const ContactSolution warm =
      solve_contact(*kernel, skin.z, 15e3, traction, {.tolerance = 1e-8}, &previous);
  EXPECT_EQ(warm.method, ContactMethod::Sparse);
  const ContactSolution dense = solve_contact(*kernel, skin.z, 15e3, traction, tight);
  EXPECT_LT(difference(warm.pressure, dense.pressure), 1e-4);
  EXPECT_LT(difference(warm.gap, dense.gap), 1e-6);
  EXPECT_NEAR(warm.shift, dense.shift, 1e-6 * std::abs(dense.shift));
  EXPECT_NEAR(mean(warm.pressure), 15e3 + mean(traction), 1e-6 * 15e3);
}

// Heights that are no numbers, of another grid, and approaches that do not exist.
TEST(Approach, WhatHasNoSolutionIsInvalid) {
  const Grid grid{32, 32, 6e-6, 6e-6};
  const auto kernel = make_contact_kernel(grid, {1e6, 0.5, 0, 1e6, 0.5});
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  const auto status = [&](const std::vector<double>& height, double approach) {
    return solve_approach(*kernel, height, approach, {}).status;
  };
  EXPECT_EQ(status(skin.z, 5e-8), ContactStatus::Converged);
  std::vector<double> broken = skin.z, shorter = skin.z;
  broken[7] = std::nan("");
  shorter.pop_back();
  EXPECT_EQ(status(broken, 5e-8), ContactStatus::Invalid);
  EXPECT_EQ(status(shorter, 5e-8), ContactStatus::Invalid);
  EXPECT_EQ(status(skin.z, std::nan("")), ContactStatus::Invalid);
  EXPECT_EQ(status(skin.z, -1e-9), ContactStatus::NoLoad);  // they do not touch yet
  EXPECT_EQ(status(skin.z, 1e-5), ContactStatus::Invalid);  // beyond full contact
}

TEST(Sparse, FallsBackToTheDenseSolverWhereMuchTouches) {
  const Grid grid{64, 64, 6e-6, 6e-6};
  const auto kernel = make_contact_kernel(grid, {1e6, 0.5, 0, 1e6, 0.5});
  const ContactOptions sparse{.tolerance = 1e-6, .method = ContactMethod::Sparse};
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  for (double load : {1e3, 1e4, 1e5}) {
    const ContactSolution s = solve_contact(*kernel, skin.z, load, {}, sparse);
    EXPECT_TRUE(s.converged()) << s.reason;
    EXPECT_NEAR(mean(s.pressure), load, 1e-9 * load);
  }
  const std::vector<double> flat(grid.size(), 0.0);
  EXPECT_TRUE(solve_contact(*kernel, flat, 1e4, {}, sparse).converged());
}

// A start far from the solution cuts most of the first step.
TEST(Dense, WarmStartsFarAwayConverge) {
  const Grid grid{128, 128, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  for (std::uint64_t k = 0; k < 4; ++k) {
    const Heightmap skin = random_surface({330e-9, 12e-6, 0.8, 1e-7}, grid, 3, k);
    const ContactOptions dense{.tolerance = 1e-8, .method = ContactMethod::Dense};
    const ContactSolution low = solve_contact(*kernel, skin.z, 150e3, {}, dense);
    for (double factor : {0.02, 0.5, 2.0, 20.0}) {
      const ContactSolution s = solve_contact(*kernel, skin.z, factor * 150e3, {}, dense, &low);
      EXPECT_TRUE(s.converged()) << factor << " " << s.reason;
      EXPECT_LT(s.iterations, 60);
    }
  }
}

// Beyond a third of the pixels the solver works on whole fields instead of lists.
TEST(Dense, ContactOfMostOfTheSurfaceIsCertifiedOnItsPressure) {
  const Grid grid{128, 96, 12e-6, 9e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 0);
  std::vector<double> disc(grid.size(), 0.0);
  for (std::size_t i = 0; i < disc.size(); ++i) {
    const int ix = static_cast<int>(i) % grid.nx, iy = static_cast<int>(i) / grid.nx;
    if (std::hypot(grid.x(ix) - 4e-6, grid.y(iy) - 5e-6) < 3e-6) disc[i] = 3e6;
  }
  for (double load : {7e6, 14e6}) {
    for (const std::vector<double>& traction : {std::vector<double>{}, disc}) {
      const ContactOptions options{.tolerance = 1e-9, .method = ContactMethod::Dense};
      const ContactSolution s = solve_contact(*kernel, skin.z, load, traction, options);
      ASSERT_TRUE(s.converged()) << load << " " << s.reason;
      EXPECT_GT(measure_area(*kernel, s).raw, 0.35);
      EXPECT_LT(certificate(*kernel, skin.z, traction, s), 1.01e-9);
      EXPECT_NEAR(mean(s.pressure), load + (traction.empty() ? 0 : mean(disc)), 1e-9 * load);
      const double peak = *std::max_element(s.pressure.begin(), s.pressure.end());
      const ContactSolution soft = solve_contact(
          *kernel, skin.z, load, traction,
          {.tolerance = 1e-9, .hardness = 0.4 * peak, .method = ContactMethod::Dense});
      ASSERT_TRUE(soft.converged()) << load << " " << soft.reason;
      EXPECT_LE(*std::max_element(soft.pressure.begin(), soft.pressure.end()), 0.4 * peak);
      EXPECT_NEAR(mean(soft.pressure), mean(s.pressure), 1e-9 * load);
    }
  }
}

TEST(Dense, PrimeAndNarrowGridsConverge) {
  for (const Grid& grid : {Grid{97, 61, 9e-6, 6e-6}, Grid{127, 127, 12e-6, 12e-6},
                           Grid{200, 3, 12e-6, 2e-7}, Grid{1, 64, 1e-7, 6e-6}}) {
    const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
    const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 3e-7}, grid, 1, 0);
    const ContactSolution s = solve_contact(*kernel, skin.z, 2e5, {},
                                            {.tolerance = 1e-8, .method = ContactMethod::Dense});
    EXPECT_TRUE(s.converged()) << grid.nx << " " << grid.ny << " " << s.reason;
  }
}

TEST(Approach, GivesTheLoadThatGivesTheApproach) {
  const Grid grid{96, 80, 9e-6, 8e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  const double top = *std::max_element(skin.z.begin(), skin.z.end());
  for (double load : {1e4, 3e5, 3e6}) {
    const ContactSolution by_load = solve_contact(*kernel, skin.z, load, {}, {.tolerance = 1e-10});
    const ContactSolution s =
        solve_approach(*kernel, skin.z, by_load.shift + top, {.tolerance = 1e-10});
    ASSERT_TRUE(s.converged()) << load << " " << s.reason;
    EXPECT_NEAR(mean(s.pressure), load, 1e-4 * load);
    EXPECT_LT(difference(s.pressure, by_load.pressure), 1e-3);
  }
  EXPECT_EQ(solve_approach(*kernel, skin.z, -1e-9, {}).status, ContactStatus::NoLoad);
  EXPECT_EQ(solve_approach(*kernel, skin.z, top + 1e-9, {}).status, ContactStatus::Invalid);
}

// Below a hardness as well: on one grid, from coarser ones, and from the state of a harder solid,
// which start beyond it.
TEST(Approach, BelowAHardnessGivesTheLoadThatGivesTheApproach) {
  const double top = 1e-7, load = 75e3;
  const ContactOptions soft{.tolerance = 1e-11, .hardness = 0.5e6};
  for (const int n : {32, 128}) {
    const Grid grid{n, n, 12e-6, 12e-6};
    const auto kernel = make_contact_kernel(grid, {53e6, 0, 0, 53e6, 0});
    std::vector<double> height;
    for (int i = 0; i < n * n; ++i)
      height.push_back(top * std::cos(2 * kPi * (i % n) / n) * std::cos(2 * kPi * (i / n) / n));
    const ContactSolution by_load = solve_contact(*kernel, height, load, {}, soft);
    ASSERT_TRUE(by_load.converged()) << n << " " << by_load.reason;
    const double approach = by_load.shift + top;
    const ContactSolution hard = solve_approach(*kernel, height, approach, {.tolerance = 1e-11});
    EXPECT_GT(*std::max_element(hard.pressure.begin(), hard.pressure.end()), 2 * soft.hardness);
    for (const ContactSolution* start : {static_cast<const ContactSolution*>(nullptr), &hard}) {
      const ContactSolution s = solve_approach(*kernel, height, approach, soft, start);
      EXPECT_EQ(s.status, ContactStatus::Converged) << n << " " << s.reason;
      EXPECT_NEAR(mean(s.pressure), load, 1e-6 * load) << n;
      EXPECT_LT(difference(s.pressure, by_load.pressure), 1e-6) << n;
    }
    EXPECT_EQ(solve_approach(*kernel, height, 50e-9, soft).status, ContactStatus::Converged) << n;
    // What no pressure reaches changes nothing.
    const ContactSolution harder =
        solve_approach(*kernel, height, approach, {.tolerance = 1e-11, .hardness = 1e12});
    EXPECT_EQ(harder.status, ContactStatus::Converged) << n << " " << harder.reason;
    EXPECT_LT(difference(harder.pressure, hard.pressure), 1e-6) << n;
  }
}

// A thin compressible layer on a rigid base is a bed of springs of stiffness
// E (1-n) / ((1+n)(1-2n) d).
TEST(Approach, ThinLayerOnARigidBaseIsABedOfSprings) {
  const double wave = 1e-4, d = 2e-7, amplitude = 1e-9;
  const Grid grid{256, 8, wave, wave / 32};
  const auto kernel = make_contact_kernel(grid, {1e6, 0.3, d, 1e16, 0.3});
  std::vector<double> height(grid.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = amplitude * std::cos(2 * kPi * grid.x(static_cast<int>(i) % 256) / wave);
  }
  const double stiffness = 1e6 * 0.7 / (1.3 * 0.4 * d);
  const ContactSolution s =
      solve_contact(*kernel, height, 0.1 * stiffness * amplitude, {}, {.tolerance = 1e-9});
  ASSERT_TRUE(s.converged()) << s.reason;
  // The periodic kernel has no mean displacement: p = k (h + level) with some level, in contact.
  const double level = s.pressure[0] / stiffness - height[0];
  double largest = 0;
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double spring = stiffness * std::max(0.0, height[i] + level);
    largest = std::max(largest, std::abs(s.pressure[i] - spring));
  }
  EXPECT_LT(largest, 0.02 * s.pressure[0]);
}

TEST(Hardness, ASoftSurfaceFlowsUntilItsAreaCarriesTheLoad) {
  const Grid grid{128, 128, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 60e6, 0.5});
  const Heightmap skin = random_surface({256e-9, 3.7e-6, 0.8, 2e-7}, grid, 1, 0);
  const ContactSolution elastic = solve_contact(*kernel, skin.z, 7e5, {}, {.tolerance = 1e-7});
  const double peak = *std::max_element(elastic.pressure.begin(), elastic.pressure.end());
  double previous = measure_area(*kernel, elastic).raw;
  for (double hardness : {10 * peak, 0.5 * peak, 0.1 * peak, 0.05 * peak}) {
    const ContactSolution s =
        solve_contact(*kernel, skin.z, 7e5, {}, {.tolerance = 1e-7, .hardness = hardness});
    ASSERT_TRUE(s.converged()) << hardness / peak << " " << s.reason;
    EXPECT_LE(s.certificate, 1e-7);
    EXPECT_NEAR(mean(s.pressure), 7e5, 1e-6 * 7e5);
    EXPECT_LE(*std::max_element(s.pressure.begin(), s.pressure.end()), hardness);
    const double area = measure_area(*kernel, s).raw;
    EXPECT_GE(area, 0.999 * previous);
    EXPECT_GE(area, 7e5 / hardness);
    previous = area;
  }
  EXPECT_NEAR(previous, 7e5 / (0.05 * peak), 0.15 * previous);  // nearly all of it flows
}

// Most of what is pressed is at the cap: the gap hangs on the few pixels that are not.
TEST(Hardness, AWarmStartHasTheGapOfAColdOne) {
  const Grid grid{64, 64, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {3e9, 0.4, 0, 3e9, 0.4});
  const Heightmap skin = random_surface({100e-9, 5e-6, 0.8, 4e-7}, grid, 1, 0);
  for (const double hardness : {0.15e9, 0.3e9}) {
    const auto solved = [&](double load, double tolerance, double cap,
                            const ContactSolution* start) {
      return solve_contact(*kernel, skin.z, load, {}, {.tolerance = tolerance, .hardness = cap},
                           start);
    };
    const double load = 114e6;
    const double exact = mean(solved(load, 1e-9, hardness, nullptr).gap);
    for (const double tolerance : {1e-3, 1e-5}) {
      const ContactSolution cold = solved(load, tolerance, hardness, nullptr);
      const ContactSolution again = solved(load, tolerance, hardness, &cold);
      EXPECT_LT(difference(again.pressure, cold.pressure), 1e-9) << hardness;
      EXPECT_NEAR(mean(again.gap), mean(cold.gap), 1e-9 * exact) << hardness;
      for (const double factor : {0.9, 0.99, 1.01, 1.1}) {
        for (const double softer : {1.0, factor}) {  // of the hardness alike, as skin softens
          const ContactSolution near = solved(factor * load, tolerance, softer * hardness, nullptr);
          const ContactSolution warm = solved(load, tolerance, hardness, &near);
          ASSERT_TRUE(warm.converged()) << warm.reason;
          EXPECT_NEAR(mean(warm.gap), exact, (tolerance > 1e-4 ? 0.04 : 0.01) * exact)
              << hardness << " " << tolerance << " " << factor << " " << softer;
        }
      }
    }
  }
}

}  // namespace
}  // namespace papilla::tests::solvers_test
