// Which evaluations deserve a surer one, and what a feature tells a model.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"
#include "optim/search.h"

namespace papilla::tests::promising_test {
namespace {

SearchProblem box(std::size_t n) {
  SearchProblem p;
  p.space.dimensions.assign(n, Dimension{});
  p.objectives = 2;
  return p;
}

std::vector<double> on_curve(double x) { return {x, (1 - x) * (1 - x)}; }

Evaluation seen(Point u, std::vector<double> values) {
  return {std::move(u), {true, {}, std::move(values), {}, {}}};
}

TEST(Hypervolume, OfOneObjectiveIsTheLengthAheadOfTheReference) {
  EXPECT_DOUBLE_EQ(hypervolume({{0.25}, {0.5}, {1.5}}, {1}), 0.75);
  EXPECT_EQ(hypervolume({{1.5}}, {1}), 0);
}

TEST(Promising, AddsMoreHypervolumeThanPointsSpreadAlongTheFront) {
  std::vector<Evaluation> all;
  std::vector<std::vector<double>> front;
  for (int i = 0; i <= 40; ++i) {
    const double x = std::pow(i / 40.0, 2);
    front.push_back(on_curve(x));
    all.push_back(seen({x}, front.back()));
  }
  const auto volume = [&](const std::vector<std::size_t>& chosen) {
    std::vector<std::vector<double>> points;
    for (std::size_t i : chosen) points.push_back(front[i]);
    return hypervolume(points, {1.1, 1.1});
  };
  EXPECT_GT(volume(promising(box(1), all, 5)), volume(spread_points(front, 5)));
  double best = 0;  // of all sets of three
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) best = std::max(best, volume({i, j, k}));
    }
  }
  const std::vector<std::size_t> three = promising(box(1), all, 3);
  EXPECT_EQ(three.size(), 3U);
  EXPECT_GT(volume(three), 0.95 * best);
}

// Eq. search.12 by hand: each next adds most, the last no less than a hundredth, the next would.
TEST(Promising, EndsWhereTheNextWouldAddLessThanAHundredth) {
  std::vector<Evaluation> all;
  for (int i = 0; i <= 40; ++i) all.push_back(seen({i / 40.0}, on_curve(i / 40.0)));
  const std::vector<std::size_t> chosen = promising(box(1), all, all.size());
  const auto volume = [&](const std::vector<std::size_t>& of) {
    std::vector<std::vector<double>> points;
    for (std::size_t i : of) points.push_back(all[i].outcome.objectives);
    return hypervolume(points, {1.1, 1.1});
  };
  const auto best_gain = [&](std::vector<std::size_t> of) {
    const double before = volume(of);
    double most = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      of.push_back(i);
      most = std::max(most, volume(of) - before);
      of.pop_back();
    }
    return most;
  };
  std::vector<std::size_t> greedy;
  while (greedy.empty() || best_gain(greedy) >= 0.01 * volume(greedy)) {
    const double most = best_gain(greedy), before = volume(greedy);
    for (std::size_t i = 0; i < all.size(); ++i) {
      greedy.push_back(i);
      if (volume(greedy) - before >= most * (1 - 1e-12)) break;
      greedy.pop_back();
    }
  }
  EXPECT_GT(chosen.size(), 3u);
  EXPECT_LT(chosen.size(), 15u);
  EXPECT_EQ(chosen.size(), greedy.size());
  EXPECT_NEAR(volume(chosen), volume(greedy), 0.01 * volume(greedy));
}

// The ends first, then the largest gaps; more than there are is all of them.
TEST(SpreadPoints, HalveTheLargestGap) {
  const std::vector<std::vector<double>> line{{0, 8}, {1, 7}, {2, 6}, {4, 4}, {7, 1}, {8, 0}};
  EXPECT_EQ(spread_points(line, 2), (std::vector<std::size_t>{0, 5}));
  EXPECT_EQ(spread_points(line, 3), (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(spread_points(line, 4), (std::vector<std::size_t>{0, 2, 3, 5}));
  EXPECT_EQ(spread_points(line, 6).size(), 6u);
  EXPECT_EQ(spread_points(line, 60).size(), 6u);
  EXPECT_EQ(spread_points(line, 6, 0.2).size(), 4u);  // 1 and 7 are nearer than a fifth
  EXPECT_TRUE(spread_points({}, 3).empty());
}

TEST(Promising, LuckOfOneAmongLikeDesignsDoesNotWin) {
  double chosen_volume = 0, spread_volume = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "scatter");
    std::vector<Evaluation> all;
    std::vector<std::vector<double>> raw, truth;
    for (int i = 0; i < 60; ++i) {
      const Point u{random.uniform(), random.uniform()};
      std::vector<double> f = on_curve(u[0]);
      for (double& v : f) v += u[1];  // the second variable only does harm
      truth.push_back(f);
      for (double& v : f) v += 0.1 * random.normal();
      raw.push_back(f);
      all.push_back(seen(u, f));
    }
    const auto volume = [&](const std::vector<std::size_t>& chosen) {
      std::vector<std::vector<double>> points;
      for (std::size_t i : chosen) points.push_back(truth[i]);
      return hypervolume(points, {1.5, 1.5});
    };
    chosen_volume += volume(promising(box(2), all, 5));
    std::vector<std::vector<double>> values;
    const std::vector<std::size_t> front = pareto_front(all);
    for (std::size_t i : front) values.push_back(raw[i]);
    std::vector<std::size_t> spread;
    for (std::size_t i : spread_points(values, 5)) spread.push_back(front[i]);
    spread_volume += volume(spread);
  }
  EXPECT_GT(chosen_volume, 1.02 * spread_volume);
}

// However few the evaluations, or alone the best of them.
TEST(Promising, AnyFeasibleEvaluationLeavesOneToConfirm) {
  const std::vector<Evaluation> three{seen({0.5, 0.154}, {-0.51629, 0.21032}),
                                      seen({0.567, 0.071}, {-0.552529, 0.208639}),
                                      seen({0.322, 0.641}, {-0.508688, 0.215713})};
  EXPECT_EQ(promising(box(2), three, 5), std::vector<std::size_t>{1});
  EXPECT_EQ(promising(box(2), {three.front()}, 5), std::vector<std::size_t>{0});
  SearchProblem one = box(2);
  one.objectives = 1;
  for (const double scale : {1e-9, 1.0, 1e6, 1e12}) {
    std::vector<Evaluation> all = three;
    for (Evaluation& e : all) e.outcome.objectives = {scale * e.outcome.objectives[0]};
    EXPECT_EQ(promising(one, all, 5), std::vector<std::size_t>{1}) << scale;
    for (Evaluation& e : all) e.outcome.objectives[0] = -scale;
    EXPECT_EQ(promising(one, all, 5).size(), 1U) << scale;
  }
}

TEST(Promising, FeasibilityComesFirst) {
  std::vector<Evaluation> all{seen({0.1}, {0, 0}), seen({0.2}, {1, 1}), seen({0.3}, {2, 0.5})};
  all[0].outcome.constraints = {0.5};
  EXPECT_EQ(promising(box(1), all, 5), (std::vector<std::size_t>{1, 2}));
  all[1].outcome.constraints = all[2].outcome.constraints = {0.1};
  EXPECT_EQ(promising(box(1), all, 5), std::vector<std::size_t>{1});
  for (Evaluation& e : all) e.outcome = {};
  EXPECT_TRUE(promising(box(1), all, 5).empty());
}

// Drafts that put the front at the wrong place: after four sure evaluations where they see it
// and four more, the next ones lie where it is.
TEST(Promising, SureEvaluationsCorrectTheDrafts) {
  const auto surface = [](const Point& u, double best) {
    std::vector<double> f = on_curve(u[0]);
    f[1] += 2 * std::pow(u[1] - best, 2);
    return f;
  };
  SearchProblem p = box(2);
  for (std::uint64_t i = 0; i < 120; ++i) {
    const Point u = low_discrepancy(2, 1, i);
    p.known_drafts.push_back(seen(u, surface(u, 0.3)));
  }
  const auto volume = [&](const std::vector<Evaluation>& sure) {
    std::vector<std::vector<double>> points;
    for (const Evaluation& e : sure) points.push_back(e.outcome.objectives);
    return hypervolume(points, {1.1, 1.1});
  };
  const auto judged = [&](const Point& u) { return seen(u, surface(u, 0.7)); };
  std::vector<Evaluation> sure;
  for (std::size_t i : promising(p, p.known_drafts, 4))
    sure.push_back(judged(p.known_drafts[i].unit));
  const double before = volume(sure);
  const auto searcher = make_searcher({"bayesian", ""}, p);
  searcher->tell(sure);
  for (int i = 0; i < 6; ++i) {
    const std::vector<Point> asked = searcher->ask();
    ASSERT_EQ(asked.size(), 1U);
    EXPECT_FALSE(searcher->asks_drafts());
    sure.push_back(judged(asked.front()));
    searcher->tell({sure.back()});
    if (i >= 4) {
      EXPECT_NEAR(asked.front()[1], 0.7, 0.1);
    }
  }
  EXPECT_GT(volume(sure), 1.25 * before);
}

TEST(Promising, AFeatureLetsAModelSeeARatio) {
  SearchProblem plain = box(2), told = plain;
  told.features = [](const Point& u) { return std::vector<double>{u[0] / (u[1] + 0.5)}; };
  std::vector<Point> with, without;
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Point u = low_discrepancy(2, 1, i);
    without.push_back(model_coordinates(plain, u));
    with.push_back(model_coordinates(told, u));
    values.push_back(std::exp(-std::pow((u[0] / (u[1] + 0.5) - 0.8) / 0.2, 2)));
  }
  EXPECT_LT(GaussianProcess(with, values).leave_one_out_error(),
            0.5 * GaussianProcess(without, values).leave_one_out_error());
}

// One variable, one objective, one constraint.
Evaluation limited(double unit, double objective, double constraint, bool ok = true) {
  return {{unit}, {ok, "", {objective}, {constraint}, {}}};
}

TEST(NextSafer, KeepsTheConstraintsAsMuchBetterAsTheyWereFoundWorse) {
  const std::vector<Evaluation> all{limited(0.1, 1, -0.01), limited(0.3, 2, -0.04),
                                    limited(0.5, 3, -0.06), limited(0.7, 4, -0.5),
                                    limited(0.9, 0, 0.2)};
  EXPECT_EQ(next_safer(all, {limited(0.1, 1, 0.04)}), 2u);  // 0.05 worse there
  EXPECT_EQ(next_safer(all, {limited(0.1, 1, 0.04), limited(0.5, 3, 0.01)}), 3u);
  EXPECT_EQ(next_safer(all, {limited(0.1, 1, 0.6)}), std::nullopt);
  EXPECT_EQ(next_safer({}, {}), std::nullopt);
}

TEST(NextSafer, LimitsAreTightenedByTheLargestWorseningAndJudgedPointsStandAsJudged) {
  const std::vector<Evaluation> all{limited(0.1, 1, -0.01), limited(0.3, 2, -0.04),
                                    limited(0.5, 3, -0.06)};
  const std::vector<Evaluation> sure =
      tightened(all, {limited(0.1, 1.5, 0.02), limited(0.3, 2, -0.05), limited(0.8, 9, 0.5)});
  ASSERT_EQ(sure.size(), 4u);
  EXPECT_EQ(sure[0].outcome.objectives[0], 1.5);
  EXPECT_EQ(sure[1].outcome.constraints[0], -0.05);
  EXPECT_NEAR(sure[2].outcome.constraints[0], -0.06 + 0.03, 1e-15);
  EXPECT_EQ(sure[3].unit, Point{0.8});
}

TEST(NextSafer, IsNotBesideOneThatFailed) {
  const std::vector<Evaluation> all{limited(0.1, 1, -1), limited(0.2, 2, -1), limited(0.4, 3, -1)};
  EXPECT_EQ(next_safer(all, {limited(0.1, 0, 0, false)}), 2u);
  EXPECT_EQ(next_safer(all, {limited(0.1, 1, -1)}), 1u);  // judged and kept: not again
}

// An interval is its unit, one with a gap goes by its values, a kind is one of so many halves.
TEST(ModelCoordinates, AreAsFarApartAsTheValues) {
  SearchProblem p;
  p.space.dimensions = {{100, 900, {}},
                        {100, 900, {}, true, {{300, 500}}},
                        {0, 2, {0, 1, 2}, false},
                        {0, 0, {1, 5, 9}}};
  const Point unit = p.space.unit({300, 700, 1, 9});
  const Point seen_as = model_coordinates(p, unit), expected{0.25, 0.75, 0, 0.5, 0, 2.5 / 3};
  ASSERT_EQ(seen_as.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(seen_as[k], expected[k], 1e-9) << k;
  p.features = [](const Point& u) { return std::vector<double>{7 * u[0], -1}; };
  const Point told = model_coordinates(p, unit);
  ASSERT_EQ(told.size(), 8u);
  EXPECT_NEAR(told[6], 7 * 0.25, 1e-12);
  EXPECT_EQ(told[7], -1);
}

}  // namespace
}  // namespace papilla::tests::promising_test
