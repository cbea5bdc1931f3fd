// Water that leads floats between film and skin: every field rule against finite volumes beside a
// straight edge, and what must not change where nothing floats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/electrostatics/field.h"
#include "physics/electrostatics/full_field.h"
#include "physics/electrostatics/screening.h"
#include "physics/electrostatics/water_bodies.h"
#include "tests/electrostatics/oxide.h"
#include "tests/electrostatics/straight_bridge.h"

namespace papilla::tests::water_potential_test {
namespace {

constexpr double kSkin = 24e-9, kPatch = 12e-6;

FieldProblem problem(double thickness, double water_skin) {
  FieldProblem p = oxide(200, thickness);
  p.skin_layer = kSkin;
  p.water_skin_layer = water_skin;
  return p;
}

// Half of the patch is under water.
Wetting strip(const Grid& grid) {
  Wetting w;
  w.grid = grid;
  w.status = WettingStatus::Film;
  w.bridges = 1;
  w.bridged.assign(grid.size(), 0);
  for (std::size_t i = 0; i < grid.size(); ++i)
    w.bridged[i] = static_cast<int>(i) % grid.nx < grid.nx / 2;
  return w;
}

Gap flat(int pixels, double g) {
  const Grid grid{pixels, 1, kPatch, kPatch};
  return {grid, std::vector<double>(grid.size(), g)};
}

// Lost beside one of the two edges of the strip [m].
double lost(const FieldSolution& wet, const Gap& gap, const FieldProblem& p) {
  EXPECT_TRUE(wet.ok) << wet.reason;
  const double dry = solve_local_field(gap, nullptr, {}, p).mean_pressure;
  return (0.5 - wet.mean_pressure / dry) * kPatch / 2;
}

StraightBridge<double> edge(double g, double thickness, double water_skin) {
  return {g, thickness, kPatch / 4, 3.9, kSkin, water_skin};
}

struct Allowed {
  double gap, local, spread, full;
};

// As docs/theory/electrostatics.md states it; pixels of 6 nm, so that the rule is what differs.
TEST(WaterPotential, EachRuleLosesThePullOfFiniteVolumesBesideAStraightEdge) {
  constexpr Allowed kAllowed[] = {
      {17e-9, 0.13, 0.06, 0.04}, {30e-9, 0.05, 0.06, 0.02}, {100e-9, 0.04, 0.08, 0.06}};
  for (const auto& [g, local, spread, full] : kAllowed) {
    const FieldProblem p = problem(500e-9, kSkin);
    const StraightBridgeField<double> exact(edge(g, 500e-9, kSkin), g / 40);
    const Gap gap = flat(2000, g);
    const Wetting water = strip(gap.grid);
    const double length = exact.lost_length();
    EXPECT_NEAR(lost(solve_local_field(gap, nullptr, water, p), gap, p), length, local * length)
        << g;
    EXPECT_NEAR(lost(solve_spread_field(gap, nullptr, water, p), gap, p), length, spread * length)
        << g;
    EXPECT_NEAR(lost(solve_full_field(gap, nullptr, water, p), gap, p), length, full * length) << g;
    // Grounded water takes far more: 2.6, 2.0 and 1.4 times as much.
    EXPECT_GT(StraightBridgeField<double>(edge(g, 500e-9, 0), g / 40).lost_length(), 1.4 * length);
  }
}

TEST(WaterPotential, TheRulesHoldFromThinFilmsToThickOnes) {
  for (const double g : {30e-9, 100e-9}) {
    for (const double x : {0.3, 1.0, 2.0, 5.0}) {
      const double d = x * g;
      const FieldProblem p = problem(d, kSkin);
      // Per length of what grounded water takes: the loss itself passes through zero.
      const double scale = screening_length(g + kSkin, d);
      const double length =
          StraightBridgeField<double>(edge(g, d, kSkin), std::min(g, d) / 40).lost_length();
      const Gap gap = flat(4000, g);
      const Wetting water = strip(gap.grid);
      EXPECT_NEAR(lost(solve_local_field(gap, nullptr, water, p), gap, p), length, 0.06 * scale)
          << g << ' ' << x;
      EXPECT_NEAR(lost(solve_spread_field(gap, nullptr, water, p, 1e-6), gap, p), length,
                  0.10 * scale)
          << g << ' ' << x;
    }
  }
}

// A wide bridge: V h/(h + d/eps), and a little more for what comes from beside it.
TEST(WaterPotential, IsTheDividerOfFilmAndSkinUnderAWideBridge) {
  for (const double h : {17e-9, 30e-9}) {
    const Grid grid{512, 1, kPatch, kPatch};
    PotentialProblem p;
    p.grid = grid;
    p.electrode.assign(grid.size(), -500e-9);
    p.surface.assign(grid.size(), 0);
    p.skin.assign(grid.size(), 50e-9);
    p.dielectric.assign(grid.size(), 500e-9 / 3.9);
    p.bridged = strip(grid).bridged;
    p.skin_layer = p.water_skin_layer = h;
    const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
    ASSERT_TRUE(s.ok) << s.reason;
    const double divider = h / (h + 500e-9 / 3.9);
    EXPECT_NEAR(s.surface_potential[10], divider, 0.03 * divider);
    EXPECT_GT(s.surface_potential[10], divider);
    EXPECT_EQ(s.surface_potential[10], s.surface_potential[200]);
    StraightBridge<double> wide = edge(50e-9, 500e-9, h);
    wide.skin_layer = h;
    EXPECT_NEAR(s.surface_potential[10], StraightBridgeField<double>(wide, 2e-9).water_potential(),
                1e-3);
  }
}

// A narrow one takes flux from the film around it and stands higher: so do the rules.
TEST(WaterPotential, StandsHigherUnderANarrowBridge) {
  const Grid grid{960, 1, kPatch, kPatch};
  PotentialProblem p;
  p.grid = grid;
  p.electrode.assign(grid.size(), -500e-9);
  p.surface.assign(grid.size(), 0);
  p.skin.assign(grid.size(), 50e-9);
  p.dielectric.assign(grid.size(), 500e-9 / 3.9);
  p.bridged.assign(grid.size(), 0);
  for (int i = 0; i < 16; ++i) p.bridged[i] = 1;  // 200 nm
  p.skin_layer = p.water_skin_layer = kSkin;
  const PotentialSolution s = solve_potential(p, {.tolerance = 1e-6});
  StraightBridge<double> narrow = edge(50e-9, 500e-9, kSkin);
  narrow.half_width = 100e-9;
  const double expected = StraightBridgeField<double>(narrow, 1.5e-9).water_potential();
  EXPECT_NEAR(s.surface_potential[3], expected, 0.02 * expected);
  EXPECT_GT(expected, 1.1 * kSkin / (kSkin + 500e-9 / 3.9));
}

// Discs of water between contacts.
struct Rough {
  Grid grid{48, 48, 4e-6, 4e-6};
  Gap gap{grid, {}};
  Wetting water;
  Rough() {
    RandomStream random(5, "rough");
    for (std::size_t i = 0; i < grid.size(); ++i)
      gap.value.push_back(40e-9 + 160e-9 * random.uniform());
    water.grid = grid;
    water.status = WettingStatus::Discs;
    water.bridged.assign(grid.size(), 0);
    for (const auto& [x, y, a] : {std::tuple{0.7e-6, 0.9e-6, 0.4e-6},
                                  {2.9e-6, 3.9e-6, 0.3e-6},
                                  {2.2e-6, 1.6e-6, 0.15e-6}}) {
      Droplet d;
      d.x = x, d.y = y, d.radius = a, d.edge_gap = d.height = 90e-9;
      d.state = DropletState::Bridge;
      water.droplets.push_back(d);
      ++water.bridges;
      for (int iy = 0; iy < 48; ++iy) {
        for (int ix = 0; ix < 48; ++ix) {
          const double dx = std::remainder((ix + 0.5) * grid.dx() - x, grid.lx),
                       dy = std::remainder((iy + 0.5) * grid.dy() - y, grid.ly);
          if (std::hypot(dx, dy) < a) water.bridged[grid.index(ix, iy)] = 1;
        }
      }
    }
  }
};

using Rule = FieldSolution (*)(const Gap&, const Wetting&, const FieldProblem&);
constexpr Rule kRules[] = {[](const Gap& g, const Wetting& w, const FieldProblem& p) {
                             return solve_local_field(g, nullptr, w, p);
                           },
                           [](const Gap& g, const Wetting& w, const FieldProblem& p) {
                             return solve_spread_field(g, nullptr, w, p, 1e-9);
                           },
                           [](const Gap& g, const Wetting& w, const FieldProblem& p) {
                             return solve_full_field(g, nullptr, w, p, {.tolerance = 1e-7});
                           }};

// A layer that vanishes grounds the water, without a step.
TEST(WaterPotential, GoesToZeroWithTheLayerInEveryRule) {
  const Rough c;
  for (const Rule rule : kRules) {
    const double grounded = rule(c.gap, c.water, problem(500e-9, 0)).mean_pressure;
    double before = 0;
    for (const double h : {1e-9, 1e-10, 1e-11}) {
      const double change = rule(c.gap, c.water, problem(500e-9, h)).mean_pressure / grounded - 1;
      EXPECT_LT(std::abs(change), 0.06 * h / 1e-9);
      before = change;
    }
    EXPECT_LT(std::abs(before), 1e-3);
    EXPECT_GT(rule(c.gap, c.water, problem(500e-9, kSkin)).mean_pressure, 1.02 * grounded);
  }
}

TEST(WaterPotential, IsOfNoAccountWhereNoDropletBridges) {
  Rough c;
  c.water.bridged.clear();
  c.water.bridges = 0;
  for (Droplet& d : c.water.droplets) d.state = DropletState::OnSubstrate;
  for (const Rule rule : kRules) {
    EXPECT_EQ(rule(c.gap, c.water, problem(500e-9, kSkin)).mean_pressure,
              rule(c.gap, c.water, problem(500e-9, 0)).mean_pressure);
  }
}

// A film that leads far better than the skin's layer: the water is at the electrode's potential, as
// the film around it is, and little is lost.
TEST(WaterPotential, IsTheElectrodesOverAFilmThatLeads) {
  for (const double g : {60e-9, 150e-9}) {
    FieldProblem p = problem(500e-9, 0);
    p.dielectric = 1e-4 * 500e-9 / 3.9;
    p.skin_layer = kSkin;
    p.water_skin_layer = 1e4 * p.dielectric;
    StraightBridge<double> leads = edge(g, 500e-9, p.water_skin_layer);
    leads.permittivity = 3.9e4;
    const StraightBridgeField<double> exact(leads, 1e-9);
    EXPECT_NEAR(exact.water_potential(), 1, 1e-3);
    const Gap gap = flat(512, g);
    const Wetting water = strip(gap.grid);
    for (const Rule rule : kRules)
      EXPECT_NEAR(lost(rule(gap, water, p), gap, p), exact.lost_length(), 0.7 * g) << g;
  }
}

// Virtual work: the water keeps its charge balance as the skin rises, and its wall rises with it.
TEST(WaterPotential, TheFullFieldsPullIsTheDerivativeOfItsEnergy) {
  const Rough c;
  PotentialProblem p;
  p.grid = c.grid;
  p.electrode.assign(c.grid.size(), -500e-9);
  p.surface.assign(c.grid.size(), 0);
  p.dielectric.assign(c.grid.size(), 500e-9 / 3.9);
  p.bridged = c.water.bridged;
  p.skin_layer = p.water_skin_layer = kSkin;
  const auto risen = [&](double by) {
    p.skin = c.gap.value;
    for (double& z : p.skin) z += by;
    return solve_potential(p, {.tolerance = 1e-8, .max_iterations = 200});
  };
  const PotentialSolution s = risen(0);
  ASSERT_TRUE(s.ok) << s.reason;
  double pull = 0;
  for (const double e2 : s.square_field) pull += e2 * c.grid.pixel_area();
  const double by = 0.2e-9;
  const double expected = (risen(-by).capacitance - risen(by).capacitance) / (2 * by);
  EXPECT_NEAR(pull, expected, 0.015 * expected);
}

// Layers that conduct: the water's potential lags. Its magnitude, as the rules take it, against
// the complex potential.
TEST(WaterPotential, TheMagnitudeOfALaggingPotentialGivesThePull) {
  for (const double phase : {0.3, 0.8}) {
    const std::complex<double> layer = std::polar(20e-9, phase);
    const double film = 500e-9 / 3.9, share = std::abs(layer / (layer + film));
    const StraightBridge<std::complex<double>> lagging{40e-9, 500e-9, 3e-6, 3.9, kSkin, layer};
    StraightBridge<double> real = edge(40e-9, 500e-9, film * share / (1 - share));
    const double exact = StraightBridgeField<std::complex<double>>(lagging, 1e-9).lost_length();
    const double grounded = StraightBridgeField<double>(edge(40e-9, 500e-9, 0), 1e-9).lost_length();
    EXPECT_NEAR(StraightBridgeField<double>(real, 1e-9).lost_length(), exact,
                (phase < 0.5 ? 0.02 : 0.10) * grounded)
        << phase;
  }
}

TEST(WaterPotential, BodiesArePixelsThatShareAnEdgeAcrossTheBorderToo) {
  const Grid grid{5, 4, 1, 1};
  // Two in a corner and opposite, one by a diagonal, a column of three.
  const std::vector<std::uint8_t> wet{1, 0, 0, 0, 1,  //
                                      0, 1, 0, 1, 0,  //
                                      0, 0, 0, 1, 0,  //
                                      0, 0, 0, 1, 0};
  const WaterBodies bodies(grid, wet, false);
  std::vector<std::size_t> sizes;
  bodies.each([&](const std::size_t* a, const std::size_t* b) { sizes.push_back(b - a); });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{2, 1, 3}));
  std::vector<double> values(20, 9);
  values[0] = 1, values[4] = 4, values[6] = 5, values[8] = 1, values[13] = 2, values[18] = 6;
  bodies.level(values, [](std::size_t i) { return i; });
  EXPECT_EQ(values[0], 2.5);
  EXPECT_EQ(values[4], 2.5);
  EXPECT_EQ(values[6], 5);
  EXPECT_EQ(values[18], 3);
  EXPECT_EQ(values[1], 9);
}

// Eq. electrostatics.9: through the whole of the film, so that pixels do not decide.
TEST(WaterPotential, ThePeakFieldOfTheDielectricHasALimitOnFinerGrids) {
  FieldProblem p = problem(500e-9, kSkin);
  std::vector<double> peaks;
  for (const int pixels : {64, 128, 256}) {
    const Gap gap = flat(pixels, 60e-9);
    peaks.push_back(solve_full_field(gap, nullptr, strip(gap.grid), p).peak_oxide_field);
  }
  EXPECT_NEAR(peaks[0], peaks[2], 2e-3 * peaks[2]);
  EXPECT_NEAR(peaks[1], peaks[2], 1e-3 * peaks[2]);
  // What the divider leaves to the film.
  const double under = p.v_peak / 3.9 / (kSkin + p.dielectric);
  EXPECT_NEAR(peaks[2], under, 0.01 * under);
}

}  // namespace
}  // namespace papilla::tests::water_potential_test
