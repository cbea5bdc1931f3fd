// Every answer of the gap table against the same rule computed pixel by pixel, inside the patch,
// over its borders and for discs that are wider than it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/footprint.h"
#include "physics/capillary/gap_table.h"

namespace papilla::tests::gap_table_second_method_test {
namespace {

using namespace papilla::capillary;

constexpr Grid kOblong{19, 13, 9.5e-6, 9.1e-6};  // pixels of 0.5 x 0.7 um

Gap random_gap() {
  Gap gap{kOblong, std::vector<double>(kOblong.size())};
  RandomStream random(9, "gaps of a table", 0);
  for (double& h : gap.value) h = 1e-6 * random.uniform();
  return gap;
}

// Node k of a row, periodic.
double node(const Gap& gap, int ix, int iy, double floor) {
  const Grid& g = gap.grid;
  return std::max(floor, gap.value[g.index(wrap(ix, g.nx), wrap(iy, g.ny))]);
}

// Between the centres of four pixels.
double bilinear(const Gap& gap, double x, double y, double floor) {
  const double u = x / gap.grid.dx() - 0.5, v = y / gap.grid.dy() - 0.5;
  const int ix = static_cast<int>(std::floor(u)), iy = static_cast<int>(std::floor(v));
  const double fx = u - ix, fy = v - iy;
  return (1 - fx) * (1 - fy) * node(gap, ix, iy, floor) +
         fx * (1 - fy) * node(gap, ix + 1, iy, floor) +
         (1 - fx) * fy * node(gap, ix, iy + 1, floor) + fx * fy * node(gap, ix + 1, iy + 1, floor);
}

// Integral along x between two places, pixel by pixel: between centres the gap is linear.
double along_row(const Gap& gap, double from, double to, double y, double floor) {
  const double dx = gap.grid.dx();
  double sum = 0, at = from;
  while (at < to) {
    const double next = std::min(to, (std::floor(at / dx - 0.5 + 1e-9) + 1.5) * dx);
    sum += 0.5 * (next - at) * (bilinear(gap, at, y, floor) + bilinear(gap, next, y, floor));
    at = next;
  }
  return sum;
}

constexpr std::array<int, 16> kCounts = {8,   12,  16,  24,  32,  48,  64,   96,
                                         128, 192, 256, 384, 512, 768, 1024, 1536};

// Chords at r cos(j pi / (N + 1)), Gauss and Chebyshev's rule of the second kind.
double by_chords(const Gap& gap, double x, double y, double radius, int chords, double floor) {
  double sum = 0;
  for (int j = 1; j <= chords; ++j) {
    const double angle = j * kPi / (chords + 1), half = radius * std::sin(angle);
    sum += kPi / (chords + 1) * std::sin(angle) * radius *
           along_row(gap, x - half, x + half, y + radius * std::cos(angle), floor);
  }
  return sum;
}

double by_points(const Gap& gap, double x, double y, double radius, int points, double floor) {
  double sum = 0;
  for (int j = 0; j < points; ++j) {
    const double angle = (j + 0.5) * 2 * kPi / points;
    sum += bilinear(gap, x + radius * std::cos(angle), y + radius * std::sin(angle), floor);
  }
  return sum / points;
}

// Inside, over each border and corner, wider than the patch.
const std::vector<std::array<double, 3>> kPlaces{
    {4.7e-6, 4.4e-6, 1.9e-6},  {5.0e-6, 4.6e-6, 0.4e-6}, {0.4e-6, 4.4e-6, 1.1e-6},
    {9.3e-6, 4.1e-6, 1.3e-6},  {4.7e-6, 0.2e-6, 0.9e-6}, {4.1e-6, 8.9e-6, 1.3e-6},
    {0.1e-6, 0.2e-6, 2.2e-6},  {9.4e-6, 9.0e-6, 0.2e-6}, {4.6e-6, 4.5e-6, 4.4e-6},
    {3.3e-6, 2.2e-6, 12.1e-6}, {2.6e-6, 4.5e-6, 2.2e-6}};

TEST(GapTableSecondMethod, APlaceLiesBetweenFourPixels) {
  const Gap gap = random_gap();
  const GapTable table(gap, 0.2e-6);
  EXPECT_TRUE(table.grid() == kOblong);
  for (int iy = 0; iy < kOblong.ny; ++iy) {
    for (int ix = 0; ix < kOblong.nx; ++ix)
      EXPECT_NEAR(table.at(kOblong.x(ix), kOblong.y(iy)), node(gap, ix, iy, 0.2e-6), 1e-19);
  }
  for (const auto& [x, y, radius] : kPlaces)
    EXPECT_NEAR(table.at(x, y), bilinear(gap, x, y, 0.2e-6), 1e-19) << x << " " << y;
  for (const auto& [x, y] : {std::pair{-3.3e-6, 23e-6}, {21e-6, -0.1e-6}, {9.49e-6, 9.09e-6}})
    EXPECT_NEAR(table.at(x, y), bilinear(gap, x, y, 0.2e-6), 1e-19) << x << " " << y;
}

TEST(GapTableSecondMethod, AroundAPlaceLieEightOthers) {
  const Gap gap = random_gap();
  const GapTable table(gap, 0.2e-6);
  for (const auto& [x, y, step] : kPlaces) {
    const std::array<double, 8> around = table.around(x, y, step);
    for (int k = 0; k < 8; ++k) {
      EXPECT_NEAR(
          around[k],
          bilinear(gap, x + step * std::cos(k * kPi / 4), y + step * std::sin(k * kPi / 4), 0.2e-6),
          1e-18)
          << x << " " << y << " " << k;
    }
  }
}

TEST(GapTableSecondMethod, ARuleHasThreeChordsInFourPixelsAndFourAndAHalfPointsAPixel) {
  const GapTable table(random_gap(), 0);
  for (double radius = 0.01e-6; radius < 3e-3; radius *= 1.13) {
    const GapTable::Rule rule = table.rule(radius);
    const auto least = [](double wanted) {
      int k = 0;
      while (k < 15 && kCounts[k] < wanted) ++k;
      return k;
    };
    EXPECT_EQ(rule.chords, least(0.75 * radius / 0.7e-6 + 6)) << radius;
    EXPECT_EQ(rule.rim_points, least(4.5 * radius / 0.5e-6 + 6)) << radius;
  }
}

TEST(GapTableSecondMethod, ADiscHoldsItsChords) {
  const Gap gap = random_gap();
  for (const double floor : {0.0, 0.3e-6}) {
    const GapTable table(gap, floor);
    for (const auto& [x, y, radius] : kPlaces) {
      for (const int finer : {0, 1, 3}) {
        const GapTable::Rule rule{table.rule(radius).chords + finer, 0};
        const double want = by_chords(gap, x, y, radius, kCounts[rule.chords], floor);
        EXPECT_NEAR(table.disc_volume(x, y, radius, rule), want, 1e-9 * want) << x << " " << y;
      }
    }
  }
}

TEST(GapTableSecondMethod, ADiscOfOneGapHoldsItsAreaTimesIt) {
  const GapTable table({kOblong, std::vector<double>(kOblong.size(), 2e-7)}, 0);
  for (const auto& [x, y, radius] : kPlaces) {
    for (const int chords : {0, 1, 2, 5, 15}) {
      const double want = kPi * radius * radius * 2e-7;
      EXPECT_NEAR(table.disc_volume(x, y, radius, {chords, 3}), want, 1e-12 * want) << chords;
      const GapTable::Rim rim = table.rim(x, y, radius, {3, chords});
      EXPECT_NEAR(rim.gap, 2e-7, 1e-19);
      EXPECT_NEAR(rim.slope, 0, 1e-12);
    }
  }
}

// The mean on circles 7 % of the radius inside and outside the rim; the bowl through both means has
// its gap at the rim half of 0.07^2 times slope and radius below their middle.
TEST(GapTableSecondMethod, ARimIsTheBowlThroughTwoCircles) {
  const Gap gap = random_gap();
  const GapTable table(gap, 0.1e-6);
  for (const auto& [x, y, radius] : kPlaces) {
    for (const int finer : {0, 2}) {
      const GapTable::Rule rule{0, table.rule(radius).rim_points + finer};
      const int points = kCounts[rule.rim_points];
      const double in = by_points(gap, x, y, 0.93 * radius, points, 0.1e-6),
                   out = by_points(gap, x, y, 1.07 * radius, points, 0.1e-6);
      // a + b r^2 through (0.93, in) and (1.07, out).
      const double b = (out - in) / (1.07 * 1.07 - 0.93 * 0.93), a = in - b * 0.93 * 0.93;
      const GapTable::Rim rim = table.rim(x, y, radius, rule);
      EXPECT_NEAR(rim.gap, a + b, 1e-10 * rim.gap) << x << " " << y;
      EXPECT_NEAR(rim.slope, 2 * b / radius, 1e-9) << x << " " << y;
    }
  }
}

// Blocks are one pixel wider than what is looked around, and a place sees the lowest of its own and
// the eight around.
TEST(GapTableSecondMethod, ALowGapIsSeenFromTheBlocksAroundIt) {
  const Grid g{20, 16, 10e-6, 16e-6};  // 0.5 x 1 um
  Gap gap{g, std::vector<double>(g.size(), 1e-6)};
  gap.value[g.index(0, 8)] = 1e-8;
  // 0.9 um: blocks of 3 x 2 pixels, of which there are 6 (the last with 5 columns) x 8.
  const GapTable table(gap, 0, 0.9e-6);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const int bx = std::min(ix / 3, 5), by = iy / 2;
      const bool near = (bx <= 1 || bx == 5) && by >= 3 && by <= 5;
      EXPECT_EQ(table.lowest_around(g.x(ix), g.y(iy)), near ? 1e-8 : 1e-6) << ix << " " << iy;
    }
  }
  // One in the last block's columns beyond 3 is seen from there, the block before it and the first.
  Gap last{g, std::vector<double>(g.size(), 1e-6)};
  last.value[g.index(19, 0)] = 1e-8;
  const GapTable at_end(last, 0, 0.9e-6);
  std::vector<double> seen, want;
  for (int ix = 0; ix < g.nx; ++ix) {
    seen.push_back(at_end.lowest_around(g.x(ix), 15.5e-6));
    want.push_back(ix < 3 || ix >= 12 ? 1e-8 : 1e-6);
  }
  EXPECT_EQ(seen, want);
  // Looking farther than the patch: one block.
  const GapTable one(gap, 0, 40e-6);
  EXPECT_EQ(one.lowest_around(9.9e-6, 0.1e-6), 1e-8);
  // Nearer gaps than the floor count as it.
  EXPECT_EQ(GapTable(gap, 3e-8, 40e-6).lowest_around(5e-6, 5e-6), 3e-8);
}

TEST(GapTableSecondMethod, AGapOfOtherSizeThanItsGridIsRefused) {
  EXPECT_ANY_THROW(GapTable({kOblong, std::vector<double>(kOblong.size() - 1, 1e-7)}, 0));
  EXPECT_ANY_THROW(GapTable({Grid{0, 0, 1, 1}, {}}, 0));
}

// --- footprints ---

TEST(FootprintSecondMethod, InAFlatGapIsTheDiscOfItsVolumeFromAnyGuess) {
  const double h = 150e-9;
  const GapTable table({kOblong, std::vector<double>(kOblong.size(), h)}, 0);
  for (double radius = 0.02e-6; radius < 30e-6; radius *= 2.3) {
    for (const double guess : {0.0, 1e-3, 0.3, 0.999, 1.0, 1.2, 4.0, 1e4}) {
      const Footprint f =
          solve_footprint(table, 4.2e-6, 3.3e-6, kPi * radius * radius * h, guess * radius);
      EXPECT_NEAR(f.radius, radius, 1e-10 * radius) << guess;
      EXPECT_NEAR(f.rim.gap, h, 1e-18);
      EXPECT_NEAR(f.rim.slope, 0, 1e-11);
    }
  }
}

// To 1e-13 of the volume (footprint.h) and the rounding of its integral, by the rule of its own
// radius.
TEST(FootprintSecondMethod, HoldsItsVolumeByItsOwnRule) {
  Gap gap{Grid{96, 80, 9.5e-6, 9.1e-6}, {}};
  for (int iy = 0; iy < 80; ++iy) {
    for (int ix = 0; ix < 96; ++ix) {
      const double u = 2 * kPi * (ix + 0.5) / 96, v = 2 * kPi * (iy + 0.5) / 80;
      gap.value.push_back(400e-9 + 150e-9 * std::cos(u) + 90e-9 * std::sin(2 * v + u));
    }
  }
  const GapTable table(gap, 0);
  RandomStream random(3, "places of footprints", 0);
  int same = 0;
  for (int k = 0; k < 400; ++k) {
    const double x = random.uniform() * 9.5e-6, y = random.uniform() * 9.1e-6;
    const double radius = 0.05e-6 * std::pow(60, random.uniform());
    const double volume = table.disc_volume(x, y, radius, table.rule(radius));
    const double guess = k % 3 ? radius * std::exp(2 * random.uniform() - 1) : 0;
    const Footprint f = solve_footprint(table, x, y, volume, guess);
    const GapTable::Rule rule = table.rule(f.radius);
    EXPECT_NEAR(table.disc_volume(x, y, f.radius, rule), volume, 1e-12 * volume) << k;
    EXPECT_EQ(f.rim.gap, table.rim(x, y, f.radius, rule).gap) << k;
    EXPECT_EQ(f.rim.slope, table.rim(x, y, f.radius, rule).slope) << k;
    same += rule == table.rule(radius) && std::abs(f.radius - radius) < 1e-9 * radius;
  }
  EXPECT_GE(same, 380);  // a few lie where the rule changes
}

// Gaps of 1 nm and 1 um at random: within 4 to 6 pixels all radii have one rule, and whatever way
// the volume jumps with the radius, the disc that is found holds it.
TEST(FootprintSecondMethod, HoldsItsVolumeAmongPocketsOfOneRule) {
  const Grid g{60, 60, 6e-6, 6e-6};
  Gap gap{g, {}};
  RandomStream random(4, "pockets of one rule", 0);
  for (std::size_t k = 0; k < g.size(); ++k)
    gap.value.push_back(random.uniform() < 0.8 ? 1e-9 : 1e-6);
  const GapTable table(gap, 0);
  for (int k = 0; k < 500; ++k) {
    const double x = random.uniform(0, 6e-6), y = random.uniform(0, 6e-6);
    const double radius = random.uniform(0.45e-6, 0.56e-6),
                 guess = random.uniform(0.45e-6, 0.56e-6);
    const GapTable::Rule rule = table.rule(radius);
    ASSERT_EQ(rule, table.rule(guess));
    const double volume = table.disc_volume(x, y, radius, rule);
    const Footprint f = solve_footprint(table, x, y, volume, guess);
    EXPECT_NEAR(table.disc_volume(x, y, f.radius, table.rule(f.radius)), volume, 1e-9 * volume)
        << k;
  }
}

// Of any size and from any guess it ends, and holds the volume but for the few radii at which two
// rules ask for each other.
TEST(FootprintSecondMethod, EndsAmongPocketsOfAllRules) {
  const Grid g{60, 60, 6e-6, 6e-6};
  for (const double narrow : {1e-9, 1e-10}) {
    Gap gap{g, {}};
    RandomStream random(4, "pockets of all rules", 0);
    for (std::size_t k = 0; k < g.size(); ++k)
      gap.value.push_back(random.uniform() < 0.8 ? narrow : 1e-6);
    const GapTable table(gap, 0);
    int off = 0;
    for (int k = 0; k < 2000; ++k) {
      const double x = random.uniform(0, 6e-6), y = random.uniform(0, 6e-6);
      const double radius = 0.02e-6 * std::pow(100, random.uniform());
      const double volume = table.disc_volume(x, y, radius, table.rule(radius));
      const double guess = k % 3 ? radius * std::exp(4 * random.uniform() - 2) : 0;
      const Footprint f = solve_footprint(table, x, y, volume, guess);
      const double held = table.disc_volume(x, y, f.radius, table.rule(f.radius));
      off += !(std::abs(held - volume) < 1e-9 * volume);
    }
    EXPECT_LE(off, 60) << narrow;
  }
}

// A well of 100 nm in a gap of 1 um: the disc that fills the well and goes on around it.
TEST(FootprintSecondMethod, OfAVolumeThatAWellDoesNotHoldGoesOnAroundIt) {
  const Grid g{160, 160, 16e-6, 16e-6};
  Gap gap{g, {}};
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix)
      gap.value.push_back(std::hypot(g.x(ix) - 8e-6, g.y(iy) - 8e-6) < 1e-6 ? 100e-9 : 1000e-9);
  }
  const GapTable table(gap, 0);
  for (const double radius : {0.5e-6, 0.8e-6, 1.3e-6, 2e-6, 5e-6}) {
    const double inner = std::min(radius, 1e-6);
    const double volume =
        kPi * (inner * inner * 100e-9 + (radius * radius - inner * inner) * 1000e-9);
    for (const double guess : {0.0, 0.1, 1.0, 8.0}) {
      const Footprint f = solve_footprint(table, 8e-6, 8e-6, volume, guess * radius);
      EXPECT_NEAR(f.radius, radius, (radius < 1e-6 ? 1e-9 : 0.03) * radius)
          << radius << " " << guess;
      EXPECT_NEAR(table.disc_volume(8e-6, 8e-6, f.radius, table.rule(f.radius)), volume,
                  1e-9 * volume);
    }
  }
}

}  // namespace
}  // namespace papilla::tests::gap_table_second_method_test
