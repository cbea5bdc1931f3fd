#include "optim/search.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "optim/algorithms/searchers.h"

namespace papilla::optim {
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

const std::vector<std::string>& searcher_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out{"auto"};
    for (const MethodKind& kind : method_kinds()) out.push_back(kind.name);
    return out;
  }();
  return names;
}

namespace {

const MethodKind& method_kind(const std::string& name) {
  for (const MethodKind& kind : method_kinds()) {
    if (kind.name == name) return kind;
  }
  throw InputError("unknown search method \"" + name + "\"; use one of " +
                   join_names(searcher_names()));
}

// A sum of as many squares as variables or more, smooth in all of them.
bool sum_of_squares(const SearchProblem& p) {
  return p.residuals >= p.space.size() && p.objectives == 1 && p.constraints == 0 &&
         std::all_of(p.space.dimensions.begin(), p.space.dimensions.end(),
                     [](const Dimension& d) { return d.choices.empty() && d.excluded.empty(); });
}

SearchMethod best_method(const SearchProblem& problem) {
  const std::size_t m = problem.objectives;
  if (sum_of_squares(problem))
    return {"least_squares", "a target at every humidity: Levenberg-Marquardt on the distances"};
  if (m <= 2 && problem.evaluations <= 400 && problem.space.size() <= 20) {
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

}  // namespace

SearchMethod choose_method(const std::string& name, const SearchProblem& problem) {
  if (name == "auto") return best_method(problem);
  const MethodKind& kind = method_kind(name);
  if (kind.of_squares && !sum_of_squares(problem)) {
    throw InputError(
        "search.method = \"" + name +
        "\" needs one target as the only objective, no choices, no constraint that needs an "
        "evaluation, and no more variables than targets; use \"auto\"");
  }
  const std::size_t m = problem.objectives;
  if (m > kind.most_objectives && kind.most_objectives == 1) {
    throw InputError("search.method = \"" + name + "\" has one objective; this study has " +
                     std::to_string(m) + ": use \"bayesian\" or \"nsga2\"");
  }
  if (m > kind.most_objectives) {
    throw InputError("search.method = \"" + name +
                     "\" handles one or two objectives; use \"nsga2\"");
  }
  if (m < kind.least_objectives) {
    throw InputError("search.method = \"" + name +
                     "\" needs two objectives; use \"bayesian\" or \"cmaes\"");
  }
  return {name, "asked for"};
}

void require_method(const SearchMethod& method) {
  if (const auto load = method_kind(method.name).load_libraries) load();
}

std::unique_ptr<Searcher> make_searcher(const SearchMethod& method, const SearchProblem& problem) {
  return problem.space.single_point() ? make_bayesian(problem)
                                      : method_kind(method.name).make(problem);
}

}  // namespace papilla::optim
