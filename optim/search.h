// Searchers: ask for points, tell their outcomes. Deterministic: the points depend on the seed and
// on the outcomes in the order they were asked, never on time or on the number of workers.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/problem.h"

namespace papilla::optim {

struct SearchProblem {
  Space space;
  std::size_t objectives = 1, constraints = 0;
  // So many Outcome::residuals, whose sum of squares grows with the one objective; 0: it is no sum
  // of squares.
  std::size_t residuals = 0;
  // Constraints known without an evaluation (<= 0 feasible, in the unit cube); may be empty.
  std::function<std::vector<double>(const Point&)> cheap_constraints;
  // The same for constraints that cost as much as a small evaluation: asked only of points that are
  // about to be chosen, a limited number of times.
  std::function<std::vector<double>(const Point&)> costly_constraints;
  // What the outcomes depend on more directly than on the coordinates, as further coordinates of
  // the models of "bayesian" (each about 0 to 1); may be empty.
  std::function<std::vector<double>(const Point&)> features;
  std::vector<Point> starts;  // points to try first (the user's design)
  int evaluations = 100;      // the budget that the searcher plans for
  // Cheap, biased evaluations of the same objectives and constraints that may be asked besides
  // (Searcher::asks_drafts): their largest number.
  int drafts = 0;
  // Drafts that are known already: "bayesian" asks no others, and starts from what it is told.
  std::vector<Evaluation> known_drafts;
  // Points that differ by less in every coordinate are one to "bayesian": where evaluations
  // scatter, nothing is learned from the same one again.
  double apart = 1e-6;
  std::uint64_t seed = 1;

  bool cheaply_feasible(const Point& unit) const;
  bool feasible_before_evaluation(const Point& unit) const;  // the costly constraints too
};

// The point as surrogate models see it: a choice of kinds becomes one coordinate per kind, so that
// any two kinds are equally far apart; the problem's features follow.
Point model_coordinates(const SearchProblem& problem, const Point& unit);

// A Gaussian process costs the cube of its evaluations: beyond these, only those that the fewest
// others dominate are modelled.
constexpr std::size_t kMostModelled = 300;

// The evaluations that deserve a surer one: each next adds most to the hypervolume, at most `count`
// and none that adds less than a hundredth. Eq. search.12 They are compared by what a Gaussian
// process through all feasible ones says of each: the luckiest of many like designs need not be the
// best. Without a feasible evaluation the one that violates least; empty when all failed. O(n^3), n
// at most kMostModelled.
std::vector<std::size_t> promising(const SearchProblem& problem,
                                   const std::vector<Evaluation>& evaluations, std::size_t count);

// The evaluations as a surer judgement of some of them says: those as they were judged, every
// constraint of the others as much worse as it was for a judged one at most. Eq. search.13
std::vector<Evaluation> tightened(std::vector<Evaluation> evaluations,
                                  const std::vector<Evaluation>& judged);

// Where a surer judgement of the promising ones kept none: the next to judge, the best of those
// that keep every constraint tightened so, and
// that are not beside one that failed. Nothing where none is left. Eq. search.13
std::optional<std::size_t> next_safer(const std::vector<Evaluation>& evaluations,
                                      const std::vector<Evaluation>& judged);

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

// Loads the libraries that a method stands on, for work that must not fail late. Throws
// std::runtime_error where one is missing.
void require_method(const SearchMethod& method);

std::unique_ptr<Searcher> make_searcher(const SearchMethod& method, const SearchProblem& problem);

// "auto" and the methods of the one list, optim/algorithms/methods.cpp.
const std::vector<std::string>& searcher_names();

}  // namespace papilla::optim
