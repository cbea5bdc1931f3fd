#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/full_field.h"
#include "tests/electrostatics/table.h"

namespace papilla::tests::full_field_slow_test {
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

// Force on a sphere of radius 1 at a distance from a plane, per eps0 V^2, its upper half replaced
// by a plane through its centre.
double sphere_force(double distance) {
  constexpr int kPixels = 160;
  PotentialProblem p = bodies({kPixels, kPixels, 2.4, 2.4});
  for (int iy = 0; iy < kPixels; ++iy) {
    for (int ix = 0; ix < kPixels; ++ix) {
      const double r2 = square(p.grid.x(ix) - 1.2) + square(p.grid.y(iy) - 1.2);
      p.skin[p.grid.index(ix, iy)] = distance + 1 - std::sqrt(std::max(0.0, 1 - r2));
    }
  }
  const PotentialSolution s = solve_potential(p, {.air_cells = 8});
  EXPECT_TRUE(s.ok) << s.reason;
  return 0.5 * mean_square_field(s) * p.grid.area();
}

// What the plane adds to the sphere and shields is the same at both distances.
TEST(FullField, ASphereOverAPlane) {
  double exact = 0;
  for (const Row& row : read_table("sphere_plane_exact.csv")) {
    if (number(row, "d_over_R") == 0.01) exact += number(row, "F_over_eps0V2");
    if (number(row, "d_over_R") == 0.03) exact -= number(row, "F_over_eps0V2");
  }
  ASSERT_GT(exact, 200);
  EXPECT_NEAR(sphere_force(0.01) - sphere_force(0.03), exact, 1e-3 * exact);
}

// The cell of the table: a disc of the same area around a hole; the square array comes within 3e-4.
TEST(FullField, HoleArraysMatchFiniteVolumes) {
  for (const Row& row : read_table("hole_array_derjaguin.csv")) {
    const double gap = 1e-6 * number(row, "gap_um"), depth = 1e-6 * number(row, "depth_um");
    if (number(row, "depth_um") != 0.6 || gap == 50e-9 || gap == 200e-9) continue;
    const double thickness = 1e-6 * number(row, "d1_um");
    const double opening = 0.5e-6 * number(row, "hole_diam_um") - thickness;
    const double side = std::sqrt(kPi) * 1e-6 * number(row, "R_cell_um");
    PotentialProblem p = bodies({256, 256, side, side});
    for (int iy = 0; iy < 256; ++iy) {
      for (int ix = 0; ix < 256; ++ix) {
        const std::size_t i = p.grid.index(ix, iy);
        const double r = std::hypot(p.grid.x(ix) - side / 2, p.grid.y(iy) - side / 2);
        p.surface[i] = r < opening ? -depth : 0;
        p.electrode[i] = (r < opening + thickness ? -depth : 0) - thickness;
        p.skin[i] = gap;
      }
    }
    fill(p, number(row, "eps1"));
    const PotentialSolution s = solve_potential(p, {.air_cells = 8});
    ASSERT_TRUE(s.ok) << s.reason;
    const double force = 0.5 * mean_square_field(s) * p.grid.area();
    EXPECT_NEAR(force, number(row, "F_over_eps0V2"), 5e-3 * force) << gap;
  }
}

}  // namespace
}  // namespace papilla::tests::full_field_slow_test
