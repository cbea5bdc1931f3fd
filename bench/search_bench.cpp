// Hypervolume against cost in equivalent full evaluations, for the searches of optim and for a
// space-filling sweep; CSV on standard output.
//   search_bench                                  problems with known fronts, and a stand-in
//   search_bench study FILE N SEEDS GRID SKINS    a study, drafts at GRID x SKINS
//   search_bench front FILE N FEW GRID SKINS SEEDS SECONDS [CSV]
//                                                 a reference front of N evaluations or as many as
//                                                 SECONDS allow (written to CSV), and the share
//                                                 that searches of up to FEW evaluations reach
//   search_bench sweep ...                        the same, the reference a sweep alone
//   search_bench share FILE CSV FRONT... [-- MOST] the hypervolume of each FRONT over that of the
//                                                 reference front CSV, all designs judged again at
//                                                 design level on fresh skins, at most MOST a
//                                                 front; then that of all of them together
//   search_bench single FILE N STEP GRID SKINS PREFIX SEED
//                                                 a search at one level alone (GRID 0: that of the
//                                                 confirmation): its front after every STEP
//                                                 evaluations, for share
//   search_bench scatter FILE FRONT MOST          how cheaper levels scatter about design level
//   search_bench levels FILE DESIGNS              what cheap levels cost and know
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "bench/front_file.h"
#include "numerics/statistics.h"
#include "optim/algorithms/searchers.h"
#include "optim/pareto.h"
#include "optim/search.h"
#include "search/problem.h"
#include "search/task.h"

using namespace papilla::tests;

namespace {

struct Bench {
  std::string name;
  SearchProblem problem;
  std::function<Outcome(const Point&)> full, draft;  // of the unit cube
  double draft_cost = 0;                             // in full evaluations
  Point reference;
  double best = 0;   // hypervolume of the true front; 0: not known
  double until = 0;  // nothing is asked after this moment; 0: no limit
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
  while (count < evaluations && (bench.until <= 0 || seconds() < bench.until)) {
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

// A study at one accuracy: outcomes are kept, processor time is summed.
class Judge {
 public:
  Judge(const StudyProblem& problem, Fidelity fidelity) : problem_(problem), fidelity_(fidelity) {}

  Outcome operator()(const Point& u) {
    if (const auto it = known_.find(u); it != known_.end()) return it->second;
    const auto from = std::clock();
    std::vector<TaskAnswer> tasks;
    const Design design = problem_.space().design(u);
    for (std::size_t t = 0; t < problem_.tasks().size(); ++t)
      tasks.push_back(evaluate_task(problem_, design, t, {fidelity_}));
    seconds_ += static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
    ++count_;
    return known_[u] = guarded(problem_.outcome(problem_.score(design, tasks)),
                               problem_.objectives().size(), problem_.constraints().evaluated());
  }
  double seconds_each() const { return count_ ? seconds_ / count_ : 0; }
  const std::map<Point, Outcome>& known() const { return known_; }

 private:
  const StudyProblem& problem_;
  Fidelity fidelity_;
  std::map<Point, Outcome> known_;
  double seconds_ = 0;
  int count_ = 0;
};

Fidelity level(int grid, int skins, int first_skin = 0) {
  Fidelity f = fidelity_level("search");
  f.grid = grid;
  f.skins = skins;
  f.first_skin = first_skin;
  return f;
}

SearchProblem search_of(const StudyProblem& problem) {
  SearchProblem p;
  const DesignSpace& space = problem.space();
  p.space = space.cube();
  p.objectives = problem.objectives().size();
  p.constraints = problem.constraints().evaluated();
  p.cheap_constraints = [&problem](const Point& u) { return problem.constraints().geometry(u); };
  if (space.has_features()) p.features = [&space](const Point& u) { return space.features(u); };
  p.starts = space.starts();
  return p;
}

// Designs spread over the space that can be made.
std::vector<Point> spread_designs(const SearchProblem& p, std::size_t count, std::uint64_t seed) {
  std::vector<Point> out;
  for (std::uint64_t i = 0; out.size() < count; ++i) {
    const Point u = p.space.snapped(low_discrepancy(p.space.size(), seed, i));
    if (p.cheaply_feasible(u)) out.push_back(u);
  }
  return out;
}

// Rank correlation.
double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& v) {
    std::vector<double> out;
    for (double x : v)
      out.push_back(
          static_cast<double>(std::count_if(v.begin(), v.end(), [&](double y) { return y < x; })));
    return out;
  };
  const std::vector<double> ra = ranks(a), rb = ranks(b);
  const double n = static_cast<double>(a.size()), mean = (n - 1) / 2;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (ra[i] - mean) * (rb[i] - mean);
    aa += (ra[i] - mean) * (ra[i] - mean);
    bb += (rb[i] - mean) * (rb[i] - mean);
  }
  return ab / std::sqrt(aa * bb);
}

// What a cheap level knows of the full one: cost and rank correlation of each objective over
// designs spread over the space, all of them and the third nearest to the front alone.
void levels(const std::string& file, std::size_t designs) {
  Study study = read_study(file);
  Study alone = study;
  alone.population.resize(std::min<std::size_t>(1, alone.population.size()));
  const StudyProblem problem(study), one(alone);
  const SearchProblem p = search_of(problem);
  std::vector<Point> points = p.starts;
  for (const Point& u : spread_designs(p, designs, 1)) points.push_back(u);
  Judge full(problem, level(128, 12));
  std::vector<std::vector<double>> truth;
  for (const Point& u : points) truth.push_back(full(u).objectives);
  fmt::print("fingers,grid,skins,cost in full evaluations");
  for (const StudyObjective& o : problem.objectives())
    fmt::print(",rank correlation of {}", o.name);
  fmt::print("\n");
  const auto row = [&](const StudyProblem& fingers, int grid, int skins, int first) {
    Judge cheap(fingers, level(grid, skins, first));
    std::vector<std::vector<double>> values;
    for (const Point& u : points) values.push_back(cheap(u).objectives);
    fmt::print("{},{},{}{},{:.4f}", fingers.tasks().size(), grid, skins, first > 0 ? " others" : "",
               cheap.seconds_each() / full.seconds_each());
    for (std::size_t k = 0; k < p.objectives; ++k) {
      std::vector<double> a, b;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (truth[i].empty() || values[i].empty()) continue;
        a.push_back(truth[i][k]);
        b.push_back(values[i][k]);
      }
      fmt::print(",{:.3f}", spearman(a, b));
    }
    fmt::print("\n");
    std::fflush(stdout);
  };
  row(one, 64, 6, 0);
  row(problem, 64, 1, 0);
  row(problem, 64, 2, 0);
  row(problem, 64, 4, 0);
  row(problem, 64, 12, 0);
  row(problem, 128, 3, 0);
  row(problem, 128, 12, 1000);
}

// A tenth of the front's extent beyond its far ends.
Point beyond(const std::vector<std::vector<double>>& front) {
  Point out;
  for (std::size_t k = 0; k < front.at(0).size(); ++k) {
    const auto less = [k](const auto& a, const auto& b) { return a[k] < b[k]; };
    const auto [low, high] = std::minmax_element(front.begin(), front.end(), less);
    out.push_back((*high)[k] + 0.1 * ((*high)[k] - (*low)[k]));
  }
  return out;
}

// The front of the evaluations, as read_front() reads it.
void write_front(const std::string& path, const Study& study, const StudyProblem& problem,
                 const std::vector<Evaluation>& all) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (!out) throw InputError("cannot write " + path);
  for (const Variable& v : study.variables)
    fmt::print(out, "{}{},", v.path, v.unit.empty() ? "" : " [" + v.unit + "]");
  for (std::size_t k = 0; k < problem.objectives().size(); ++k)
    fmt::print(out, "{}{}", k ? "," : "", problem.objectives()[k].name);
  fmt::print(out, "\n");
  for (std::size_t i : pareto_front(all)) {
    const std::vector<double> values = problem.space().value(all[i].unit);
    for (std::size_t k = 0; k < values.size(); ++k)
      fmt::print(out, "{},", variable_text(study.variables[k], values[k], true));
    for (std::size_t k = 0; k < problem.objectives().size(); ++k)
      fmt::print(out, "{}{:.5g}", k ? "," : "",
                 (problem.objectives()[k].maximise ? -1 : 1) * all[i].outcome.objectives[k]);
    fmt::print(out, "\n");
  }
  std::fclose(out);
}

// A search of one level alone: that of the confirmation (GRID 0: the design level's; `skins` a
// finger) or a cheaper one (`skins` in all on GRID x GRID pixels). Its front after every `step`
// evaluations to PREFIX-N.csv, for share(); the processor time so far, the search's own included.
void single(const std::string& file, int evaluations, int step, int grid, int skins,
            const std::string& prefix, std::uint64_t seed) {
  const Study study = read_study(file);
  const StudyProblem problem(study);
  Fidelity alone = grid > 0 ? level(grid, skins) : fidelity_level("design");
  alone.skins = skins;
  alone.seed = seed;
  if (grid == 0) alone.first_skin = 1000;
  Judge judge(problem, alone);
  std::vector<Evaluation> all;
  Bench bench;
  bench.problem = search_of(problem);
  bench.reference.assign(bench.problem.objectives, 0);  // for the trace of this run, not read
  const auto from = std::clock();
  bench.full = [&](const Point& u) {
    all.push_back({u, judge(u)});
    const int n = static_cast<int>(all.size());
    if (n % step == 0) {
      write_front(fmt::format("{}-{}.csv", prefix, n), study, problem, all);
      fmt::print("{},{:.1f}\n", n, static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC);
      std::fflush(stdout);
    }
    return all.back().outcome;
  };
  run("bayesian", bench, seed, evaluations);
}

// Share of a reference front's hypervolume that searches of few evaluations reach, all at the same
// level, its pull corrected to the 3-D field of a skin. The reference: a sweep; refined: of half
// the evaluations, then NSGA-II from its front.
void fronts(bool refined, const std::string& file, int evaluations, int few, int grid, int skins,
            int seeds, double limit, const std::string& out) {
  const double begin = seconds();
  const Study study = read_study(file);
  const StudyProblem problem(study);
  SearchProblem p = search_of(problem);
  Fidelity corrected = level(grid, skins);
  corrected.field_skins = 1;  // over kinds and films the field rule alone misleads
  Judge judge(problem, corrected);
  std::vector<Evaluation> all;
  const auto evaluate = [&](const Point& u) {
    all.push_back({u, judge(u)});
    return all.back().outcome;
  };
  for (const Point& u : p.starts) evaluate(u);
  for (const Point& u :
       spread_designs(p, static_cast<std::size_t>(refined ? evaluations / 2 : evaluations), 7))
    if (seconds() < begin + (refined ? 0.5 : 1) * limit) evaluate(u);
  Bench bench;
  bench.until = begin + limit;
  bench.name = study.name;
  bench.problem = p;
  for (std::size_t i : pareto_front(all)) bench.problem.starts.push_back(all[i].unit);
  bench.full = evaluate;
  bench.reference.assign(p.objectives, 0);  // for the traces of this run, not read
  if (refined) run("nsga2", bench, 1, evaluations - evaluations / 2);
  const std::vector<std::size_t> front = pareto_front(all);
  std::vector<std::vector<double>> points;
  for (std::size_t i : front) points.push_back(all[i].outcome.objectives);
  bench.reference = beyond(points);
  const double best = hypervolume(points, bench.reference);
  fmt::print(stderr, "reference: {} evaluations, {} on the front, {:.3f} s each\n", all.size(),
             front.size(), judge.seconds_each());
  if (!out.empty()) write_front(out, study, problem, all);
  bench.until = 0;
  bench.problem.starts = p.starts;
  bench.full = [&](const Point& u) { return judge(u); };
  table(bench, {"sweep", "nsga2", "bayesian"}, few, seeds, best);
}

// Design level on skins that no search has seen.
Fidelity fresh_level() {
  Fidelity fresh = fidelity_level("design");
  fresh.first_skin = 100000;
  fresh.control_skins = 0;
  return fresh;
}

// Hypervolumes of fronts at design level on skins that no search has seen, over the first one's.
void shares(const std::string& file, const std::vector<std::string>& fronts, std::size_t most) {
  const Study study = read_study(file);
  const StudyProblem problem(study);
  Judge judge(problem, fresh_level());
  Point reference;
  double best = 0;
  std::vector<Evaluation> all;
  const auto row = [&](const std::string& name, const std::vector<Evaluation>& judged) {
    std::vector<std::vector<double>> points;
    for (std::size_t i : pareto_front(judged)) points.push_back(judged[i].outcome.objectives);
    if (reference.empty()) reference = beyond(points);
    const double volume = hypervolume(points, reference);
    if (best == 0) best = volume;
    fmt::print("{},{},{},{:.4g},{:.4f}\n", name, judged.size(), points.size(), volume,
               volume / best);
    std::fflush(stdout);
  };
  for (const std::string& path : fronts) {
    const std::vector<Point> designs = read_front(path, problem, most);
    std::vector<Evaluation> judged;
    for (const Point& u : designs) {
      judged.push_back({u, judge(u)});
      for (double v : problem.space().value(u)) fmt::print(stderr, "{:.4g} ", v);
      for (double v : judged.back().outcome.objectives) fmt::print(stderr, " {:.4f}", v);
      fmt::print(stderr, "{}\n", judged.back().outcome.feasible() ? "" : " infeasible");
    }
    row(path, judged);
    all.insert(all.end(), judged.begin(), judged.end());
  }
  row("all of them", all);
}

// What cheaper levels know of the designs of a front, at most `most` of them: their scatter about
// the best straight line to design level on fresh skins, with three sets of skins each.
void scatter(const std::string& file, const std::string& front, std::size_t most) {
  const Study study = read_study(file);
  const StudyProblem problem(study);
  const std::vector<Point> designs = read_front(front, problem, most);
  const auto objectives = [&](Judge& judge) {
    std::vector<std::vector<double>> out(problem.objectives().size());
    for (const Point& u : designs) {
      const Outcome o = judge(u);
      for (std::size_t k = 0; k < out.size(); ++k) out[k].push_back(o.objectives[k]);
    }
    return out;
  };
  Judge fresh(problem, fresh_level());
  const auto truth = objectives(fresh);
  fmt::print("grid,skins a finger,seed,processor s,objective,scatter,spread of the designs\n");
  for (const auto& [grid, skins] : {std::pair{64, 4}, {64, 8}, {64, 16}, {128, 4}, {128, 8}}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Fidelity f = level(grid, skins);
      f.seed = seed;
      Judge judge(problem, f);
      const auto seen = objectives(judge);
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const auto n = static_cast<double>(designs.size());
        const double mx = std::accumulate(seen[k].begin(), seen[k].end(), 0.0) / n;
        const double my = std::accumulate(truth[k].begin(), truth[k].end(), 0.0) / n;
        double xx = 0, xy = 0, yy = 0;
        for (std::size_t i = 0; i < designs.size(); ++i) {
          xx += square(seen[k][i] - mx);
          xy += (seen[k][i] - mx) * (truth[k][i] - my);
          yy += square(truth[k][i] - my);
        }
        fmt::print("{},{},{},{:.3f},{},{:.4f},{:.4f}\n", grid, skins, seed, judge.seconds_each(),
                   problem.objectives()[k].name, std::sqrt(std::max(0.0, yy - xy * xy / xx) / n),
                   std::sqrt(yy / n));
      }
      std::fflush(stdout);
    }
  }
}

// The product's study at search level; drafts at the level of its searches.
void product(const std::string& file, int evaluations, int seeds, int grid, int skins) {
  const Study study = read_study(file);
  const StudyProblem problem(study);
  Judge full(problem, level(128, 12)), draft(problem, level(grid, skins));
  Bench bench;
  bench.name = study.name;
  bench.problem = search_of(problem);
  bench.full = [&](const Point& u) { return full(u); };
  bench.draft = [&](const Point& u) { return draft(u); };
  const Point own = problem.space().unit_of_study();
  full(own);
  draft(own);
  bench.draft_cost = draft.seconds_each() / full.seconds_each();
  fmt::print(stderr, "a draft costs {:.4f} of a full evaluation\n", bench.draft_cost);
  bench.reference = {-0.3, 0.7};
  // Raw hypervolumes, put in relation by the reader.
  table(bench, {"bayesian", "bayesian + drafts 80"}, evaluations, seeds, 1);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> a(argv + 1, argv + argc);
  const auto number = [&](std::size_t i) { return std::atoi(a.at(i).c_str()); };
  const std::string what = a.empty() ? "analytic" : a[0];
  if (what == "levels") {
    levels(a.at(1), static_cast<std::size_t>(number(2)));
    return 0;
  }
  if (what == "share") {
    std::vector<std::string> fronts(a.begin() + 2, a.end());
    std::size_t most = 1000;
    if (fronts.size() > 2 && fronts[fronts.size() - 2] == "--") {
      most = static_cast<std::size_t>(number(a.size() - 1));
      fronts.resize(fronts.size() - 2);
    }
    fmt::print("front,judged,on the front,hypervolume,share of the first\n");
    shares(a.at(1), fronts, most);
    return 0;
  }
  if (what == "scatter") {
    scatter(a.at(1), a.at(2), static_cast<std::size_t>(number(3)));
    return 0;
  }
  if (what == "single") {
    fmt::print("evaluations,processor s\n");
    single(a.at(1), number(2), number(3), number(4), number(5), a.at(6),
           static_cast<std::uint64_t>(number(7)));
    return 0;
  }
  fmt::print("problem,method,full evaluations,hypervolume median,least,greatest,searcher s\n");
  if (what == "study") {
    product(a.at(1), number(2), number(3), number(4), number(5));
  } else if (what == "front" || what == "sweep") {
    fronts(what == "front", a.at(1), number(2), number(3), number(4), number(5), number(6),
           number(7), a.size() > 8 ? a[8] : "");
  } else {
    analytic();
  }
}
