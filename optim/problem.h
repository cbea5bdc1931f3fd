// An optimisation problem as numbers only: a box, objectives to minimise, constraints <= 0.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::optim {

using Point = std::vector<double>;

// The i-th point of a scrambled low-discrepancy sequence in the unit cube (generalised golden
// ratio).
Point low_discrepancy(std::size_t dimensions, std::uint64_t seed, std::uint64_t i);

// Values between two others; the ends do not belong to it.
struct Excluded {
  double from = 0, to = 0;

  bool holds(double value) const { return value > from && value < to; }
  bool operator==(const Excluded&) const = default;
};

// One variable: an interval, without what is excluded of it, or a list of choices (values in
// increasing order).
struct Dimension {
  double low = 0, high = 1;
  std::vector<double> choices;
  bool ordered = true;               // else the choices are kinds: none lies between two others
  std::vector<Excluded> excluded{};  // in increasing order, apart, within the interval

  double value(double unit) const;  // unit: in [0, 1]
  double unit(double value) const;  // of an excluded value: of the end that is nearer
};

// The unit cube is what searchers see; choices split their unit interval into equal cells,
// excluded values take none of it.
struct Space {
  std::vector<Dimension> dimensions;
  // Unit points that are the same thing to their representative; may be empty. Idempotent.
  std::function<Point(const Point&)> collapse;

  std::size_t size() const { return dimensions.size(); }
  Point value(const Point& unit) const;  // unit cube -> values; outside is clamped
  Point unit(const Point& value) const;
  Point snapped(const Point& unit) const;  // unit(value(unit)): the point that is really evaluated
  bool single_point() const;
};

struct Outcome {
  bool ok = false;
  std::string reason;               // when not ok: why, for people
  std::vector<double> objectives;   // minimised; finite when ok
  std::vector<double> constraints;  // <= 0 is feasible; finite when ok; kept of a refused point
  std::vector<double> residuals;    // of a sum of squares (SearchProblem::residuals)

  double violation() const;  // sum of positive constraints
  bool feasible() const { return ok && violation() <= 0; }
  bool operator==(const Outcome&) const = default;
};

struct Evaluation {
  Point unit;  // in the unit cube, snapped
  Outcome outcome;
};

// Checks what an evaluation returned: wrong counts, NaN or Inf become a failed outcome with a
// reason.
Outcome guarded(Outcome outcome, std::size_t objectives, std::size_t constraints);

}  // namespace papilla::optim
