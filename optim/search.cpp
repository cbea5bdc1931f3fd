#include "optim/search.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "optim/algorithms/searchers.h"

namespace papilla {

namespace {

bool kept(const std::function<std::vector<double>(const Point&)>& constraints, const Point& unit) {
  if (!constraints) return true;
  const std::vector<double> c = constraints(unit);
  return std::all_of(c.begin(), c.end(), [](double v) { return v <= 0; });
}

}  // namespace

bool SearchProblem::cheaply_feasible(const Point& unit) const {
  return kept(cheap_constraints, unit);
}

bool SearchProblem::feasible_before_evaluation(const Point& unit) const {
  return cheaply_feasible(unit) && kept(costly_constraints, unit);
}

std::vector<std::string> searcher_names() {
  return {"auto", "bayesian", "nsga2", "cmaes", "bobyqa", "sbplx", "direct", "least_squares"};
}

SearchMethod choose_method(const std::string& name, const SearchProblem& problem) {
  const std::size_t n = problem.space.size(), m = problem.objectives;
  const bool smooth = problem.residuals >= n && m == 1 && problem.constraints == 0 &&
                      std::all_of(problem.space.dimensions.begin(), problem.space.dimensions.end(),
                                  [](const Dimension& d) { return d.choices.empty(); });
  if (name == "auto" && smooth)
    return {"least_squares", "a target at every humidity: Levenberg-Marquardt on the distances"};
  if (name == "least_squares" && !smooth)
    throw InputError(
        "search.method = \"least_squares\" needs one target as the only objective, no choices, no "
        "constraint that needs an evaluation, and no more variables than targets; use \"auto\"");
  if (name == "auto") {
    if (m <= 2 && problem.evaluations <= 400 && n <= 20) {
      return {"bayesian",
              m == 2 ? "two objectives and few, noisy evaluations: Gaussian process with expected "
                       "hypervolume improvement"
                     : "few, noisy evaluations: Gaussian process with expected improvement"};
    }
    if (m >= 2) return {"nsga2", "a large budget for several objectives: NSGA-II"};
    return {
        "cmaes",
        "a large budget for one noisy objective: CMA-ES, the local method that noise hurts least"};
  }
  const auto names = searcher_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw InputError("unknown search method \"" + name + "\"; use one of " + join_names(names));
  }
  if (m > 1 && name != "nsga2" && name != "bayesian") {
    throw InputError("search.method = \"" + name + "\" has one objective; this study has " +
                     std::to_string(m) + ": use \"bayesian\" or \"nsga2\"");
  }
  if (m > 2 && name == "bayesian")
    throw InputError("search.method = \"bayesian\" handles one or two objectives; use \"nsga2\"");
  if (m == 1 && name == "nsga2")
    throw InputError(
        "search.method = \"nsga2\" needs two objectives; use \"bayesian\" or \"cmaes\"");
  return {name, "asked for"};
}

std::unique_ptr<Searcher> make_searcher(const SearchMethod& method, const SearchProblem& problem) {
  if (method.name == "bayesian" || problem.space.single_point()) return make_bayesian(problem);
  if (method.name == "nsga2") return make_nsga2(problem);
  if (method.name == "cmaes") return make_cmaes(problem);
  if (method.name == "least_squares") return make_least_squares(problem);
  return make_nlopt(method.name, problem);
}

}  // namespace papilla
