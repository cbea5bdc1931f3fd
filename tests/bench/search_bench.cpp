// search_bench [analytic | study FILE EVALUATIONS SEEDS]: hypervolume against cost in equivalent
// full evaluations, for the searches of optim and for a space-filling sweep. CSV on standard
// output.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/statistics.h"
#include "optim/algorithms/searchers.h"
#include "optim/pareto.h"
#include "optim/search.h"
#include "study/objective.h"

using namespace papilla;

namespace {

struct Bench {
  std::string name;
  SearchProblem problem;
  std::function<Outcome(const Point&)> full, draft;  // of the unit cube
  double draft_cost = 0;                             // in full evaluations
  Point reference;
  double best = 0;  // hypervolume of the true front; 0: not known
};

struct Trace {
  std::vector<double> cost, value;  // after each evaluation
  double searcher_seconds = 0;      // the searcher's own time
};

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Trace run(const std::string& method, const Bench& bench, std::uint64_t seed, int evaluations) {
  SearchProblem p = bench.problem;
  p.seed = seed;
  p.evaluations = evaluations;
  constexpr std::string_view kDrafts = "bayesian + drafts ";  // and their number
  if (method.starts_with(kDrafts)) p.drafts = std::atoi(method.c_str() + kDrafts.size());
  Trace trace;
  std::vector<std::vector<double>> points;
  double cost = 0;
  int count = 0;
  const auto add = [&](const Outcome& o) {
    if (o.feasible()) points.push_back(o.objectives);
    cost += 1;
    ++count;
    trace.cost.push_back(cost);
    trace.value.push_back(points.empty() ? 0 : hypervolume(points, bench.reference));
  };
  if (method == "sweep") {
    for (std::uint64_t i = 0; count < evaluations; ++i) {
      const Point u = p.space.snapped(low_discrepancy(p.space.size(), seed, i));
      if (p.cheaply_feasible(u)) add(bench.full(u));
    }
    return trace;
  }
  const std::string name = p.drafts > 0 ? "bayesian" : method;
  const auto searcher = make_searcher(choose_method(name, p), p);
  while (count < evaluations) {
    const double from = seconds();
    const std::vector<Point> asked = searcher->ask();
    trace.searcher_seconds += seconds() - from;
    if (asked.empty()) break;
    std::vector<Evaluation> batch;
    for (const Point& u : asked) {
      if (!p.cheaply_feasible(u)) {
        Outcome refused;
        refused.constraints = p.cheap_constraints(u);
        batch.push_back({u, refused});
      } else if (searcher->asks_drafts()) {
        batch.push_back({u, bench.draft(u)});
        cost += bench.draft_cost;
      } else if (count < evaluations) {
        batch.push_back({u, bench.full(u)});
        add(batch.back().outcome);
      }
    }
    searcher->tell(batch);
  }
  return trace;
}

double at_cost(const Trace& t, double cost) {
  double value = 0;
  for (std::size_t i = 0; i < t.cost.size() && t.cost[i] <= cost; ++i) value = t.value[i];
  return value;
}

void table(const Bench& bench, const std::vector<std::string>& methods, int evaluations, int seeds,
           double scale) {
  for (const std::string& method : methods) {
    std::vector<Trace> traces;
    for (int seed = 1; seed <= seeds; ++seed)
      traces.push_back(run(method, bench, static_cast<std::uint64_t>(seed), evaluations));
    double own = 0;
    for (const Trace& t : traces) own += t.searcher_seconds / seeds;
    for (double cost : {12., 16., 20., 25., 30., 40., 60., 80., 160.}) {
      if (cost > evaluations) break;
      std::vector<double> values;
      for (const Trace& t : traces) values.push_back(at_cost(t, cost) / scale);
      fmt::print("{},{},{:.0f},{:.4f},{:.4f},{:.4f},{:.2f}\n", bench.name, method, cost,
                 quantile(values, 0.5), quantile(values, 0), quantile(values, 1), own);
    }
    std::fflush(stdout);
  }
}

SearchProblem box(std::size_t n, std::size_t objectives) {
  SearchProblem p;
  p.space.dimensions.assign(n, Dimension{});
  p.objectives = objectives;
  return p;
}

Outcome good(std::vector<double> objectives) { return {true, {}, std::move(objectives), {}, {}}; }

double tail_sum(const Point& x) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += x[i];
  return sum / static_cast<double>(x.size() - 1);
}

// The default study's landscape in closed form (mean modulation and its variation over humidity
// against fill, period, depth and contact angle); the draft is off by a factor and by a tilt.
Outcome stand_in(const Point& u, bool draft) {
  const double fill = 0.7 * u[1], deep = 1 - std::exp(-3 * u[2]), angle = u[3], fine = 1 - u[0];
  const double works = fill * deep * (0.5 + 0.5 * fine);
  double mean = 0.53 + 0.1 * angle * angle - 0.35 * works;
  double variation =
      0.55 - 0.25 * angle - 0.75 * works * (1 - 0.6 * angle) + 1.2 * works * works * angle;
  variation = std::sqrt(variation * variation + 0.003);
  if (draft) {
    mean = 1.2 * mean + 0.03 * std::sin(5 * u[2]) + 0.02 * u[0];
    variation = 0.8 * variation + 0.05 * u[3] + 0.03 * std::sin(4 * u[1]);
  }
  const auto noise = [&](std::uint64_t k) {
    double key = static_cast<double>(k);
    for (double v : u) key = 1e3 * (key + v);
    return 2 * hash_uniform(draft ? 5 : 4, static_cast<std::uint64_t>(std::abs(key)), k) - 1;
  };
  return good({-mean * (1 + 0.003 * noise(1)), variation * (1 + 0.02 * noise(2))});
}

void analytic() {
  const std::vector<std::string> methods{"sweep", "nsga2", "bayesian"};
  std::vector<Bench> benches;
  const auto zdt = [&](const char* name, double best, auto f2, bool sixth = false) {
    benches.push_back({name,
                       box(4, 2),
                       [f2, sixth](const Point& x) {
                         const double f1 = sixth ? 1 - std::exp(-4 * x[0]) *
                                                           std::pow(std::sin(6 * M_PI * x[0]), 6)
                                                 : x[0];
                         return good({f1, f2(f1, x)});
                       },
                       {},
                       0,
                       {1.1, 1.1},
                       best});
  };
  const auto g = [](const Point& x) { return 1 + 9 * tail_sum(x); };
  zdt("ZDT1", 0.876667, [g](double f, const Point& x) { return g(x) * (1 - std::sqrt(f / g(x))); });
  zdt("ZDT2", 0.543333,
      [g](double f, const Point& x) { return g(x) * (1 - f / g(x) * (f / g(x))); });
  zdt("ZDT3", 1.331763, [g](double f, const Point& x) {
    return g(x) * (1 - std::sqrt(f / g(x)) - f / g(x) * std::sin(10 * M_PI * f));
  });
  zdt("ZDT4", 0.876667, [](double f, const Point& x) {
    double s = 1 + 10 * static_cast<double>(x.size() - 1);
    for (std::size_t i = 1; i < x.size(); ++i) {
      const double t = 10 * x[i] - 5;
      s += t * t - 10 * std::cos(4 * M_PI * t);
    }
    return s * (1 - std::sqrt(f / s));
  });
  zdt(
      "ZDT6", 0.507878,
      [](double f, const Point& x) {
        const double s = 1 + 9 * std::pow(tail_sum(x), 0.25);
        return s * (1 - f / s * (f / s));
      },
      true);
  for (const Bench& b : benches) table(b, methods, 80, 3, b.best);
  Bench dtlz{"DTLZ2",
             box(5, 3),
             [](const Point& x) {
               double s = 1;
               for (std::size_t i = 2; i < x.size(); ++i) s += (x[i] - 0.5) * (x[i] - 0.5);
               const double a = x[0] * M_PI / 2, b = x[1] * M_PI / 2;
               return good(
                   {s * std::cos(a) * std::cos(b), s * std::cos(a) * std::sin(b), s * std::sin(a)});
             },
             {},
             0,
             {1.1, 1.1, 1.1},
             0.807401};
  table(dtlz, {"sweep", "nsga2"}, 160, 3, dtlz.best);
  Bench study{"stand-in",
              box(4, 2),
              [](const Point& u) { return stand_in(u, false); },
              [](const Point& u) { return stand_in(u, true); },
              1.0 / 30,
              {-0.25, 0.6},
              0};
  std::vector<std::vector<double>> points;  // its front, from a large sweep without noise's help
  for (std::uint64_t i = 0; i < 20000; ++i)
    points.push_back(stand_in(low_discrepancy(4, 9, i), false).objectives);
  table(study, {"sweep", "nsga2", "bayesian", "bayesian + drafts 32", "bayesian + drafts 80"}, 80,
        5, hypervolume(points, study.reference));
}

// The product's study at search level; drafts at 64 x 64 with the first finger.
void product(const std::string& file, int evaluations, int seeds) {
  const Study study = read_study(file);
  const StudyProblem problem(study);
  std::map<Point, Outcome> known[2];
  double spent[2] = {0, 0};
  const auto evaluate = [&](const Point& u, bool draft) {
    if (const auto it = known[draft].find(u); it != known[draft].end()) return it->second;
    Fidelity fidelity = fidelity_level("search");
    if (draft) {
      fidelity.grid = 64;
      fidelity.skins = 6;
    }
    const double from = seconds();
    std::vector<Outcome> tasks;
    for (std::size_t t = 0; t < problem.tasks().size(); ++t)
      tasks.push_back(draft && t > 0 ? tasks[0] : problem.evaluate_task(u, t, fidelity, false));
    spent[draft] += seconds() - from;
    return known[draft][u] = guarded(problem.outcome(problem.score(tasks)),
                                     problem.objectives().size(), problem.constraints());
  };
  Bench bench;
  bench.name = study.name;
  bench.problem.space = problem.space();
  bench.problem.objectives = problem.objectives().size();
  bench.problem.constraints = problem.constraints();
  bench.problem.cheap_constraints = [&](const Point& u) { return problem.geometry(u); };
  bench.problem.starts = problem.starts();
  bench.full = [&](const Point& u) { return evaluate(u, false); };
  bench.draft = [&](const Point& u) { return evaluate(u, true); };
  const Point own = problem.unit_of_study();
  for (int i = 0; i < 2; ++i) {  // the second: everything warm
    known[0].clear();
    known[1].clear();
    spent[0] = spent[1] = 0;
    evaluate(own, false);
    evaluate(own, true);
  }
  bench.draft_cost = spent[1] / spent[0];
  fmt::print(stderr, "full {:.3f} s, draft {:.3f} s\n", spent[0], spent[1]);
  bench.reference = {-0.3, 0.7};
  // Shares of the best that anybody finds; printed raw, put in relation by the reader.
  table(bench, {"bayesian", "bayesian + drafts 32", "bayesian + drafts 80", "sweep"}, evaluations,
        seeds, 1);
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("problem,method,full evaluations,hypervolume median,least,greatest,searcher s\n");
  if (argc >= 5 && std::string(argv[1]) == "study") {
    product(argv[2], std::atoi(argv[3]), std::atoi(argv[4]));
  } else {
    analytic();
  }
}
