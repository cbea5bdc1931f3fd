// The algorithms behind make_searcher (internal to optim).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/search.h"

namespace papilla::optim {

using MakeSearcher = std::unique_ptr<Searcher>(const SearchProblem& problem);

// Gaussian process with expected improvement (one objective) or exact expected hypervolume
// improvement (two), constraints by probability of feasibility. Small budgets, noise welcome.
MakeSearcher make_bayesian;

// NSGA-II and CMA-ES of pagmo, constraints by a penalty in front of the objectives.
MakeSearcher make_nsga2, make_cmaes;

// NLopt, one objective.
MakeSearcher make_bobyqa, make_sbplx, make_direct;

// Levenberg-Marquardt on the residuals, from the user's point, then from others while asked on.
MakeSearcher make_least_squares;

// A search method as studies name it, and what it can do.
struct MethodKind {
  std::string name;
  std::size_t least_objectives = 1, most_objectives = 1;
  MakeSearcher* make = nullptr;
  bool of_squares = false;             // needs the residuals of a smooth sum of squares
  void (*load_libraries)() = nullptr;  // throws std::runtime_error where one is missing; null: none
};

// The one list of methods.
const std::vector<MethodKind>& method_kinds();

// A blocking optimiser as a searcher: `run` gets an objective function of a list of points that it
// may call in one thread; the call returns what tell() brought, or throws when the search ends.
using BlockingObjective = std::function<std::vector<Outcome>(const std::vector<Point>&)>;
std::unique_ptr<Searcher> make_blocking(std::function<void(const BlockingObjective&)> run);

// What an optimiser sees in place of outcomes: of feasible ones their objectives, of failed and
// infeasible ones a finite number that grows with the violation, the worst so far plus a margin.
// Never a huge constant: that would spoil quadratic models.
// Optimisers keep the numbers that they saw. Where the first outcomes are infeasible, no objective
// is known that a number could lie above; the share of the violation is then the number, from 0
// to 1, and feasible objectives are moved below 0, in their order, to the end of the search.
class Penalty {
 public:
  std::vector<double> finite(const Outcome& outcome, std::size_t objectives);

 private:
  std::vector<double> below_violations(const std::vector<double>& objectives) const;

  std::vector<double> worst_, best_;  // feasible
  std::vector<double> first_;         // the first feasible; empty: there is none yet
  std::vector<double> scale_;         // the largest size up to it, of infeasible ones too
  bool began_infeasible_ = false;
};

std::size_t nsga2_population(const SearchProblem& problem);
// The user's points, then spread ones that are cheaply feasible, as they are evaluated.
std::vector<Point> first_points(const SearchProblem& problem, std::size_t size);

}  // namespace papilla::optim
