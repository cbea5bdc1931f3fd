// Drops that meet: which become one, where, and at what price.
#include "physics/capillary/drop_population.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/drop_energy.h"

namespace papilla::tests::drop_population_test {
namespace {

using namespace papilla::capillary;

constexpr double kUm = 1e-6, kGap = 100e-9;
constexpr Grid kPatch{120, 100, 12 * kUm, 10 * kUm};

Gap flat_gap() { return {kPatch, std::vector<double>(kPatch.size(), kGap)}; }

// Volume of a bridge of this radius in the flat gap.
double disc(double radius) { return kPi * radius * radius * kGap; }

struct Patch {
  Gap gap;
  DropEnergy energy;
  DropPopulation drops;

  explicit Patch(Gap over = flat_gap())
      : gap(std::move(over)), energy(gap, {}, 0.3e-9), drops(kPatch, energy) {}
  Drop bridge(double x, double y, double volume) { return energy.placed(x, y, volume, 0, true); }
  void take(const std::vector<std::vector<double>>& discs) {  // x, y, radius
    std::vector<Drop> all;
    for (const auto& d : discs) all.push_back(bridge(d[0] * kUm, d[1] * kUm, disc(d[2] * kUm)));
    drops.take(std::move(all));
  }
};

void expect_drop(const Drop& d, double x, double y, double radius) {
  EXPECT_TRUE(d.alive && d.bridge);
  EXPECT_NEAR(d.x, x * kUm, 1e-14);
  EXPECT_NEAR(d.y, y * kUm, 1e-14);
  EXPECT_NEAR(d.radius, radius * kUm, 1e-9 * radius * kUm);
  EXPECT_NEAR(d.volume, disc(radius * kUm), 1e-9 * d.volume);
}

TEST(DropPopulation, OverlappingDropsBecomeOneAtTheirCentroid) {
  Patch p;
  p.take({{0.2, 9.9, 0.3}, {5, 5, 0.4}, {11.8, 0.1, 0.6}, {6.1, 5, 0.6}});
  EXPECT_EQ(p.drops.size(), 4);
  EXPECT_EQ(p.drops.merges(), 1);
  // Volumes as 1 to 4 over both borders: 4/5 of (-0.4, 0.2) from the first; 5 and 6.1 um do not
  // overlap.
  expect_drop(p.drops[0], 11.88, 0.06, std::sqrt(0.45));
  expect_drop(p.drops[1], 5, 5, 0.4);
  EXPECT_FALSE(p.drops[2].alive);
  expect_drop(p.drops[3], 6.1, 5, 0.6);
  // What is dead has no energy.
  const double want = p.drops[0].energy + p.drops[1].energy + p.drops[3].energy;
  EXPECT_NEAR(p.drops.energy(), want, 1e-12 * std::abs(want));
  EXPECT_NEAR(p.drops[0].energy, p.bridge(1 * kUm, 1 * kUm, disc(std::sqrt(0.45) * kUm)).energy,
              1e-9 * std::abs(want));
}

TEST(DropPopulation, WhatTheMergedDropMeetsIsPartOfIt) {
  Patch p;
  // The second overlaps the first; together they are larger and meet the third, all at 4 um.
  p.take({{3, 4, 0.5}, {3.8, 4, 0.5}, {3.4, 4.9, 0.25}, {3.4, 5.6, 0.3}});
  EXPECT_EQ(p.drops.merges(), 2);
  const double third = 0.0625 / 0.5625;  // its share of the volume
  expect_drop(p.drops[0], 3.4, 4 + 0.9 * third, 0.75);
  EXPECT_FALSE(p.drops[1].alive || p.drops[2].alive);
  expect_drop(p.drops[3], 3.4, 5.6, 0.3);
}

TEST(DropPopulation, AMoveToAFreePlaceIsMade) {
  Patch p;
  p.take({{3, 4, 0.5}, {6, 4, 0.5}});
  EXPECT_TRUE(p.drops.move(0, p.bridge(4.99 * kUm, 4 * kUm, disc(0.5 * kUm))));
  EXPECT_EQ(p.drops.merges(), 0);
  expect_drop(p.drops[0], 4.99, 4, 0.5);
  // It is found where it is now and no more where it was.
  EXPECT_TRUE(p.drops.move(1, p.bridge(3.2 * kUm, 4 * kUm, disc(0.5 * kUm))));
  EXPECT_EQ(p.drops.merges(), 0);
  EXPECT_TRUE(p.drops.move(1, p.bridge(4.1 * kUm, 4 * kUm, disc(0.5 * kUm))));
  EXPECT_EQ(p.drops.merges(), 1);
}

TEST(DropPopulation, AMoveOntoOthersIsMadeWhereTheEnergyFalls) {
  Patch p;
  p.take({{3, 4, 0.5}, {6, 4, 0.5}});
  const double before = p.drops.energy();
  // In a flat gap one line is shorter than two, wherever it lies.
  EXPECT_TRUE(p.drops.move(1, p.bridge(3.9 * kUm, 4 * kUm, disc(0.5 * kUm))));
  EXPECT_FALSE(p.drops[0].alive);
  EXPECT_TRUE(p.drops[1].alive);
  EXPECT_NEAR(p.drops[1].volume, 2 * disc(0.5 * kUm), 1e-9 * disc(kUm));
  EXPECT_LT(p.drops.energy(), before);
  EXPECT_EQ(p.drops.merges(), 1);
}

// Two wells that are full, 4 um apart, in a wide gap: one drop in either well would spill over.
Gap two_wells() {
  Gap gap{kPatch, {}};
  for (int iy = 0; iy < kPatch.ny; ++iy) {
    for (int ix = 0; ix < kPatch.nx; ++ix) {
      const double a = std::hypot(kPatch.x(ix) - 3 * kUm, kPatch.y(iy) - 4 * kUm),
                   b = std::hypot(kPatch.x(ix) - 7 * kUm, kPatch.y(iy) - 4 * kUm);
      gap.value.push_back(std::min(a, b) < 0.6 * kUm ? 50e-9 : 500e-9);
    }
  }
  return gap;
}

TEST(DropPopulation, AMoveOntoOthersIsRefusedWhereTheEnergyWouldRise) {
  Patch p(two_wells());
  const double volume = kPi * square(0.5 * kUm) * 50e-9;
  p.drops.take({p.bridge(3 * kUm, 4 * kUm, volume), p.bridge(7 * kUm, 4 * kUm, volume)});
  const double before = p.drops.energy();
  EXPECT_FALSE(p.drops.move(0, p.bridge(6.9 * kUm, 4 * kUm, volume)));
  EXPECT_EQ(p.drops.energy(), before);
  EXPECT_EQ(p.drops.merges(), 0);
  EXPECT_EQ(p.drops[0].x, 3 * kUm);
  EXPECT_TRUE(p.drops[0].alive && p.drops[1].alive);
}

TEST(DropPopulation, OneDropOfManyLiesAtTheBestOfTheirPlaces) {
  // A drop outside the well meets the one in it: neither its own place nor their centroid is as
  // narrow as the well.
  Patch p(two_wells());
  const double volume = kPi * square(0.3 * kUm) * 50e-9;
  p.drops.take({p.bridge(7 * kUm, 4 * kUm, volume), p.bridge(10 * kUm, 4 * kUm, 2 * volume)});
  EXPECT_TRUE(p.drops.move(1, p.bridge(7.45 * kUm, 4 * kUm, 2 * volume)));
  EXPECT_EQ(p.drops.merges(), 1);
  EXPECT_NEAR(p.drops[1].x, 7 * kUm, 1e-18);
  EXPECT_NEAR(p.drops[1].volume, 3 * volume, 1e-12 * volume);
  // The other way round it is the mover's place.
  Patch q(two_wells());
  q.drops.take({q.bridge(7.5 * kUm, 4 * kUm, 2 * volume), q.bridge(10 * kUm, 4 * kUm, volume)});
  EXPECT_TRUE(q.drops.move(1, q.bridge(7 * kUm, 4 * kUm, volume)));
  EXPECT_NEAR(q.drops[1].x, 7 * kUm, 1e-18);
}

// Of many others the centres of the first four are tried, in the order in which they are found: the
// last of a cell first.
TEST(DropPopulation, OfManyOthersTheFirstFourPlacesAreTried) {
  for (const int well : {1, 2, 3, 4, 5, 6}) {
    Gap gap = flat_gap();
    const auto place = [](int i) {
      return std::pair{(4 + 0.3 * i) * kUm, (3.8 + 0.4 * (i % 2)) * kUm};
    };
    const auto [wx, wy] = place(well);
    for (int iy = 0; iy < kPatch.ny; ++iy) {
      for (int ix = 0; ix < kPatch.nx; ++ix) {
        const double r = std::hypot(kPatch.x(ix) - wx, kPatch.y(iy) - wy);
        gap.value[kPatch.index(ix, iy)] = kGap + 0.02 * r;
      }
    }
    Patch p(gap);
    std::vector<Drop> all{p.bridge(9 * kUm, 8 * kUm, disc(0.5 * kUm))};
    for (int i = 1; i <= 6; ++i) {
      const auto [x, y] = place(i);
      all.push_back(p.bridge(x, y, disc(0.05 * kUm)));
    }
    p.drops.take(std::move(all));
    ASSERT_EQ(p.drops.merges(), 0);
    ASSERT_TRUE(p.drops.move(0, p.bridge(5.05 * kUm, 4.01 * kUm, disc(0.9 * kUm))));
    EXPECT_EQ(p.drops.merges(), 6);
    const bool there = std::hypot(p.drops[0].x - wx, p.drops[0].y - wy) < 1e-12;
    EXPECT_EQ(there, well >= 3) << well;
  }
}

TEST(DropPopulation, ADrainedDropIsPlacedAnewOrGone) {
  Patch p;
  p.take({{3, 4, 0.5}, {6, 4, 0.5}, {9, 4, 0.5}});
  p.drops.drain(0, 0.36 * disc(0.5 * kUm));
  expect_drop(p.drops[0], 3, 4, 0.4);
  p.drops.drain(1, disc(0.5 * kUm));
  EXPECT_FALSE(p.drops[1].alive);
  p.drops.drain(2, 2 * disc(0.5 * kUm));
  EXPECT_FALSE(p.drops[2].alive);
  EXPECT_NEAR(p.drops.energy(), p.drops[0].energy, 1e-30);
  // The first is found as what it is, the others no more.
  EXPECT_TRUE(p.drops.move(0, p.bridge(6 * kUm, 4 * kUm, disc(0.4 * kUm))));
  EXPECT_EQ(p.drops.merges(), 0);
  // Little is left: a cap.
  p.drops.drain(0, disc(0.4 * kUm) - cube(50e-9));
  EXPECT_FALSE(p.drops[0].bridge);
  EXPECT_NEAR(p.drops[0].radius, cap_shape(50 * kPi / 180).widest * 50e-9, 1e-15);
}

TEST(DropPopulation, FilmsAreLeftAlone) {
  Patch p;
  std::vector<Drop> all{p.bridge(3 * kUm, 4 * kUm, disc(0.5 * kUm)),
                        p.bridge(3.1 * kUm, 4 * kUm, disc(0.5 * kUm)),
                        p.bridge(3.2 * kUm, 4 * kUm, disc(0.5 * kUm))};
  all[0].film = all[1].film = 1;
  p.drops.take(std::move(all));
  EXPECT_EQ(p.drops.merges(), 0);
  EXPECT_TRUE(p.drops[0].alive && p.drops[1].alive && p.drops[2].alive);
}

}  // namespace
}  // namespace papilla::tests::drop_population_test
