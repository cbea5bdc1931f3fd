// Drops that walk downhill: their steps and energies counted, where they end, and what holds them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/settling.h"

namespace papilla::tests::settling_by_count_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kStep = 200e-9, kDiagonal = 0.7071067811865476;
constexpr Grid kPatch{240, 200, 12 * kUm, 10 * kUm};

// Lowest at (mx, my) [m], over the borders too.
Gap bowl(double mx, double my) {
  Gap gap{kPatch, {}};
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix) {
      const double ex = nearest_image(kPatch.x(ix) - mx, kPatch.lx),
                   ey = nearest_image(kPatch.y(iy) - my, kPatch.ly);
      gap.value.push_back(60e-9 + (square(ex) + square(ey)) / (2 * 60e-6));
    }
  }
  return gap;
}

constexpr double kVolume = 0.02e-18;  // a bridge of about 0.3 um

TEST(SettlingByCount, ADropWalksStraightToTheLowestPlaceInAllDirections) {
  // The bottom is a corner of pixels, so that both sides of it are the same.
  const double mx = 0.6 * kUm, my = 9.7 * kUm;
  const Gap gap = bowl(mx, my);
  const std::array<std::array<double, 2>, 8> ways = {{{1, 0},
                                                      {kDiagonal, kDiagonal},
                                                      {0, 1},
                                                      {-kDiagonal, kDiagonal},
                                                      {-1, 0},
                                                      {-kDiagonal, -kDiagonal},
                                                      {0, -1},
                                                      {kDiagonal, -kDiagonal}}};
  for (const auto& way : ways) {
    SettleReport report;
    const DropletSeed seed{into_period(mx + 5 * kStep * way[0], kPatch.lx),
                           into_period(my + 5 * kStep * way[1], kPatch.ly), kVolume};
    const Wetting w = settle_droplets(gap, {seed}, {}, {}, &report);
    ASSERT_EQ(w.droplets.size(), 1u);
    EXPECT_NEAR(nearest_image(w.droplets[0].x - mx, kPatch.lx), 0, 1e-14) << way[0] << way[1];
    EXPECT_NEAR(nearest_image(w.droplets[0].y - my, kPatch.ly), 0, 1e-14) << way[0] << way[1];
    // Five steps of 200 nm and none of 100, 50, 25 and 12.5.
    EXPECT_EQ(report.moves, 5);
    EXPECT_EQ(report.merges, 0);
    EXPECT_EQ(report.initial_droplets, 1);
    EXPECT_TRUE(report.converged);
    EXPECT_FALSE(report.energy_rose);
    // Asked: where it starts; eight directions; five steps and one too many; from there the six
    // directions that neither led here nor were that one; eight for each of the four halves.
    EXPECT_EQ(report.evaluations, 1 + 8 + 6 + 6 + 4 * 8);
    DropEnergy energy(gap, {}, 0.3e-9);
    EXPECT_NEAR(report.initial_energy, energy.placed(seed.x, seed.y, kVolume, 0, false).energy,
                1e-9 * std::abs(report.initial_energy));
    EXPECT_NEAR(report.final_energy, energy.placed(mx, my, kVolume, 0, false).energy,
                1e-9 * std::abs(report.final_energy));
    EXPECT_NEAR(w.droplets[0].energy, report.final_energy, 1e-9 * std::abs(report.final_energy));
    EXPECT_LT(report.final_energy, report.initial_energy);
  }
}

TEST(SettlingByCount, ItsLastStepsAreHalvesOfTheFirst) {
  const double mx = 6 * kUm, my = 5 * kUm;
  const Gap gap = bowl(mx, my);
  // 200 + 100 + 25 nm away: a step of each, the others find nothing lower.
  const auto settled = [&](int halvings, double away) {
    DropletOptions options;
    options.halvings = halvings;
    SettleReport report;
    const Wetting w = settle_droplets(gap, {{mx - away, my, kVolume}}, {}, options, &report);
    EXPECT_TRUE(report.converged);
    return std::pair{report.moves, w.droplets.at(0).x - mx};
  };
  const auto expect = [&](int halvings, double away, int moves, double left) {
    const auto [got, at] = settled(halvings, away);
    EXPECT_EQ(got, moves) << halvings << " " << away;
    EXPECT_NEAR(at, left, 1e-14) << halvings << " " << away;
  };
  expect(0, 325e-9, 2, 75e-9);   // 325, 125, -75
  expect(1, 325e-9, 3, -25e-9);  // and 100 back: 75 above, 25 below
  expect(3, 325e-9, 4, 0);       // 25
  expect(4, 325e-9, 4, 0);
  expect(4, 12.5e-9, 1, 0);
  expect(3, 12.5e-9 + 1e-9, 1, 11.5e-9);  // 25 nm overshoots to a place that is nearer
  expect(0, 90e-9, 0, -90e-9);
}

TEST(SettlingByCount, ADropStopsAtItsMostMoves) {
  const double mx = 6 * kUm, my = 5 * kUm;
  DropletOptions options;
  options.max_moves = 3;
  SettleReport report;
  const Wetting w =
      settle_droplets(bowl(mx, my), {{mx + 5 * kStep, my, kVolume}}, {}, options, &report);
  // Three steps of 200 nm, three of 100 and, within what is allowed, two of 50.
  EXPECT_EQ(report.moves, 8);
  EXPECT_FALSE(report.converged);
  EXPECT_NEAR(w.droplets.at(0).x, mx, 1e-14);
  options.halvings = 0;
  const Wetting first =
      settle_droplets(bowl(mx, my), {{mx + 5 * kStep, my, kVolume}}, {}, options, &report);
  EXPECT_EQ(report.moves, 3);
  EXPECT_FALSE(report.converged);
  EXPECT_NEAR(first.droplets.at(0).x, mx + 2 * kStep, 1e-14);
  options.max_moves = 6;
  settle_droplets(bowl(mx, my), {{mx + 5 * kStep, my, kVolume}}, {}, options, &report);
  EXPECT_EQ(report.moves, 5);
  EXPECT_TRUE(report.converged);
  options.max_moves = 0;
  const Wetting at_rest =
      settle_droplets(bowl(mx, my), {{mx + 5 * kStep, my, kVolume}}, {}, options, &report);
  EXPECT_EQ(report.moves, 0);
  EXPECT_EQ(at_rest.droplets.at(0).x, mx + 5 * kStep);
}

TEST(SettlingByCount, DropsThatMeetOnTheirWayBecomeOneAtTheBottom) {
  const double mx = 6 * kUm, my = 5 * kUm;
  const Gap gap = bowl(mx, my);
  SettleReport report;
  const Wetting w = settle_droplets(
      gap,
      {{mx + 6 * kStep, my, kVolume}, {mx - 6 * kStep, my, kVolume}, {mx, my + 8 * kStep, kVolume}},
      {}, {}, &report);
  ASSERT_EQ(w.droplets.size(), 1u);
  EXPECT_EQ(report.initial_droplets, 3);
  EXPECT_EQ(report.merges, 2);
  EXPECT_NEAR(w.droplets[0].volume, 3 * kVolume, 1e-12 * kVolume);
  EXPECT_NEAR(w.droplets[0].x, mx, 13e-9);
  EXPECT_NEAR(w.droplets[0].y, my, 13e-9);
  EXPECT_FALSE(report.energy_rose);
  EXPECT_NEAR(w.droplets[0].energy, report.final_energy, 1e-12 * std::abs(report.final_energy));
}

TEST(SettlingByCount, DropsThatOverlapAtFirstMergeBeforeTheirEnergyIsCounted) {
  const double mx = 6 * kUm, my = 5 * kUm;
  const Gap gap = bowl(mx, my);
  DropletOptions rest;
  rest.max_moves = 0;
  SettleReport report;
  const Wetting w = settle_droplets(
      gap, {{mx - 0.1 * kUm, my, kVolume}, {mx + 0.1 * kUm, my, kVolume}}, {}, rest, &report);
  ASSERT_EQ(w.droplets.size(), 1u);
  EXPECT_EQ(report.initial_droplets, 2);
  EXPECT_EQ(report.merges, 1);
  EXPECT_NEAR(w.droplets[0].x, mx, 1e-17);
  DropEnergy energy(gap, {}, 0.3e-9);
  const double one = energy.placed(mx, my, 2 * kVolume, 0, true).energy;
  EXPECT_NEAR(report.initial_energy, one, 1e-9 * std::abs(one));
  EXPECT_NEAR(report.final_energy, one, 1e-9 * std::abs(one));
  // A drop over a placed one and the trial of their one: 2 and 1.
  EXPECT_EQ(report.evaluations, 3);
}

TEST(SettlingByCount, ACapFloatsWhereNothingNarrowIsAndFallsIntoBridgesNearby) {
  // A trench of 50 nm below x = 3 um in a gap of 400 nm, and a drop of 0.25 um: it bridges up to
  // 0.875 of its size, 219 nm.
  Gap gap{kPatch, {}};
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix)
      gap.value.push_back(kPatch.x(ix) < 3 * kUm ? 50e-9 : 400e-9);
  }
  const double volume = cube(0.25e-6);
  const auto settled = [&](double x, SettleReport& report) {
    return settle_droplets(gap, {{x, 5 * kUm, volume}}, {}, {}, &report).droplets.at(0);
  };
  SettleReport report;
  const Droplet far = settled(7 * kUm, report);
  EXPECT_EQ(far.state, DropletState::OnSubstrate);
  EXPECT_EQ(far.x, 7 * kUm);
  EXPECT_EQ(report.moves, 0);
  EXPECT_EQ(report.evaluations, 0);  // of bridges none is asked
  const Droplet near = settled(3.15 * kUm, report);
  EXPECT_EQ(near.state, DropletState::Bridge);
  EXPECT_LT(near.x, 3 * kUm);
  EXPECT_GT(report.moves, 0);
}

// --- pinning ---

// A step down of 300 nm at x = 6 um under a skin that comes down towards x = 7.5 um: a free bridge
// on the land runs over the edge. Gaps 40 to 100 nm on the land.
struct Stepped {
  Heightmap texture{kPatch, {}};
  Gap gap{kPatch, {}};

  explicit Stepped(double depth) {
    for (int iy = 0; iy < kPatch.ny; ++iy) {
      for (int ix = 0; ix < kPatch.nx; ++ix) {
        const double x = kPatch.x(ix), z = x > 6 * kUm && x < 10 * kUm ? -depth : 0;
        texture.z.push_back(z);
        gap.value.push_back(40e-9 + 0.02 * std::abs(x - 7.5 * kUm) - z);
      }
    }
  }
  Droplet settled(bool pinned, const WaterProperties& water, double x, SettleReport& report) const {
    DropletOptions options;
    options.rims = std::make_shared<RimMap>(texture);
    options.rim_pinning = pinned;
    return settle_droplets(gap, {{x, 5 * kUm, kVolume}}, water, options, &report).droplets.at(0);
  }
};

TEST(SettlingByCount, AnEdgeHoldsABridgeThatItsAngleDoesNotLetPass) {
  const Stepped at(4e-9);
  SettleReport report;
  // 80 and 50 deg and walls of 90: 50 + 90 + 80 > 180, no line passes.
  const Droplet free = at.settled(false, {}, 5 * kUm, report);
  EXPECT_NEAR(free.x, 7.5 * kUm, 0.1 * kUm);
  const Droplet held = at.settled(true, {}, 5 * kUm, report);
  EXPECT_LT(held.x + held.radius, 6.05 * kUm);  // up to the pixel beside the edge
  EXPECT_GT(held.x + held.radius, 5.9 * kUm);
  EXPECT_FALSE(report.energy_rose);
  // What lies over the edge from the start has reached it.
  const Droplet over = at.settled(true, {}, 6 * kUm, report);
  EXPECT_GT(over.x, 6 * kUm);
  // A valid map without pinning, and pinning without a map, hold nothing.
  DropletOptions no_map;
  no_map.rim_pinning = true;
  EXPECT_EQ(settle_droplets(at.gap, {{5 * kUm, 5 * kUm, kVolume}}, {}, no_map).droplets.at(0).x,
            free.x);
}

TEST(SettlingByCount, AnEdgeLetsPassWhereTheGapIsNarrowEnough) {
  // Angles of 20 and 20 deg: at 90 deg walls cos(theta*) < cos(110 deg) where local / edge gap is
  // below (cos(20) - cos(70)) / (2 cos(20)) = 0.318; the gap at the edge is about the bridge's own.
  WaterProperties water;
  water.theta_skin = water.theta_substrate = 20 * kPi / 180;
  const Stepped at(4e-9);
  SettleReport report;
  EXPECT_LT(at.settled(true, water, 5 * kUm, report).x, 6 * kUm);
  // A ridge of the skin of 15 nm along the edge: there the line passes.
  Stepped narrow(4e-9);
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix) {
      if (std::abs(kPatch.x(ix) - 6 * kUm) < 0.06 * kUm)
        narrow.gap.value[kPatch.index(ix, iy)] = 8e-9;
    }
  }
  EXPECT_GT(narrow.settled(true, water, 5 * kUm, report).x + 0.4 * kUm, 6 * kUm);
}

}  // namespace
}  // namespace papilla::tests::settling_by_count_test
