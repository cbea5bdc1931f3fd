// The algorithms behind make_searcher (internal to optim).
#pragma once

#include <memory>

#include "optim/search.h"

namespace papilla {

// Gaussian process with expected improvement (one objective) or exact expected hypervolume
// improvement (two), constraints by probability of feasibility. Small budgets, noise welcome.
std::unique_ptr<Searcher> make_bayesian(const SearchProblem& problem);

// NSGA-II (pagmo), constraints by a penalty in front of the objectives.
std::unique_ptr<Searcher> make_nsga2(const SearchProblem& problem);
std::unique_ptr<Searcher> make_cmaes(const SearchProblem& problem);

// Levenberg-Marquardt on the residuals, from the user's point, then from others while asked on.
std::unique_ptr<Searcher> make_least_squares(const SearchProblem& problem);

// NLopt: "bobyqa", "sbplx", "direct"; one objective.
std::unique_ptr<Searcher> make_nlopt(const std::string& name, const SearchProblem& problem);

// A blocking optimiser as a searcher: `run` gets an objective function of a list of points that it
// may call in one thread; the call returns what tell() brought, or throws when the search ends.
using BlockingObjective = std::function<std::vector<Outcome>(const std::vector<Point>&)>;
std::unique_ptr<Searcher> make_blocking(std::function<void(const BlockingObjective&)> run);

// A finite stand-in for failed and infeasible outcomes: the worst so far plus a margin that grows
// with the violation. Never a huge constant: that would spoil quadratic models.
class Penalty {
 public:
  std::vector<double> finite(const Outcome& outcome, std::size_t objectives);

 private:
  std::vector<double> worst_, best_;
};

}  // namespace papilla
