// The ends of a profile of one parameter, refit by refit: steps that are doubled until the sum has
// risen enough, and a secant that is exact where the sum is a parabola.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "optim/fit_profile.h"

namespace papilla::tests::profile_test {
namespace {

struct End {
  double at = 0;
  bool open = false;
  int refits = 0;
};

// Of a parameter that is best at 0, the one that there is: a refit is one evaluation.
End end_of(const std::function<double(double)>& sum, double low, double high, double direction,
           double first, double rise = 1) {
  const std::vector<FitParameter> list{{"p", 0, low, high}};
  const FitCoordinates c(list);
  LeastSquaresOptions options;
  const ResidualFunction f = [&](std::span<const double> p, std::span<double> r) {
    r[0] = std::sqrt(2 + sum(p[0]));  // 2 is the least
    return true;
  };
  TrustRegion solver(c, 1, f, options);
  const FitSolution best = solver.solve({c.to(0, 0)}, {}, 10);
  const int before = solver.evaluations();
  FitProfile profile(solver, c, best, 0, rise, 10);
  End out;
  out.at = c.from(0, profile.end(direction, first / c.scale(0), out.open));
  out.refits = solver.evaluations() - before;
  return out;
}

double parabola(double x) { return x * x; }

// 0.1, 0.3, 0.7 and 1.5, between the last two the root of 1.
TEST(Profile, OfAParabolaIsFourStepsAndTheRoot) {
  for (const double direction : {1.0, -1.0}) {
    const End e = end_of(parabola, -40, 40, direction, 0.1);
    EXPECT_NEAR(e.at, direction, 1e-9);
    EXPECT_FALSE(e.open);
    EXPECT_EQ(e.refits, 5);
    // A rise of 9 is at 3: 3.1 is beyond it.
    const End far = end_of(parabola, -40, 40, direction, 0.1, 9);
    EXPECT_NEAR(far.at, 3 * direction, 1e-9);
    EXPECT_EQ(far.refits, 6);
  }
}

TEST(Profile, EndsAtABoundThatComesFirst) {
  for (const double direction : {1.0, -1.0}) {
    const auto end = [&](double bound) {
      return direction > 0 ? end_of(parabola, -40, bound, 1, 0.1)
                           : end_of(parabola, -bound, 40, -1, 0.1);
    };
    const End early = end(0.5);  // 0.1, 0.3, the bound
    EXPECT_TRUE(early.open);
    EXPECT_NEAR(early.at, 0.5 * direction, 1e-12);
    EXPECT_EQ(early.refits, 3);
    const End late = end(1.2);  // 0.1, 0.3, 0.7, the bound, the root
    EXPECT_FALSE(late.open);
    EXPECT_NEAR(late.at, direction, 1e-9);
    EXPECT_EQ(late.refits, 5);
    const End there = end(0);  // at the bound already
    EXPECT_TRUE(there.open);
    EXPECT_EQ(there.at, 0);
    EXPECT_EQ(there.refits, 0);
  }
}

// A quartic, whose secants stall on one side: halved every third time it still ends, to a
// thousandth of the rise or of the distance.
TEST(Profile, OfWhatIsNoParabolaIsWithinAThousandth) {
  for (const double power : {4.0, 8.0, 1.0}) {
    const auto sum = [=](double x) { return std::pow(std::abs(x), power); };
    for (const double rise : {1.0, 3.84}) {
      const End e = end_of(sum, -40, 40, 1, 0.1, rise);
      const double root = std::pow(rise, 1 / power);
      EXPECT_NEAR(e.at, root, 1.1e-3 * root) << power;
      EXPECT_LE(e.refits, 16) << power;
    }
  }
  // A step: only halving finds it.
  const End step = end_of([](double x) { return x < 1 ? 0.0 : 50.0; }, -40, 40, 1, 0.1);
  EXPECT_NEAR(step.at, 1, 1e-3);
  EXPECT_LE(step.refits, 40);
}

}  // namespace
}  // namespace papilla::tests::profile_test
