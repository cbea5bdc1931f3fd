#include "optim/search.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "optim/gaussian_process.h"
#include "optim/pareto.h"
#include "optim/worker.h"

namespace papilla::tests::search_test {
namespace {

SearchProblem box(std::size_t n, std::size_t objectives, int evaluations, double low = 0,
                  double high = 1) {
  SearchProblem p;
  p.space.dimensions.assign(n, {low, high, {}});
  p.objectives = objectives;
  p.evaluations = evaluations;
  return p;
}

template <class F>
std::vector<Evaluation> run(const std::string& name, const SearchProblem& problem, F&& f) {
  const auto searcher = make_searcher(choose_method(name, problem), problem);
  std::vector<Evaluation> all;
  while (static_cast<int>(all.size()) < problem.evaluations) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) {
      if (static_cast<int>(all.size() + batch.size()) == problem.evaluations) break;  // as a study
      batch.push_back(
          {u, guarded(f(problem.space.value(u)), problem.objectives, problem.constraints)});
    }
    if (batch.empty()) break;
    searcher->tell(batch);
    all.insert(all.end(), batch.begin(), batch.end());
  }
  return all;
}

Outcome outcome(std::vector<double> objectives, std::vector<double> constraints = {}) {
  return {true, {}, std::move(objectives), std::move(constraints), {}};
}

double best(const std::vector<Evaluation>& all) {
  double value = std::numeric_limits<double>::infinity();
  for (const Evaluation& e : all) {
    if (e.outcome.feasible()) value = std::min(value, e.outcome.objectives[0]);
  }
  return value;
}

double front_volume(const std::vector<Evaluation>& all, const std::vector<double>& reference) {
  std::vector<std::vector<double>> points;
  for (std::size_t i : pareto_front(all)) points.push_back(all[i].outcome.objectives);
  return hypervolume(points, reference);
}

Outcome zdt1(const Point& x) {
  double g = 0;
  for (std::size_t i = 1; i < x.size(); ++i) g += x[i];
  g = 1 + 9 * g / static_cast<double>(x.size() - 1);
  return outcome({x[0], g * (1 - std::sqrt(x[0] / g))});
}
Outcome zdt2(const Point& x) {
  double g = 0;
  for (std::size_t i = 1; i < x.size(); ++i) g += x[i];
  g = 1 + 9 * g / static_cast<double>(x.size() - 1);
  return outcome({x[0], g * (1 - (x[0] / g) * (x[0] / g))});
}

// Points (0, 1), (2, 2), (4, 0): the box to the best is 4 x 2, and infeasible ones count nothing.
TEST(Hypervolume, ItsSharesAreOfTheBoxBetweenWorstAndBest) {
  std::vector<Evaluation> all{{{0.0}, outcome({0, 1})},
                              {{0.1}, outcome({-9, -9})},
                              {{0.2}, outcome({2, 2})},
                              {{0.3}, outcome({4, 0})}};
  all[1].outcome.constraints = {1};
  EXPECT_EQ(hypervolume_shares(all), (std::vector<double>{0.5, 0.5, 0.5, 0.5}));
  all.push_back({{0.4}, outcome({1, 0})});
  EXPECT_EQ(hypervolume_shares(all).back(), (4.0 + 3.0) / 8);
}

TEST(Hypervolume, HasItsClosedForms) {
  EXPECT_DOUBLE_EQ(hypervolume({{1, 2}, {2, 1}}, {3, 3}), 3);
  EXPECT_DOUBLE_EQ(hypervolume({{1, 1, 1}}, {2, 3, 4}), 6);
  EXPECT_DOUBLE_EQ(hypervolume({{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}, {2, 2, 2}), 1 + 3 * 1);
  // 100 points on ZDT1's front, uniform in f1: 0.871409 to the reference (1.1, 1.1).
  std::vector<std::vector<double>> front;
  for (int i = 0; i < 100; ++i) front.push_back({i / 99.0, 1 - std::sqrt(i / 99.0)});
  EXPECT_NEAR(hypervolume(front, {1.1, 1.1}), 0.871409, 1e-6);
}

TEST(Bayesian, FindsTheFrontOfZdt1InSixtyEvaluations) {
  const SearchProblem p = box(4, 2, 60);
  const auto all = run("auto", p, zdt1);
  EXPECT_GT(front_volume(all, {1.1, 1.1}), 0.97 * 0.876667);
}

TEST(Bayesian, BeatsNsga2AtEqualSmallBudgets) {
  const SearchProblem p = box(4, 2, 60);
  for (auto f : {zdt1, zdt2}) {
    EXPECT_GT(front_volume(run("bayesian", p, f), {1.1, 1.1}),
              1.1 * front_volume(run("nsga2", p, f), {1.1, 1.1}));
  }
}

TEST(Nsga2, ConvergesWithAllItsEvaluations) {
  const SearchProblem p = box(4, 2, 3000);
  EXPECT_GT(front_volume(run("nsga2", p, zdt1), {1.1, 1.1}), 0.95 * 0.876667);
}

// 1.1 * 1.1 less what lies below f2 = 1 - f1^2: 0.543333.
TEST(Nsga2, ConvergesOnAFrontThatBulges) {
  const SearchProblem p = box(4, 2, 3000);
  EXPECT_GT(front_volume(run("nsga2", p, zdt2), {1.1, 1.1}), 0.93 * 0.543333);
}

// Axes of 1 to 100 that lie across the coordinates: without learning their directions the steps
// stay too short.
TEST(Cmaes, FindsTheMinimumOfATurnedEllipsoid) {
  const SearchProblem p = box(4, 1, 3000);
  const auto all = run("cmaes", p, [](const Point& x) {
    double sum = 0, signs[4][4] = {{1, 1, 1, 1}, {1, -1, 1, -1}, {1, 1, -1, -1}, {1, -1, -1, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
      double along = 0;
      for (std::size_t k = 0; k < 4; ++k)
        along += 0.5 * signs[i][k] * (x[k] - 0.2 - 0.15 * static_cast<double>(k));
      sum += std::pow(10, 4.0 / 3 * static_cast<double>(i)) * along * along;
    }
    return outcome({sum});
  });
  EXPECT_LT(best(all), 1e-7);
}

TEST(Search, EverySingleObjectiveMethodFindsANoisyMinimum) {
  for (const char* name : {"bayesian", "cmaes", "sbplx", "direct", "bobyqa"}) {
    SearchProblem p = box(3, 1, std::string(name) == "bayesian" ? 60 : 250);
    RandomStream noise(5, "noise");
    const auto all = run(name, p, [&](const Point& x) {
      double sum = 0;
      for (double v : x) sum += (v - 0.3) * (v - 0.3);
      return outcome({1 + sum + 1e-3 * noise.normal()});
    });
    EXPECT_LT(best(all), 1.02) << name;
  }
}

TEST(Search, TheConstrainedMinimumLiesOnTheConstraint) {
  // min x + y subject to x y >= 0.25: (0.5, 0.5), value 1.
  for (const char* name : {"bayesian", "sbplx"}) {
    SearchProblem p = box(2, 1, std::string(name) == "bayesian" ? 50 : 300);
    p.constraints = 1;
    const auto all =
        run(name, p, [](const Point& x) { return outcome({x[0] + x[1]}, {0.25 - x[0] * x[1]}); });
    EXPECT_LT(best(all), 1.05) << name;
    EXPECT_GE(best(all), 1 - 1e-9) << name;
  }
}

TEST(Search, HardProblemsEnd) {
  const auto quadratic = [](const Point& x) { return outcome({x[0] * x[0]}); };
  for (const char* name : {"bayesian", "cmaes", "sbplx", "direct", "bobyqa"}) {
    const SearchProblem p = box(2, 1, 40, -1, 1);
    const auto half_nan = [&](const Point& x) {
      return x[0] < 0 ? outcome({std::nan("")}) : quadratic(x);
    };
    const auto infinite = [&](const Point& x) {
      return x[1] < 0 ? outcome({INFINITY}) : quadratic(x);
    };
    const auto flat = [&](const Point&) { return outcome({3}); };
    const auto never = [&](const Point&) { return Outcome{}; };
    EXPECT_LT(best(run(name, p, half_nan)), 0.5) << name;
    EXPECT_LT(best(run(name, p, infinite)), 0.5) << name;
    EXPECT_EQ(best(run(name, p, flat)), 3) << name;
    EXPECT_FALSE(run(name, p, never).empty()) << name;
  }
}

TEST(Search, ExtremeScalesAreNoDifferent) {
  for (double scale : {1e-12, 1e9}) {
    const SearchProblem p = box(2, 1, 40, 0, scale);
    const auto all = run("bayesian", p, [&](const Point& x) {
      return outcome({std::pow(x[0] / scale - 0.4, 2) + x[1] / scale});
    });
    EXPECT_LT(best(all), 0.02) << scale;
  }
}

TEST(Search, OnePointIsEvaluatedOnce) {
  SearchProblem p = box(2, 1, 20, 0.5, 0.5);
  EXPECT_EQ(run("auto", p, [](const Point&) { return outcome({1}); }).size(), 1u);
}

TEST(Search, AnEmptyFeasibleSetGivesTheLeastViolatingPoint) {
  SearchProblem p = box(2, 1, 40);
  p.constraints = 1;
  const auto all = run("bayesian", p, [](const Point& x) { return outcome({x[0]}, {1 + x[1]}); });
  const auto front = pareto_front(all);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_LT(all[front[0]].unit[1], 0.1);
}

TEST(Search, ChoicesAreTaken) {
  SearchProblem p;
  p.space.dimensions = {{0, 1, {}}, {0, 0, {1, 5, 9}}};
  p.evaluations = 30;
  const auto all =
      run("auto", p, [](const Point& x) { return outcome({std::abs(x[1] - 5) + x[0]}); });
  EXPECT_LT(best(all), 0.05);
  for (const Evaluation& e : all) {
    const double c = p.space.value(e.unit)[1];
    EXPECT_TRUE(c == 1 || c == 5 || c == 9);
  }
}

// Four kinds with minima of their own; the best of all is a kind between two poor ones.
// 100 to 900 without 300 to 400 and 600 to 700: 600 are left, evenly over the unit interval.
TEST(Space, HasNothingOfWhatIsExcluded) {
  const Space space{{{100, 900, {}, true, {{300, 400}, {600, 700}}}}, {}};
  const Dimension& d = space.dimensions[0];
  int below = 0, between = 0;
  constexpr int kPoints = 6000;
  for (int i = 0; i < kPoints; ++i) {
    const double v = space.value({(i + 0.5) / kPoints})[0];
    ASSERT_FALSE(d.excluded[0].holds(v) || d.excluded[1].holds(v)) << v;
    below += v <= 300;
    between += v >= 400 && v <= 600;
    EXPECT_NEAR(space.value(space.snapped({(i + 0.5) / kPoints}))[0], v, 1e-9);
  }
  EXPECT_NEAR(below, 2000, 1);
  EXPECT_NEAR(between, 2000, 1);
  // Ends are themselves, excluded values the nearer one.
  for (const double end : {100., 300., 400., 600., 700., 900.})
    EXPECT_EQ(space.value(space.unit({end}))[0], end);
  EXPECT_EQ(space.value(space.unit({349}))[0], 300);
  EXPECT_EQ(space.value(space.unit({351}))[0], 400);
  EXPECT_EQ(space.value(space.unit({699}))[0], 700);
}

// The minimum of all lies at 355; of what is left at the nearer end, 400 before 301.
TEST(Search, FindsTheBestOfWhatIsNotExcluded) {
  SearchProblem p = box(2, 1, 60, 100, 900);
  p.space.dimensions[0].excluded = {{301, 400}};
  const auto bowl = [](const Point& v) {
    return Outcome{true, "", {std::pow(v[0] - 355, 2) + std::pow(v[1] - 500, 2)}, {}, {}};
  };
  for (const char* method : {"bayesian", "cmaes", "direct"}) {
    double best = 1e300;
    for (const Evaluation& e : run(method, p, bowl)) {
      EXPECT_FALSE(p.space.dimensions[0].excluded[0].holds(p.space.value(e.unit)[0])) << method;
      best = std::min(best, e.outcome.objectives[0]);
    }
    EXPECT_GE(best, 45 * 45) << method;
    if (method == std::string("bayesian")) {
      EXPECT_LT(best, 54 * 54);  // the farther end
    }
  }
}

TEST(Search, KindsAreNotTakenForNeighbours) {
  SearchProblem p;
  p.space.dimensions = {{0, 3, {0, 1, 2, 3}, false}, {0, 1, {}}, {0, 1, {}}};
  p.evaluations = 45;
  const double least[] = {0.5, 0.4, 0.0, 0.6}, where[] = {0.2, 0.9, 0.35, 0.7};
  const auto all = run("auto", p, [&](const Point& x) {
    const auto kind = static_cast<std::size_t>(x[0]);
    return outcome({least[kind] + std::pow(x[1] - where[kind], 2) + std::pow(x[2] - 0.5, 2)});
  });
  EXPECT_LT(best(all), 0.01);
}

TEST(Search, PointsThatAreOneDesignAreAskedOnce) {
  SearchProblem p = box(2, 1, 25);
  // Below a depth of a half the second variable does nothing.
  p.space.collapse = [](Point u) {
    if (u[0] < 0.5) u = {0, 0.5};
    return u;
  };
  int flat = 0;
  const auto all = run("bayesian", p, [&](const Point& x) {
    flat += x[0] == 0;
    return outcome({1 - x[0] + x[1]});
  });
  EXPECT_EQ(flat, 1);
  EXPECT_LT(best(all), 0.05);
}

TEST(Search, TheSameSeedAsksTheSamePoints) {
  for (const char* name : {"bayesian", "nsga2"}) {
    const SearchProblem p = box(3, 2, 30);
    const auto a = run(name, p, zdt1), b = run(name, p, zdt1);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].unit, b[i].unit);
  }
}

TEST(GaussianProcess, InterpolatesAndKnowsWhereItDoesNotKnow) {
  std::vector<Point> x;
  std::vector<double> y;
  for (int i = 0; i <= 10; ++i) {
    if (i == 5) continue;
    x.push_back({i / 10.0});
    y.push_back(std::sin(4 * i / 10.0));
  }
  const GaussianProcess gp(x, y);
  EXPECT_NEAR(gp.predict({0.5}).mean, std::sin(2.0), 0.02);
  EXPECT_NEAR(gp.predict({0.3}).mean, std::sin(1.2), 1e-2);
  EXPECT_GT(gp.predict({0.5}).sd, gp.predict({0.3}).sd);
}

// A quadratic whose draft is tilted and scaled: twelve full evaluations and 60 drafts.
double drafted_best(double tilt, int drafts) {
  SearchProblem p = box(4, 1, 12);
  p.drafts = drafts;
  const auto f = [](const Point& x) {
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k)
      sum += std::pow(x[k] - 0.2 - 0.2 * static_cast<double>(k), 2);
    return sum;
  };
  const auto searcher = make_searcher({"bayesian", ""}, p);
  double found = 1e9;
  for (int count = 0; count < p.evaluations;) {
    std::vector<Evaluation> batch;
    for (const Point& u : searcher->ask()) {
      if (searcher->asks_drafts()) {
        batch.push_back({u, outcome({tilt < 0 ? std::sin(40 * u[0] + 9 * u[1])
                                              : 1 + 0.5 * f(u) + tilt * u[0]})});
      } else {
        batch.push_back({u, outcome({f(u)})});
        found = std::min(found, f(u));
        ++count;
      }
    }
    searcher->tell(batch);
  }
  return found;
}

TEST(Drafts, BiasedOnesHelpAndMisleadingOnesAreDropped) {
  EXPECT_LT(drafted_best(0.1, 60), 0.01);
  EXPECT_LT(drafted_best(0.1, 60), 0.3 * drafted_best(0.1, 0));
  EXPECT_LT(drafted_best(-1, 60), 0.3);
}

TEST(Bayesian, ACostlyConstraintIsAskedOfFewPointsAndKept) {
  SearchProblem p = box(2, 1, 24);
  int asked = 0;
  p.costly_constraints = [&](const Point& u) {
    ++asked;
    return std::vector<double>{0.7 - u[0]};
  };
  const auto all = run("bayesian", p, [&](const Point& x) {
    return x[0] < 0.7 ? Outcome{false, "refused", {}, {}, {}} : outcome({x[0] + x[1]});
  });
  int refused = 0;
  for (const Evaluation& e : all) refused += !e.outcome.ok;
  EXPECT_LE(refused, 8);  // 14 when only the most promising candidates are asked
  EXPECT_LT(best(all), 0.75);
  EXPECT_LT(asked, 60 * 24);
}

TEST(Worker, ACrashAHangAndAnExceptionBecomeFailures) {
  const auto work = [](const Bytes& request) -> Bytes {
    if (request == "crash") ::abort();
    if (request == "throw") throw std::runtime_error("no water left\nfor the droplets");
    while (request == "hang") ::pause();
    return request + "\n\t" + Bytes(1, '\0');
  };
  using Reason = WorkFailure::Reason;
  Worker worker(work, {.seconds = 1});
  const auto ask = [&](const Bytes& request) {
    worker.send(request);
    return worker.receive();
  };
  const auto failure = [&](const Bytes& request) { return ask(request).failure.value(); };
  EXPECT_EQ(failure("crash").reason, Reason::Crashed);
  EXPECT_NE(failure("crash").text.find("crashed"), std::string::npos);
  EXPECT_EQ(failure("throw"), (WorkFailure{Reason::Threw, "no water left for the droplets"}));
  EXPECT_EQ(failure("hang").reason, Reason::TimedOut);
  EXPECT_NE(failure("hang").text.find("longer"), std::string::npos);
  EXPECT_EQ(ask("work").bytes, Bytes("work\n\t") + '\0');
  EXPECT_FALSE(ask("").failure);
}

TEST(Worker, RunsInParallelAlthoughItsParentDidSoBefore) {
  std::atomic<int> sum{0};
  parallel_for(
      4, [&](int i) { sum += i; }, 2);
  Worker worker(
      [](const Bytes& request) {
        std::atomic<int> counted{0};
        parallel_for(
            8, [&](int) { ++counted; }, 2);
        return std::to_string(std::stoi(request) + counted);
      },
      {.seconds = 20});
  worker.send("1");
  const WorkAnswer out = worker.receive();
  ASSERT_FALSE(out.failure) << out.failure->text;
  EXPECT_EQ(out.bytes, "9");
}

TEST(Worker, TooMuchMemoryBecomesAFailure) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "workers have no limit of address space under the sanitizer";
#endif
  Worker worker(
      [](const Bytes& request) {
        std::vector<double> field(std::stoul(request), 1.0);
        return std::to_string(field.back());
      },
      {.seconds = 20, .bytes = 1e9});
  worker.send("4000000000");
  EXPECT_EQ(worker.receive().failure,
            (WorkFailure{WorkFailure::Reason::OutOfMemory, "not enough memory"}));
  worker.send("1000");
  EXPECT_EQ(worker.receive().bytes, std::to_string(1.0));
}

TEST(Team, AnyNumberGivesTheSameAnswers) {
  std::vector<Bytes> requests;
  for (int i = 0; i < 9; ++i) requests.push_back(std::to_string(i));
  const auto work = [](const Bytes& request) {
    const int i = std::stoi(request);
    if (i == 3) ::abort();
    ::usleep(static_cast<unsigned>(2e3 * (9 - i)));  // the first are the slowest
    return std::to_string(3 * i);
  };
  std::vector<WorkAnswer> first;
  for (std::size_t jobs : {1u, 2u, 3u}) {
    const auto answers = make_local_team(jobs, work, {})->answer(requests);
    if (first.empty()) first = answers;
    EXPECT_EQ(answers, first);
  }
  EXPECT_TRUE(first[3].failure);
  EXPECT_EQ(first[8].bytes, "24");
}

TEST(Team, AHangHoldsUpNobodyElse) {
  const auto work = [](const Bytes& request) {
    while (request == "hang") ::pause();
    return request;
  };
  const auto out = make_local_team(2, work, {.seconds = 1})->answer({"hang", "1", "2", "3"});
  EXPECT_EQ(out[0].failure.value().reason, WorkFailure::Reason::TimedOut);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(out[i].bytes, std::to_string(i));
}

// Of the one list of methods, each as studies name it.
TEST(Method, EveryNameMakesASearcherThatAsks) {
  SearchProblem p = box(2, 1, 10);
  p.residuals = 2;
  for (const std::string& name : searcher_names()) {
    p.objectives = name == "nsga2" ? 2 : 1;
    const std::vector<Point> asked = make_searcher(choose_method(name, p), p)->ask();
    ASSERT_FALSE(asked.empty()) << name;
    EXPECT_EQ(asked[0].size(), 2u) << name;
  }
}

TEST(Method, WhatCannotDoTheProblemIsRefused) {
  EXPECT_THROW(choose_method("bobyqa", box(2, 2, 10)), InputError);
  EXPECT_THROW(choose_method("annealing", box(2, 1, 10)), InputError);
  EXPECT_EQ(choose_method("auto", box(4, 2, 100)).name, "bayesian");
  EXPECT_EQ(choose_method("auto", box(4, 3, 10000)).name, "nsga2");
}

// The method for every number of objectives, evaluations and variables, on both sides of each
// limit.
TEST(Searchers, AutoTakesTheMethodThatTheStudyHasRoomFor) {
  for (const auto& [variables, objectives, evaluations, method] :
       {std::tuple{20, 1, 400, "bayesian"},
        {20, 2, 400, "bayesian"},
        {20, 1, 401, "cmaes"},
        {20, 2, 401, "nsga2"},
        {21, 1, 400, "cmaes"},
        {21, 2, 400, "nsga2"},
        {4, 3, 100, "nsga2"}}) {
    const SearchMethod chosen = choose_method("auto", box(variables, objectives, evaluations));
    EXPECT_EQ(chosen.name, method) << variables << " " << objectives << " " << evaluations;
    EXPECT_FALSE(chosen.why.empty());
  }
  EXPECT_EQ(choose_method("cmaes", box(4, 1, 100)).why, "asked for");
  EXPECT_THROW(choose_method("bayesian", box(2, 3, 10)), InputError);
  EXPECT_THROW(choose_method("nsga2", box(2, 1, 10)), InputError);
  EXPECT_THROW(choose_method("least_squares", box(2, 1, 10)), InputError);
}

// What is known without an evaluation must be kept, the cheap and the costly of it.
TEST(Searchers, APointIsFeasibleWhereEveryConstraintIsKept) {
  SearchProblem p = box(2, 1, 10);
  const Point point{0.5, 0.5};
  EXPECT_TRUE(p.feasible_before_evaluation(point));
  double cheap = -1, costly = -1;
  p.cheap_constraints = [&](const Point&) { return std::vector<double>{-1, cheap}; };
  p.costly_constraints = [&](const Point&) { return std::vector<double>{costly, -1}; };
  for (const auto& [a, b] :
       {std::pair{-1.0, -1.0}, {0.0, 0.0}, {0.1, -1.0}, {-1.0, 0.1}, {1.0, 1.0}}) {
    cheap = a, costly = b;
    EXPECT_EQ(p.cheaply_feasible(point), a <= 0) << a;
    EXPECT_EQ(p.feasible_before_evaluation(point), a <= 0 && b <= 0) << a << " " << b;
  }
}

// A study's own points are none of the drafts where it asks for none.
TEST(Bayesian, WithoutDraftsTheStartsAreEvaluatedThemselves) {
  SearchProblem p = box(2, 1, 30);
  p.starts = {{0.25, 0.75}};
  const auto searcher = make_searcher({"bayesian", ""}, p);
  const std::vector<Point> asked = searcher->ask();
  EXPECT_FALSE(searcher->asks_drafts());
  ASSERT_EQ(asked.size(), 3u * 2 + 4);  // the first design
  EXPECT_EQ(asked[0], p.space.snapped(p.starts[0]));
  p.drafts = 12;
  const auto drafting = make_searcher({"bayesian", ""}, p);
  EXPECT_EQ(drafting->ask().size(), 8u);  // two thirds at once, the starts among them
  EXPECT_TRUE(drafting->asks_drafts());
}

// As long as nothing can be evaluated, what is asked keeps the limits and is new.
TEST(Bayesian, WhereEverythingFailsItGoesOnWithinTheLimits) {
  SearchProblem p = box(2, 1, 40);
  p.cheap_constraints = [](const Point& u) { return std::vector<double>{0.9 - u[0]}; };
  const auto all = run("bayesian", p, [](const Point&) { return Outcome{}; });
  ASSERT_EQ(all.size(), 40u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_GE(all[i].unit[0], 0.9) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(all[i].unit, all[j].unit) << i << " " << j;
  }
}

TEST(Outcomes, OfAnotherNumberOfValuesOrNoNumbersAreFailures) {
  EXPECT_TRUE(guarded(outcome({1, 2}, {-1}), 2, 1).ok);
  for (const auto& [wrong, why] : {std::pair{outcome({1}, {-1}), "number of values"},
                                   {outcome({1, 2, 3}, {-1}), "number of values"},
                                   {outcome({1, 2}), "number of values"},
                                   {outcome({1, 2}, {-1, -1}), "number of values"},
                                   {outcome({1, std::nan("")}, {-1}), "an objective is not"},
                                   {outcome({1, INFINITY}, {-1}), "an objective is not"},
                                   {outcome({1, 2}, {std::nan("")}), "a constraint is not"}}) {
    const Outcome guard = guarded(wrong, 2, 1);
    EXPECT_FALSE(guard.ok);
    EXPECT_NE(guard.reason.find(why), std::string::npos) << guard.reason;
    EXPECT_TRUE(guard.objectives.empty() && guard.constraints.empty());
  }
  EXPECT_EQ(guarded({false, "refused", {1}, {1}, {}}, 1, 1).reason, "refused");
  EXPECT_EQ(guarded({}, 1, 1).reason, "the evaluation failed");
  EXPECT_EQ(outcome({1}, {2, -5, 0.5}).violation(), 2.5);
  EXPECT_FALSE(outcome({1}, {2, -5}).feasible());
  EXPECT_TRUE(outcome({1}, {0, -5}).feasible());
  EXPECT_FALSE(Outcome{}.feasible());
}

// A process with values 10^6 times as large, somewhere else, says the same of them.
TEST(GaussianProcess, GoesWithTheScaleAndThePlaceOfItsValues) {
  std::vector<Point> x;
  std::vector<double> y, moved;
  for (int i = 0; i < 9; ++i) {
    x.push_back({i / 8.0});
    y.push_back(std::sin(4 * i / 8.0));
    moved.push_back(3e6 + 1e6 * y.back());
  }
  const GaussianProcess one(x, y), other(x, moved);
  for (const double at : {0.05, 0.33, 0.9}) {
    const Prediction a = one.predict({at}), b = other.predict({at});
    EXPECT_NEAR(b.mean, 3e6 + 1e6 * a.mean, 1);
    EXPECT_NEAR(b.sd, 1e6 * a.sd, 1e-4 * b.sd + 1e-3);
  }
  EXPECT_NEAR(other.leave_one_out_error(), 1e6 * one.leave_one_out_error(),
              1e-4 * other.leave_one_out_error());
}

// Two values by hand: Eq. search.6 with the fitted length and noise.
TEST(GaussianProcess, OfTwoValuesIsItsClosedForm) {
  const GaussianProcess process({{0.0}, {1.0}}, {10, 16});  // mean 13, scale 3
  const double length = std::exp(process.parameters()[0]),
               own = 1 + std::exp(process.parameters()[1]);
  const auto alike = [&](double distance) {
    const double r = std::sqrt(5.0) * distance / length;
    return (1 + r + r * r / 3) * std::exp(-r);
  };
  const double both = alike(1), signal = 1 / (own - both);
  for (const double x : {0.1, 0.25, 0.5, 0.9}) {
    const double a = alike(x), b = alike(1 - x);
    const double known = (own * (a * a + b * b) - 2 * both * a * b) / (own * own - both * both);
    const Prediction p = process.predict({x});
    EXPECT_NEAR(p.mean, 13 + 3 * (b - a) / (own - both), 1e-6) << x;
    EXPECT_NEAR(p.sd, 3 * std::sqrt(signal * (1 - known)), 1e-5) << x;
  }
}

TEST(DraftedProcess, FindsHowManyTimesTheDraftTheValuesAre) {
  std::vector<Point> dense, few;
  std::vector<double> draft_values, values;
  for (int i = 0; i <= 24; ++i) {
    dense.push_back({i / 24.0});
    draft_values.push_back(std::sin(9 * i / 24.0));
  }
  for (int i = 0; i < 6; ++i) {
    few.push_back({(4 * i + 1) / 24.0});
    values.push_back(2 - 3 * std::sin(9 * few.back()[0]));
  }
  const GaussianProcess draft(dense, draft_values);
  const DraftedProcess process(few, values, &draft);
  EXPECT_NEAR(process.ratio(), -3, 0.02);
  for (const double x : {0.13, 0.4, 0.71, 0.95})
    EXPECT_NEAR(process.predict({x}).mean, 2 - 3 * std::sin(9 * x), 0.05) << x;
}

}  // namespace
}  // namespace papilla::tests::search_test
