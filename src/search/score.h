// A design judged from the answers of its tasks, and how two designs differ.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/objectives.h"
#include "search/protocol.h"

namespace papilla::search {

// A design judged: objectives in the user's sign, over all tasks.
struct Score {
  bool ok = false;
  std::string reason;  // when not ok: the first task without an answer, and why
  // One per objective; one standard error of what is the design's own: all but the parameters.
  // Values: the risk over tasks, scatter and humidities. Errors: the mean over tasks, which share
  // their skins; of confirmed designs from `samples` where a risk is over them.
  std::vector<double> values, errors;
  // What a standard deviation of the fingers' fitted numbers does to each objective: directions are
  // the same for every design of a study; the mean over tasks. Empty where not known (of an
  // objective: not defined at a step); only of confirmed designs. Eq. accuracy.12
  std::vector<StepSamples> parameter_steps;
  // Behind the errors, one per objective; only of confirmed designs. Eq. accuracy.14
  std::vector<ErrorSamples> samples;
  std::vector<double> residuals;  // of targets: weighted distances, one per task and humidity
  // Over tasks of some weight:
  double worst = 0;                    // the lowest modulation; 0: undriven
  double oxide_margin = 0;             // the smallest; infinite without a field
  std::optional<Look> look;            // that of the highest haze, where the study asks for it
  std::vector<double> limited;         // the bad side of each constraint on a metric
  std::vector<std::string> reports{};  // of each task as designed; empty where not confirmed
};

// What scores are made with, of a study.
struct Scoring {
  const StudyGoals& goals;
  const std::vector<StudyTask>& tasks;
  std::size_t nominal = 0;                      // the first tasks are as designed
  std::size_t scatter = 0;                      // numbers that scatter
  const std::vector<double>& humidity_weights;  // empty: all alike
};

// From one answer per task.
Score score_of(const Scoring& scoring, const std::vector<TaskAnswer>& answers);
// From the steps of every task as designed, where all have them. Fingers of one uncertainty move
// together, others on their own; all share their skins.
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
