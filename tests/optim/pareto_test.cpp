// Fronts, hypervolumes and choices from them against counts over small lattices.
#include "optim/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace papilla::tests::pareto_test {
namespace {

using Values = std::vector<double>;
using Places = std::vector<std::size_t>;

Evaluation seen(Values objectives, Values constraints = {}) {
  return {{}, {true, "", std::move(objectives), std::move(constraints), {}}};
}

Evaluation refused(Values constraints = {}) { return {{}, {false, "no", {}, constraints, {}}}; }

TEST(Pareto, ToDominateIsToBeNowhereWorseAndSomewhereBetter) {
  EXPECT_TRUE(dominates({1, 2}, {1, 3}));
  EXPECT_TRUE(dominates({0, 3}, {1, 3}));
  EXPECT_FALSE(dominates({1, 3}, {1, 3}));
  EXPECT_FALSE(dominates({1, 4}, {2, 3}));
  EXPECT_FALSE(dominates({2, 3}, {1, 4}));
  EXPECT_TRUE(dominates({1, 1, 1}, {1, 1, 2}));
  EXPECT_FALSE(dominates({1, 1, 3}, {0, 0, 2}));
}

// By the first objective; of equals the earliest; what breaks a limit or failed is none.
TEST(Pareto, TheFrontIsWhatNoFeasibleOneDominates) {
  const std::vector<Evaluation> all{seen({3, 1}, {0}), seen({1, 3}, {-1}), seen({2, 2}, {0}),
                                    seen({2, 2}, {0}), seen({2, 3}, {0}),  seen({0, 0}, {0.1}),
                                    refused({-1}),     seen({1, 3}, {0}),  seen({3, 0.5}, {1e-9})};
  EXPECT_EQ(pareto_front(all), (Places{1, 2, 0}));
  EXPECT_TRUE(pareto_front({}).empty());
  EXPECT_EQ(pareto_front({refused(), seen({5})}), (Places{1}));
}

// Of none that is feasible: evaluated ones first, then the least sum of what is broken, then the
// earliest; a refused one only where it said by how much.
TEST(Pareto, WithoutAFeasibleOneTheLeastViolationIsTheFront) {
  EXPECT_EQ(
      pareto_front({seen({1}, {3}), seen({1}, {1, 1.5}), seen({9}, {2.5, -9}), refused({0.1})}),
      (Places{1}));
  EXPECT_EQ(pareto_front({seen({1}, {1, 1.6}), seen({9}, {2.5, -9})}), (Places{1}));
  EXPECT_EQ(pareto_front({refused({0.5}), refused({0.2}), refused(), refused({0.2})}), (Places{1}));
  EXPECT_EQ(pareto_front({refused({0.5}), seen({1}, {7})}), (Places{1}));
  EXPECT_TRUE(pareto_front({refused(), refused()}).empty());
}

// Dominated by 0, 1, 2 and 3 others and one of a branch of its own.
TEST(Pareto, TheLeastDominatedAreKeptInTheirOrder) {
  const std::vector<Evaluation> all{seen({4, 4}),       seen({9, 9}, {1}), seen({3, 3}),
                                    seen({2, 2}),       seen({1, 1}),      seen({0, 5}),
                                    seen({0, 0}, {0.5})};
  EXPECT_EQ(least_dominated(all, 1), (Places{4}));
  EXPECT_EQ(least_dominated(all, 2), (Places{4, 5}));
  EXPECT_EQ(least_dominated(all, 3), (Places{3, 4, 5}));
  EXPECT_EQ(least_dominated(all, 4), (Places{2, 3, 4, 5}));
  EXPECT_EQ(least_dominated(all, 5), (Places{0, 2, 3, 4, 5}));
  EXPECT_EQ(least_dominated(all, 50), (Places{0, 2, 3, 4, 5}));
  EXPECT_TRUE(least_dominated(all, 0).empty());
}

// Points on a lattice: the hypervolume is the number of unit cells that one of them is below.
TEST(Hypervolume, OfLatticePointsIsTheNumberOfCells) {
  RandomStream random(3, "lattice");
  for (int round = 0; round < 40; ++round) {
    for (std::size_t m = 1; m <= 3; ++m) {
      const int side = 7;
      std::vector<Values> points(static_cast<std::size_t>(random.below(7)));
      for (Values& p : points)
        for (std::size_t k = 0; k < m; ++k) p.push_back(random.below(side + 2));  // some beyond
      int count = 0;
      for (int cell = 0; cell < std::pow(side, m); ++cell) {
        const int place[3] = {cell % side, cell / side % side, cell / side / side};
        count += std::any_of(points.begin(), points.end(), [&](const Values& p) {
          for (std::size_t k = 0; k < m; ++k)
            if (p[k] > place[k]) return false;
          return true;
        });
      }
      EXPECT_EQ(hypervolume(points, Values(m, side)), count) << m;
    }
  }
}

TEST(Hypervolume, ScalesWithEachSideAndMovesWithTheReference) {
  const std::vector<Values> points{{-1, 5, 10}, {0, 4, 20}, {-0.5, 4.5, 12}};
  const Values reference{1, 6, 30};
  std::vector<Values> scaled = points;
  for (Values& p : scaled) p = {3 + 2 * p[0], 10 * p[1], p[2] - 7};
  EXPECT_NEAR(hypervolume(scaled, {5, 60, 23}), 20 * hypervolume(points, reference), 1e-9);
  // By hand: 2 x 1 x 20, 1 x 2 x 10 less the 1 x 1 x 10 of both, and of the third what neither has.
  EXPECT_NEAR(hypervolume({points[0], points[1]}, reference), 40 + 20 - 10, 1e-12);
  // 1.5 x 1.5 x 18 less 1.5 x 1 x 18 and 1 x 1.5 x 10 of the others, whose common 1 x 1 x 10 it
  // has.
  EXPECT_NEAR(hypervolume(points, reference), 50 + 40.5 - 27 - 15 + 10, 1e-12);
}

// After each: the share of the box from the worst to the best of all feasible ones.
TEST(Hypervolume, SharesOfOneAndOfThreeObjectives) {
  EXPECT_EQ(hypervolume_shares({seen({9}, {1}), seen({4}), seen({6}), seen({2}), refused()}),
            (Values{0, 0.5, 0.5, 1, 1}));
  EXPECT_EQ(
      hypervolume_shares({seen({0, 0, 4}), seen({2, 0, 0}), seen({1, 1, 1}), seen({2, 2, 3})}),
      (Values{0, 0, 1.0 * 1 * 3 / 16, 3.0 / 16}));
  // Of an objective that is alike for all, the box has the others; of none, nothing.
  EXPECT_EQ(hypervolume_shares({seen({5}), seen({5})}), (Values{0, 0}));
  EXPECT_TRUE(hypervolume_shares({}).empty());
}

// The ends of each objective, then always the farthest from all that are chosen, in units of the
// extent: the second axis is a thousand times the first.
TEST(SpreadPoints, TakeTheEndsAndThenTheFarthestInUnitsOfTheExtent) {
  const std::vector<Values> points{{0.5, 480}, {0, 1000},  {0.1, 900},
                                   {1, 0},     {0.8, 300}, {0.3, 700}};
  EXPECT_EQ(spread_points(points, 1), (Places{1}));
  EXPECT_EQ(spread_points(points, 2), (Places{1, 3}));
  EXPECT_EQ(spread_points(points, 3), (Places{0, 1, 3}));     // 0.69 from both, 0.48 x sqrt 2
  EXPECT_EQ(spread_points(points, 4), (Places{0, 1, 3, 4}));  // 0.36 and 0.35, 0.30 of the fifth
  EXPECT_EQ(spread_points(points, 5), (Places{0, 1, 3, 4, 5}));
  EXPECT_TRUE(spread_points(points, 0).empty());
  // Until all others are nearer than that: the fifth is 0.297 from its nearest, the third 0.141.
  EXPECT_EQ(spread_points(points, 6, 0.31), (Places{0, 1, 3, 4}));
  EXPECT_EQ(spread_points(points, 6, 0.29), (Places{0, 1, 3, 4, 5}));
  EXPECT_EQ(spread_points(points, 6, 0.14), (Places{0, 1, 2, 3, 4, 5}));
  // One that is best in both is one end; an objective without extent counts by itself.
  EXPECT_EQ(spread_points({{0, 0}, {1, 3}, {3, 1}}, 2).front(), 0u);
  EXPECT_EQ(spread_points({{0, 7}, {1, 7}, {4, 7}, {9, 7}}, 3), (Places{0, 2, 3}));
}

}  // namespace
}  // namespace papilla::tests::pareto_test
