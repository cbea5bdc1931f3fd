// NSGA-II and CMA-ES of pagmo; permissive builds have evolution_own.cpp in its place.
#include <algorithm>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "optim/algorithms/searchers.h"

namespace papilla::optim {
namespace {

// pagmo's view: unit cube, objectives with the penalty folded in (its NSGA-II takes no
// constraints).
struct PagmoProblem {
  const SearchProblem* problem = nullptr;
  const BlockingObjective* objective = nullptr;
  Penalty* penalty = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& u) const { return batch_fitness(u); }
  pagmo::vector_double batch_fitness(const pagmo::vector_double& all) const {
    const auto n = static_cast<std::ptrdiff_t>(problem->space.size());
    std::vector<Point> points;
    for (auto u = all.begin(); u != all.end(); u += n)
      points.push_back(problem->space.snapped(Point(u, u + n)));
    pagmo::vector_double out;
    for (const Outcome& o : (*objective)(points)) {
      for (double f : penalty->finite(o, problem->objectives)) out.push_back(f);
    }
    return out;
  }
  pagmo::vector_double::size_type get_nobj() const { return problem->objectives; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(problem->space.size(), 0.0),
            pagmo::vector_double(problem->space.size(), 1.0)};
  }
  pagmo::thread_safety get_thread_safety() const { return pagmo::thread_safety::none; }
};

pagmo::population first_population(const SearchProblem& problem, const pagmo::problem& p,
                                   std::size_t size) {
  const std::vector<Point> points = first_points(problem, size);
  pagmo::vector_double all;
  for (const Point& u : points) all.insert(all.end(), u.begin(), u.end());
  const pagmo::vector_double fitness = p.batch_fitness(all);
  pagmo::population population(p, 0, static_cast<unsigned>(problem.seed));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto f = fitness.begin() + static_cast<std::ptrdiff_t>(i * problem.objectives);
    population.push_back(
        points[i], pagmo::vector_double(f, f + static_cast<std::ptrdiff_t>(problem.objectives)));
  }
  return population;
}

}  // namespace

std::unique_ptr<Searcher> make_nsga2(const SearchProblem& problem) {
  return make_blocking([problem](const BlockingObjective& objective) {
    Penalty penalty;
    const pagmo::problem p{PagmoProblem{&problem, &objective, &penalty}};
    pagmo::population population = first_population(problem, p, nsga2_population(problem));
    const double mutation = 1.0 / static_cast<double>(problem.space.size());
    unsigned generation = 0;
    while (true) {
      pagmo::nsga2 algorithm(1, kCrossover, kCrossoverIndex, mutation, kMutationIndex,
                             static_cast<unsigned>(problem.seed) + generation++);
      algorithm.set_bfe(pagmo::bfe{pagmo::member_bfe{}});  // a generation is asked at once
      population = algorithm.evolve(population);
    }
  });
}

std::unique_ptr<Searcher> make_cmaes(const SearchProblem& problem) {
  return make_blocking([problem](const BlockingObjective& objective) {
    Penalty penalty;
    long calls = 0;
    const BlockingObjective counted = [&](const std::vector<Point>& points) {
      calls += static_cast<long>(points.size());
      return objective(points);
    };
    const pagmo::problem p{PagmoProblem{&problem, &counted, &penalty}};
    pagmo::population population = first_population(problem, p, kCmaPoints);
    for (unsigned restart = 0;; ++restart) {
      const long before = calls;
      pagmo::cmaes algorithm(static_cast<unsigned>(std::max(1, problem.evaluations / 12)), -1, -1,
                             -1, -1, kCmaStep, 1e-7, 1e-9, false, true,
                             static_cast<unsigned>(problem.seed) + restart);
      population = algorithm.evolve(population);
      if (calls == before) return;  // converged at once: a flat or failing objective
    }
  });
}

}  // namespace papilla::optim
