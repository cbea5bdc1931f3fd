// A target as least squares: which problems take it, and how few evaluations it needs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "optim/search.h"

namespace papilla::tests::target_search_test {
namespace {

SearchProblem target_problem() {
  SearchProblem p;
  p.space.dimensions.assign(2, {0, 1, {}});
  p.residuals = 4;
  p.evaluations = 30;
  p.starts = {{0.9, 0.2}};
  return p;
}

// Four curved distances that vanish together at (0.3, 0.6), with a little noise.
Outcome distances(const Point& x, double noise) {
  RandomStream random(7, "noise", static_cast<std::uint64_t>(1e6 * x[0] + 1e3 * x[1]));
  std::vector<double> r{std::exp(x[0]) - std::exp(0.3), x[1] * x[1] - 0.36, x[0] * x[1] - 0.18,
                        x[0] - 0.3 + 0.5 * (x[1] - 0.6)};
  double sum = 0;
  for (double& v : r) {
    v += noise * random.normal();
    sum += v * v;
  }
  return {true, {}, {std::sqrt(sum)}, {}, r};
}

double best_of(const std::string& method, SearchProblem p, double noise) {
  const auto searcher = make_searcher(choose_method(method, p), p);
  double best = std::numeric_limits<double>::infinity();
  for (int count = 0; count < p.evaluations;) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) {
      batch.push_back({u, distances(u, noise)});
      best = std::min(best, distances(u, 0).objectives[0]);
      ++count;
    }
    if (batch.empty()) break;
    searcher->tell(batch);
  }
  return best;
}

TEST(TargetSearch, AutoTakesLeastSquaresAndMeetsTheTarget) {
  EXPECT_EQ(choose_method("auto", target_problem()).name, "least_squares");
  EXPECT_LT(best_of("auto", target_problem(), 0), 1e-4);
  EXPECT_LT(best_of("auto", target_problem(), 1e-3), 1e-2);
}

TEST(TargetSearch, UsesTheResidualsThatOthersThrowAway) {
  SearchProblem p = target_problem();
  p.evaluations = 22;
  EXPECT_LT(best_of("least_squares", p, 0), 0.1 * best_of("sbplx", p, 0));
}

TEST(TargetSearch, WhatIsNoSumOfSquaresIsRefused) {
  SearchProblem p = target_problem();
  p.residuals = 0;
  EXPECT_THROW(choose_method("least_squares", p), InputError);
  p = target_problem();
  p.space.dimensions[0].choices = {0.1, 0.9};
  EXPECT_THROW(choose_method("least_squares", p), InputError);
  EXPECT_NE(choose_method("auto", p).name, "least_squares");
  p = target_problem();
  p.constraints = 1;
  EXPECT_NE(choose_method("auto", p).name, "least_squares");
}

}  // namespace
}  // namespace papilla::tests::target_search_test
