// A design judged from the answers of its tasks, and how two designs differ.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/objectives.h"
#include "search/protocol.h"

namespace papilla::search {

// What limits are about, of one task or the bad side of several.
struct LimitedNumbers {
  double oxide_margin = 0;             // infinite without a field
  std::vector<Look> looks;             // where the study asks for them: the worst counts
  std::vector<double> limited;         // of each constraint on a metric
  std::vector<double> limited_errors;  // one standard error of each
};

// Share of the plates that keep every limit. Eq. search.20
struct YieldShare {
  double share = 0,
         error = 0;  // one standard error: of the plates drawn and of the limited metrics
};

// A design judged: objectives in the user's sign, over all tasks.
struct Score {
  bool ok = false;
  std::string reason;  // when not ok: the first task without an answer, and why
  TaskStatus::Kind kind = TaskStatus::Kind::Ok;  // of that task
  // One per objective; one standard error of what is the design's own: all but the parameters.
  // Values: the risk over tasks, scatter and humidities. Errors: the mean over tasks, which share
  // their skins; of confirmed designs from `samples` where a risk is over them.
  std::vector<double> values, errors;
  std::vector<std::vector<double>> of_tasks;  // [objective][task as designed]
  // What a standard deviation of the fingers' fitted numbers does to each objective: directions are
  // the same for every design of a study; the mean over tasks. Empty where not known (of an
  // objective: not defined at a step); only of confirmed designs. Eq. accuracy.12
  std::vector<StepSamples> parameter_steps;
  // Behind the errors, one per objective; only of confirmed designs. Eq. accuracy.14
  std::vector<ErrorSamples> samples;
  std::vector<double> residuals;  // of targets: weighted distances, one per task and humidity
  // Over tasks; with a limit on the yield over those as designed:
  double worst = 0;                     // the lowest modulation of driven ones; 0: there is none
  double oxide_margin = 0;              // the smallest; infinite without a field
  std::vector<Look> looks;              // where the study asks for them: the worst counts
  std::vector<double> limited;          // the bad side of each constraint on a metric
  std::vector<LimitedNumbers> by_task;  // of every task, where numbers scatter
  std::optional<YieldShare> yield;      // where a limit is on it
  std::vector<std::string> reports{};   // of each task as designed; empty where not confirmed
};

// Sets the numbers of `out` that limits are about to the confirmed ones, moved as `there` moves
// `own`: answers of one task, or scores, at another level or of few skins. The look is the same at
// every level and stays. Eq. accuracy.15
void move_limits(const StudyGoals& goals, const TaskAnswer& confirmed, const TaskAnswer& own,
                 const TaskAnswer& there, TaskAnswer& out);
void move_limits(const StudyGoals& goals, const Score& confirmed, const Score& own,
                 const Score& there, Score& out);

// What scores are made with, of a study.
struct Scoring {
  const StudyGoals& goals;
  const std::vector<StudyTask>& tasks;
  std::size_t nominal = 0;                      // the first tasks are as designed
  ScatterLaw law{};                             // of the numbers that scatter
  const std::vector<double>& humidity_weights;  // empty: all alike
};

// The bad side of each number over the first tasks.
LimitedNumbers bad_side(const Scoring& scoring, const std::vector<LimitedNumbers>& of_tasks);

// From one answer per task; the yield is asked for besides.
Score score_of(const Scoring& scoring, const std::vector<TaskAnswer>& answers);
// From what every task as designed answers of finger and model, where all do: of the score of those
// tasks, in proportion where a number keeps its sign. Fingers of one uncertainty move together,
// others on their own; all share their skins. Eq. accuracy.12, accuracy.15
void add_steps(Score& score, const Scoring& scoring, const std::vector<TaskAnswer>& answers);

// Standard error that the parameters leave of an objective, or of its difference from another
// design's; nothing where not known. Eq. accuracy.12
std::optional<double> parameter_error(const Score& score, std::size_t objective);
std::optional<double> parameter_error(const Score& score, const Score& other,
                                      std::size_t objective);

// Standard error of the difference of two designs in an objective: from their samples on common
// skins, droplets and grids (Eq. accuracy.14); the larger of both errors where those are not known.
double difference_error(const Score& score, const Score& other, std::size_t objective);

// By no objective is the design better than the other by more than the error of the difference.
bool no_better(const std::vector<StudyObjective>& objectives, const Score& design,
               const Score& other);

}  // namespace papilla::search
