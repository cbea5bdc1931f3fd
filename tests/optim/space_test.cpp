// From the unit cube to values and back, and the sequence that fills it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"
#include "optim/problem.h"

namespace papilla::tests::space_test {
namespace {

double fraction(double x) { return x - std::floor(x); }

// Steps by the golden ratio on a line; on a plane by the root of x^3 = x + 1 and its square; in
// space by that of x^4 = x + 1.
TEST(LowDiscrepancy, StepsByThePowersOfTheGeneralisedGoldenRatio) {
  const double roots[] = {std::numbers::phi, 1.3247179572447460, 1.2207440846057596};
  for (std::size_t n = 1; n <= 3; ++n) {
    const Point first = low_discrepancy(n, 5, 0);
    ASSERT_EQ(first.size(), n);
    for (std::uint64_t i = 1; i < 50; ++i) {
      const Point u = low_discrepancy(n, 5, i);
      for (std::size_t k = 0; k < n; ++k) {
        const double step = std::pow(roots[n - 1], -static_cast<double>(k + 1));
        const double off = fraction(u[k] - first[k] - step * static_cast<double>(i));
        EXPECT_NEAR(std::min(off, 1 - off), 0, 1e-9) << n << " " << i << " " << k;
        EXPECT_GE(u[k], 0);
        EXPECT_LT(u[k], 1);
      }
    }
    EXPECT_NE(low_discrepancy(n, 6, 0), first);  // another shift
  }
  // From a shift of each coordinate, one step on: the same points on every machine.
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(low_discrepancy(2, 5, 0)[k],
                fraction(hash_uniform(5, 77, k) + std::pow(roots[1], -static_cast<double>(k + 1))),
                1e-12);
}

// Equal cells, the border to the upper one and the end to the last; back to the middle of the cell.
TEST(Choices, SplitTheUnitIntervalIntoEqualCells) {
  const Dimension d{0, 0, {2, 3, 7, 20}};
  for (const auto& [unit, value] : {std::pair{0.0, 2.0},
                                    {0.2499, 2.0},
                                    {0.25, 3.0},
                                    {0.4999, 3.0},
                                    {0.5, 7.0},
                                    {0.75, 20.0},
                                    {1.0, 20.0}})
    EXPECT_EQ(d.value(unit), value) << unit;
  for (const auto& [value, unit] : {std::pair{2.0, 0.125},
                                    {3.0, 0.375},
                                    {7.0, 0.625},
                                    {20.0, 0.875},
                                    {-50.0, 0.125},
                                    {2.4, 0.125},
                                    {2.6, 0.375},
                                    {4.9, 0.375},
                                    {5.1, 0.625},
                                    {13.4, 0.625},
                                    {13.6, 0.875},
                                    {400.0, 0.875}})
    EXPECT_EQ(d.unit(value), unit) << value;
}

TEST(Interval, IsStretchedOverTheUnitInterval) {
  const Dimension d{-3, 5, {}};
  EXPECT_EQ(d.value(0), -3);
  EXPECT_EQ(d.value(0.25), -1);
  EXPECT_EQ(d.value(1), 5);
  EXPECT_EQ(d.unit(-3), 0);
  EXPECT_EQ(d.unit(3), 0.75);
  EXPECT_EQ(d.unit(5), 1);
  EXPECT_EQ(d.unit(6), 1);
  EXPECT_EQ(d.unit(-4), 0);
  EXPECT_EQ((Dimension{2, 2, {}}).unit(2), 0.5);
  EXPECT_EQ((Dimension{2, 2, {}}).value(0.7), 2);
}

// 0 to 10 without 2 to 4 and 7 to 8: seven are left, a seventh of the unit interval each.
TEST(Excluded, TakesNothingOfTheUnitInterval) {
  const Dimension d{0, 10, {}, true, {{2, 4}, {7, 8}}};
  for (const auto& [value, unit] : {std::pair{0.0, 0.0},
                                    {1.0, 1.0 / 7},
                                    {4.5, 2.5 / 7},
                                    {6.0, 4.0 / 7},
                                    {8.5, 5.5 / 7},
                                    {9.0, 6.0 / 7},
                                    {10.0, 1.0}}) {
    EXPECT_NEAR(d.unit(value), unit, 1e-12) << value;
    EXPECT_NEAR(d.value(unit), value, 1e-9) << unit;
  }
  // The lower end is just before its upper one, which is the next that there is.
  EXPECT_NEAR(d.unit(2), 2.0 / 7, 1e-12);
  EXPECT_GT(d.unit(4), d.unit(2));
  EXPECT_NEAR(d.unit(4), 2.0 / 7, 2e-9);
  EXPECT_GT(d.unit(8), d.unit(7));
  EXPECT_NEAR(d.unit(8), 5.0 / 7, 2e-9);
  EXPECT_EQ(d.value(d.unit(4)), 4);
  EXPECT_EQ(d.value(d.unit(2)), 2);
  // What is next to the upper end in the last digits is that end, and what is farther is itself.
  EXPECT_EQ(d.value(2.0 / 7 + 0.9e-9), 4);
  EXPECT_NEAR(d.value(2.0 / 7 + 5e-9) - 4, 35e-9, 1e-12);
  // Inside, the nearer end.
  for (const auto& [inside, end] :
       {std::pair{2.1, 2.0}, {2.9, 2.0}, {3.1, 4.0}, {3.9, 4.0}, {7.4, 7.0}, {7.6, 8.0}})
    EXPECT_EQ(d.value(d.unit(inside)), end) << inside;
  EXPECT_FALSE(d.excluded[0].holds(2));
  EXPECT_TRUE(d.excluded[0].holds(2.001));
  EXPECT_TRUE(d.excluded[0].holds(3.999));
  EXPECT_FALSE(d.excluded[0].holds(4));
}

TEST(Space, GoesCoordinateByCoordinateAndClampsWhatIsOutside) {
  Space space{{{0, 10, {}}, {0, 0, {1, 5}}, {-1, 1, {}}}, {}};
  EXPECT_EQ(space.size(), 3u);
  EXPECT_EQ(space.value({0.5, 0.6, 0.75}), (Point{5, 5, 0.5}));
  EXPECT_EQ(space.value({-2, 3, 7}), (Point{0, 5, 1}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(space.value({nan, nan, nan}), (Point{5, 5, 0}));  // the middle
  EXPECT_EQ(space.unit({5, 1, -0.5}), (Point{0.5, 0.25, 0.25}));
  EXPECT_EQ(space.snapped({0.5, 0.9, 2}), (Point{0.5, 0.75, 1}));
  space.collapse = [](const Point& u) { return u[0] < 0.5 ? Point{0, 0.25, u[2]} : u; };
  EXPECT_EQ(space.snapped({0.4, 0.9, 0.5}), (Point{0, 0.25, 0.5}));
  EXPECT_EQ(space.snapped({0.5, 0.9, 0.5}), (Point{0.5, 0.75, 0.5}));
}

TEST(Space, IsOnePointWhereNothingMayMove) {
  const Dimension fixed{2, 2, {}}, moving{2, 3, {}}, one{0, 0, {7}}, two{0, 0, {7, 8}};
  EXPECT_TRUE((Space{{fixed, one}, {}}).single_point());
  EXPECT_FALSE((Space{{fixed, two}, {}}).single_point());
  EXPECT_FALSE((Space{{moving, one}, {}}).single_point());
  EXPECT_FALSE((Space{{fixed, moving}, {}}).single_point());
}

// Limits that are kept count nothing, those that are broken add up; residuals stay.
TEST(Outcomes, AreGuardedAsWholes) {
  Outcome sound{true, "", {1, 2}, {-1, 0.5, 0.25}, {3}};
  EXPECT_EQ(sound.violation(), 0.75);
  EXPECT_EQ(guarded(sound, 2, 3), sound);
  Outcome wrong = guarded(sound, 3, 3);
  EXPECT_EQ(wrong.reason, "the evaluation returned the wrong number of values");
  EXPECT_FALSE(wrong.ok);
  EXPECT_TRUE(wrong.objectives.empty());
  EXPECT_TRUE(wrong.constraints.empty());
  sound.objectives[1] = -INFINITY;
  EXPECT_EQ(guarded(sound, 2, 3).reason, "an objective is not a finite number");
  sound.objectives[1] = 2;
  sound.constraints[2] = INFINITY;
  EXPECT_EQ(guarded(sound, 2, 3).reason, "a constraint is not a finite number");
  sound.reason = "own words";
  EXPECT_EQ(guarded(sound, 2, 3).reason, "own words");
}

}  // namespace
}  // namespace papilla::tests::space_test
