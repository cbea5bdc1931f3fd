// Evolutions of populations behind an interface (internal to optim): pagmo's, in the module
// papilla_evolution.so (optim/modules/pagmo.cpp), which is loaded by the first search that evolves.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/rooms.h"
#include "optim/problem.h"

namespace papilla::optim {

// Over the unit cube, without constraints.
struct EvolutionProblem {
  std::size_t variables = 1, objectives = 1;
  // Objectives of points, both one after another. An exception of it ends the evolution.
  std::function<std::vector<double>(const std::vector<double>& points)> evaluate;
  std::vector<Point> first;  // the first generation
  unsigned seed = 1;
};

class Evolution {
 public:
  virtual ~Evolution() = default;
  // NSGA-II (Deb et al. 2002), generation after generation until `evaluate` throws.
  virtual void nsga2(const EvolutionProblem& problem) const = 0;
  // CMA-ES of one objective with restarts of so many generations; returns when a restart has
  // nothing left to try.
  virtual void cmaes(const EvolutionProblem& problem, unsigned generations) const = 0;
};

// Version of the classes above: the module of another build is refused.
constexpr int kEvolutionInterface = 1;

// Loads the module on the first call. Throws std::runtime_error where it does not load.
const Evolution& evolution();

}  // namespace papilla::optim
