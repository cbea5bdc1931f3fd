// Single contacts with numbers from their force laws turned round, and both tables of the egg box
// against the solver, knot by knot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "physics/contact/closed_forms.h"
#include "physics/contact/contact.h"

namespace papilla::tests::closed_form_values_test {
namespace {

double relative(double a, double b) { return std::abs(a / b - 1); }

// 2 MPa, 3 um, a contact of 0.1 um: F = 4 E a^3/(3 R), delta = a^2/R, p0 = 2 E a/(pi R).
TEST(SingleContacts, OfASphereAreHertzs) {
  const Hertz sphere{2e6, 3e-6};
  const double force = 4 * 2e6 * 1e-21 / 9e-6;
  EXPECT_LT(relative(sphere.contact_radius(force), 1e-7), 1e-12);
  EXPECT_LT(relative(sphere.approach(force), 1e-14 / 3e-6), 1e-12);
  EXPECT_LT(relative(sphere.peak_pressure(force), 2 * 2e6 * 1e-7 / (kPi * 3e-6)), 1e-12);
}

// F = pi E a^2 tan(beta)/2, delta = pi a tan(beta)/2
TEST(SingleContacts, OfAConeAreSneddons) {
  const Cone cone{2e6, 0.3};
  const double force = kPi * 2e6 * 1e-14 * 0.3 / 2;
  EXPECT_LT(relative(cone.contact_radius(force), 1e-7), 1e-12);
  EXPECT_LT(relative(cone.approach(force), kPi * 1e-7 * 0.3 / 2), 1e-12);
}

// In units of a0 = (9 pi w R^2/(2 E))^(1/3) and w R: Hertz's force 6 pi x^3, less 6 pi x^1.5 (JKR)
// or 2 pi (DMT); the approach x^2 - 2/3 x^0.5 of a0^2/R.
TEST(SingleContacts, OfAdhesiveSpheresAreTheirNormalForm) {
  const double e = 2e6, r = 3e-6, w = 0.04;
  const AdhesiveSphere s{e, r, w};
  const double a0 = std::cbrt(9 * kPi * w * r * r / (2 * e)), unit = kPi * w * r;
  for (const double x : {0.2, 0.7, 1.0, 1.9}) {
    EXPECT_NEAR(s.jkr_force(x * a0) / unit, 6 * x * x * x - 6 * std::pow(x, 1.5), 1e-10) << x;
    EXPECT_NEAR(s.dmt_force(x * a0) / unit, 6 * x * x * x - 2, 1e-10) << x;
    EXPECT_NEAR(s.jkr_approach(x * a0) / (a0 * a0 / r), x * x - 2.0 / 3 * std::sqrt(x), 1e-10) << x;
  }
  EXPECT_LT(relative(s.jkr_pull_off(), -1.5 * unit), 1e-12);
  EXPECT_LT(relative(s.dmt_pull_off(), -2 * unit), 1e-12);
  // mu = (R w^2 / (E^2 z0^3))^(1/3): 3e-6 * 16e-4 / (4e12 * 8e-27) cubed root of 1.5e5.
  EXPECT_LT(relative(s.tabor(2e-9), std::cbrt(1.5e5)), 1e-12);
}

// Within the half angle psi_a of the contact, sin^2 psi_a = p/p*: 2 p cos(psi)/sin^2(psi_a)
// sqrt(sin^2 psi_a - sin^2 psi), nothing outside.
TEST(SingleContacts, OfAWaveAreWestergaards) {
  const Westergaard wave{2e6, 3e-8, 1.5e-6};
  const double full = kPi * 2e6 * 3e-8 / 1.5e-6;
  EXPECT_LT(relative(wave.full_pressure(), full), 1e-12);
  const double p = full / 4;  // sin psi_a = 1/2: a third of the surface
  EXPECT_LT(relative(wave.area(p), 1.0 / 3), 1e-12);
  EXPECT_LT(relative(wave.peak_pressure(p), 4 * p), 1e-12);
  const double x = 1.5e-6 * 0.1;  // psi = 0.1 pi
  const double expected =
      8 * p * std::cos(0.1 * kPi) * std::sqrt(0.25 - square(std::sin(0.1 * kPi)));
  EXPECT_LT(relative(wave.pressure(p, x), expected), 1e-12);
  EXPECT_LT(relative(wave.pressure(p, -x), expected), 1e-12);
  EXPECT_GT(wave.pressure(p, 1.5e-6 / 6.01), 0);
  EXPECT_EQ(wave.pressure(p, 1.5e-6 / 5.99), 0);
  EXPECT_EQ(wave.pressure(p, 0.75e-6), 0);
  EXPECT_LT(relative(wave.pressure(3 * full, x), full * (3 + std::cos(0.2 * kPi))), 1e-12);
}

// The laws hold for pressures below a pascal too.
TEST(SingleContacts, OfAVerySoftWaveAreTheSame) {
  const Westergaard wave{2, 3e-8, 1.5e-6};
  const EggBox box{2, 3e-8, 1.5e-6};
  const double full = kPi * 2 * 3e-8 / 1.5e-6;
  EXPECT_LT(relative(wave.peak_pressure(full / 4), full), 1e-12);
  EXPECT_LT(relative(wave.area(full / 4), 1.0 / 3), 1e-12);
  EXPECT_LT(relative(wave.pressure(2 * full, 0), 3 * full), 1e-12);
  EXPECT_LT(relative(box.area(std::sqrt(2.0) * full * 0.1), 0.19059), 1e-12);
  EXPECT_LT(relative(box.peak_pressure(2 * full), (2 + std::sqrt(2.0)) * full), 1e-12);
}

constexpr double kKnots[] = {.005, .01, .02, .05, .1, .15, .2,  .3,
                             .4,   .5,  .6,  .7,  .8, .9,  .95, .99};

struct Solved {
  double area, peak;
};
Solved egg_box_at(double share) {
  constexpr int n = 96;
  const EggBox box{1e6, 1e-8, 1e-6};
  const auto kernel = make_contact_kernel({n, n, 1e-6, 1e-6}, {1e6, 0, 0, 1e6, 0});
  const Grid& grid = kernel->grid();
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix)
      height[grid.index(ix, iy)] =
          1e-8 * std::cos(2 * kPi * (ix + 0.5) / n) * std::cos(2 * kPi * (iy + 0.5) / n);
  }
  const ContactSolution s =
      solve_contact(*kernel, height, share * box.full_pressure(), {}, {.tolerance = 1e-7});
  EXPECT_TRUE(s.converged()) << share;
  return {measure_area(*kernel, s).near_edge,
          *std::max_element(s.pressure.begin(), s.pressure.end()) / box.full_pressure()};
}

TEST(EggBox, EveryKnotOfItsTablesIsTheSolversAnswer) {
  const EggBox box{1e6, 1e-8, 1e-6};
  const double full = box.full_pressure();
  for (const double share : kKnots) {
    const Solved s = egg_box_at(share);
    EXPECT_LT(relative(box.area(share * full), s.area), share < 0.03 ? 0.02 : 0.008) << share;
    EXPECT_LT(relative(box.peak_pressure(share * full) / full, s.peak), 0.015) << share;
  }
}

// Straight between the knots of each table, Hertz below the first.
TEST(EggBox, LiesHalfWayBetweenItsKnots) {
  const EggBox box{3e6, 2e-8, 1.5e-6};
  const double full = std::sqrt(2.0) * kPi * 3e6 * 2e-8 / 1.5e-6;
  EXPECT_LT(relative(box.full_pressure(), full), 1e-12);
  std::vector<double> knots(std::begin(kKnots), std::end(kKnots));
  knots.push_back(1);
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double middle = 0.5 * (knots[k - 1] + knots[k]);
    EXPECT_NEAR(box.area(middle * full),
                0.5 * (box.area(knots[k - 1] * full) + box.area(knots[k] * full)), 1e-12)
        << middle;
  }
  const double roots[] = {0, .005, .01, .05, .1, .2, .5, .8, 1};
  for (std::size_t k = 1; k < std::size(roots); ++k) {
    const double middle = 0.5 * (std::cbrt(roots[k - 1]) + std::cbrt(roots[k]));
    EXPECT_NEAR(box.peak_pressure(cube(middle) * full),
                0.5 * (box.peak_pressure(roots[k - 1] * full) + box.peak_pressure(roots[k] * full)),
                1e-9 * full)
        << middle;
  }
  // pi (3 s/(8 pi))^(2/3), and an excess that grows with the load to meet the first knot.
  const auto hertz = [](double s) { return kPi * std::cbrt(square(3 * s / (8 * kPi))); };
  const double excess = box.area(0.005 * full) / hertz(0.005) - 1;
  for (const double s : {1e-5, 1e-3, 4e-3})
    EXPECT_LT(relative(box.area(s * full), hertz(s) * (1 + excess * s / 0.005)), 1e-12) << s;
  EXPECT_LT(std::abs(excess), 0.02);
}

}  // namespace
}  // namespace papilla::tests::closed_form_values_test
