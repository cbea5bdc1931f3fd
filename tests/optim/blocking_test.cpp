// What blocking optimisers share: stand-ins for failures, first points, budgets, and the question
// and answer of their thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "optim/algorithms/searchers.h"

namespace papilla::tests::blocking_test {
namespace {

using Values = std::vector<double>;

Outcome feasible(Values objectives) { return {true, "", std::move(objectives), {}, {}}; }
Outcome broken(Values objectives, Values constraints, bool ok = true) {
  return {ok, "", std::move(objectives), std::move(constraints), {}};
}

// The worst so far and of the span to the best a tenth and v / (1 + v), of a failure of unknown
// violation a tenth and one.
TEST(Penalty, IsTheWorstSoFarAndAShareOfTheSpanThatGrowsWithTheViolation) {
  Penalty penalty;
  EXPECT_EQ(penalty.finite(feasible({2, 30}), 2), (Values{2, 30}));
  EXPECT_EQ(penalty.finite(feasible({6, 10}), 2), (Values{6, 10}));
  EXPECT_EQ(penalty.finite(feasible({4, 20}), 2), (Values{4, 20}));
  const auto expect = [&](const Outcome& o, double share) {
    const Values out = penalty.finite(o, 2);
    EXPECT_NEAR(out[0], 6 + 4 * share, 1e-12);
    EXPECT_NEAR(out[1], 30 + 20 * share, 1e-12);
  };
  expect(broken({0, 0}, {1, 2, -5}), 0.1 + 0.75);
  expect(broken({0, 0}, {0.25}), 0.1 + 0.2);
  expect(broken({}, {1}, false), 0.1 + 0.5);  // refused, and it says by how much
  expect(Outcome{}, 0.1 + 1);
  expect(broken({0, 0}, {std::numeric_limits<double>::infinity()}), 0.1 + 1);
  // Of values that are alike a millionth of their size, of at least one.
  Penalty flat;
  flat.finite(feasible({-5000, 0.25}), 2);
  EXPECT_NEAR(flat.finite(Outcome{}, 2)[0] + 5000, 1.1 * 5e-3, 1e-9);
  EXPECT_NEAR(flat.finite(Outcome{}, 2)[1] - 0.25, 1.1e-6, 1e-12);
}

// v / (1 + v) while nothing is feasible; what is feasible lies below that for ever, in its order,
// however large and however much worse than the first.
TEST(Penalty, GrowsWithTheViolationBeforeAnythingIsFeasible) {
  Penalty penalty;
  const auto value = [&](const Outcome& o) { return penalty.finite(o, 1).at(0); };
  EXPECT_NEAR(value(broken({110}, {3})), 0.75, 1e-12);
  EXPECT_NEAR(value(broken({140}, {0.1})), 0.1 / 1.1, 1e-12);
  EXPECT_EQ(value(Outcome{}), 1);
  EXPECT_EQ(value(feasible({160})), -1);
  EXPECT_NEAR(value(feasible({152})), -1.05, 1e-12);  // in units of the largest up to the first
  EXPECT_NEAR(value(feasible({240})), -1 + 0.5 / 1.5, 1e-12);
  EXPECT_LT(value(feasible({1e9})), 0);
  EXPECT_NEAR(value(broken({100}, {0.1})), 0.1 / 1.1, 1e-12);  // as before
  Penalty zero;
  zero.finite(broken({0}, {1}), 1);
  EXPECT_EQ(zero.finite(feasible({0}), 1), Values{-1});
  EXPECT_EQ(zero.finite(feasible({-2}), 1), Values{-3});
}

SearchProblem square_problem() {
  SearchProblem p;
  p.space.dimensions.assign(2, {0, 1, {}});
  return p;
}

// A twelfth of the evaluations, from 12 to 100, in fours.
TEST(Nsga2, ItsPopulationIsATwelfthOfTheEvaluations) {
  SearchProblem p = square_problem();
  for (const auto& [evaluations, population] : {std::pair{1, 12u},
                                                {155, 12u},
                                                {191, 12u},
                                                {192, 16u},
                                                {600, 48u},
                                                {624, 52u},
                                                {1199, 96u},
                                                {1200, 100u},
                                                {90000, 100u}}) {
    p.evaluations = evaluations;
    EXPECT_EQ(nsga2_population(p), population) << evaluations;
  }
}

TEST(FirstPoints, AreTheStartsAndThenTheSequenceWhereItIsCheaplyFeasible) {
  SearchProblem p = square_problem();
  p.seed = 3;
  p.starts = {{0.2, 0.3}, {0.9, 1.4}, {0.5, 0.5}};
  std::vector<Point> expected{{0.2, 0.3}, {0.9, 1}, {0.5, 0.5}};
  for (std::uint64_t i = 0; i < 4; ++i) expected.push_back(low_discrepancy(2, 3, i));
  const auto expect = [&](std::size_t size) {
    const std::vector<Point> points = first_points(p, size);
    ASSERT_EQ(points.size(), size);
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(points[i][k], expected[i][k], 1e-12);
  };
  expect(7);
  expect(2);
  p.cheap_constraints = [](const Point& u) { return Values{u[0] - 0.4}; };
  expected.resize(3);  // starts are taken as they are
  for (std::uint64_t i = 0; expected.size() < 6; ++i) {
    const Point u = low_discrepancy(2, 3, i);
    if (u[0] <= 0.4) expected.push_back(u);
  }
  expect(6);
  // Nothing is feasible: after 5001 that were tried whatever comes.
  p.cheap_constraints = [](const Point&) { return Values{1}; };
  expected.resize(3);
  expected.push_back(low_discrepancy(2, 3, 5001));
  expected.push_back(low_discrepancy(2, 3, 5002));
  expect(5);
}

// The optimiser waits for each answer, sees it in the order of its points, and ends the asking.
TEST(Blocking, AsksInTurnAndEndsWithItsOptimiser) {
  Values answers;
  const auto searcher = make_blocking([&](const BlockingObjective& objective) {
    for (const Outcome& o : objective({{0.1}, {0.2}})) answers.push_back(o.objectives[0]);
    answers.push_back(objective({{0.3}})[0].objectives[0]);
  });
  const auto told = [](const std::vector<Point>& points) {
    std::vector<Evaluation> out;
    for (const Point& u : points) out.push_back({u, feasible({10 * u[0]})});
    return out;
  };
  const std::vector<Point> two = searcher->ask();
  EXPECT_EQ(two, (std::vector<Point>{{0.1}, {0.2}}));
  EXPECT_EQ(searcher->ask(), two);  // asked again, the same question
  searcher->tell({});
  EXPECT_EQ(searcher->ask(), two);  // of nothing nothing is learned
  searcher->tell(told(two));
  EXPECT_EQ(searcher->ask(), (std::vector<Point>{{0.3}}));
  searcher->tell(told({{0.3}}));
  EXPECT_TRUE(searcher->ask().empty());
  EXPECT_EQ(answers, (Values{1, 2, 3}));
}

TEST(Blocking, ACutBatchAndAnOptimiserThatThrowsEndTheSearch) {
  int answered = 0;
  {
    const auto searcher = make_blocking([&](const BlockingObjective& objective) {
      objective({{0.1}, {0.2}});
      ++answered;
    });
    const std::vector<Point> asked = searcher->ask();
    searcher->tell({{asked[0], feasible({1})}});
    EXPECT_TRUE(searcher->ask().empty());
  }
  EXPECT_EQ(answered, 0);
  const auto throwing =
      make_blocking([](const BlockingObjective&) { throw std::runtime_error("roundoff"); });
  EXPECT_TRUE(throwing->ask().empty());
}

TEST(Methods, EachIsListedWithTheObjectivesThatItTakes) {
  std::string list;
  for (const MethodKind& kind : method_kinds()) {
    const bool any = kind.most_objectives == std::numeric_limits<std::size_t>::max();
    list += kind.name + " " + std::to_string(kind.least_objectives) + "-" +
            (any ? "any" : std::to_string(kind.most_objectives)) +
            (kind.of_squares ? " squares" : "") + "; ";
  }
  EXPECT_EQ(list,
            "bayesian 1-2; nsga2 2-any; cmaes 1-1; bobyqa 1-1; sbplx 1-1; direct 1-1; "
            "least_squares 1-1 squares; ");
  EXPECT_EQ(searcher_names().front(), "auto");
  EXPECT_EQ(searcher_names().size(), method_kinds().size() + 1);
}

std::string refusal(const std::string& method, const SearchProblem& p) {
  try {
    choose_method(method, p);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(Methods, EachRefusalSaysWhatToUse) {
  SearchProblem p = square_problem();
  EXPECT_EQ(refusal("annealing", p),
            "unknown search method \"annealing\"; use one of auto, bayesian, nsga2, cmaes, bobyqa, "
            "sbplx, direct, least_squares");
  EXPECT_EQ(refusal("nsga2", p),
            "search.method = \"nsga2\" needs two objectives; use \"bayesian\" or \"cmaes\"");
  p.objectives = 2;
  EXPECT_EQ(refusal("cmaes", p),
            "search.method = \"cmaes\" has one objective; this study has 2: use \"bayesian\" or "
            "\"nsga2\"");
  EXPECT_EQ(refusal("bayesian", p), "");
  EXPECT_EQ(refusal("nsga2", p), "");
  p.objectives = 3;
  EXPECT_EQ(refusal("bayesian", p),
            "search.method = \"bayesian\" handles one or two objectives; use \"nsga2\"");
  EXPECT_EQ(refusal("nsga2", p), "");
}

// As many targets as variables or more, one objective, nothing else that bends it.
TEST(Methods, ASumOfSquaresIsOneWithTargetsEnough) {
  SearchProblem p = square_problem();
  const auto squares = [&] {
    EXPECT_EQ(refusal("least_squares", p).empty(),
              choose_method("auto", p).name == "least_squares");
    return refusal("least_squares", p).empty();
  };
  p.residuals = 2;
  EXPECT_TRUE(squares());
  p.residuals = 3;
  EXPECT_TRUE(squares());
  p.residuals = 1;
  EXPECT_FALSE(squares());
  p.residuals = 2;
  p.constraints = 1;
  EXPECT_FALSE(squares());
  p.constraints = 0;
  p.space.dimensions[1].excluded = {{0.2, 0.3}};
  EXPECT_FALSE(squares());
  p.space.dimensions[1] = {0, 0, {1, 2}};
  EXPECT_FALSE(squares());
}

// Sixteen points at once and then generations of as many; of CMA-ES twelve to begin with.
TEST(Evolutions, AskForAGenerationAtOnce) {
  SearchProblem p = square_problem();
  p.evaluations = 192;
  for (const auto& [method, objectives, size] :
       {std::tuple{"nsga2", 2u, 16u}, {"cmaes", 1u, 12u}}) {
    p.objectives = objectives;
    const auto searcher = make_searcher({method, ""}, p);
    const int generations = objectives == 2 ? 4 : 1;
    for (int generation = 0; generation < generations; ++generation) {
      const std::vector<Point> asked = searcher->ask();
      ASSERT_EQ(asked.size(), size) << method << " " << generation;
      if (generation == 0) {
        EXPECT_EQ(asked, first_points(p, size));
      }
      std::vector<Evaluation> told;
      for (const Point& u : asked) {
        told.push_back({u, feasible({u[0]})});
        if (objectives == 2) told.back().outcome.objectives.push_back(1 - u[0] + u[1]);
        for (const double x : u) EXPECT_TRUE(x >= 0 && x <= 1);
      }
      searcher->tell(told);
    }
  }
}

// None of the first twelve lies in the band, whose distance is all that leads there.
TEST(Evolutions, FindABandOfAFiftiethByTheViolation) {
  SearchProblem p;
  p.space.dimensions = {{0, 1, {}}};
  p.constraints = 1;
  p.evaluations = 60;
  const auto searcher = make_searcher({"cmaes", ""}, p);
  std::vector<Evaluation> all;
  while (all.size() < 60) {
    std::vector<Evaluation> told;
    for (const Point& u : searcher->ask())
      told.push_back({u, broken({100 + u[0]}, {std::abs(u[0] - 0.93) / 0.01 - 1})});
    ASSERT_FALSE(told.empty()) << all.size();
    searcher->tell(told);
    all.insert(all.end(), told.begin(), told.end());
  }
  const auto holds = [](const Evaluation& e) { return e.outcome.feasible(); };
  EXPECT_TRUE(std::none_of(all.begin(), all.begin() + 12, holds));
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), holds));
}

// The local ones begin at the user's point and go a fifth of the unit cube from it; the global one
// begins in the middle. All of them find a bowl.
TEST(LocalSearches, BeginAtTheStartAndAFifthFromIt) {
  for (const char* method : {"sbplx", "bobyqa", "direct"}) {
    SearchProblem p = square_problem();
    p.starts = {{0.25, 0.625}};
    p.evaluations = 200;
    const auto searcher = make_searcher({method, ""}, p);
    std::vector<Point> asked;
    double least = 1;
    for (int i = 0; i < 200; ++i) {
      const std::vector<Point> one = searcher->ask();
      if (one.empty()) break;
      ASSERT_EQ(one.size(), 1u);
      asked.push_back(one[0]);
      const double f = std::pow(one[0][0] - 0.4, 2) + 2 * std::pow(one[0][1] - 0.3, 2);
      least = std::min(least, f);
      searcher->tell({{one[0], feasible({f})}});
    }
    EXPECT_LT(least, 1e-4) << method;
    const bool global = method == std::string("direct");
    EXPECT_EQ(asked[0], (global ? Point{0.5, 0.5} : Point{0.25, 0.625})) << method;
    if (global) continue;
    for (std::size_t k = 1; k <= 2; ++k)
      EXPECT_NEAR(std::max(std::abs(asked[k][0] - 0.25), std::abs(asked[k][1] - 0.625)), 0.2, 1e-6)
          << method;
  }
}

// Residuals that are linear: from the start a step of two hundredths each
// way, and the least sum in a few steps.
TEST(LeastSquaresSearch, TakesDifferencesOfTwoHundredthsOfTheUnitCube) {
  SearchProblem p = square_problem();
  p.residuals = 2;
  p.starts = {{0.5, 0.25}};
  const auto searcher = make_searcher({"least_squares", ""}, p);
  std::vector<Point> asked;
  double least = 1;
  for (int i = 0; i < 12; ++i) {
    const std::vector<Point> one = searcher->ask();
    ASSERT_EQ(one.size(), 1u);
    asked.push_back(one[0]);
    const double x = one[0][0] - 0.7, y = one[0][1] - 0.4;
    least = std::min(least, std::hypot(x, y));
    searcher->tell({{one[0], {true, "", {std::hypot(x, y)}, {}, {x, y}}}});
  }
  EXPECT_EQ(asked[0], (Point{0.5, 0.25}));
  // Steps of 0.02 of a coordinate that lies one beyond.
  std::vector<Point> steps(asked.begin() + 1, asked.begin() + 5);
  std::sort(steps.begin(), steps.end());
  const std::vector<Point> expected{{0.47, 0.25}, {0.5, 0.225}, {0.5, 0.275}, {0.53, 0.25}};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(steps[k][i], expected[k][i], 1e-9);
  EXPECT_LT(least, 1e-4);
  for (std::size_t i = 0; i < asked.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(asked[i], asked[j]);  // never twice
}

}  // namespace
}  // namespace papilla::tests::blocking_test
