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

// What each number of a vector of violations is about, as the numbers travel through a search
// without it. Null: that the shape exists and can be judged at all.
using Judged = std::vector<const Constraint*>;

// Violations are <= 0 where a constraint is kept, relative to its limit (design/limits.h).
class StudyConstraints {
 public:
  StudyConstraints(const Study& study, const DesignSpace& space,
                   const std::vector<StudyTask>& tasks, const StudyGoals& goals);
  // Places of its lists are those of the study's own constraints.
  StudyConstraints(const StudyConstraints&) = delete;
  StudyConstraints& operator=(const StudyConstraints&) = delete;

  // Fabrication limits, known without an evaluation; the first is 1 for a shape that cannot exist.
  // Of the shape, and what is left of the film below it under the drive's amplitude: microseconds.
  std::vector<double> geometry(const Point& unit) const { return geometry(space_.design(unit)); }
  std::vector<double> geometry(const Design& design) const;
  const Judged& in_geometry() const { return geometry_; }
  // Of its look, in the scenario where it is worst: an optical calculation.
  std::vector<double> look(const Point& unit) const { return look(space_.design(unit)); }
  std::vector<double> look(const Design& design) const;
  const Judged& in_look() const { return look_; }
  // Of those that need an evaluation.
  std::vector<double> violations(const Score& score) const;
  // What these are of: of each limit that an evaluation judges.
  std::vector<LimitValue> evaluated(const Score& score) const;
  const Judged& in_evaluation() const { return evaluated_; }
  std::size_t evaluated() const { return evaluated_.size(); }
  // All that is known of a design without an evaluation: of the shape, then of the look.
  std::vector<double> before_evaluation(const Design& design) const;
  Judged in_before_evaluation() const;

  // What a viewer meets of a design: in each scenario that counts, the same look once.
  std::vector<Design> looked_at(const Design& design) const;
  std::vector<Look> looks(const Design& design) const;

  // Why the shape or its look is refused, for people; "" where it is not.
  std::string geometry_reason(const Point& unit) const {
    return geometry_reason(space_.design(unit));
  }
  std::string geometry_reason(const Design& design) const;
  // Whether the shape exists and can be judged.
  bool possible(const Design& design) const { return refusal(design).empty(); }
  // The breakdown margin as far as it is known before an evaluation, at the scenario that is worst;
  // infinite where the evaluation says it: a current source, a wish with a voltage of its own.
  double film_margin(const Design& design) const;

  // Of a limit that is not on the yield; the numbers: of an evaluation of the design.
  double value(const Constraint& limit, const Design& design, const LimitedNumbers& numbers) const;
  // Of each limit of the study, in its order; of the yield where it was asked for. The score: of an
  // evaluation that has not failed.
  std::vector<LimitValue> values(const Design& design, const Score& score) const;
  bool kept(const Design& design, const Score& score) const;

  // The constraints that none of these designs keeps, for people: "min_wall (at least 5.5 um)".
  std::vector<std::string> never_kept(const std::vector<Evaluation>& tried) const;

  // The limits of shape and film that no texture of the space keeps together; nothing where some
  // texture keeps them. Some thousand shapes.
  std::optional<Contradiction> contradiction() const;

 private:
  std::optional<double> value_before(const Constraint& limit, const Design& design) const;
  std::optional<double> value_with(const Constraint& limit, const LimitedNumbers& numbers) const;
  std::string refusal(const Design& design) const;

  const Study& study_;
  const DesignSpace& space_;
  const std::vector<StudyTask>& tasks_;
  const StudyGoals& goals_;
  // What is known when. The film's margin is judged twice: what is left of it under the drive's own
  // amplitude before an evaluation, the field in it with one. Looks of arrays cost a millisecond
  // and steer the search itself; of others they are known with the evaluation.
  Judged geometry_, look_, evaluated_;
};

}  // namespace papilla::search
