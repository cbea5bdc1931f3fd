// NSGA-II and CMA-ES of pagmo: the module papilla_evolution.so (optim/evolution.h).
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "optim/evolution.h"

namespace papilla::optim {
namespace {

// Probability and distribution indices of NSGA-II; first step of CMA-ES in the unit cube.
constexpr double kCrossover = 0.95, kCrossoverIndex = 10, kMutationIndex = 20;
constexpr double kCmaStep = 0.3;

// pagmo's view of a problem, of which it makes copies.
struct PagmoProblem {
  const EvolutionProblem* problem = nullptr;
  long* evaluations = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& u) const { return batch_fitness(u); }
  pagmo::vector_double batch_fitness(const pagmo::vector_double& all) const {
    *evaluations += static_cast<long>(all.size() / problem->variables);
    return problem->evaluate(all);
  }
  pagmo::vector_double::size_type get_nobj() const { return problem->objectives; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(problem->variables, 0.0),
            pagmo::vector_double(problem->variables, 1.0)};
  }
  pagmo::thread_safety get_thread_safety() const { return pagmo::thread_safety::none; }
};

pagmo::population first_population(const EvolutionProblem& problem, const pagmo::problem& p) {
  pagmo::vector_double all;
  for (const Point& u : problem.first) all.insert(all.end(), u.begin(), u.end());
  const pagmo::vector_double fitness = p.batch_fitness(all);
  pagmo::population population(p, 0, problem.seed);
  const auto objectives = static_cast<std::ptrdiff_t>(problem.objectives);
  auto f = fitness.begin();
  for (const Point& u : problem.first) {
    population.push_back(u, pagmo::vector_double(f, f + objectives));
    f += objectives;
  }
  return population;
}

class PagmoEvolution final : public Evolution {
 public:
  void nsga2(const EvolutionProblem& problem) const override {
    long evaluations = 0;
    const pagmo::problem p{PagmoProblem{&problem, &evaluations}};
    pagmo::population population = first_population(problem, p);
    const double mutation = 1.0 / static_cast<double>(problem.variables);
    for (unsigned generation = 0;; ++generation) {
      pagmo::nsga2 algorithm(1, kCrossover, kCrossoverIndex, mutation, kMutationIndex,
                             problem.seed + generation);
      algorithm.set_bfe(pagmo::bfe{pagmo::member_bfe{}});  // a generation is asked at once
      population = algorithm.evolve(population);
    }
  }

  void cmaes(const EvolutionProblem& problem, unsigned generations) const override {
    long evaluations = 0;
    const pagmo::problem p{PagmoProblem{&problem, &evaluations}};
    pagmo::population population = first_population(problem, p);
    for (unsigned restart = 0;; ++restart) {
      const long before = evaluations;
      pagmo::cmaes algorithm(generations, -1, -1, -1, -1, kCmaStep, 1e-7, 1e-9, false, true,
                             problem.seed + restart);
      population = algorithm.evolve(population);
      if (evaluations == before) return;  // converged at once: a flat or failing objective
    }
  }
};

}  // namespace
}  // namespace papilla::optim

extern "C" const papilla::optim::Evolution* papilla_evolution(int version) {
  static const papilla::optim::PagmoEvolution evolution;
  return version == papilla::optim::kEvolutionInterface ? &evolution : nullptr;
}
