// Pareto fronts with constraints, feasibility first, and exact hypervolume.
#pragma once

#include <vector>

#include "optim/problem.h"

namespace papilla {

// a is nowhere worse and somewhere better (minimisation).
bool dominates(const std::vector<double>& a, const std::vector<double>& b);

// Indices of the non-dominated feasible evaluations, by first objective; when none is feasible, the
// single least-violating one, of those that were evaluated where any was; empty when every
// evaluation failed. Equal outcomes: the earliest.
std::vector<std::size_t> pareto_front(const std::vector<Evaluation>& evaluations);

// Indices of feasible evaluations in their order, at most `most`: those that the fewest others
// dominate.
std::vector<std::size_t> least_dominated(const std::vector<Evaluation>& evaluations,
                                         std::size_t most);

// Hypervolume between the points and a reference point, exact, 1 to 3 objectives (minimisation).
// Points beyond the reference count nothing.
double hypervolume(std::vector<std::vector<double>> points, const std::vector<double>& reference);

// After each evaluation the hypervolume of the feasible ones so far to the worst values of all of
// them, as a share of the box from there to the best. At most three objectives.
std::vector<double> hypervolume_shares(const std::vector<Evaluation>& evaluations);

// Crowding-like choice of `count` points spread along the front: the ends first, then the largest
// gaps, until every other point is nearer than `nearest` (of the extent) to a chosen one.
std::vector<std::size_t> spread_points(const std::vector<std::vector<double>>& points,
                                       std::size_t count, double nearest = 0);

}  // namespace papilla
