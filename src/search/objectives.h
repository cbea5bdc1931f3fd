// What a study wants: its objectives and the metrics that its constraints limit.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/limits.h"
#include "metrics/metrics.h"
#include "search/risk.h"
#include "search/tasks.h"

namespace papilla::search {

struct StudyObjective {
  MetricExpression expression;
  bool maximise = true;
  std::string name;    // "mean(modulation)"
  bool aimed = false;  // the root mean square distance from `target`, Eq. search.11
  double target = 0;   // SI
};

// What it may lose before that counts: 5 % of a value, in the user's sign or minimised (of a
// distance from a target: 5 % of the larger of it and the target), and what its instruments
// resolve, in quadrature: of a sparkle of nothing 5 % are no loss. Eq. search.9
double tolerated_loss(const StudyObjective& objective, double value);

struct StudyGoals {
  std::vector<StudyObjective> objectives;
  std::vector<StudyObjective> limited;  // metrics of constraints, in their order
  std::vector<double> voltage_targets;  // of voltage_for in either
  // What an objective or a limit is about depends on the study's own amplitude: not voltage_for,
  // which has its own. The dielectric has to hold what counts.
  bool own_amplitude = false;
  Risk risk;
  bool looks = false;    // an objective or a constraint is about the look
  bool pull_in = false;  // or about pull-in
  bool felt = false;     // or about who feels it, which takes the errors of the modulation
  bool pen = false;      // or about the pen, which is then evaluated beside the finger
  bool areas = false;  // or about contact areas and what goes with them, of which pixels miss much
  // A limit is on the yield: the others are then asked of the design as drawn.
  bool yield = false;
  bool film = false;  // a limit is on what the dielectric holds: none that breaks down keeps it

  // The objective is made of its quantity at each humidity, not of a summary over them: its aim or
  // its risk takes those.
  bool by_points(std::size_t objective) const;
  // Where a limited metric stands in `limited`, and its values in scores and answers.
  std::size_t place_of(const MetricLimit& limit) const;
};

// Throws InputError for what cannot be judged.
StudyGoals study_goals(const Study& study, const std::vector<StudyTask>& tasks);

}  // namespace papilla::search
