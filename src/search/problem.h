// What a study wants, as numbers for a search: variables to a unit cube, fingers and scenarios to
// tasks, metrics over humidity to objectives and constraints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/describe.h"
#include "design/study.h"
#include "forward/fidelity.h"
#include "metrics/metrics.h"
#include "optim/problem.h"

namespace papilla {

// How a set of values becomes one number. Eq. search.4-6
struct Risk {
  enum class Kind { Mean, MeanStd, Cvar, Worst };
  Kind kind = Kind::Mean;
  double parameter = 0;  // k of mean - k std; share of the cvar
};
Risk parse_risk(const std::string& text);  // "" is the mean; throws InputError
// Weighted values to one, towards the bad side (low when higher is better).
double apply_risk(const Risk& risk, bool higher_is_better, const std::vector<double>& values,
                  const std::vector<double>& weights);

// One finger in one scenario, as designed or with one number at an end of its scatter: the unit of
// work.
struct StudyTask {
  std::string name;  // "reference", "moist, worn"
  double weight = 1;
  Finger finger;
  std::vector<Setting> settings;  // of the scenario
  int scattered = -1;             // which of the study's scatter; -1: as designed
  int sign = 0;                   // -1, +1: the end
};

// Eq. search.10: a quantity over independent scatter, uniform within the tolerances, from its
// nominal value and those with one number at the lower and upper end: values of equal weight that
// have the exact mean (Risk::Mean), mean and variance (MeanStd), the worst (Worst) or a
// low-discrepancy sample (Cvar) of the additive quadratic model through them.
std::vector<double> scattered_values(const Risk& risk, bool higher_is_better, double nominal,
                                     const std::vector<double>& lower,
                                     const std::vector<double>& upper);

struct StudyObjective {
  MetricExpression expression;
  bool maximise = true;
  std::string name;    // "mean(modulation)"
  bool aimed = false;  // the root mean square distance from `target`, Eq. search.11
  double target = 0;   // SI
};

// A design judged: objectives in the user's sign, over all tasks.
struct Score {
  bool ok = false;
  std::string reason;
  // One an objective; one standard error of what is the design's own: all but the parameters.
  std::vector<double> values, errors;
  // What a standard deviation of the fingers' fitted numbers does to each objective: directions are
  // the same for every design of a study. Empty where not known (of an objective: not defined at a
  // step); only of confirmed designs. Eq. accuracy.12
  std::vector<StepSamples> parameter_steps;
  // Behind the errors, one an objective; only of confirmed designs. Eq. accuracy.14
  std::vector<ErrorSamples> samples;
  std::vector<double> residuals;     // of targets: weighted distances, one a task and humidity
  double worst = 0;                  // lowest modulation over tasks and humidities; 0: undriven
  double oxide_margin = 0;           // smallest; infinite without a field
  std::optional<Optics> appearance;  // where the study asks for it
  std::vector<double> limited;       // the bad side over tasks of each constraint on a metric
  std::vector<std::string> reports;  // JSON of the response of each task as designed, where asked
};

// Standard error that the parameters leave of an objective, or of its difference from another
// design's; nothing where not known. Eq. accuracy.12
std::optional<double> parameter_error(const Score& score, std::size_t objective);
std::optional<double> parameter_error(const Score& score, const Score& other,
                                      std::size_t objective);

// Why drive.frequency changes nothing on this design; "" where it may.
std::string frequency_not_felt(const Design& design);

// Standard error of the difference of two designs in an objective: from their samples on common
// skins, droplets and grids (Eq. accuracy.14); the larger of both errors where those are not known.
double difference_error(const Score& score, const Score& other, std::size_t objective);

// By no objective is the design better than the other by more than the error of the difference.
bool no_better(const std::vector<StudyObjective>& objectives, const Score& design,
               const Score& other);

class StudyProblem {
 public:
  explicit StudyProblem(const Study& study);  // throws InputError for what cannot be judged
  StudyProblem(const StudyProblem&) = delete;
  StudyProblem& operator=(const StudyProblem&) = delete;

  const Space& space() const { return space_; }
  const std::vector<StudyTask>& tasks() const { return tasks_; }
  std::size_t nominal_tasks() const { return nominal_; }  // the first ones: as designed
  const std::vector<StudyObjective>& objectives() const { return objectives_; }
  const std::vector<double>& voltage_targets() const { return voltage_targets_; }
  // Why the parameters' part of confirmed designs is not known; "" when it is.
  std::string parameters_unknown() const;

  Design design(const Point& unit) const;
  std::vector<double> values(const Point& unit) const { return space_.value(unit); }
  Point unit_of_study() const;  // the study's own design
  std::vector<Point> starts() const;
  // The same surface without its texture, where the space holds that and the point has a texture.
  std::optional<Point> flattened(const Point& unit) const;

  // What the response hangs on more directly than on the variables: the open share of a lattice,
  // as a length over the period, where both lengths vary. For SearchProblem::features.
  bool has_features() const;
  std::vector<double> features(const Point& unit) const;

  // Fabrication limits, known without an evaluation: <= 0 feasible, relative to the limit; the
  // first is 1 for a shape that cannot exist. Reasons for people.
  std::vector<double> geometry(const Point& unit) const;  // of the shape alone: microseconds
  std::vector<double> look(const Point& unit) const;      // of its look: an optical calculation
  bool limits_look() const;
  std::string geometry_reason(const Point& unit) const;

  // One task of one design: numbers for score(), with the response as JSON where wanted. Runs the
  // forward model; this is what a worker does.
  Outcome evaluate_task(const Design& design, std::size_t task, const Fidelity& fidelity,
                        bool report) const;
  Outcome evaluate_task(const Point& unit, std::size_t task, const Fidelity& fidelity,
                        bool report) const {
    return evaluate_task(design(unit), task, fidelity, report);
  }
  Score score(const std::vector<Outcome>& tasks) const;

  // The steps of the parameters alone, for a task as designed whose finger has an `uncertainty`;
  // info for add_steps. With [accuracy] parameters a reported evaluate_task has them too.
  Outcome evaluate_steps(const Design& design, std::size_t task, const Fidelity& fidelity) const;
  // info of every task as designed.
  void add_steps(Score& score, const std::vector<std::vector<double>>& tasks) const;

  // The constraints that none of these designs keeps, for people: "min_wall (at least 5.5 um)".
  std::vector<std::string> never_kept(const std::vector<Evaluation>& tried) const;

  std::size_t constraints() const;            // that need an evaluation
  std::size_t residuals() const;              // of an outcome; 0: the objective is no target
  Outcome outcome(const Score& score) const;  // for the searcher: minimised
  bool feasible(const Score& score, const Point& unit) const;

  // Everything that decides the result, for the journal's key.
  std::string identity() const;

  bool needs_appearance() const;  // an objective or a constraint is about the look

 private:
  const Study& study_;
  Space space_;
  // The representative of all points that are the same design: numbers without effect on this kind
  // of texture, or at depth 0, take the study's own value.
  Point collapsed(const Point& unit) const;
  std::size_t task_numbers() const;  // of a task's info, before the steps of the parameters
  Fidelity steps_fidelity(Fidelity fidelity) const;
  std::vector<double> sample_numbers(const Response& response) const;
  // Which numbers of a task an objective is made of: a summary over humidity, or the quantity at
  // each where the objective or its risk takes those.
  bool by_points(std::size_t objective) const;
  std::vector<std::size_t> entries(std::size_t objective) const;
  // An objective from the numbers of all tasks. residuals: of targets are appended; or null.
  double combined(std::size_t objective, const std::vector<std::vector<double>>& numbers,
                  std::vector<double>* residuals) const;
  void add_samples(Score& score, const std::vector<std::vector<double>>& numbers,
                   std::vector<std::vector<double>>& rest) const;
  std::vector<double> step_numbers(const Response& response) const;
  // The design of a task.
  Design task_design(Design design, const StudyTask& task) const;
  std::string problem_of(const Design& design) const;
  // Flat by one variable alone; nothing where that is not possible, or is so already.
  std::optional<Point> flat_by(std::size_t variable, const Point& unit) const;
  bool acts(const std::vector<NumberField>& known, std::size_t variable) const;

  std::vector<StudyTask> tasks_;
  bool needs_evaluation(const Constraint& constraint) const;

  std::size_t nominal_ = 0;
  bool slow_look_ = false;  // the appearance of some kind of texture takes as long as an evaluation
  Point own_value_;         // of the study's own design
  std::vector<StudyObjective> objectives_;
  std::vector<StudyObjective> limited_;  // metrics of constraints, in their order
  std::vector<double> voltage_targets_;  // of voltage_for in either
  Risk risk_;
};

}  // namespace papilla
