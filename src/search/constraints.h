// The constraints of a study on a design: known before an evaluation, or with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/limits.h"
#include "search/score.h"
#include "search/space.h"

namespace papilla::search {

// A limit of the study and what a design has of it.
struct LimitValue {
  Constraint limit;
  double value = 0;  // SI; infinite: there is no such thing on this design

  bool kept() const { return keeps(limit, value); }
};

// Limits that contradict each other.
struct Contradiction {
  std::string text;         // which, and what can be had of them
  bool flat_keeps = false;  // a surface without a texture keeps them: the search finds nothing else
};

// Violations are <= 0 where a constraint is kept, relative to its limit (design/limits.h).
class StudyConstraints {
 public:
  StudyConstraints(const Study& study, const DesignSpace& space,
                   const std::vector<StudyTask>& tasks, const StudyGoals& goals);

  // Fabrication limits, known without an evaluation; the first is 1 for a shape that cannot exist.
  // Of the shape, and what is left of the film below it under the drive's amplitude: microseconds.
  std::vector<double> geometry(const Point& unit) const { return geometry(space_.design(unit)); }
  std::vector<double> geometry(const Design& design) const;
  std::vector<double> look(const Point& unit) const { return look(space_.design(unit)); }
  std::vector<double> look(const Design& design) const;  // of its look: an optical calculation
  bool limits_look() const { return !look_.empty(); }
  // Why the shape or its look is refused, for people; "" where it is not.
  std::string geometry_reason(const Point& unit) const;
  // The limits that geometry() judges after its first number, in that order.
  std::vector<Constraint> judged_by_geometry() const;
  // The breakdown margin as far as it is known before an evaluation, at the scenario that is worst;
  // infinite where the evaluation says it: a current source, a wish with a voltage of its own.
  double film_margin(const Design& design) const;

  std::size_t evaluated() const { return evaluated_.size(); }  // how many need an evaluation
  std::vector<double> violations(const Score& score) const;    // of those
  std::vector<Constraint> judged_by_evaluation() const;        // those, in that order

  // Of each limit of the study, in its order. The score: of an evaluation that has not failed.
  std::vector<LimitValue> values(const Design& design, const Score& score) const;
  bool kept(const Design& design, const Score& score) const;

  // The constraints that none of these designs keeps, for people: "min_wall (at least 5.5 um)".
  std::vector<std::string> never_kept(const std::vector<Evaluation>& tried) const;

  // The limits of shape and film that no texture of the space keeps together; nothing where some
  // texture keeps them. Some thousand shapes.
  std::optional<Contradiction> contradiction() const;

 private:
  using Places = std::vector<std::size_t>;  // in the constraints of the study

  const Constraint& at(std::size_t place) const { return study_.constraints[place]; }
  std::vector<Constraint> listed(const Places& places) const;
  Places cheap() const;  // as geometry() judges them
  double cheap_value(std::size_t place, const Design& design) const;
  std::string refusal(const Design& design) const;

  const Study& study_;
  const DesignSpace& space_;
  const std::vector<StudyTask>& tasks_;
  const StudyGoals& goals_;
  // What is known when. The film's margin is judged twice: what is left of it under the drive's own
  // amplitude before an evaluation, the field in it with one. Looks of arrays cost a millisecond
  // and steer the search itself; of others they are known with the evaluation.
  Places shape_, film_, look_, evaluated_;
};

}  // namespace papilla::search
