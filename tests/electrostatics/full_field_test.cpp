#include "physics/electrostatics/full_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/field.h"
#include "tests/electrostatics/table.h"

namespace papilla {
namespace {

// Mean of the squared field on the skin [1/m^2].
double mean_square_field(const PotentialSolution& s) {
  double sum = 0;
  for (double e : s.field) sum += square(e);
  return sum / static_cast<double>(s.field.size());
}

PotentialProblem bodies(const Grid& grid, double permittivity = 1) {
  PotentialProblem p;
  p.grid = grid;
  p.permittivity = permittivity;
  p.electrode.assign(grid.size(), 0);
  p.surface = p.skin = p.electrode;
  return p;
}

TEST(FullField, AFlatStackIsExactAtAnyGap) {
  for (const double gap : {0.0, 1e-9, 30e-9, 2e-6}) {
    PotentialProblem p = bodies({8, 6, 1e-6, 1e-6}, 3.9);
    p.skin_layer = 70e-9;
    for (std::size_t i = 0; i < p.skin.size(); ++i) {
      p.electrode[i] = -500e-9;
      p.skin[i] = gap;
    }
    const PotentialSolution s = solve_potential(p, {.levels = 24, .tolerance = 1e-9});
    ASSERT_TRUE(s.ok) << s.reason;
    const double expected = 1 / (500e-9 / 3.9 + gap + 70e-9);
    for (double e : s.field) EXPECT_NEAR(e, expected, 1e-6 * expected);
    EXPECT_NEAR(s.capacitance, 1e-12 * expected, 1e-18 * expected);
  }
}

TEST(FullField, SinusoidalElectrodesMatchTheExactSeries) {
  for (const Row& row : read_table("sinusoidal_electrode.csv")) {
    const double kg = number(row, "kg"), a = number(row, "a_over_g");
    PotentialProblem p = bodies({128, 1, 2 * kPi / kg, 1});
    for (int i = 0; i < 128; ++i) {
      p.electrode[i] = p.surface[i] = a * std::cos(kg * p.grid.x(i));
      p.skin[i] = 1;
    }
    const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
    ASSERT_TRUE(s.ok) << s.reason;
    const double exact = number(row, "p_mean_exact_over_p0");
    EXPECT_NEAR(mean_square_field(s), exact, 5e-3 * exact) << kg << ' ' << a;
  }
}

TEST(FullField, AStepPullsMoreThanItsTwoGaps) {
  for (const Row& row : read_table("step_edge_exact.csv")) {
    const double step = number(row, "step_s");
    const double length = 8 * (1 + step);
    PotentialProblem p = bodies({512, 1, length, 1});
    for (int i = 0; i < 512; ++i) {
      p.electrode[i] = p.surface[i] = i < 256 ? 0 : -step;
      p.skin[i] = 1;
    }
    const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
    ASSERT_TRUE(s.ok) << s.reason;
    const double local = 0.5 * length / 2 * (1 + 1 / square(1 + step));
    const double excess = 2 * number(row, "Fexcess_exact_over_eps0V2");
    const double force = 0.5 * length * mean_square_field(s);
    EXPECT_NEAR(force, local + excess, 5e-3 * (local + excess));
  }
}

TEST(FullField, AWaterWallScreensAsTanhSquared) {
  constexpr int kPixels = 16;  // a gap
  constexpr double kFilm = 1e-3;
  const int n = 16 * kPixels;
  PotentialProblem p = bodies({n, 1, 16, 1});
  p.bridged.assign(n, 0);
  for (int i = 0; i < n; ++i) {
    p.electrode[i] = -kFilm;  // water on a bare electrode would short it
    p.skin[i] = 1 - kFilm;
    p.bridged[i] = i < 4 * kPixels;
  }
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
  ASSERT_TRUE(s.ok) << s.reason;
  double lost = 0;
  for (int i = 4 * kPixels; i < 10 * kPixels; ++i) {
    const double exact = square(std::tanh(kPi * (p.grid.x(i) - 4) / 2));
    EXPECT_NEAR(square(s.field[i]), exact, 5e-3) << p.grid.x(i);
    lost += (1 - square(s.field[i])) * p.grid.dx();
  }
  EXPECT_NEAR(lost, 2 / kPi, 5e-3 * 2 / kPi);
}

TEST(FullField, AStackWithoutInsulatorAndAHopelessLimitEndInAStatus) {
  PotentialProblem p = bodies({8, 8, 1e-6, 1e-6});
  EXPECT_FALSE(solve_potential(p, {}).ok);
  for (int i = 0; i < 64; ++i) {
    p.electrode[i] = p.surface[i] = i % 8 < 4 ? 0 : -300e-9;
    p.skin[i] = 100e-9;
  }
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-12, .max_iterations = 1});
  EXPECT_FALSE(s.ok);
  EXPECT_GT(s.residual, 1e-12);
  EXPECT_FALSE(s.reason.empty());
}

TEST(FullField, OnFlatSurfacesThePullIsTheLocalOne) {
  const Gap gap{{16, 16, 2e-6, 2e-6}, std::vector<double>(256, 120e-9)};
  FieldProblem p;
  p.v_rms = 100;
  p.v_peak = 100 * std::sqrt(2.0);
  p.dielectric = 500e-9 / 3.9;
  p.dielectric_thickness = 500e-9;
  p.skin_layer = {30e-9, 60e-9};
  const FieldSolution local = solve_local_field(gap, nullptr, {}, p);
  const FullFieldSolution full = solve_full_field(gap, nullptr, {}, p);
  ASSERT_TRUE(full.ok) << full.reason;
  EXPECT_NEAR(full.mean_pressure, local.mean_pressure, 1e-5 * local.mean_pressure);
  EXPECT_EQ(full.over_limit_area, local.over_limit_area);
}

}  // namespace
}  // namespace papilla
