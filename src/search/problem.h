// What a study wants, as numbers for a search: its space, tasks, goals and constraints, and scores
// of designs as outcomes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/search.h"
#include "scene/belief.h"
#include "search/constraints.h"
#include "search/objectives.h"
#include "search/prospects.h"
#include "search/score.h"
#include "search/space.h"
#include "search/tasks.h"
#include "search/yield.h"

namespace papilla::search {

class StudyProblem {
 public:
  explicit StudyProblem(const Study& study);  // throws InputError for what cannot be judged
  StudyProblem(const StudyProblem&) = delete;
  StudyProblem& operator=(const StudyProblem&) = delete;

  const Study& study() const { return study_; }
  const DesignSpace& space() const { return space_; }
  const std::vector<StudyTask>& tasks() const { return tasks_; }
  std::size_t nominal_tasks() const { return scoring_.nominal; }  // the first ones: as designed
  const StudyGoals& goals() const { return goals_; }
  const std::vector<StudyObjective>& objectives() const { return goals_.objectives; }
  const StudyConstraints& constraints() const { return constraints_; }
  // Somewhere a drive is applied or searched: designs have a modulation there.
  bool driven() const;
  // And what is asked of them is asked at the study's own amplitude, where their worst modulation
  // is: voltage_for alone has amplitudes of its own.
  bool judged_at_amplitude() const { return driven() && goals_.own_amplitude; }
  // Of the designs that keep the limits on shapes: the smallest feature [m] that a search meets,
  // from a thousand of them; infinite where they have none.
  double smallest_feature() const { return smallest_feature_; }
  // Why the parameters' part of confirmed designs is not known; "" when it is.
  std::string parameters_unknown() const;
  // "belief about finger and model", or "the fit of the finger": whose that part is.
  std::string model_source() const;
  bool has_belief() const;  // all fingers name one
  // Its members are common to all tasks; none: belief_absent says why.
  const std::optional<Belief>& belief() const { return belief_; }
  std::string belief_absent() const;  // for people; "": there is one
  const BeliefRisk& belief_risk() const { return belief_risk_; }

  // From one answer per task, of this design; with its yield where a limit is on that.
  Score score(const Design& design, const std::vector<TaskAnswer>& answers) const;
  // Of which nobody asks whether it keeps the limits: yields draw thousands of plates.
  Score score_without_yield(const std::vector<TaskAnswer>& answers) const {
    return score_of(scoring_, answers);
  }
  // Where numbers scatter and a limit may be broken by it; of a score that is ok.
  std::optional<Yield> yield(const Design& design, const Score& score) const;
  void add_steps(Score& score, const std::vector<TaskAnswer>& answers) const {
    search::add_steps(score, scoring_, answers);
  }

  std::size_t residuals() const;              // of an outcome; 0: the objective is no target
  Outcome outcome(const Score& score) const;  // for the searcher: minimised
  std::vector<double> minimised(const Score& score) const;  // its objectives, of one that is ok
  bool feasible(const Score& score, const Design& design) const;

  // Everything that decides the result, for the journal's key.
  std::string identity() const;

 private:
  const Study& study_;
  DesignSpace space_;
  std::vector<StudyTask> tasks_;
  StudyGoals goals_;
  StudyConstraints constraints_;
  Scoring scoring_;
  BeliefRisk belief_risk_;
  std::optional<Belief> belief_;
  double smallest_feature_;
};

// What a search leaves aside, for people: textures, where only a flat surface keeps the limits on
// shape and film; belief, where the fingers have none in common. Throws InputError where no design
// of the space keeps those limits, and where [risk] says how a belief decides that is not there.
std::vector<std::string> study_warnings(const StudyProblem& problem);

// Throws InputError where a finger of the study was fitted with other model options than those that
// it is searched with (estimate/evaluation.h). way_out: "run with --force".
void require_fitted_fingers(const StudyProblem& problem, const std::string& file,
                            const std::string& way_out);

// Evaluations that a study gets when nothing else is said.
int default_evaluations(const Study& study);

// As its searcher sees it. Refers to the problem.
SearchProblem search_problem(const StudyProblem& problem);

}  // namespace papilla::search
