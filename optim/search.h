// Searchers: ask for points, tell their outcomes. Deterministic: the points depend on the seed and
// on the outcomes in the order they were asked, never on time or on the number of workers.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "optim/problem.h"

namespace papilla {

struct SearchProblem {
  Space space;
  std::size_t objectives = 1, constraints = 0;
  // The first numbers of Outcome::info are so many residuals, whose sum of squares grows with the
  // one objective; 0: it is no sum of squares.
  std::size_t residuals = 0;
  // Constraints known without an evaluation (<= 0 feasible, in the unit cube); may be empty.
  std::function<std::vector<double>(const Point&)> cheap_constraints;
  std::vector<Point> starts;  // points to try first (the user's design)
  int evaluations = 100;      // the budget that the searcher plans for
  // Cheap, biased evaluations of the same objectives and constraints that may be asked besides
  // (Searcher::asks_drafts): their largest number.
  int drafts = 0;
  std::uint64_t seed = 1;

  bool cheaply_feasible(const Point& unit) const;
};

class Searcher {
 public:
  virtual ~Searcher() = default;
  // The next points, snapped; empty when the searcher has nothing more to try.
  virtual std::vector<Point> ask() = 0;
  // The last ask wants drafts, not full evaluations.
  virtual bool asks_drafts() const { return false; }
  // Outcomes of the last ask, in its order.
  virtual void tell(const std::vector<Evaluation>& evaluations) = 0;
};

struct SearchMethod {
  std::string name, why;
};
// "auto" resolved from the problem, with the reason; other names pass through after a check.
// Throws InputError for a method that cannot do the problem.
SearchMethod choose_method(const std::string& name, const SearchProblem& problem);

std::unique_ptr<Searcher> make_searcher(const SearchMethod& method, const SearchProblem& problem);

// Names that make_searcher knows, "auto" first.
std::vector<std::string> searcher_names();

}  // namespace papilla
