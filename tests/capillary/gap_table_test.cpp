#include "physics/capillary/gap_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/footprint.h"

namespace papilla::tests::gap_table_test {
namespace {

using namespace papilla::capillary;

// Oblong pixels, counts that no block divides.
Gap rough_gap() {
  const Grid grid{37, 22, 11e-6, 9e-6};
  Gap gap{grid, std::vector<double>(grid.size())};
  RandomStream random(5, "gap table", 0);
  for (double& h : gap.value) h = 1e-6 * random.uniform();
  return gap;
}

Gap bowl(double floor, double curvature) {
  const Grid grid{200, 160, 10e-6, 8e-6};
  Gap gap{grid, {}};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      gap.value.push_back(floor + 0.5 * curvature *
                                      (square(grid.x(ix) - 5e-6) + square(grid.y(iy) - 4e-6)));
    }
  }
  return gap;
}

TEST(GapTable, TheBoundOfTheGapsAroundAPlaceIsNeverAboveOneOfThem) {
  const Gap gap = rough_gap();
  RandomStream random(6, "places", 0);
  for (const double around : {0.05e-6, 0.3e-6, 0.77e-6, 3e-6, 40e-6}) {
    const GapTable table(gap, 0, around);
    double gained = 0;
    for (int k = 0; k < 2000; ++k) {
      const double x = random.uniform() * gap.grid.lx, y = random.uniform() * gap.grid.ly;
      const double bound = table.lowest_around(x, y);
      gained += bound;
      const double angle = 2 * kPi * random.uniform(), far = around * random.uniform();
      ASSERT_LE(bound, table.at(into_period(x + far * std::cos(angle), gap.grid.lx),
                                into_period(y + far * std::sin(angle), gap.grid.ly)))
          << around << " around " << x << ", " << y;
    }
    EXPECT_GT(gained / 2000, around < 0.1e-6 ? 0.02e-6 : 0) << "a bound of 0 is none";
  }
}

// A disc of radius r about the middle of a bowl: pi r^2 (h + c r^2 / 4); its rim h + c r^2 / 2.
TEST(GapTable, VolumeAndRimOfADiscOverABowl) {
  const double h = 0.2e-6, c = 2e5;
  const GapTable table(bowl(h, c), 0);
  for (const double r : {0.3e-6, 1e-6, 2.5e-6}) {
    const GapTable::Rule rule = table.rule(r);
    EXPECT_NEAR(table.disc_volume(5e-6, 4e-6, r, rule) / (kPi * r * r * (h + c * r * r / 4)), 1,
                2e-3);
    const GapTable::Rim rim = table.rim(5e-6, 4e-6, r, rule);
    EXPECT_NEAR(rim.gap / (h + c * r * r / 2), 1, 2e-3);
    EXPECT_NEAR(rim.slope / (c * r), 1, 5e-3);
  }
}

TEST(GapTable, AFootprintHoldsItsVolumeWhateverTheGuess) {
  const double h = 0.2e-6, c = 2e5;
  const GapTable table(bowl(h, c), 0);
  for (const double volume : {0.02e-18, 0.3e-18, 4e-18}) {
    // pi r^2 h + pi c r^4 / 4 = volume
    const double exact = std::sqrt((-h + std::sqrt(square(h) + c * volume / kPi)) / (0.5 * c));
    const double alone = solve_footprint(table, 5e-6, 4e-6, volume, 0).radius;
    EXPECT_NEAR(alone / exact, 1, 2e-3);
    for (const double guess : {0.1, 0.6, 0.99, 1.4, 12.0}) {
      const double r = solve_footprint(table, 5e-6, 4e-6, volume, guess * exact).radius;
      EXPECT_NEAR(r / alone, 1, 1e-10) << guess;
      EXPECT_NEAR(table.disc_volume(5e-6, 4e-6, r, table.rule(r)) / volume, 1, 1e-9);
    }
  }
}

// Pockets in a nearly closed gap: whatever the guess, the disc holds the volume by its own rule.
TEST(Footprint, HoldsItsVolumeInPocketsToo) {
  Gap gap = rough_gap();
  for (double& h : gap.value) h = 1e-6 * std::pow(1e6 * h, 8);
  const GapTable table(gap, 1e-10);
  RandomStream random(7, "pockets", 0);
  int off = 0;
  for (int k = 0; k < 400; ++k) {
    const double x = random.uniform() * gap.grid.lx, y = random.uniform() * gap.grid.ly;
    const double volume = 1e-20 * std::pow(10, 3 * random.uniform());
    const double guess = k % 2 ? 0 : 1e-7 * std::pow(10, 1.5 * random.uniform());
    const Footprint f = solve_footprint(table, x, y, volume, guess);
    const double held = table.disc_volume(x, y, f.radius, table.rule(f.radius));
    off += std::abs(held - volume) > 1e-8 * volume;
    EXPECT_DOUBLE_EQ(f.rim.gap, table.rim(x, y, f.radius, table.rule(f.radius)).gap);
  }
  EXPECT_LE(off, 4);  // where two rules ask for each other, the finer one's counts
}

}  // namespace
}  // namespace papilla::tests::gap_table_test
