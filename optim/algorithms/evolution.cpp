// NSGA-II and CMA-ES as searchers: points of the space, constraints by a penalty in front of the
// objectives.
#include "optim/evolution.h"

#include <algorithm>

#include "base/module.h"
#include "optim/algorithms/searchers.h"

namespace papilla::optim {
namespace {

constexpr std::size_t kCmaPoints = 12;  // of a generation

EvolutionProblem evolution_problem(const SearchProblem& problem, const BlockingObjective& objective,
                                   Penalty& penalty, std::size_t points) {
  EvolutionProblem out;
  out.variables = problem.space.size();
  out.objectives = problem.objectives;
  out.evaluate = [&](const std::vector<double>& all) {
    const auto n = static_cast<std::ptrdiff_t>(problem.space.size());
    std::vector<Point> asked;
    for (auto u = all.begin(); u != all.end(); u += n)
      asked.push_back(problem.space.snapped(Point(u, u + n)));
    std::vector<double> values;
    for (const Outcome& o : objective(asked)) {
      for (const double f : penalty.finite(o, problem.objectives)) values.push_back(f);
    }
    return values;
  };
  out.first = first_points(problem, points);
  out.seed = static_cast<unsigned>(problem.seed);
  return out;
}

}  // namespace

const Evolution& evolution() {
  static const auto* const loaded = static_cast<const Evolution*>(
      load_module("evolution", kEvolutionInterface, "search by NSGA-II or CMA-ES"));
  return *loaded;
}

std::size_t nsga2_population(const SearchProblem& problem) {
  return static_cast<std::size_t>(std::clamp(problem.evaluations / 12, 12, 100)) / 4 * 4;
}

std::vector<Point> first_points(const SearchProblem& problem, std::size_t size) {
  std::vector<Point> points;
  for (const Point& start : problem.starts) {
    if (points.size() < size) points.push_back(problem.space.snapped(start));
  }
  for (std::uint64_t i = 0; points.size() < size; ++i) {
    const Point u = problem.space.snapped(low_discrepancy(problem.space.size(), problem.seed, i));
    if (problem.cheaply_feasible(u) || i > 5000) points.push_back(u);
  }
  return points;
}

std::unique_ptr<Searcher> make_nsga2(const SearchProblem& problem) {
  return make_blocking([problem, &with = evolution()](const BlockingObjective& objective) {
    Penalty penalty;
    with.nsga2(evolution_problem(problem, objective, penalty, nsga2_population(problem)));
  });
}

std::unique_ptr<Searcher> make_cmaes(const SearchProblem& problem) {
  return make_blocking([problem, &with = evolution()](const BlockingObjective& objective) {
    Penalty penalty;
    with.cmaes(evolution_problem(problem, objective, penalty, kCmaPoints),
               static_cast<unsigned>(std::max(1, problem.evaluations / 12)));
  });
}

}  // namespace papilla::optim
