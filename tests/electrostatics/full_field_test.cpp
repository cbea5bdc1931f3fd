#include "physics/electrostatics/full_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/field.h"
#include "tests/electrostatics/table.h"

namespace papilla::tests::full_field_test {
namespace {

// Mean of the squared field on the skin [1/m^2].
double mean_square_field(const PotentialSolution& s) {
  double sum = 0;
  for (double e2 : s.square_field) sum += e2;
  return sum / static_cast<double>(s.square_field.size());
}

PotentialProblem bodies(const Grid& grid) {
  PotentialProblem p;
  p.grid = grid;
  p.electrode.assign(grid.size(), 0);
  p.surface = p.skin = p.electrode;
  return p;
}

// The columns between electrode and surface filled with a dielectric.
void fill(PotentialProblem& p, double permittivity) {
  p.dielectric.resize(p.surface.size());
  for (std::size_t i = 0; i < p.surface.size(); ++i)
    p.dielectric[i] = (p.surface[i] - p.electrode[i]) / permittivity;
}

TEST(FullField, AFlatStackIsExactAtAnyGap) {
  for (const double gap : {0.0, 1e-9, 30e-9, 2e-6}) {
    PotentialProblem p = bodies({8, 6, 1e-6, 1e-6});
    p.skin_layer = 70e-9;
    for (std::size_t i = 0; i < p.skin.size(); ++i) {
      p.electrode[i] = -500e-9;
      p.skin[i] = gap;
    }
    fill(p, 3.9);
    const PotentialSolution s = solve_potential(p, {.tolerance = 1e-9});
    ASSERT_TRUE(s.ok) << s.reason;
    const double expected = 1 / (500e-9 / 3.9 + gap + 70e-9);
    for (double e2 : s.square_field) EXPECT_NEAR(std::sqrt(e2), expected, 3e-6 * expected);
    EXPECT_NEAR(s.capacitance, 1e-12 * expected, 1e-18 * expected);
  }
}

// A film that passes next to nothing sets the flux, whatever stands above: of a ripple a cos kx of
// the skin over a gap g the stress through the film's plane is that flux's times
// 1 - (k a)^2 / (2 cosh^2 k g), to second order in a.
TEST(FullField, UnderAFilmThatSetsTheFluxARippledSkinIsPulledLess) {
  const double period = 1e-6, gap = 60e-9, a = 25e-9, k = 2 * kPi / period;
  PotentialProblem p = bodies({128, 1, period, period / 128});
  for (int i = 0; i < 128; ++i) {
    p.electrode[i] = -100e-9;
    p.skin[i] = gap + a * std::cos(2 * kPi * (i + 0.5) / 128);
  }
  fill(p, 4e-4);
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
  ASSERT_TRUE(s.ok) << s.reason;
  const double flux = 1 / (100e-9 / 4e-4 + gap);
  const double expected = square(flux) * (1 - square(k * a / std::cosh(k * gap)) / 2);
  EXPECT_NEAR(mean_square_field(s), expected, 2e-3 * expected);
  EXPECT_LT(expected, 0.991 * square(flux));
}

// As many cells as the thickness has in half pixels of the finer side, and two.
TEST(FullField, CellsOfTheDielectricFollowTheFinerPixel) {
  for (const bool along_x : {true, false}) {
    PotentialProblem p =
        bodies(along_x ? Grid{16, 8, 1.6e-6, 3.2e-6} : Grid{8, 16, 3.2e-6, 1.6e-6});
    for (std::size_t i = 0; i < p.skin.size(); ++i) {
      p.electrode[i] = -0.8e-6;  // 8 of the finer pixels
      p.skin[i] = 1e-7 * (1 + static_cast<double>(i % 5));
    }
    fill(p, 4);
    const PotentialSolution s = solve_potential(p, {});
    EXPECT_EQ(s.square_field, solve_potential(p, {.dielectric_cells = 6}).square_field);
    EXPECT_NE(s.square_field, solve_potential(p, {.dielectric_cells = 5}).square_field);
  }
}

// All of the field of a flat stack stands along z.
TEST(FullField, PeaksOfAFlatStackAreItsFields) {
  PotentialProblem p = bodies({8, 6, 1e-6, 1e-6});
  for (std::size_t i = 0; i < p.skin.size(); ++i) {
    p.electrode[i] = -400e-9;
    p.skin[i] = 150e-9;
  }
  fill(p, 4);
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-9});
  ASSERT_TRUE(s.ok) << s.reason;
  EXPECT_NEAR(s.peak_air, 1 / 250e-9, 1e-5 / 250e-9);
  for (const double phi : s.surface_potential) EXPECT_NEAR(phi, 150.0 / 250, 1e-5);
  for (double& z : p.skin) z = 0;  // no air left
  EXPECT_EQ(solve_potential(p, {}).peak_air, 0);
}

TEST(FullField, SinusoidalElectrodesMatchTheExactSeries) {
  for (const Row& row : read_table("sinusoidal_electrode.csv")) {
    const double kg = number(row, "kg"), a = number(row, "a_over_g");
    PotentialProblem p = bodies({128, 1, 2 * kPi / kg, 1});
    for (int i = 0; i < 128; ++i) {
      p.electrode[i] = p.surface[i] = a * std::cos(kg * p.grid.x(i));
      p.skin[i] = 1;
    }
    const PotentialSolution s = solve_potential(p, {.air_cells = 16, .tolerance = 1e-6});
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
    const PotentialSolution s = solve_potential(p, {.air_cells = 16, .tolerance = 1e-6});
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
  const PotentialSolution s = solve_potential(p, {.air_cells = 16, .tolerance = 1e-6});
  ASSERT_TRUE(s.ok) << s.reason;
  double lost = 0;
  for (int i = 4 * kPixels; i < 10 * kPixels; ++i) {
    const double exact = square(std::tanh(kPi * (p.grid.x(i) - 4) / 2));
    EXPECT_NEAR(s.square_field[i], exact, 5e-3) << p.grid.x(i);
    lost += (1 - s.square_field[i]) * p.grid.dx();
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
  const FieldSolution full = solve_full_field(gap, nullptr, {}, p);
  ASSERT_TRUE(full.ok) << full.reason;
  EXPECT_NEAR(full.mean_pressure, local.mean_pressure, 1e-5 * local.mean_pressure);
  EXPECT_EQ(full.over_limit_area, local.over_limit_area);
}

// A droplet as an upright cylinder of radius a and height b in a gap of 1 over a dielectric d1, by
// symmetry a quarter of a periodic cell: pull over its centre and over all, dry pressure 1.
struct CylinderPull {
  double centre = 0, excess = 0;
};

CylinderPull cylinder(bool on_skin, double a, double b, double d1, double side, int pixels) {
  PotentialProblem p = bodies({pixels, pixels, side, side});
  std::vector<double> water(p.grid.size(), 0);
  for (int iy = 0; iy < pixels; ++iy) {
    for (int ix = 0; ix < pixels; ++ix) {
      const std::size_t i = p.grid.index(ix, iy);
      p.electrode[i] = -d1;
      p.skin[i] = 1;
      if (std::hypot(p.grid.x(ix) - side / 2, p.grid.y(iy) - side / 2) < a) water[i] = b;
    }
  }
  (on_skin ? p.water_above : p.water_below) = water;
  fill(p, 3.9);
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-5});
  EXPECT_TRUE(s.ok) << s.reason;
  const double dry = 1 / square(1 + d1 / 3.9);
  CylinderPull out;
  out.centre = s.square_field[p.grid.index(pixels / 2, pixels / 2)] / dry;
  out.excess = (mean_square_field(s) / dry - 1) * p.grid.area();
  return out;
}

TEST(FullField, DropletsThatDoNotBridgeRaiseThePullAsFiniteVolumesSay) {
  for (const Row& row : read_table("droplet_nonbridging_electro.csv")) {
    const double a = number(row, "drop_radius_over_g"), b = number(row, "drop_height_over_g");
    const double d1 = number(row, "d1_over_g"), box = number(row, "R_box_over_g");
    if (a != 2 || b > 0.6 || d1 > 0.5) continue;
    const bool on_skin = row.at("where") == "skin";
    const CylinderPull pull = cylinder(on_skin, a, b, d1, 10, 80);
    const double centre = number(row, "p_center_over_pinf");
    // Of a droplet on the skin the table has the stress in the air below it, the solver that on the
    // skin above: water gathers some flux from its sides between the two.
    EXPECT_NEAR(pull.centre, centre, (on_skin ? 0.08 : 5e-3) * centre) << on_skin << b;
    if (on_skin) continue;
    const double excess = (number(row, "F_total_over_dry_within_R") - 1) * kPi * square(box);
    EXPECT_NEAR(pull.excess, excess, 0.03 * excess) << on_skin << b;  // steps of the round edge
  }
}

TEST(FullField, AGroundedBridgeLeavesTheWholeVoltageToTheDielectric) {
  PotentialProblem p = bodies({24, 24, 3e-6, 3e-6});
  p.bridged.assign(p.grid.size(), 0);
  p.skin_layer = 200e-9;
  for (int i = 0; i < 24 * 24; ++i) {
    p.electrode[i] = -500e-9;
    p.skin[i] = 400e-9;
    p.bridged[i] = i % 24 < 12;
  }
  fill(p, 3.9);
  const PotentialSolution s = solve_potential(p, {});
  ASSERT_TRUE(s.ok) << s.reason;
  for (int i = 0; i < 24 * 24; ++i) {
    if (p.bridged[i]) {
      EXPECT_EQ(s.surface_potential[i], 0);
    } else {
      EXPECT_GT(s.surface_potential[i], 0.05);
    }
  }
}

TEST(FullField, TheStatedEdgeRadiusRaisesTheFieldInTheDielectricBehindWalls) {
  const Grid grid{32, 32, 4e-6, 4e-6};
  Heightmap hole{grid, std::vector<double>(grid.size(), 0)};
  for (int iy = 8; iy < 24; ++iy) {
    for (int ix = 8; ix < 24; ++ix) hole.z[grid.index(ix, iy)] = -600e-9;
  }
  const CoveredSurface covered(hole, {{FilmProcess::Conformal, 0, 500e-9, 3.9}});
  Gap gap{grid, std::vector<double>(grid.size())};
  for (std::size_t i = 0; i < grid.size(); ++i) gap.value[i] = 20e-9 - hole.z[i];
  FieldProblem p;
  p.v_rms = 100;
  p.v_peak = 100 * std::sqrt(2.0);
  p.dielectric = 500e-9 / 3.9;
  p.dielectric_thickness = 500e-9;
  // Through the whole of the film: edges count by their radius alone.
  const FieldSolution none_stated = solve_full_field(gap, &covered, {}, p);
  const FieldSolution flat_rule = solve_spread_field(gap, &covered, {}, p);
  EXPECT_NEAR(none_stated.peak_oxide_field, flat_rule.peak_oxide_field,
              0.03 * flat_rule.peak_oxide_field);
  for (const double radius : {20e-9, 400e-9}) {  // a pixel is 125 nm
    p.edge_radius = radius;
    const double x = 500e-9 / radius, k = x / std::log1p(x);
    const FieldSolution rounded = solve_full_field(gap, &covered, {}, p);
    EXPECT_NEAR(rounded.peak_oxide_field, k * none_stated.peak_oxide_field,
                1e-6 * rounded.peak_oxide_field);
    EXPECT_EQ(rounded.mean_pressure, none_stated.mean_pressure);
  }
  // A flat electrode has no edge.
  gap.value.assign(grid.size(), 20e-9);
  EXPECT_LT(solve_full_field(gap, nullptr, {}, p).peak_oxide_field, p.v_peak / 500e-9);
}

}  // namespace
}  // namespace papilla::tests::full_field_test
