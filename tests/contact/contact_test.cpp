#include "physics/contact/contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/roughness.h"
#include "physics/contact/facts.h"

namespace papilla::tests::contact_test {
namespace {

const LayeredSolid kHalfSpace{1e6, 0, 0, 1e6, 0};

// Samples of C q checked against an independent ODE propagator (knowledge: contact-peers 3.7).
TEST(Compliance, LayeredKernelMatchesThePropagatorSamples) {
  struct Case {
    double e1, n1, e2, n2;
    double values[5];
  };
  const double qd[5] = {0.1, 0.5, 1, 2, 5};
  for (const Case& c :
       {Case{1, .3, 10, .2, {.259183133, .5296501476, .8748552924, 1.441113552, 1.815105603}},
        Case{10, .3, 1, .49, {1.518231163, 1.266709625, .6935605056, .2742359927, .1827980901}},
        Case{.1, .45, 1, .3, {2.000274167, 3.25969899, 6.005739596, 11.56354226, 15.8877074}}}) {
    for (int i = 0; i < 5; ++i) {
      const LayeredSolid s{c.e1, c.n1, 1, c.e2, c.n2};
      EXPECT_NEAR(compliance(s, qd[i]) * qd[i], c.values[i], 6e-10 * c.values[i]);
    }
  }
}

// The same layer as six numbers: displacements (u, w) = the plane-strain solutions e^(-qz), z
// e^(-qz), e^(qz), z e^(qz) in the layer and the first two below, joined at z = d, under a unit
// pressure wave.
double solved_layer(const LayeredSolid& s, double q) {
  using Real = long double;
  const Real x = static_cast<Real>(q) * s.layer_thickness;
  const auto shear = [](Real e, Real n) { return e / (2 * (1 + n)); };
  // With e the sign of the exponent and lengths in 1/q: w = (a + b z) exp(e z), from equilibrium
  // u = -e (a + b (z + e (3 - 4 nu))) exp(e z) of a field (u sin, w cos), stresses over 2 G q.
  struct Column {
    Real u, w, normal, tangential;
  };
  const auto columns = [](Real n, Real e, Real z, bool times_z, Real g) {
    const Real f = std::exp(e * z), k = 3 - 4 * n;
    Column c{};
    const Real u = times_z ? -e * z - k : -e, w = times_z ? z : 1;
    const Real du = times_z ? -e - e * (e * z + k) : -1, dw = times_z ? 1 + e * z : e;
    c.u = u * f;
    c.w = w * f;
    const Real strain_x = u, strain_z = dw;  // of u sin(x): u cos(x)
    c.normal = 2 * g * (strain_z + n / (1 - 2 * n) * (strain_x + strain_z)) * f;
    c.tangential = g * (du - w) * f;
    return c;
  };
  const Real n1 = s.layer_poisson, n2 = s.bulk_poisson;
  const Real g1 = shear(s.layer_modulus, n1), g2 = shear(s.bulk_modulus, n2);
  Real m[6][7] = {};
  int col = 0;
  for (Real e : {Real(-1), Real(1)}) {
    for (bool times_z : {false, true}) {
      const Column top = columns(n1, e, 0, times_z, g1), low = columns(n1, e, x, times_z, g1);
      const Real rows[6] = {top.normal, top.tangential, low.u, low.w, low.normal, low.tangential};
      for (int r = 0; r < 6; ++r) m[r][col] = rows[r];
      ++col;
    }
  }
  for (bool times_z : {false, true}) {
    const Column c = columns(n2, -1, x, times_z, g2);
    const Real rows[6] = {0, 0, -c.u, -c.w, -c.normal, -c.tangential};
    for (int r = 0; r < 6; ++r) m[r][col] = rows[r];
    ++col;
  }
  m[0][6] = -1;  // normal stress under a unit pressure
  for (int k = 0; k < 6; ++k) {
    int best = k;
    for (int r = k + 1; r < 6; ++r) {
      if (std::abs(m[r][k]) > std::abs(m[best][k])) best = r;
    }
    std::swap(m[k], m[best]);
    for (int r = 0; r < 6; ++r) {
      if (r == k) continue;
      const Real f = m[r][k] / m[k][k];
      for (int c = k; c < 7; ++c) m[r][c] -= f * m[k][c];
    }
  }
  // w at z = 0, in 1/q: the two solutions without z.
  return static_cast<double>((m[0][6] / m[0][0] + m[2][6] / m[2][2]) / q);
}

TEST(Compliance, LayeredKernelIsThatOfTheEquationsOfElasticitySolvedDirectly) {
  RandomStream random(1, "layers", 0);
  for (int k = 0; k < 300; ++k) {
    const LayeredSolid s{std::pow(10, 4 * random.uniform() - 2), 0.49 * random.uniform(), 1, 1,
                         0.49 * random.uniform()};
    const double q = std::pow(10, 2.7 * random.uniform() - 2);
    const double exact = solved_layer(s, q);
    EXPECT_NEAR(compliance(s, q), exact, 1e-10 * exact)
        << s.layer_modulus << " " << s.layer_poisson << " " << s.bulk_poisson << " " << q;
  }
}

TEST(Compliance, HasItsLimits) {
  const LayeredSolid s{66e6, 0.5, 1e-6, 20e6, 0.5};
  EXPECT_NEAR(compliance(s, 1e-3) * 1e-3, 2 * 0.75 / 20e6, 1e-8 * 2 * 0.75 / 20e6);
  EXPECT_NEAR(compliance(s, 1e8) * 1e8, 2 * 0.75 / 66e6, 1e-12 * 2 * 0.75 / 66e6);
  const LayeredSolid same{66e6, 0.3, 1e-6, 66e6, 0.3};
  for (double q : {1e3, 1e5, 1e6, 1e7})
    EXPECT_NEAR(compliance(same, q) * q, 2 * 0.91 / 66e6, 1e-12 * 2 * 0.91 / 66e6);
  // Thin layer on a rigid base: C -> d (1+n)(1-2n) / (E (1-n)).
  const LayeredSolid rigid{1e6, 0.3, 1e-6, 1e15, 0.3};
  EXPECT_NEAR(compliance(rigid, 1e3), 1e-6 * 1.3 * 0.4 / (1e6 * 0.7), 1e-5 * 7.4e-13);
}

// Westergaard 1939: A/A0 = (2/pi) asin sqrt(p/p*), p* = pi E* D / l.
TEST(Contact, WavySurfaceHasWestergaardsArea) {
  const double period = 1e-6, amplitude = 1e-8;
  const Grid grid{1024, 2, period, period / 512};
  const ContactKernel kernel(grid, kHalfSpace);
  std::vector<double> height(grid.size());
  for (int ix = 0; ix < grid.nx; ++ix) {
    for (int iy = 0; iy < grid.ny; ++iy)
      height[grid.index(ix, iy)] = amplitude * std::cos(2 * kPi * grid.x(ix) / period);
  }
  for (double share : {0.05, 0.2, 0.5, 0.8}) {
    const double p = share * kPi * 1e6 * amplitude / period;
    const ContactSolution s = solve_contact(kernel, height, p, {}, {.tolerance = 1e-9});
    ASSERT_TRUE(s.converged()) << s.reason;
    const double exact = 2 / kPi * std::asin(std::sqrt(share));
    EXPECT_NEAR(measure_area(kernel, s).near_edge, exact, 0.005 * exact) << share;
    const double peak = 2 * p / std::sin(std::asin(std::sqrt(share)));
    EXPECT_NEAR(*std::max_element(s.pressure.begin(), s.pressure.end()), peak, 0.01 * peak);
  }
}

// Hertz on a large patch: a^3 = 3FR/(4E*).
TEST(Contact, SphereHasHertzsArea) {
  const Grid grid{256, 256, 1e-5, 1e-5};
  const ContactKernel kernel(grid, kHalfSpace);
  const double radius = 2e-5, a = 4.5 * grid.dx();
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      height[grid.index(ix, iy)] =
          -(square(grid.x(ix) - 5.003e-6) + square(grid.y(iy) - 4.991e-6)) / (2 * radius);
    }
  }
  const double force = 4 * 1e6 * cube(a) / (3 * radius);
  const ContactSolution s =
      solve_contact(kernel, height, force / grid.area(), {}, {.tolerance = 1e-9});
  ASSERT_TRUE(s.converged());
  const double exact = kPi * a * a / grid.area();
  EXPECT_NEAR(measure_area(kernel, s).near_edge, exact, 0.015 * exact);
}

TEST(Contact, SavedRoughCasesAreReproducedToOneInAMillion) {
  const Heightmap surface = read_heightmap(PAPILLA_TEST_DATA "/contact/surface_N256.npy", 1.0);
  const ContactKernel kernel(surface.grid, {1, 0, 0, 1, 0});
  for (const char* load : {"0.01", "0.05", "0.2"}) {
    const Heightmap expected = read_heightmap(
        std::string(PAPILLA_TEST_DATA "/contact/pressure_N256_p") + load + ".npy", 1.0);
    const ContactSolution s =
        solve_contact(kernel, surface.z, std::stod(load), {}, {.tolerance = 1e-13});
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < s.pressure.size(); ++i) {
      difference += square(s.pressure[i] - expected.z[i]);
      norm += square(expected.z[i]);
    }
    EXPECT_LT(std::sqrt(difference / norm), 1e-6) << load << " " << s.reason;
  }
}

TEST(Contact, LoadIsCarriedAndGapIsZeroUnderPressure) {
  const Grid grid{90, 75, 9e-6, 7e-6};  // neither square nor a power of two
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 20e6, 0.5});
  const Heightmap skin = random_surface({2e-7, 3e-6, 0.8, 3e-7}, grid, 1, 0);
  std::vector<double> traction(grid.size(), 0.0);
  for (std::size_t i = 0; i < traction.size() / 3; ++i) traction[i] = 4e5;
  const ContactSolution s = solve_contact(*kernel, skin.z, 3e5, traction, {.tolerance = 1e-8});
  ASSERT_TRUE(s.converged()) << s.reason;
  double mean = 0, pull = 0;
  for (std::size_t i = 0; i < s.pressure.size(); ++i) {
    mean += s.pressure[i] / static_cast<double>(grid.size());
    pull += traction[i] / static_cast<double>(grid.size());
    EXPECT_GE(s.pressure[i], 0);
    EXPECT_GE(s.gap[i], 0);
    if (s.pressure[i] > 0) {
      EXPECT_EQ(s.gap[i], 0);
    }
  }
  EXPECT_NEAR(mean, 3e5 + pull, 1e-9 * mean);
}

TEST(Contact, UniformTractionEqualsMoreLoad) {
  const Grid grid{64, 64, 6e-6, 6e-6};
  const auto kernel = make_contact_kernel(grid, kHalfSpace);
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  const std::vector<double> traction(grid.size(), 2e4);
  const ContactSolution a = solve_contact(*kernel, skin.z, 1e4, traction, {.tolerance = 1e-10});
  const ContactSolution b = solve_contact(*kernel, skin.z, 3e4, {}, {.tolerance = 1e-10});
  for (std::size_t i = 0; i < a.gap.size(); ++i) EXPECT_NEAR(a.gap[i], b.gap[i], 1e-12);
}

TEST(Contact, HardnessCapsThePressureAndIsRefusedBelowTheLoad) {
  const Grid grid{64, 64, 6e-6, 6e-6};
  const auto kernel = make_contact_kernel(grid, kHalfSpace);
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  const ContactSolution s =
      solve_contact(*kernel, skin.z, 1e4, {}, {.tolerance = 1e-7, .hardness = 8e4});
  ASSERT_TRUE(s.converged()) << s.reason;
  double mean = 0;
  int capped = 0;
  for (double p : s.pressure) {
    mean += p / 4096;
    EXPECT_LE(p, 8e4);
    capped += p == 8e4;
  }
  EXPECT_NEAR(mean, 1e4, 1e-6);
  EXPECT_GT(capped, 10);
  EXPECT_EQ(solve_contact(*kernel, skin.z, 9e4, {}, {.hardness = 8e4}).status,
            ContactStatus::Invalid);
}

TEST(Contact, HardCasesEndInAnAnswerOrAStatus) {
  const Grid grid{32, 32, 1e-6, 1e-6};
  const auto kernel = make_contact_kernel(grid, kHalfSpace);
  std::vector<double> flat(grid.size(), 0.0), spike(grid.size(), 0.0), broken(grid.size(), 0.0);
  spike[100] = 1e-7;
  broken[5] = std::numeric_limits<double>::quiet_NaN();
  const ContactSolution even = solve_contact(*kernel, flat, 1e4, {}, {});
  EXPECT_TRUE(even.converged());
  for (double p : even.pressure) EXPECT_NEAR(p, 1e4, 1e-6);
  const ContactSolution one = solve_contact(*kernel, spike, 1.0, {}, {});
  EXPECT_TRUE(one.converged());
  EXPECT_NEAR(one.pressure[100], 1024, 1e-9);
  EXPECT_EQ(solve_contact(*kernel, spike, 0, {}, {}).status, ContactStatus::NoLoad);
  EXPECT_EQ(solve_contact(*kernel, broken, 1e4, {}, {}).status, ContactStatus::Invalid);
  const std::vector<double> lifted(grid.size(), -2e4);
  EXPECT_EQ(solve_contact(*kernel, spike, 1e4, lifted, {}).status, ContactStatus::NoLoad);
  // To full contact.
  const Heightmap skin = random_surface({1e-9, 3e-7, 0.8, 1e-7}, grid, 1, 0);
  const ContactSolution full = solve_contact(*kernel, skin.z, 1e6, {}, {});
  EXPECT_TRUE(full.converged()) << full.reason;
  EXPECT_DOUBLE_EQ(measure_area(*kernel, full).raw, 1);
}

TEST(Contact, StiffnessRatiosOfTenThousandConverge) {
  const Grid grid{64, 64, 6e-6, 6e-6};
  const Heightmap skin = random_surface({1e-7, 3e-6, 0.8, 4e-7}, grid, 1, 3);
  for (double ratio : {1e-4, 1e4}) {
    const ContactKernel kernel(grid, {1e6 * ratio, 0.5, 5e-7, 1e6, 0.5});
    const ContactSolution s = solve_contact(kernel, skin.z, 1e3, {}, {.tolerance = 1e-6});
    EXPECT_TRUE(s.converged()) << ratio << " " << s.reason;
  }
}

// Five times the certificate (Eq. accuracy.1); a certificate costs at least three transform pairs,
// and 3.3 a digit beyond.
TEST(ContactFacts, AreThePriceAndTheErrorOfACertificate) {
  EXPECT_DOUBLE_EQ(contact::contact_error(3e-4), 1.5e-3);
  EXPECT_EQ(contact::contact_method(1e-4), "layered half-space, certified to 0.0001");
  const Grid grid{128, 64, 1, 1};
  const double pair = contact::contact_seconds(grid, 1e-1) / 3;
  EXPECT_GT(pair, 0);
  EXPECT_NEAR(contact::contact_seconds(grid, 1e-2), 3 * pair, 1e-12);
  EXPECT_NEAR(contact::contact_seconds(grid, 1e-4), 8.2 * pair, 1e-9 * pair);
  EXPECT_NEAR(contact::contact_seconds(grid, 1e-6), 14.8 * pair, 1e-9 * pair);
}

// Pressed flat, a wave A cos(qx) takes the pressure A / C(q) and stores A^2 / (4 C) per area.
TEST(Contact, AWavePressedFlatStoresItsEnergy) {
  const Grid grid{64, 32, 2e-6, 1e-6};
  const LayeredSolid solid{5e6, 0.3, 3e-7, 1e6, 0.45};
  const ContactKernel kernel(grid, solid);
  const double amplitude = 1e-9, q = 2 * kPi / 1e-6, peak = amplitude / compliance(solid, q);
  std::vector<double> height(grid.size());
  for (std::size_t i = 0; i < height.size(); ++i)
    height[i] = amplitude * std::cos(q * grid.x(static_cast<int>(i) % 64));
  const ContactSolution s = solve_contact(kernel, height, 2 * peak, {}, {.tolerance = 1e-10});
  ASSERT_TRUE(s.converged()) << s.reason;
  EXPECT_NEAR(s.elastic_energy, square(amplitude) / (4 * compliance(solid, q)) * grid.area(),
              1e-6 * s.elastic_energy);
  EXPECT_NEAR(s.shift, 0, 1e-6 * amplitude);  // of the mean surface, whose displacement is none
  for (std::size_t i = 0; i < height.size(); ++i)
    EXPECT_NEAR(s.pressure[i], peak * (2 + height[i] / amplitude), 1e-4 * peak);
}

TEST(Contact, WhatIsNotCertifiedSaysHowFarItCame) {
  const Grid grid{64, 64, 12e-6, 12e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  const Heightmap h = random_surface({1e-7, 6e-6, 0.8, 5e-7}, grid, 1, 0);
  const ContactSolution s =
      solve_contact(kernel, h.z, 1e4, {},
                    {.tolerance = 1e-12, .max_iterations = 3, .method = ContactMethod::Dense});
  EXPECT_EQ(s.status, ContactStatus::IterationLimit);
  EXPECT_FALSE(s.converged());
  EXPECT_GT(s.certificate, 1e-12);
  EXPECT_TRUE(s.reason.starts_with("certificate ")) << s.reason;
  EXPECT_TRUE(
      s.reason.ends_with(" above 1e-12 after " + std::to_string(s.iterations) + " iterations"))
      << s.reason;
}

TEST(Contact, AWarmStartGivesTheSameAnswer) {
  const Grid grid{128, 128, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {66e6, 0.5, 1e-6, 60e6, 0.5});
  const Heightmap skin = random_surface({256e-9, 3.7e-6, 0.8, 1e-7}, grid, 1, 0);
  const ContactSolution near = solve_contact(*kernel, skin.z, 6e5, {}, {.tolerance = 1e-8});
  const ContactSolution cold = solve_contact(*kernel, skin.z, 7e5, {}, {.tolerance = 1e-8});
  const ContactSolution warm = solve_contact(*kernel, skin.z, 7e5, {}, {.tolerance = 1e-8}, &near);
  EXPECT_NEAR(measure_area(*kernel, warm).near_edge, measure_area(*kernel, cold).near_edge, 1e-5);
}

// Nothing presses: whether it is the tractions that lift or nothing at all is said.
TEST(Contact, WithoutALoadItIsSaidWhatLifts) {
  const Grid grid{16, 16, 1e-6, 1e-6};
  const ContactKernel kernel(grid, {1e6, 0.4, 1e-6, 1e5, 0.4, 0, 0.4});
  std::vector<double> height(grid.size());
  for (std::size_t i = 0; i < height.size(); ++i) height[i] = 1e-9 * static_cast<double>(i % 7);
  const auto reason = [&](double load, double traction) {
    return solve_contact(kernel, height, load, std::vector<double>(grid.size(), traction), {})
        .reason;
  };
  EXPECT_EQ(reason(0, 0), "no load: first touch");
  EXPECT_EQ(reason(100, -200), "the tractions lift the surfaces apart");
}

}  // namespace
}  // namespace papilla::tests::contact_test
