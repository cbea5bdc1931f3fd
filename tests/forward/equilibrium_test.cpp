// The search for an equilibrium against laws of attraction whose equilibria and folds are known.
#include "forward/equilibrium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/constants.h"

namespace papilla::tests::equilibrium_test {
namespace {

using forward::EquilibriumSearch;
using Next = EquilibriumSearch::Next;

struct Found {
  Next end = Next::Ask;
  double applied = 0;
  int asked = 0;
};
Found sought(double load, const std::function<double(double)>& law, double slope = 0,
             double tolerance = 1e-3) {
  EquilibriumSearch search(load, {{0}, {law(0)}}, slope, tolerance);
  Found out;
  for (out.asked = 1; out.asked <= 60; ++out.asked) {
    out.applied = search.applied().front();
    out.end = search.found({law(out.applied)});
    if (out.end != Next::Ask) break;
  }
  return out;
}

// Nine tenths of what the load leaves open, where that is a twentieth of the places: 48 of 1024 are
// less, and closing all of them is no pull-in.
TEST(EquilibriumSearch, AGapIsPulledShutWhereTheLoadLeavesATwentiethOpen) {
  EXPECT_FALSE(forward::is_pulled_shut(1024, 976, 1024));
  EXPECT_TRUE(forward::is_pulled_shut(1000, 950, 1000));
  EXPECT_FALSE(forward::is_pulled_shut(1000, 951, 1000));
  EXPECT_TRUE(forward::is_pulled_shut(1000, 900, 991));
  EXPECT_FALSE(forward::is_pulled_shut(1000, 900, 990));
  EXPECT_TRUE(forward::is_pulled_shut(1000, 0, 901));
  EXPECT_FALSE(forward::is_pulled_shut(1000, 0, 900));
}

TEST(EquilibriumSearch, SolvesALinearLawInTwoStates) {
  for (const double slope : {-0.5, 0.2, 0.6}) {
    const Found f = sought(
        1, [&](double a) { return 0.5 + slope * a; }, 0, 1e-9);
    EXPECT_EQ(f.end, Next::Settled);
    EXPECT_NEAR(f.applied, 0.5 / (1 - slope), 1e-8);
    EXPECT_LE(f.asked, 2);
  }
  // A neighbour that knows the slope leaves one.
  for (const double slope : {0.2, 0.6})
    EXPECT_EQ(sought(
                  1, [&](double a) { return 0.5 + slope * a; }, slope)
                  .asked,
              1);
}

// A plate on a spring over another under voltage: it rests down to 2/3 of the gap and jumps beyond,
// V^2 = 8 k d^3/(27 eps A). Here the force is v d^2/(d - a)^2 with d = 1: the fold is at v = 4/27.
TEST(EquilibriumSearch, FollowsThePlateOnASpringToItsFoldAndNoFurther) {
  const auto plate = [](double v) {
    return [v](double a) { return a < 1 ? v / ((1 - a) * (1 - a)) : kInfinity; };
  };
  constexpr double kFold = 4.0 / 27;
  for (const double share : {0.3, 0.7, 0.9, 0.99}) {  // of the voltage
    const double v = share * share * kFold;
    const Found f = sought(0.05, plate(v), 0, 1e-4);
    ASSERT_EQ(f.end, Next::Settled) << share;
    EXPECT_LT(f.applied, 1.0 / 3) << share;
    EXPECT_NEAR(f.applied * (1 - f.applied) * (1 - f.applied), v, 3e-4 * (0.05 + v)) << share;
    EXPECT_LE(f.asked, 12) << share;
  }
  for (const double share : {1.02, 1.1, 2.0}) {
    EXPECT_EQ(sought(0.05, plate(share * share * kFold)).end, Next::Jumped) << share;
  }
}

// An attraction that saturates, as air that breaks down makes it.
TEST(EquilibriumSearch, StaysBetweenItsBoundsWhereTheLawSaturates) {
  for (const double guess : {0.0, 0.3, 0.7}) {
    const auto law = [](double a) { return 0.4 + 0.9 * std::tanh(a); };
    const Found f = sought(1, law, guess, 1e-6);
    EXPECT_EQ(f.end, Next::Settled);
    EXPECT_NEAR(law(f.applied), f.applied, 1e-5);
    EXPECT_LE(f.asked, 9);
  }
}

TEST(EquilibriumSearch, SettlesAmongDropletsThatComeToBridge) {
  // Steps of a thousandth of the load.
  const auto law = [](double a) {
    return 0.4 + 0.3 * a + 1e-3 * std::round(40 * std::sin(90 * a) / 40);
  };
  const Found f = sought(1, law, 0.2, 2e-3);
  EXPECT_EQ(f.end, Next::Settled);
  EXPECT_NEAR(f.applied, 0.4 / 0.7, 6e-3);
}

TEST(EquilibriumSearch, TakesWaterThatPushes) {
  const auto law = [](double a) { return -0.1 + 0.2 * a; };
  const Found f = sought(1, law, 0, 1e-6);
  EXPECT_EQ(f.end, Next::Settled);
  EXPECT_NEAR(f.applied, -0.125, 1e-5);
}

}  // namespace
}  // namespace papilla::tests::equilibrium_test
