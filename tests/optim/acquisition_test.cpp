// What Bayesian search asks next, against the acquisition integrated here from the same processes
// over a dense line of points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "numerics/statistics.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"
#include "optim/search.h"

namespace papilla::tests::acquisition_test {
namespace {

SearchProblem line(std::size_t objectives, std::size_t constraints = 0) {
  SearchProblem p;
  p.space.dimensions.assign(1, {0, 1, {}});
  p.objectives = objectives;
  p.constraints = constraints;
  p.evaluations = 40;
  return p;
}

// Of the integral of the distribution function of a prediction from where it is 0 to z.
double integral_below(double z, const Prediction& p) {
  const int n = 400;
  const double low = std::min(z, p.mean - 8 * p.sd);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    sum += normal_cdf((low + (i + 0.5) * (z - low) / n - p.mean) / p.sd) * (z - low) / n;
  return sum;
}

// Seven points spread over the line are what is asked first: told, they are the data.
struct Told {
  std::unique_ptr<Searcher> searcher;
  std::vector<Evaluation> all;
  std::vector<Point> points;

  Told(const SearchProblem& p, const std::function<Outcome(double)>& f)
      : searcher(make_searcher({"bayesian", ""}, p)) {
    for (const Point& u : searcher->ask()) {
      all.push_back({u, f(u[0])});
      points.push_back(u);
    }
    searcher->tell(all);
  }
  GaussianProcess process(const std::function<double(const Outcome&)>& value) const {
    std::vector<Point> at;
    std::vector<double> values;
    for (const Evaluation& e : all) {
      if (!e.outcome.ok) continue;
      at.push_back(e.unit);
      values.push_back(value(e.outcome));
    }
    return {at, values};
  }
  // The next is within a hundredth of the best of 501 places.
  void expect_best(const std::function<double(const Point&)>& acquisition) const {
    double most = 0;
    for (int i = 0; i <= 500; ++i) most = std::max(most, acquisition({i / 500.0}));
    const std::vector<Point> next = searcher->ask();
    ASSERT_EQ(next.size(), 1u);
    ASSERT_GT(most, 0);
    EXPECT_GT(acquisition(next[0]), 0.99 * most) << next[0][0];
  }
};

Outcome outcome(std::vector<double> objectives, std::vector<double> constraints = {}) {
  return {true, "", std::move(objectives), std::move(constraints), {}};
}

double wave(double x) { return std::sin(11 * x) + 0.6 * x; }

// Eq. search.1
TEST(Acquisition, OfOneObjectiveIsTheExpectedImprovement) {
  for (const double scale : {1.0, 1e-6, 500.0}) {
    const Told told(line(1), [&](double x) { return outcome({scale * wave(x)}); });
    ASSERT_EQ(told.all.size(), 7u);  // three a variable and four
    const GaussianProcess process = told.process([](const Outcome& o) { return o.objectives[0]; });
    double best = INFINITY;
    for (const Evaluation& e : told.all) best = std::min(best, e.outcome.objectives[0]);
    told.expect_best([&](const Point& u) { return integral_below(best, process.predict(u)); });
  }
}

// Eq. search.3: only a feasible one is an improvement on, by the chance that the limit is kept.
TEST(Acquisition, IsTimesTheChanceThatTheLimitIsKept) {
  const Told told(line(1, 1), [](double x) { return outcome({wave(x)}, {std::cos(9 * x) - 0.2}); });
  const GaussianProcess process = told.process([](const Outcome&o) { return o.objectives[0]; }),
                        limit = told.process([](const Outcome&o) { return o.constraints[0]; });
  double best = INFINITY;
  int feasible = 0;
  for (const Evaluation& e : told.all) {
    if (!e.outcome.feasible()) continue;
    best = std::min(best, e.outcome.objectives[0]);
    ++feasible;
  }
  ASSERT_GT(feasible, 0);
  ASSERT_LT(feasible, 7);
  told.expect_best([&](const Point& u) {
    const Prediction c = limit.predict(u);
    return normal_cdf(-c.mean / c.sd) * integral_below(best, process.predict(u));
  });
}

TEST(Acquisition, OfNothingFeasibleIsTheChanceAlone) {
  const Told told(line(1, 1), [](double x) {
    return outcome({wave(x)}, {0.05 + 3 * (x - 0.37) * (x - 0.37)});
  });
  const GaussianProcess limit = told.process([](const Outcome& o) { return o.constraints[0]; });
  told.expect_best([&](const Point& u) {
    const Prediction c = limit.predict(u);
    return normal_cdf(-c.mean / c.sd);
  });
}

// A regression of 0 and 1 through those that failed, clipped.
TEST(Acquisition, IsTimesTheChanceThatAnEvaluationSucceeds) {
  const Told told(line(1),
                  [](double x) { return x > 0.55 ? Outcome{} : outcome({2 - std::sin(3 * x)}); });
  const GaussianProcess process = told.process([](const Outcome& o) { return o.objectives[0]; });
  std::vector<double> failed;
  double best = INFINITY;
  for (const Evaluation& e : told.all) {
    failed.push_back(e.outcome.ok ? 0 : 1);
    if (e.outcome.ok) best = std::min(best, e.outcome.objectives[0]);
  }
  const GaussianProcess failures(told.points, failed);
  told.expect_best([&](const Point& u) {
    return std::clamp(1 - failures.predict(u).mean, 0.0, 1.0) *
           integral_below(best, process.predict(u));
  });
}

// Eq. search.2 strip by strip under the front, down from a reference a tenth of the seen range
// beyond the worst of its nine tenths, or of the front where that is farther.
TEST(Acquisition, OfTwoObjectivesIsTheExpectedGainOfHypervolume) {
  for (const double scale : {1.0, 300.0}) {
    const Told told(line(2), [&](double x) {
      return outcome({x + 0.3 * std::sin(12 * x), scale * (std::cos(4 * x) + 0.4 * x)});
    });
    const GaussianProcess a = told.process([](const Outcome&o) { return o.objectives[0]; }),
                          b = told.process([](const Outcome&o) { return o.objectives[1]; });
    std::vector<std::vector<double>> front;
    for (const std::size_t i : pareto_front(told.all))
      front.push_back(told.all[i].outcome.objectives);
    ASSERT_GT(front.size(), 1u);
    std::vector<double> reference;
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> values;
      for (const Evaluation& e : told.all) values.push_back(e.outcome.objectives[k]);
      const double low = *std::min_element(values.begin(), values.end()),
                   high = quantile(values, 0.9);
      double end = high;
      for (const auto& f : front) end = std::max(end, f[k]);
      reference.push_back(end + 0.1 * (high - low));
    }
    told.expect_best([&](const Point& u) {
      const Prediction pa = a.predict(u), pb = b.predict(u);
      double sum = 0, before = 0, height = reference[1];
      for (const auto& f : front) {
        const double to = integral_below(f[0], pa);
        sum += (to - before) * integral_below(height, pb);
        before = to;
        height = f[1];
      }
      return sum + (integral_below(reference[0], pa) - before) * integral_below(height, pb);
    });
  }
}

// Limits that are known are kept before all else.
TEST(Acquisition, KeepsCheapLimits) {
  SearchProblem p = line(1);
  p.cheap_constraints = [](const Point& u) { return std::vector<double>{-1, u[0] - 0.3}; };
  const Told told(p, [](double x) { return outcome({-x}); });
  for (const Point& u : told.points) EXPECT_LE(u[0], 0.3);
  const std::vector<Point> next = told.searcher->ask();
  EXPECT_LE(next[0][0], 0.3);
  EXPECT_GT(next[0][0], 0.29);
}

// Every third is the farthest from all that is known, once the first ones are.
TEST(Bayesian, EveryThirdExplores) {
  const auto f = [](const Point& u) { return outcome({std::pow(u[0] - 0.2, 2) + u[1]}); };
  SearchProblem p = line(1);
  p.space.dimensions.assign(2, {0, 1, {}});
  const auto searcher = make_searcher({"bayesian", ""}, p);
  std::vector<Evaluation> all;
  const auto nearest = [&](const Point& u) {
    double out = INFINITY;
    for (const Evaluation& e : all)
      out = std::min(out, std::hypot(u[0] - e.unit[0], u[1] - e.unit[1]));
    return out;
  };
  std::string explores;
  while (all.size() < 20) {
    double largest = 0;  // hole between the points
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 40; ++j) largest = std::max(largest, nearest({i / 40.0, j / 40.0}));
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) batch.push_back({u, f(u)});
    ASSERT_EQ(batch.size(), all.empty() ? 10u : 1u);
    if (!all.empty()) {
      explores +=
          std::to_string(all.size()) + (nearest(batch[0].unit) > 0.8 * largest ? "x " : " ");
    }
    all.insert(all.end(), batch.begin(), batch.end());
    searcher->tell(batch);
  }
  EXPECT_EQ(explores, "10 11 12x 13 14 15x 16 17 18x 19 ");
}

// Three for a variable and four, from six to a third of the budget; after drafts one and four.
TEST(Bayesian, TheFirstDesignGrowsWithTheVariables) {
  const auto first = [](std::size_t n, int evaluations) {
    SearchProblem p;
    p.space.dimensions.assign(n, {0, 1, {}});
    p.evaluations = evaluations;
    return make_searcher({"bayesian", ""}, p)->ask().size();
  };
  EXPECT_EQ(first(1, 100), 7u);
  EXPECT_EQ(first(2, 100), 10u);
  EXPECT_EQ(first(4, 100), 16u);
  EXPECT_EQ(first(4, 30), 10u);
  EXPECT_EQ(first(4, 9), 6u);
  EXPECT_EQ(first(1, 9), 6u);
}

// Four choices are four designs.
TEST(Bayesian, OfFewChoicesAllAreAskedFirst) {
  SearchProblem p;
  p.space.dimensions = {{0, 0, {1, 2}}, {0, 0, {5, 7}}};
  p.evaluations = 30;
  const auto searcher = make_searcher({"bayesian", ""}, p);
  std::vector<Point> asked = searcher->ask();
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(asked, (std::vector<Point>{{0.25, 0.25}, {0.25, 0.75}, {0.75, 0.25}, {0.75, 0.75}}));
}

// After them nothing new is left, whatever came of them.
TEST(Bayesian, EndsWhereEveryChoiceIsKnown) {
  SearchProblem p;
  p.space.dimensions = {{0, 0, {1, 2}}, {0, 0, {5, 7}}};
  p.evaluations = 30;
  for (const bool fails : {false, true}) {
    const auto searcher = make_searcher({"bayesian", ""}, p);
    std::vector<Evaluation> known;
    for (const Point& u : searcher->ask())
      known.push_back({u, fails ? Outcome{} : outcome({u[0] + 2 * u[1]})});
    ASSERT_EQ(known.size(), 4u);
    searcher->tell(known);
    EXPECT_TRUE(searcher->ask().empty()) << fails;
  }
}

// Twelve drafts: eight spread at once, then rounds of at most eight where they say that the best
// is; six evaluations of one variable's first design and its starts.
TEST(Bayesian, DraftsComeInTwoThirdsAndRounds) {
  SearchProblem p = line(1);
  p.drafts = 30;
  p.starts = {{0.35}};
  const auto f = [](const Point& u) { return outcome({std::pow(u[0] - 0.62, 2)}); };
  const auto searcher = make_searcher({"bayesian", ""}, p);
  std::vector<std::size_t> sizes;
  std::vector<Evaluation> drafts;
  for (;;) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) batch.push_back({u, f(u)});
    sizes.push_back(batch.size());
    if (!searcher->asks_drafts()) {
      EXPECT_EQ(batch[0].unit, Point{0.35});  // the user's first, then the drafts' best
      EXPECT_NEAR(batch[1].unit[0], 0.62, 0.02);
      break;
    }
    if (drafts.empty()) {
      EXPECT_EQ(batch[0].unit, Point{0.35});
    }
    drafts.insert(drafts.end(), batch.begin(), batch.end());
    searcher->tell(batch);
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{20, 8, 2, 6}));
}

}  // namespace
}  // namespace papilla::tests::acquisition_test
