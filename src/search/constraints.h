// The constraints of a study on a design: known before an evaluation, or with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/score.h"
#include "search/space.h"

namespace papilla::search {

// Violations are <= 0 where a constraint is kept, relative to its limit.
class StudyConstraints {
 public:
  StudyConstraints(const Study& study, const DesignSpace& space,
                   const std::vector<StudyTask>& tasks, const StudyGoals& goals);

  // Fabrication limits, known without an evaluation; the first is 1 for a shape that cannot exist.
  // Of the shape, and what is left of the film below it under the drive's amplitude: microseconds.
  std::vector<double> geometry(const Point& unit) const;
  std::vector<double> look(const Point& unit) const;  // of its look: an optical calculation
  bool limits_look() const;
  // Why the shape or its look is refused, for people; "" where it is not.
  std::string geometry_reason(const Point& unit) const;

  std::size_t evaluated() const;                             // how many need an evaluation
  std::vector<double> violations(const Score& score) const;  // of those

  // The constraints that none of these designs keeps, for people: "min_wall (at least 5.5 um)".
  std::vector<std::string> never_kept(const std::vector<Evaluation>& tried) const;

 private:
  bool needs_evaluation(const Constraint& constraint) const;
  // Where its violation stands in the constraints of a refused design; nothing: only an evaluation
  // knows it.
  std::optional<std::size_t> place_refused(const Constraint& constraint) const;
  const Constraint* film_limit() const;  // on the breakdown margin; null: none
  std::string refusal(const Design& design) const;
  // The breakdown margin as far as it is known before an evaluation, at the scenario that is worst;
  // infinite where the evaluation says it: a current source, a wish with a voltage of its own.
  double film_margin(const Design& design) const;

  const Study& study_;
  const DesignSpace& space_;
  const std::vector<StudyTask>& tasks_;
  const StudyGoals& goals_;
  bool slow_look_ = false;  // the appearance of some kind of texture takes as long as an evaluation
};

}  // namespace papilla::search
