// The energy and the force of a drop, Eqs. capillary.4 and 6, written down anew, and which state it
// takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/footprint.h"

namespace papilla::tests::drop_energy_closed_forms_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kDegree = kPi / 180;
constexpr Grid kPatch{240, 200, 12 * kUm, 10 * kUm};

WaterProperties water_of(double skin, double substrate) {
  return {.surface_tension = 0.06,
          .theta_skin = skin * kDegree,
          .theta_substrate = substrate * kDegree,
          .hysteresis = 0.25};
}

Gap flat_gap(double h) { return {kPatch, std::vector<double>(kPatch.size(), h)}; }

// Lowest at (6, 5) um, of this curvature [1/m]; the slope at a radius is the curvature times it.
Gap bowl(double lowest, double curvature) {
  Gap gap{kPatch, {}};
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix) {
      gap.value.push_back(lowest +
                          0.5 * curvature *
                              (square(kPatch.x(ix) - 6 * kUm) + square(kPatch.y(iy) - 5 * kUm)));
    }
  }
  return gap;
}

// f(theta_2, theta_1 + alpha) as the quartic through five angles up to 45 deg, by Lagrange's
// formula.
double meniscus(const WaterProperties& w, double slope) {
  const std::array<double, 5> at{-1, -0.5, 0, 0.5, 1};
  const double x = std::clamp(std::atan(slope) / (kPi / 4), -1.0, 1.0);
  double sum = 0;
  for (int i = 0; i < 5; ++i) {
    double term =
        meniscus_factor(w.theta_substrate, std::clamp(w.theta_skin + at[i] * kPi / 4, 0.0, kPi));
    for (int j = 0; j < 5; ++j) term *= i == j ? 1 : (x - at[j]) / (at[i] - at[j]);
    sum += term;
  }
  return sum;
}

double fading(double slope) { return 1 / (1 + square(std::atan(slope) / (15 * kDegree))); }

// Of a slab with this rim, per tension.
double slab(const WaterProperties& w, double r, double edge_gap, double slope) {
  const double alpha = std::atan(std::clamp(slope, -1.0, 1.0));
  return -(std::cos(w.theta_skin) + std::cos(w.theta_substrate) +
           std::cos(w.theta_skin) * square(std::tan(0.5 * alpha))) *
             kPi * r * r +
         2 * kPi * r * meniscus(w, slope) * edge_gap;
}

// Exact flat bridge less slab, per tension: energy and its derivative by the mean gap.
struct Beyond {
  double energy, force;
};
Beyond beyond(const WaterProperties& w, double volume, double r) {
  const BridgeTable table(w.theta_skin, w.theta_substrate);
  const double h = volume / (kPi * r * r);
  if (h >= table.limits().rupture * std::cbrt(volume)) return {0, 0};
  const BridgeTable::Value exact = table.evaluate(h, volume, 1);
  const double c = std::cos(w.theta_skin) + std::cos(w.theta_substrate);
  const double f = meniscus_factor(w.theta_skin, w.theta_substrate);
  // Of a disc of the same volume: -C V / h + 2 f sqrt(pi V h).
  return {exact.energy + c * volume / h - 2 * f * std::sqrt(kPi * volume * h),
          exact.force - c * volume / (h * h) - f * std::sqrt(kPi * volume / h)};
}

double energy_of(const WaterProperties& w, const Drop& d) {
  return w.surface_tension * (slab(w, d.radius, d.edge_gap, d.edge_slope) +
                              fading(d.edge_slope) * beyond(w, d.volume, d.radius).energy);
}

struct Case {
  double skin, substrate, lowest, curvature, x, y, volume;
};
// Flat; in the middle of bowls from shallow to steeper than 45 deg and of a hill; beside the
// middle.
const std::vector<Case> kCases{
    {80, 50, 100e-9, 0, 3e-6, 4e-6, 0.02e-18},       {80, 50, 100e-9, 1e5, 6e-6, 5e-6, 0.1e-18},
    {80, 50, 60e-9, 3e5, 6.4e-6, 4.8e-6, 0.1e-18},   {60, 95, 60e-9, 8e5, 6e-6, 5e-6, 0.1e-18},
    {20, 20, 40e-9, 1.5e6, 6e-6, 5e-6, 0.6e-18},     {80, 50, 900e-9, -2e5, 6e-6, 5e-6, 1.2e-18},
    {110, 80, 50e-9, 2e5, 5.8e-6, 5.3e-6, 0.05e-18}, {150, 20, 80e-9, 2e5, 6.1e-6, 5e-6, 0.05e-18}};

TEST(DropEnergyClosedForms, ABridgeHasTheEnergyOfItsRimAndOfTheExactFlatOne) {
  for (const Case& c : kCases) {
    const WaterProperties w = water_of(c.skin, c.substrate);
    const Gap gap = bowl(c.lowest, c.curvature);
    DropEnergy energy(gap, w, 0.3e-9);
    const GapTable table(gap, 0.3e-9);
    const Drop d = energy.kept(c.x, c.y, c.volume, 0.5e-6);
    ASSERT_TRUE(d.bridge) << c.skin << " " << c.curvature;
    const Footprint f = solve_footprint(table, c.x, c.y, c.volume, 0);
    EXPECT_NEAR(d.radius, f.radius, 1e-9 * f.radius);
    EXPECT_NEAR(d.edge_gap, f.rim.gap, 1e-9 * f.rim.gap);
    EXPECT_NEAR(d.edge_slope, f.rim.slope, 1e-8);
    EXPECT_NEAR(d.edge_slope, c.curvature * d.radius,
                0.02 * std::abs(c.curvature * d.radius) + 1e-12);
    EXPECT_EQ(d.x, c.x);
    EXPECT_EQ(d.y, c.y);
    EXPECT_EQ(d.volume, c.volume);
    EXPECT_TRUE(d.alive);
    EXPECT_EQ(d.film, 0);
    const double want = energy_of(w, d);
    EXPECT_NEAR(d.energy, want, 1e-10 * std::abs(want)) << c.skin << " " << c.curvature;
    EXPECT_EQ(energy.evaluations(), 1);
  }
}

TEST(DropEnergyClosedForms, ItsForceIsTheChangeOfThatEnergyByTheGap) {
  for (const Case& c : kCases) {
    const WaterProperties w = water_of(c.skin, c.substrate);
    const Gap gap = bowl(c.lowest, c.curvature);
    DropEnergy energy(gap, w, 0.3e-9);
    const GapTable table(gap, 0.3e-9);
    const Drop d = energy.kept(c.x, c.y, c.volume, 0);
    const double r = d.radius;
    // The gap opens under the same rim, which shrinks by r / 2 h_e: by rims 4 % inside and outside.
    const auto rim = [&](double radius) { return table.rim(c.x, c.y, radius, table.rule(r)); };
    const GapTable::Rim in = rim(0.96 * r), out = rim(1.04 * r);
    const Beyond b = beyond(w, c.volume, r);
    const double by_radius = (slab(w, 1.04 * r, out.gap, out.slope) + fading(out.slope) * b.energy -
                              slab(w, 0.96 * r, in.gap, in.slope) - fading(in.slope) * b.energy) /
                             (0.08 * r);
    const double want =
        w.surface_tension *
        (2 * kPi * r * meniscus(w, d.edge_slope) - r / (2 * d.edge_gap) * by_radius +
         fading(d.edge_slope) * b.force * c.volume / (kPi * r * r) / d.edge_gap);
    const double scale = std::abs(want) + w.surface_tension * std::cbrt(c.volume);
    EXPECT_NEAR(energy.force(d), want, 1e-9 * scale) << c.skin << " " << c.curvature;
    // And the difference of energies of the whole, over gaps 0.4 nm apart; what the 4 % leave is
    // largest where the force passes through zero.
    Gap up = gap, down = gap;
    for (double& h : up.value) h += 0.2e-9;
    for (double& h : down.value) h -= 0.2e-9;
    const double slope = (DropEnergy(up, w, 0.1e-9).kept(c.x, c.y, c.volume, r).energy -
                          DropEnergy(down, w, 0.1e-9).kept(c.x, c.y, c.volume, r).energy) /
                         0.4e-9;
    EXPECT_NEAR(energy.force(d), slope, 0.015 * scale) << c.skin << " " << c.curvature;
    EXPECT_NEAR(energy.retention(d), kPi / 2 * 0.06 * r * 0.25, 1e-12 * 0.06 * r);
    // Preset m3, Eq. capillary.24.
    WaterProperties paper = w;
    paper.pressure_alone = true;
    const double pressure =
        0.06 * kPi * r * r *
        ((std::cos(w.theta_skin) + std::cos(w.theta_substrate)) / d.edge_gap - 1 / r);
    EXPECT_NEAR(DropEnergy(gap, paper, 0.3e-9).force(d), pressure,
                1e-9 * std::abs(pressure) + 1e-20);
  }
}

TEST(DropEnergyClosedForms, AnEstimateIsTheEnergyAtTheNextPlaceToFirstOrder) {
  for (const Case& c : kCases) {
    const WaterProperties w = water_of(c.skin, c.substrate);
    const Gap gap = bowl(c.lowest, c.curvature);
    DropEnergy energy(gap, w, 0.3e-9);
    const GapTable table(gap, 0.3e-9);
    const Drop d = energy.kept(c.x, c.y, c.volume, 0);
    const double r = d.radius;
    EXPECT_NEAR(energy.estimated(d, c.x, c.y), d.energy, 1e-9 * std::abs(d.energy));
    const double x = c.x + 60e-9, y = c.y - 40e-9;
    // The radius changes by what is missing over the wall at the rim; wetting and line follow it.
    const GapTable::Rule rule = table.rule(r);
    const GapTable::Rim rim = table.rim(x, y, r, rule);
    const double change = (c.volume - table.disc_volume(x, y, r, rule)) / (2 * kPi * r * rim.gap);
    Drop there = d;
    there.edge_gap = rim.gap;
    there.edge_slope = rim.slope;
    const double gain = std::cos(w.theta_skin) + std::cos(w.theta_substrate);
    const double want =
        energy_of(w, there) +
        w.surface_tension * change *
            (-gain * 2 * kPi * r + meniscus_factor(w.theta_skin, w.theta_substrate) * 2 * kPi *
                                       (rim.gap + r * rim.slope));
    EXPECT_NEAR(energy.estimated(d, x, y), want, 1e-9 * std::abs(want)) << c.skin << c.curvature;
    const long before = energy.evaluations();
    energy.estimated(d, x, y);
    EXPECT_EQ(energy.evaluations(), before + 1);
  }
}

TEST(DropEnergyClosedForms, FarFromHereTheEstimateIsTheEnergyThere) {
  const WaterProperties w = water_of(80, 50);
  DropEnergy energy(bowl(50e-9, 2e5), w, 0.3e-9);
  const Drop d = energy.placed(6 * kUm, 5 * kUm, 0.05e-18, 0, true);
  const Drop far = energy.kept(7.2 * kUm, 5 * kUm, 0.05e-18, 0);
  ASSERT_TRUE(d.bridge && far.bridge);
  ASSERT_LT(far.radius, 0.7 * d.radius);
  const long before = energy.evaluations();
  EXPECT_NEAR(energy.estimated(d, 7.2 * kUm, 5 * kUm), far.energy, 1e-8 * std::abs(far.energy));
  EXPECT_EQ(energy.evaluations(), before + 2);  // the estimate and the bridge
}

TEST(DropEnergyClosedForms, ACapHasItsShapeOnTheSideOfLowerAngle) {
  for (const auto& [skin, substrate] :
       {std::pair{80.0, 50.0}, {50.0, 80.0}, {120.0, 130.0}, {70.0, 70.0}}) {
    const WaterProperties w = water_of(skin, substrate);
    DropEnergy energy(flat_gap(5 * kUm), w, 0.3e-9);
    const double theta = std::min(skin, substrate) * kDegree, volume = 8e-21;
    const CapShape cap = cap_shape(theta);
    // Outside the period, a guess or not.
    const Drop d = energy.placed(-1 * kUm, 23 * kUm, volume, 0, false);
    EXPECT_FALSE(d.bridge);
    EXPECT_NEAR(d.x, 11 * kUm, 1e-17);
    EXPECT_NEAR(d.y, 3 * kUm, 1e-17);
    EXPECT_NEAR(d.radius, cap.widest * 2e-7, 1e-18);
    EXPECT_EQ(d.edge_gap, 0);
    EXPECT_EQ(d.edge_slope, 0);
    EXPECT_NEAR(d.energy, 0.06 * cap.energy * 4e-14, 1e-12 * d.energy);
    EXPECT_EQ(energy.evaluations(), 0);
    EXPECT_EQ(d.side, skin < substrate ? DropletState::OnSkin : DropletState::OnSubstrate);
    EXPECT_EQ(energy.cap_state(), d.side);
    EXPECT_NEAR(d.footprint, cap.footprint * 2e-7, 1e-18);
    EXPECT_NEAR(d.height, cap.height * 2e-7, 1e-18);
  }
}

// 80 and 50 deg in a flat gap, lengths in V^(1/3): bridges cost less than caps up to the switching
// gap; one that is there stays up to its rupture; tried is up to 1.3 times the switching.
TEST(DropEnergyClosedForms, ADropTakesTheStateOfItsGap) {
  const WaterProperties w = water_of(80, 50);
  const BridgeLimits limits = bridge_limits(80 * kDegree, 50 * kDegree);
  const double size = 2e-7, volume = 8e-21;
  struct State {
    bool bridge;
    long asked;
  };
  const auto placed = [&](double h, bool was) {
    DropEnergy energy(flat_gap(h * size), w, 0.3e-9);
    const Drop d = energy.placed(1 * kUm, 1 * kUm, volume, 0, was);
    return State{d.bridge, energy.evaluations()};
  };
  const auto kept = [&](double h) {
    DropEnergy energy(flat_gap(h * size), w, 0.3e-9);
    return energy.kept(1 * kUm, 1 * kUm, volume, 0).bridge;
  };
  for (const bool was : {false, true}) {
    EXPECT_TRUE(placed(0.999 * limits.switching, was).bridge) << was;
    EXPECT_FALSE(placed(1.001 * limits.switching, was).bridge) << was;
  }
  EXPECT_EQ(placed(1.299 * limits.switching, false).asked, 1);
  EXPECT_EQ(placed(1.301 * limits.switching, false).asked, 0);
  EXPECT_EQ(placed(1.301 * limits.switching, true).asked, 1);
  EXPECT_TRUE(kept(1.001 * limits.switching));
  EXPECT_TRUE(kept(0.999 * limits.rupture));
  EXPECT_FALSE(kept(1.001 * limits.rupture));
}

TEST(DropEnergyClosedForms, ACapThatIsTallerThanTheGapMustBridge) {
  // Beyond 180 deg a bridge may cost more than the cap; 175 and 160 deg have no gap at which it
  // pays.
  const BridgeLimits limits = bridge_limits(175 * kDegree, 160 * kDegree);
  const WaterProperties w = water_of(175, 160);
  const double size = 2e-7, height = cap_shape(160 * kDegree).height;
  const auto bridges = [&](double h) {
    return DropEnergy(flat_gap(h * size), w, 0.3e-9).placed(0, 0, cube(size), 0, false).bridge;
  };
  EXPECT_TRUE(bridges(0.999 * height));
  EXPECT_EQ(bridges(1.001 * height), limits.switching > 1.001 * height);
  // Squeezed flat it costs far more than a cap, and is a bridge all the same.
  DropEnergy energy(flat_gap(0.3 * size), w, 0.3e-9);
  const Drop d = energy.placed(0, 0, cube(size), 0, false);
  EXPECT_TRUE(d.bridge);
  EXPECT_GT(d.energy, 0.06 * cap_shape(160 * kDegree).energy * size * size);
}

TEST(DropEnergyClosedForms, OnlyWhereNoGapInReachIsNarrowADropFloats) {
  const WaterProperties w = water_of(80, 50);
  const double reach = 1.3 * bridge_limits(80 * kDegree, 50 * kDegree).switching, h = 300e-9;
  Gap gap = flat_gap(h);
  DropEnergy energy(gap, w, 0.3e-9, 0.2 * kUm);
  const auto floats = [&](DropEnergy& e, double size, double x, double y) {
    return e.floats_around({.x = x, .y = y, .volume = cube(size)});
  };
  EXPECT_TRUE(floats(energy, 0.999 * h / reach, 1 * kUm, 1 * kUm));
  EXPECT_FALSE(floats(energy, 1.001 * h / reach, 1 * kUm, 1 * kUm));
  // A narrow pixel at (6, 5) um is seen from nearby and not from afar.
  gap.value[kPatch.index(120, 100)] = 10e-9;
  DropEnergy narrow(gap, w, 0.3e-9, 0.2 * kUm);
  EXPECT_FALSE(floats(narrow, 0.9 * h / reach, 6.2 * kUm, 5.1 * kUm));
  EXPECT_TRUE(floats(narrow, 0.9 * h / reach, 9 * kUm, 5.1 * kUm));
  EXPECT_TRUE(floats(narrow, 0.9 * h / reach, 6.2 * kUm, 8 * kUm));
}

TEST(DropEnergyClosedForms, AGapNearerThanAMoleculeCountsAsAMolecule) {
  const WaterProperties w = water_of(80, 50);
  DropEnergy energy(flat_gap(0), w, 2e-9);
  EXPECT_EQ(energy.gap_at(1 * kUm, 1 * kUm), 2e-9);
  const Drop d = energy.placed(1 * kUm, 1 * kUm, 2e-9 * kPi * 1e-12, 0, false);
  EXPECT_NEAR(d.radius, 1 * kUm, 1e-15);
}

}  // namespace
}  // namespace papilla::tests::drop_energy_closed_forms_test
