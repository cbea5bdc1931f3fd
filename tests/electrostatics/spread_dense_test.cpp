// The rule with spreading flux against its equation as dense matrices, and how soon it converges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/field.h"
#include "physics/electrostatics/screening.h"

namespace papilla::tests::spread_dense_test {
namespace {

// K of Eq. electrostatics.16 between pixels: eps q coth(q d), eps/d at q = 0, summed over waves.
std::vector<double> film_response(const Grid& g, double thickness, double permittivity) {
  std::vector<double> out(g.size());
  for (int y = 0; y < g.ny; ++y) {
    for (int x = 0; x < g.nx; ++x) {
      double sum = 0;
      for (int ky = 0; ky < g.ny; ++ky) {
        for (int kx = 0; kx < g.nx; ++kx) {
          const double qx = 2 * kPi * std::min(kx, g.nx - kx) / g.lx,
                       qy = 2 * kPi * std::min(ky, g.ny - ky) / g.ly, q = std::hypot(qx, qy);
          const double k =
              q > 0 ? permittivity * q / std::tanh(q * thickness) : permittivity / thickness;
          sum += k * std::cos(
                         2 * kPi *
                         (static_cast<double>(kx * x) / g.nx + static_cast<double>(ky * y) / g.ny));
        }
      }
      out[g.index(x, y)] = sum / static_cast<double>(g.size());
    }
  }
  return out;
}

// phi on the dielectric for one volt on the electrode; zero on wet pixels where no layer is between
// water and body, else one for each run of wet pixels of a row, which charge it together.
std::vector<double> potential(const Grid& g, const std::vector<double>& dielectric,
                              const std::vector<double>& conductance,
                              const std::vector<std::uint8_t>& wet, double thickness,
                              double permittivity, double water_skin_layer = 0) {
  const std::vector<double> k = film_response(g, thickness, permittivity);
  const std::size_t n = g.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      const bool floats = wet[i] && water_skin_layer > 0;
      if (wet[i] && !floats) {
        a[i][i] = 1;
        continue;
      }
      for (int jy = 0; jy < g.ny; ++jy) {
        for (int jx = 0; jx < g.nx; ++jx)
          a[i][g.index(jx, jy)] = k[g.index(wrap(jx - ix, g.nx), wrap(jy - iy, g.ny))];
      }
      a[i][i] += 1 / dielectric[i] - permittivity / thickness +
                 (floats ? 1 / water_skin_layer : conductance[i]);
      a[i][n] = 1 / dielectric[i];
    }
  }
  for (std::size_t i = 1; i < n && water_skin_layer > 0; ++i) {
    if (!wet[i] || !wet[i - 1]) continue;
    // The sum of both equations, and both potentials the same.
    for (std::size_t j = 0; j <= n; ++j) {
      a[i][j] += a[i - 1][j];
      a[i - 1][j] = j == i ? 1 : j == i - 1 ? -1 : 0;
    }
  }
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      if (i == c) continue;
      const double f = a[i][c] / a[c][c];
      for (std::size_t j = c; j <= n; ++j) a[i][j] -= f * a[c][j];
    }
  }
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i][n] / a[i][i];
  return out;
}

// Sides that suit the vector registers and sides that do not.
constexpr Grid kGrids[] = {{9, 7, 1.2e-6, 0.9e-6}, {8, 6, 1.1e-6, 1.3e-6}, {16, 16, 2e-6, 1.6e-6}};

TEST(SpreadDense, EveryPixelIsPulledAsItsEquationSays) {
  for (const Grid& grid : kGrids) {
    RandomStream random(21, "spread", static_cast<std::uint64_t>(grid.nx));
    Gap gap{grid, {}};
    Heightmap surface{grid, std::vector<double>(grid.size(), 0)};
    Wetting w;
    w.grid = grid;
    w.status = WettingStatus::Discs;
    w.bridges = 1;
    w.bridged.assign(grid.size(), 0);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      gap.value.push_back(i % 9 == 4 ? 0 : 150e-9 * random.uniform());
      surface.z[i] = -120e-9 * random.uniform();
      w.bridged[i] = i % 13 == 6;
    }
    Droplet drop;
    drop.x = 0.3 * grid.lx, drop.y = 0.6 * grid.ly, drop.radius = 0.3e-6, drop.height = 30e-9;
    drop.state = DropletState::OnSkin;
    w.droplets = {drop};
    FieldProblem p;
    p.v_rms = 60, p.v_peak = 60 * std::sqrt(2.0);
    p.dielectric_thickness = 300e-9;
    p.dielectric = 300e-9 / 4;
    p.skin_layer = {20e-9, 12e-9};
    const CoveredSurface covered(surface, {{FilmProcess::Planar, 0, 300e-9, 4}});
    for (const CoveredSurface* s : {static_cast<const CoveredSurface*>(nullptr), &covered}) {
      const FieldSolution out = solve_spread_field(gap, s, w, p, 1e-11);
      ASSERT_TRUE(out.ok) << out.reason;
      const std::vector<double> dielectric =
          s ? s->effective : std::vector<double>(grid.size(), p.dielectric);
      double mean = 0;
      for (const double d : dielectric) mean += d / static_cast<double>(grid.size());
      const std::vector<double> water = droplet_columns(grid, w);
      std::vector<double> air(grid.size()), conductance(grid.size());
      for (std::size_t i = 0; i < grid.size(); ++i) {
        const double b = std::min(water[i], 0.9 * gap.value[i]);
        air[i] = gap.value[i] - b;
        conductance[i] = 1 / (air[i] + b / kWaterPermittivity + 20e-9);
      }
      const std::vector<double> phi =
          potential(grid, dielectric, conductance, w.bridged, 4 * mean, 4);
      const std::vector<double> open = air_screening_factor(gap, w, true);
      double sum = 0, strongest = 0, air_field = 0;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        // The flux c phi where the skin's layer has no imaginary part; that takes the rest as in
        // Eq. electrostatics.1, of the column as it is.
        const double column = 1 / conductance[i] + dielectric[i];
        const double flux2 =
            square(phi[i] * conductance[i] * column) / (square(column) + square(12e-9));
        const double pressure =
            w.bridged[i] ? 0 : open[i] * 0.5 * kVacuumPermittivity * square(60.0) * flux2;
        EXPECT_NEAR(out.traction.value[i], pressure, 1e-6 * out.mean_pressure) << i;
        sum += pressure;
        if (w.bridged[i]) {
          strongest = std::max(strongest, 1 / dielectric[i]);
          continue;
        }
        if (air[i] > 0) air_field = std::max(air_field, p.v_peak * std::sqrt(flux2));
        const double voltage =
            (1 - phi[i]) / std::sqrt(1 + square((1 - phi[i]) / dielectric[i] * 12e-9));
        strongest = std::max(strongest, voltage / dielectric[i]);
      }
      EXPECT_NEAR(out.mean_pressure * static_cast<double>(grid.size()), sum, 1e-7 * sum);
      EXPECT_NEAR(out.peak_air_field, air_field, 1e-6 * air_field);
      EXPECT_NEAR(out.peak_oxide_field, p.v_peak * strongest * p.dielectric / 300e-9,
                  1e-6 * out.peak_oxide_field);
      // Without bridges the film's own voltage is what counts.
      Wetting dry;
      dry.grid = grid;
      const FieldSolution open_field = solve_spread_field(gap, s, dry, p, 1e-11);
      const std::vector<double> none(grid.size(), 0.0);
      std::vector<double> bare(grid.size());
      for (std::size_t i = 0; i < grid.size(); ++i) bare[i] = 1 / (gap.value[i] + 20e-9);
      const std::vector<double> all =
          potential(grid, dielectric, bare, std::vector<std::uint8_t>(grid.size(), 0), 4 * mean, 4);
      double film = 0;
      for (std::size_t i = 0; i < grid.size(); ++i) {
        const double flux = (1 - all[i]) / dielectric[i];
        film = std::max(film, flux / std::sqrt(1 + square(flux * 12e-9)));
      }
      EXPECT_NEAR(open_field.peak_oxide_field, p.v_peak * film * p.dielectric / 300e-9,
                  1e-6 * open_field.peak_oxide_field);
    }
  }
}

// Bodies of one, two and three pixels, each at a potential of its own.
TEST(SpreadDense, WaterHasThePotentialAtWhichItsChargeBalances) {
  for (const Grid& grid : kGrids) {
    RandomStream random(22, "floating", static_cast<std::uint64_t>(grid.nx));
    Gap gap{grid, {}};
    Wetting w;
    w.grid = grid;
    w.status = WettingStatus::Film;
    w.bridges = 3;
    w.bridged.assign(grid.size(), 0);
    for (std::size_t i = 0; i < grid.size(); ++i) gap.value.push_back(150e-9 * random.uniform());
    for (const int wet : {1, 2, 3}) {
      for (int k = 0; k < wet; ++k) w.bridged[grid.index(1 + k, 2 * wet - 1)] = 1;
    }
    FieldProblem p;
    p.v_rms = 60, p.v_peak = 85;
    p.dielectric_thickness = 300e-9;
    p.dielectric = 300e-9 / 4;
    p.skin_layer = 20e-9;
    p.water_skin_layer = 15e-9;
    const FieldSolution out = solve_spread_field(gap, nullptr, w, p, 1e-11);
    ASSERT_TRUE(out.ok) << out.reason;
    const std::vector<double> dielectric(grid.size(), p.dielectric);
    std::vector<double> conductance, reach;
    for (const double g : gap.value) {
      reach.push_back(g + 20e-9);
      conductance.push_back(1 / reach.back());
    }
    const std::vector<double> phi =
        potential(grid, dielectric, conductance, w.bridged, 300e-9, 4, 15e-9);
    const WallFields wall{phi, dielectric, reach, 15e-9};
    const std::vector<double> open = air_screening_factor(gap, w, true, &wall);
    double strongest = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double pressure =
          open[i] * 0.5 * kVacuumPermittivity * square(60 * phi[i] * conductance[i]);
      EXPECT_NEAR(out.traction.value[i], w.bridged[i] ? 0 : pressure, 1e-6 * out.mean_pressure)
          << i;
      strongest = std::max(strongest, (1 - phi[i]) / dielectric[i]);
    }
    EXPECT_NEAR(out.peak_oxide_field, 85 * strongest / 4, 1e-6 * out.peak_oxide_field);
    // The more alone it stands, the more of the film around charges it.
    const double one = phi[grid.index(1, 1)], three = phi[grid.index(2, 5)];
    EXPECT_GT(one, three);
    EXPECT_GT(three, 15.0 / 90);
    EXPECT_NEAR(phi[grid.index(1, 5)], phi[grid.index(3, 5)], 1e-12);
  }
}

// Under preset rules without pull below droplets the air there still leads.
TEST(SpreadDense, ColumnsWithoutPullStillCarryFlux) {
  const Grid grid{16, 8, 2e-6, 1e-6};
  const Gap gap{grid, std::vector<double>(grid.size(), 60e-9)};
  Wetting w;
  w.grid = grid;
  Droplet drop;
  drop.x = 1e-6, drop.y = 0.5e-6, drop.radius = 0.3e-6, drop.height = 20e-9;
  w.droplets = {drop};
  FieldProblem p;
  p.v_rms = 60, p.v_peak = 85;
  p.dielectric_thickness = 300e-9, p.dielectric = 75e-9;
  p.zero_under_droplets = true;
  p.droplet_enhancement = false;
  const FieldSolution s = solve_spread_field(gap, nullptr, w, p, 1e-9);
  ASSERT_TRUE(s.ok);
  // The gap is even, so the potential is, but for the water's 1/80 of its height: a pixel is pulled
  // as if there were no droplet, or not.
  const double whole = 0.5 * kVacuumPermittivity * square(60 / 135e-9);
  const std::vector<double> water = droplet_columns(grid, w);
  for (std::size_t i = 0; i < grid.size(); ++i)
    EXPECT_NEAR(s.traction.value[i], water[i] > 0 ? 0 : whole, 1e-3 * whole) << i;
}

// Contact spots a nanometre across under a bare skin, and a patch of usual gaps: docs/theory states
// 2, 4 and 6 iterations at these residuals.
TEST(SpreadDense, ConvergesInTheIterationsThatAreStated) {
  const Grid grid{64, 64, 12e-6, 12e-6};
  Gap gap{grid, {}};
  for (int iy = 0; iy < 64; ++iy) {
    for (int ix = 0; ix < 64; ++ix) {
      const double h = 400e-9 +
                       250e-9 * std::cos(2 * kPi * ix / 16) * std::cos(2 * kPi * iy / 21.34) +
                       200e-9 * std::cos(2 * kPi * (3 * ix + 5 * iy) / 64);
      gap.value.push_back(std::max(0.0, h));
    }
  }
  FieldProblem p;
  p.v_rms = 100, p.v_peak = 141;
  p.dielectric_thickness = 500e-9, p.dielectric = 500e-9 / 3.9;
  p.skin_layer = 24e-9;
  EXPECT_LE(solve_spread_field(gap, nullptr, {}, p, 1e-2).iterations, 2);
  EXPECT_LE(solve_spread_field(gap, nullptr, {}, p, 1e-3).iterations, 4);
  EXPECT_LE(solve_spread_field(gap, nullptr, {}, p, 1e-5).iterations, 6);
  // Water over a fifth of it, with a potential of its own.
  Wetting w;
  w.grid = grid;
  w.status = WettingStatus::Film;
  for (const double g : gap.value) w.bridged.push_back(g < 230e-9);
  EXPECT_GT(std::count(w.bridged.begin(), w.bridged.end(), 1), 800);
  p.water_skin_layer = 24e-9;
  EXPECT_LE(solve_spread_field(gap, nullptr, w, p, 1e-2).iterations, 3);
  EXPECT_LE(solve_spread_field(gap, nullptr, w, p, 1e-3).iterations, 5);
  EXPECT_LE(solve_spread_field(gap, nullptr, w, p, 1e-5).iterations, 8);
}

TEST(SpreadDense, WhatDoesNotConvergeSaysHowFarItCame) {
  const Grid grid{16, 16, 2e-6, 2e-6};
  Gap gap{grid, {}};
  for (std::size_t i = 0; i < grid.size(); ++i)
    gap.value.push_back(1e-9 * static_cast<double>(i % 50));
  FieldProblem p;
  p.v_rms = 100, p.v_peak = 141;
  p.dielectric_thickness = 500e-9, p.dielectric = 500e-9 / 3.9;
  const FieldSolution s = solve_spread_field(gap, nullptr, {}, p, 0);
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.iterations, 60);
  EXPECT_EQ(s.reason.find("the surface potential has not converged: residual "), 0u);
  EXPECT_NE(s.reason.find(" after 60 iterations, asked for 0.0e+00"), std::string::npos);
  EXPECT_GT(s.mean_pressure, 0);  // as far as it came
  gap.value[7] = std::nan("");
  const FieldSolution none = solve_spread_field(gap, nullptr, {}, p);
  EXPECT_FALSE(none.ok);
  EXPECT_EQ(none.reason, "the pull is not finite");
}

// A film that insulates, or none, or no voltage: the columns themselves.
TEST(SpreadDense, IsTheLocalRuleWhereNothingSpreads) {
  Gap gap{{8, 8, 1e-6, 1e-6}, {}};
  for (int i = 0; i < 64; ++i) gap.value.push_back(1e-9 * (i * 29 % 80));
  FieldProblem p;
  p.v_rms = 100, p.v_peak = 141;
  p.dielectric_thickness = 500e-9, p.dielectric = 500e-9 / 3.9;
  const auto same = [&](const FieldProblem& problem) {
    const FieldSolution spread = solve_spread_field(gap, nullptr, {}, problem);
    return spread.iterations == 0 &&
           spread.traction.value == solve_local_field(gap, nullptr, {}, problem).traction.value;
  };
  EXPECT_FALSE(same(p));
  FieldProblem holds = p;
  holds.dielectric = 101 * p.dielectric_thickness;
  EXPECT_TRUE(same(holds));
  FieldProblem still = p;
  still.v_rms = still.v_peak = 0;
  EXPECT_TRUE(same(still));
  still.v_peak = 100;
  EXPECT_GT(solve_spread_field(gap, nullptr, {}, still).iterations, 0);
}

}  // namespace
}  // namespace papilla::tests::spread_dense_test
