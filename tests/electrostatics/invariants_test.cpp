// What no rule of the field may depend on: which side is called x, where the patch is cut, in which
// units it is written; and that the pull is the derivative of the energy. On a textured film of
// oblong pixels with a rough gap, a bridge and droplets on either side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/electrode.h"
#include "physics/electrostatics/field.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/screening.h"
#include "scene/finger.h"

namespace papilla::tests::invariants_test {
namespace {

constexpr Grid kGrid{48, 32, 4.8e-6, 3.5e-6};

// Where the pixel (ix, iy) of another grid comes from, and a place (x, y) [m] of it goes to.
struct Move {
  const char* name;
  Grid grid;
  std::function<std::size_t(int ix, int iy)> from;
  std::function<std::pair<double, double>(double x, double y)> to;
};

std::vector<Move> moves() {
  const Grid turned{kGrid.ny, kGrid.nx, kGrid.ly, kGrid.lx};
  const double sx = 20 * kGrid.dx(), sy = 9 * kGrid.dy();
  return {
      {"turned", turned, [](int ix, int iy) { return kGrid.index(iy, ix); },
       [](double x, double y) {
         return std::pair{y, x};
       }},
      {"mirrored along x", kGrid, [](int ix, int iy) { return kGrid.index(47 - ix, iy); },
       [](double x, double y) {
         return std::pair{kGrid.lx - x, y};
       }},
      {"mirrored along y", kGrid, [](int ix, int iy) { return kGrid.index(ix, 31 - iy); },
       [](double x, double y) {
         return std::pair{x, kGrid.ly - y};
       }},
      {"moved", kGrid, [](int ix, int iy) { return kGrid.index((ix + 20) % 48, (iy + 9) % 32); },
       [sx, sy](double x, double y) {
         return std::pair{std::fmod(x - sx + kGrid.lx, kGrid.lx),
                          std::fmod(y - sy + kGrid.ly, kGrid.ly)};
       }}};
}

template <class T>
std::vector<T> moved(const std::vector<T>& field, const Move& m) {
  std::vector<T> out(field.size());
  for (int iy = 0; iy < m.grid.ny; ++iy) {
    for (int ix = 0; ix < m.grid.nx; ++ix) out[m.grid.index(ix, iy)] = field[m.from(ix, iy)];
  }
  return out;
}

struct Scene3d {
  Heightmap surface;
  Gap gap;
  Wetting water;
  FieldProblem problem;
  std::vector<FilmLayer> layers{{FilmProcess::Conformal, 0, 200e-9, 3.9},
                                {FilmProcess::Directional, 0.4, 150e-9, 7}};

  Scene3d() {
    const std::size_t n = kGrid.size();
    surface = {kGrid, std::vector<double>(n)};
    gap = {kGrid, std::vector<double>(n)};
    water.grid = kGrid;
    water.status = WettingStatus::Discs;
    water.bridged.assign(n, 0);
    RandomStream random(4, "gap of a test", 0);
    const double cx = 3.4e-6, cy = 1.3e-6;  // of the bridge
    for (int iy = 0; iy < kGrid.ny; ++iy) {
      for (int ix = 0; ix < kGrid.nx; ++ix) {
        const std::size_t i = kGrid.index(ix, iy);
        const bool hole = ix >= 6 && ix < 18 && iy >= 5 && iy < 17;
        surface.z[i] = hole ? -250e-9 : ix > 40 ? 60e-9 : 0;
        gap.value[i] = 60e-9 + 80e-9 * random.uniform() - std::min(0.0, surface.z[i]);
        water.bridged[i] = std::hypot(kGrid.x(ix) - cx, kGrid.y(iy) - cy) < 0.5e-6;
      }
    }
    const auto droplet = [&](double x, double y, double radius, double height, DropletState state) {
      Droplet d;
      d.x = x, d.y = y, d.radius = radius, d.height = height, d.state = state;
      water.droplets.push_back(d);
    };
    droplet(cx, cy, 0.5e-6, 80e-9, DropletState::Bridge);
    droplet(2.6e-6, 2.8e-6, 0.45e-6, 40e-9, DropletState::OnSubstrate);
    droplet(0.3e-6, 3.2e-6, 0.4e-6, 30e-9, DropletState::OnSkin);
    problem.v_peak = 200;
    problem.v_rms = 200 / std::sqrt(2.0);
    problem.dielectric_thickness = 350e-9;
    problem.dielectric = 200e-9 / 3.9 + 150e-9 / 7;
    problem.edge_radius = 50e-9;
    problem.skin_layer = {24e-9, 9e-9};
  }
  Scene3d other(const Move& m) const {
    Scene3d out = *this;
    out.surface = {m.grid, moved(surface.z, m)};
    out.gap = {m.grid, moved(gap.value, m)};
    out.water.grid = m.grid;
    out.water.bridged = moved(water.bridged, m);
    for (Droplet& d : out.water.droplets) std::tie(d.x, d.y) = m.to(d.x, d.y);
    return out;
  }
  FieldSolution solved(FieldMethod method) const {
    const CoveredSurface covered(surface, layers);
    if (method == FieldMethod::Local) return solve_local_field(gap, &covered, water, problem);
    if (method == FieldMethod::Spread)
      return solve_spread_field(gap, &covered, water, problem, 1e-8);
    return solve_full_field(gap, &covered, water, problem, {.tolerance = 1e-7});
  }
};

constexpr FieldMethod kMethods[] = {FieldMethod::Local, FieldMethod::Spread, FieldMethod::Full};

// Relative, of the rule's own iterations.
double scatter_of(FieldMethod method) { return method == FieldMethod::Full ? 2e-4 : 1e-6; }

TEST(FieldInvariants, ATurnedMirroredOrMovedPatchIsPulledAlike) {
  const Scene3d own;
  for (const FieldMethod method : kMethods) {
    const FieldSolution s = own.solved(method);
    ASSERT_TRUE(s.ok) << s.reason;
    EXPECT_GT(s.mean_pressure, 0);
    const double error = scatter_of(method);
    const double strongest = *std::max_element(s.traction.value.begin(), s.traction.value.end());
    for (const Move& m : moves()) {
      const FieldSolution t = own.other(m).solved(method);
      ASSERT_TRUE(t.ok) << t.reason;
      const int k = static_cast<int>(method);
      EXPECT_NEAR(t.mean_pressure, s.mean_pressure, error * s.mean_pressure) << m.name << k;
      EXPECT_NEAR(t.over_limit_area, s.over_limit_area, 2.0 / 1536) << m.name << k;
      EXPECT_NEAR(t.over_limit_share, s.over_limit_share, 5e-3) << m.name << k;
      EXPECT_NEAR(t.peak_air_field, s.peak_air_field, 5 * error * s.peak_air_field) << m.name << k;
      EXPECT_NEAR(t.peak_oxide_field, s.peak_oxide_field, 5 * error * s.peak_oxide_field)
          << m.name << k;
      const std::vector<double> expected = moved(s.traction.value, m);
      double most = 0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        most = std::max(most, std::abs(t.traction.value[i] - expected[i]));
      EXPECT_LT(most, 20 * error * strongest) << m.name << k;
    }
  }
}

// Lengths and volts times three: the same fields, and so the same pull.
TEST(FieldInvariants, FieldsOfALargerPatchUnderMoreVoltageAreTheSame) {
  const Scene3d own;
  Scene3d large = own;
  for (Grid* g : {&large.surface.grid, &large.gap.grid, &large.water.grid}) g->lx *= 3, g->ly *= 3;
  for (double& z : large.surface.z) z *= 3;
  for (double& g : large.gap.value) g *= 3;
  for (FilmLayer& l : large.layers) l.thickness *= 3;
  for (Droplet& d : large.water.droplets) d.x *= 3, d.y *= 3, d.radius *= 3, d.height *= 3;
  FieldProblem& p = large.problem;
  p.v_peak *= 3, p.v_rms *= 3, p.dielectric_thickness *= 3, p.dielectric *= 3, p.edge_radius *= 3;
  p.skin_layer *= 3;
  for (const FieldMethod method : kMethods) {
    const FieldSolution a = own.solved(method), b = large.solved(method);
    const double error = scatter_of(method);
    EXPECT_NEAR(b.mean_pressure, a.mean_pressure, error * a.mean_pressure);
    EXPECT_NEAR(b.peak_air_field, a.peak_air_field, error * a.peak_air_field);
    EXPECT_NEAR(b.peak_oxide_field, a.peak_oxide_field, error * a.peak_oxide_field);
  }
}

TEST(FieldInvariants, PullGoesWithTheSquareOfTheVoltageAndIsGoneAtNone) {
  for (const FieldMethod method : kMethods) {
    Scene3d scene;
    const FieldSolution one = scene.solved(method);
    scene.problem.v_peak *= 0.5, scene.problem.v_rms *= 0.5;
    const FieldSolution half = scene.solved(method);
    EXPECT_NEAR(half.mean_pressure, one.mean_pressure / 4, 1e-9 * one.mean_pressure);
    EXPECT_NEAR(half.peak_air_field, one.peak_air_field / 2, 1e-9 * one.peak_air_field);
    EXPECT_NEAR(half.peak_oxide_field, one.peak_oxide_field / 2, 1e-9 * one.peak_oxide_field);
    EXPECT_LE(half.over_limit_area, one.over_limit_area);
    scene.problem.v_peak = scene.problem.v_rms = 0;
    const FieldSolution none = scene.solved(method);
    EXPECT_TRUE(none.ok);
    EXPECT_EQ(none.mean_pressure, 0);
    EXPECT_EQ(none.peak_oxide_field, 0);
    EXPECT_EQ(none.traction.value, std::vector<double>(kGrid.size(), 0.0));
  }
}

// Bridges take pull away, droplets that do not bridge add some, and each can be left out.
TEST(FieldInvariants, WaterActsOnlyWhereItIsCounted) {
  for (const FieldMethod method : kMethods) {
    const Scene3d wet;
    Scene3d dry = wet, bridge = wet, drops = wet;
    dry.water = Wetting{};
    bridge.water.droplets.resize(1);
    drops.water.bridged.clear();
    drops.water.droplets.erase(drops.water.droplets.begin());
    const auto pull = [&](const Scene3d& s) { return s.solved(method).mean_pressure; };
    const double none = pull(dry);
    EXPECT_LT(pull(bridge), 0.97 * none);
    EXPECT_GT(pull(drops), 1.005 * none);
    drops.problem.droplet_enhancement = false;
    EXPECT_NEAR(pull(drops), none, 1e-6 * none);
    drops.problem.zero_under_droplets = true;
    EXPECT_LT(pull(drops), 0.95 * none);
    // Without screening a bridge takes no more than the pull on its own pixels; of the flux that
    // spreads in the film it takes more.
    bridge.problem.screening = false;
    double left = 0;
    const FieldSolution open = dry.solved(method);
    for (std::size_t i = 0; i < kGrid.size(); ++i)
      left +=
          bridge.water.bridged[i] ? 0 : open.traction.value[i] / static_cast<double>(kGrid.size());
    EXPECT_LT(pull(bridge), (1 + 1e-4) * left);
    EXPECT_GT(pull(bridge), (method == FieldMethod::Spread ? 0.9 : 1 - 1e-4) * left);
    // The cap of breakdown in air holds every pixel at its field.
    Scene3d capped = dry;
    capped.problem.v_peak *= 4, capped.problem.v_rms *= 4;
    const std::vector<double> free = capped.solved(method).traction.value;
    capped.problem.air_limit = AirLimit::Emission, capped.problem.steady = true;
    const std::vector<double> held = capped.solved(method).traction.value;
    const double most = 0.5 * kVacuumPermittivity * square(350e6);
    ASSERT_GT(*std::max_element(free.begin(), free.end()), most);
    for (std::size_t i = 0; i < free.size(); ++i)
      ASSERT_NEAR(held[i], std::min(free[i], most), 1e-6 * most);
  }
}

// Bodies of the full field, rough on both sides, with a film, a layer on the skin, water.
PotentialProblem rough_bodies() {
  PotentialProblem p;
  p.grid = {24, 20, 2.4e-6, 1.6e-6};
  const std::size_t n = p.grid.size();
  RandomStream random(9, "bodies of a test", 0);
  p.skin_layer = 30e-9;
  p.bridged.assign(n, 0);
  p.water_below.assign(n, 0.0);
  for (int iy = 0; iy < p.grid.ny; ++iy) {
    for (int ix = 0; ix < p.grid.nx; ++ix) {
      const double z = ix > 5 && ix < 12 && iy > 3 && iy < 12 ? -200e-9 : 0;
      p.electrode.push_back(z - 150e-9 - 20e-9 * random.uniform());
      p.surface.push_back(z);
      p.skin.push_back(z + (z < 0 ? 250e-9 : 60e-9) + 60e-9 * random.uniform());
      p.dielectric.push_back((p.surface.back() - p.electrode.back()) / 3.9);
      const std::size_t i = p.grid.index(ix, iy);
      p.bridged[i] = ix >= 16 && ix < 19 && iy >= 5 && iy < 8;
      if (ix >= 14 && ix < 20 && iy >= 13 && iy < 18) p.water_below[i] = 30e-9;
    }
  }
  return p;
}

// Eq. electrostatics.14: what the capacitance loses when the skin rises is the squared field on it,
// all of it or a single column.
TEST(FieldInvariants, ThePullIsTheDerivativeOfTheEnergy) {
  const PotentialOptions options{.tolerance = 1e-9, .max_iterations = 200};
  PotentialProblem own = rough_bodies();
  for (const bool water : {false, true}) {
    if (!water)
      own.bridged.clear(), own.water_below.clear();
    else
      own = rough_bodies();
    const PotentialSolution s = solve_potential(own, options);
    ASSERT_TRUE(s.ok) << s.reason;
    const auto capacitance = [&](const std::function<bool(int, int)>& rises, double by) {
      PotentialProblem p = own;
      for (int iy = 0; iy < p.grid.ny; ++iy) {
        for (int ix = 0; ix < p.grid.nx; ++ix) {
          const std::size_t i = p.grid.index(ix, iy);
          if (rises(ix, iy) && (p.bridged.empty() || !p.bridged[i])) p.skin[i] += by;
        }
      }
      return solve_potential(p, options).capacitance;
    };
    const double by = 0.2e-9;
    for (const auto& rises :
         {std::function<bool(int, int)>([](int, int) { return true; }),
          std::function<bool(int, int)>([](int ix, int iy) { return ix == 3 && iy == 15; }),
          std::function<bool(int, int)>([](int ix, int iy) { return ix == 8 && iy == 6; }),
          std::function<bool(int, int)>([](int ix, int iy) { return ix == 16 && iy == 15; })}) {
      double pull = 0;
      for (int iy = 0; iy < own.grid.ny; ++iy) {
        for (int ix = 0; ix < own.grid.nx; ++ix)
          pull +=
              rises(ix, iy) ? s.square_field[own.grid.index(ix, iy)] * own.grid.pixel_area() : 0;
      }
      const double slope = (capacitance(rises, -by) - capacitance(rises, by)) / (2 * by);
      EXPECT_NEAR(slope, pull, 0.025 * pull) << water;
    }
  }
}

// Between bare bodies nothing tells the electrode from the skin.
TEST(FieldInvariants, UpsideDownTheCapacitanceIsTheSame) {
  PotentialProblem p = rough_bodies(), down;
  p.dielectric.clear(), p.bridged.clear(), p.water_below.clear();
  p.skin_layer = 0;
  p.surface = p.electrode;
  down.grid = p.grid;
  for (std::size_t i = 0; i < p.skin.size(); ++i) {
    down.electrode.push_back(-p.skin[i]);
    down.skin.push_back(-p.electrode[i]);
  }
  down.surface = down.electrode;
  const PotentialOptions options{.air_cells = 8, .tolerance = 1e-9, .max_iterations = 200};
  const PotentialSolution a = solve_potential(p, options), b = solve_potential(down, options);
  ASSERT_TRUE(a.ok && b.ok);
  EXPECT_NEAR(b.capacitance, a.capacitance, 1e-3 * a.capacitance);
}

}  // namespace
}  // namespace papilla::tests::invariants_test
