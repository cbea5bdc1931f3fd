#include "physics/contact/closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla::tests::closed_forms_test {
namespace {

const LayeredSolid kHalfSpace{1e6, 0, 0, 1e6, 0};

std::vector<double> sampled(const Grid& grid, const std::function<double(double, double)>& h) {
  std::vector<double> z(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) z[grid.index(ix, iy)] = h(grid.x(ix), grid.y(iy));
  }
  return z;
}

TEST(ClosedForms, WaveInOneDirectionIsSolvedToTheExactPressure) {
  const Westergaard exact{1e6, 1e-8, 1e-6};
  const Grid grid{1024, 2, 1e-6, 1e-6 / 512};
  const ContactKernel kernel(grid, kHalfSpace);
  const std::vector<double> h =
      sampled(grid, [](double x, double) { return 1e-8 * std::cos(2 * kPi * x / 1e-6); });
  for (double share : {0.05, 0.2, 0.5, 0.8}) {
    const double p = share * exact.full_pressure();
    const ContactSolution s = solve_contact(kernel, h, p, {}, {.tolerance = 1e-9});
    ASSERT_TRUE(s.converged()) << s.reason;
    EXPECT_NEAR(measure_area(kernel, s).near_edge, exact.area(p), 0.005 * exact.area(p));
    double error = 0;
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double x = std::remainder(grid.x(ix), 1e-6);
      if (std::abs(std::abs(x) / 1e-6 - exact.area(p) / 2) < 0.01) continue;  // the edge itself
      error = std::max(error, std::abs(s.pressure[ix] - exact.pressure(p, x)));
    }
    EXPECT_LT(error, 0.01 * exact.peak_pressure(p)) << share;
  }
}

TEST(ClosedForms, EggBoxHasTheAreaOfTheTable) {
  const EggBox exact{1e6, 1e-8, 1e-6};
  const Grid grid{256, 256, 1e-6, 1e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  const std::vector<double> h = sampled(grid, [](double x, double y) {
    return 1e-8 * std::cos(2 * kPi * x / 1e-6) * std::cos(2 * kPi * y / 1e-6);
  });
  for (double share : {0.05, 0.1, 0.3, 0.5, 0.8, 0.95}) {
    const double p = share * exact.full_pressure();
    const ContactSolution s = solve_contact(kernel, h, p, {}, {.tolerance = 1e-8});
    ASSERT_TRUE(s.converged()) << s.reason;
    EXPECT_NEAR(measure_area(kernel, s).near_edge, exact.area(p), 0.005 * exact.area(p)) << share;
    EXPECT_NEAR(*std::max_element(s.pressure.begin(), s.pressure.end()), exact.peak_pressure(p),
                0.01 * exact.peak_pressure(p))
        << share;
  }
  const Hertz peak{1e6, square(1e-6 / (2 * kPi)) / 1e-8};  // two per period
  const double light = 1e-4 * exact.full_pressure();
  EXPECT_NEAR(exact.peak_pressure(light), peak.peak_pressure(light * square(1e-6) / 2),
              0.03 * exact.peak_pressure(light));
  EXPECT_NEAR(exact.area(1e-4 * exact.full_pressure()),  // the Hertz limit, two peaks per period
              kPi * std::pow(3e-4 / (8 * kPi), 2.0 / 3),
              0.01 * exact.area(1e-4 * exact.full_pressure()));
}

TEST(ClosedForms, SphereAndConeHaveTheirContactRadius) {
  const Grid grid{256, 256, 1e-5, 1e-5};
  const ContactKernel kernel(grid, kHalfSpace);
  const double middle = 5.003e-6;
  const Hertz sphere{1e6, 2e-5};
  const Cone cone{1e6, 0.05};
  const auto distance = [&](double x, double y) { return std::hypot(x - middle, y - middle); };
  const std::vector<double> ball = sampled(
      grid, [&](double x, double y) { return -square(distance(x, y)) / (2 * sphere.radius); });
  const std::vector<double> tip =
      sampled(grid, [&](double x, double y) { return -cone.slope * distance(x, y); });
  for (double a : {6 * grid.dx(), 12 * grid.dx()}) {
    const double exact = kPi * a * a / grid.area();
    const double force = 4 * 1e6 * cube(a) / (3 * sphere.radius);
    EXPECT_NEAR(sphere.contact_radius(force), a, 1e-12 * a);
    const ContactSolution s =
        solve_contact(kernel, ball, force / grid.area(), {}, {.tolerance = 1e-9});
    const double share = a > 10 * grid.dx() ? 0.005 : 0.01;
    EXPECT_NEAR(measure_area(kernel, s).near_edge, exact, share * exact);
    EXPECT_NEAR(*std::max_element(s.pressure.begin(), s.pressure.end()),
                sphere.peak_pressure(force), 0.01 * sphere.peak_pressure(force));
    const double press = kPi * 1e6 * a * a * cone.slope / 2;
    EXPECT_NEAR(cone.contact_radius(press), a, 1e-12 * a);
    const ContactSolution c =
        solve_contact(kernel, tip, press / grid.area(), {}, {.tolerance = 1e-9});
    EXPECT_NEAR(measure_area(kernel, c).near_edge, exact, 0.02 * exact);
  }
  // delta = dU/dF: the approach is the derivative of the energy with the force.
  for (double f : {1e-6, 1e-4}) {
    const double d = 1e-4 * f;
    const auto work = [](const auto& body, double force) {  // integral of F d(delta) by parts
      double sum = 0;
      for (int k = 0; k < 20000; ++k) sum += body.approach(force * (k + 0.5) / 20000) * force / 2e4;
      return sum;
    };
    EXPECT_NEAR((work(sphere, f + d) - work(sphere, f - d)) / (2 * d), sphere.approach(f),
                1e-4 * sphere.approach(f));
  }
}

TEST(ClosedForms, AdhesiveSpheresPullOffWhereTheirForceIsLeast) {
  const AdhesiveSphere s{1e6, 1e-6, 0.05};
  double least = 0, at = 0;
  for (int k = 1; k < 4000; ++k) {
    const double a = 1e-9 * k;
    if (s.jkr_force(a) < least) {
      least = s.jkr_force(a);
      at = a;
    }
  }
  EXPECT_NEAR(least, s.jkr_pull_off(), 1e-5 * std::abs(least));
  EXPECT_NEAR(cube(at), 9 * kPi * 0.05 * square(1e-6) / (8 * 1e6), 0.02 * cube(at));
  const double rest = std::cbrt(9 * kPi * 0.05 * square(1e-6) / (2 * 1e6));  // no force
  EXPECT_NEAR(s.jkr_force(rest), 0, 1e-12 * std::abs(s.jkr_pull_off()) + 1e-18);
  EXPECT_DOUBLE_EQ(s.dmt_force(0), s.dmt_pull_off());
  // Without adhesion both are Hertz.
  const AdhesiveSphere dry{1e6, 1e-6, 0};
  const Hertz hertz{1e6, 1e-6};
  EXPECT_NEAR(hertz.contact_radius(dry.jkr_force(1e-7)), 1e-7, 1e-16);
  EXPECT_NEAR(dry.jkr_approach(1e-7), hertz.approach(dry.dmt_force(1e-7)), 1e-20);
  // dF/d(delta) > 0 along the stable branch, work of a closed loop is none: F = -dU/d(delta) with
  // U = stored energy - w pi a^2 has dU/da = 0 at fixed delta.
  EXPECT_NEAR(s.tabor(1e-9) / s.tabor(8e-9), 8, 1e-12);
}

// Beyond full contact the wave of pressure is as high as at it, on a higher mean.
TEST(ClosedForms, BeyondFullContactTheWholeWaveIsPressed) {
  const Westergaard wave{1e6, 1e-8, 1e-6};
  const EggBox box{1e6, 1e-8, 1e-6};
  const double full = kPi * 1e6 * 1e-8 / 1e-6;
  EXPECT_DOUBLE_EQ(wave.full_pressure(), full);
  EXPECT_DOUBLE_EQ(box.full_pressure(), std::sqrt(2.0) * full);
  for (const double p : {1.0 * full, 3 * full}) {
    EXPECT_DOUBLE_EQ(wave.area(p), 1);
    EXPECT_DOUBLE_EQ(wave.peak_pressure(p), p + full);
    EXPECT_NEAR(wave.pressure(p, 0.5e-6), p - full, 1e-9 * full);
    EXPECT_NEAR(wave.pressure(p, 0.25e-6), p, 1e-9 * full);
    EXPECT_DOUBLE_EQ(box.area(std::sqrt(2.0) * p), 1);
    EXPECT_DOUBLE_EQ(box.peak_pressure(std::sqrt(2.0) * p), std::sqrt(2.0) * (p + full));
  }
  for (const double p : {0.0, -full}) {
    EXPECT_EQ(wave.area(p), 0);
    EXPECT_EQ(wave.peak_pressure(p), 0);
    EXPECT_EQ(box.area(p), 0);
    EXPECT_EQ(box.peak_pressure(p), 0);
  }
  // The mean over a period is the load, below full contact and beyond.
  for (const double p : {0.3 * full, 2 * full}) {
    double sum = 0;
    for (int k = 0; k < 100000; ++k) sum += wave.pressure(p, 1e-6 * (k + 0.5 - 50000) / 1e5) / 1e5;
    EXPECT_NEAR(sum, p, 1e-5 * p);
  }
}

// Without force a JKR sphere is pressed in by a third of what its contact takes without work
// (Johnson, Kendall and Roberts 1971), and its force is the slope of its energy.
TEST(ClosedForms, ApproachesOfConeAndAdhesiveSphereFollowFromTheirForces) {
  const AdhesiveSphere s{1e6, 1e-6, 0.05};
  const double rest = std::cbrt(9 * kPi * 0.05 * square(1e-6) / (2 * 1e6));
  EXPECT_NEAR(s.jkr_approach(rest), square(rest) / 3e-6, 1e-9 * square(rest) / 1e-6);
  EXPECT_NEAR(s.jkr_pull_off() / (kPi * 0.05 * 1e-6), -1.5, 1e-12);
  EXPECT_NEAR(s.dmt_pull_off() / (kPi * 0.05 * 1e-6), -2, 1e-12);
  EXPECT_NEAR(s.tabor(1e-9), std::cbrt(1e-6 * square(0.05) / (square(1e6) * cube(1e-9))), 1e-9);
  const Cone cone{2e6, 0.1};
  const double a = cone.contact_radius(3e-6);
  EXPECT_NEAR(cone.approach(3e-6), kPi * a * 0.1 / 2, 1e-12 * a);
  EXPECT_NEAR(kPi * 2e6 * a * a * 0.1 / 2, 3e-6, 1e-15);
}

// A soft body on what does not give: a half-space for waves short against it, a bonded film for
// long ones. Eq. contact.9
TEST(Kernel, AFiniteCounterBodyGivesAsABondedFilm) {
  LayeredSolid solid;
  solid.bulk_modulus = 1e15;  // the other side is rigid
  solid.counter_modulus = 2.6e6, solid.counter_poisson = 0.4, solid.counter_thickness = 2e-6;
  const double thick = 2 * (1 - 0.16) / 2.6e6;
  EXPECT_NEAR(compliance(solid, 1e8), thick / 1e8, 1e-6 * thick / 1e8);
  const double film = 2e-6 * 1.4 * 0.2 / (2.6e6 * 0.6);
  EXPECT_NEAR(compliance(solid, 1e2), film, 1e-3 * film);
  EXPECT_LT(compliance(solid, 5e5), 0.4 * thick / 5e5);  // 12 um
  solid.counter_thickness = 0;
  EXPECT_LT(compliance(solid, 5e5), 1e-6 * thick / 5e5);
}

// A layer, what lies below and a soft counter-body: the stiffness of two half-spaces in series.
TEST(ClosedForms, ACounterBodyAddsTheComplianceOfItsHalfSpace) {
  LayeredSolid solid{.layer_modulus = 3e6,
                     .layer_poisson = 0.3,
                     .layer_thickness = 0,
                     .bulk_modulus = 2e6,
                     .bulk_poisson = 0.4};
  const Grid grid{16, 16, 1e-6, 1e-6};
  const double below = (1 - 0.16) / 2e6, counter = (1 - 0.0625) / 5e6;
  for (const double q : {1e4, 1e7})
    EXPECT_NEAR(compliance(solid, q), 2 * below / q, 1e-9 * below / q);
  EXPECT_NEAR(ContactKernel(grid, solid).contact_modulus(), 1 / below, 1e-9 / below);
  solid.counter_modulus = 5e6, solid.counter_poisson = 0.25;
  for (const double q : {1e4, 1e7})
    EXPECT_NEAR(compliance(solid, q), 2 * (below + counter) / q, 1e-9 * below / q);
  EXPECT_NEAR(ContactKernel(grid, solid).contact_modulus(), 1 / (below + counter), 1e-9 / below);
  solid.layer_thickness = 1e-3;  // much deeper than the waves: the layer alone
  const double layer = (1 - 0.09) / 3e6;
  EXPECT_NEAR(compliance(solid, 1e7), 2 * (layer + counter) / 1e7, 1e-9 * layer / 1e7);
  EXPECT_NEAR(ContactKernel(grid, solid).contact_modulus(), 1 / (layer + counter), 1e-9 / layer);
}

}  // namespace
}  // namespace papilla::tests::closed_forms_test
