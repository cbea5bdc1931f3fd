// Which of several designs is better, and how sure that is: paired differences on common skins,
// with more skins only where the order is open. Equations ranking.N: docs/theory/ranking.md.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/design.h"
#include "metrics/metrics.h"

namespace papilla {

// One criterion: a metric over humidity and which direction is better.
struct Criterion {
  MetricExpression expression;
  bool high = false;

  std::string text() const;  // "mean(friction):low"
};
// "friction:low,adhesion:low"; a metric with a better direction of its own may stand alone.
// Throws InputError.
std::vector<Criterion> parse_criteria(const std::string& text);

struct Interval {
  double value = 0, low = 0, high = 0;  // 95 %
  // The part of the finger's fitted numbers in it, one standard error; nothing where not asked for.
  std::optional<double> parameters{};
};

struct RankedCandidate {
  std::size_t index = 0;  // into the designs as given
  int rank = 1;           // ties share the better rank
  bool tied_with_next = false;
  Interval score;                 // Eq. ranking.1; higher is better
  Interval behind_best;           // score difference to the first, <= 0 up to noise; 0 for itself
  Interval ahead_of_next;         // score difference to the next one; 0 for the last
  double p_best = 0;              // probability of the highest score, Eq. ranking.3
  double p_ahead = 0;             // probability of being ahead of the next one, Eq. ranking.4
  std::vector<Interval> metrics;  // one a criterion, in its unit
  int skins = 0;
};

struct StateRanking {
  FingerState state = FingerState::Clean;
  std::vector<RankedCandidate> candidates;  // best first
  int skins = 0;                            // solved
  int equal_skins = 0;  // what everyone as often as the neediest candidate would have taken
};

struct RankOptions {
  std::vector<Criterion> criteria;
  std::vector<FingerState> states;
  int batch = 6;       // skins a step
  int max_skins = 96;  // a candidate and state
  int threads = 0;
  bool parameters = false;      // also what the finger's fitted numbers leave open, Eq. ranking.5
  bool any_conditions = false;  // candidates under other conditions are compared all the same
  std::vector<std::string> names;  // of the candidates in messages; empty: their titles
  std::function<void(const std::string&)> note;  // progress for people; may be empty
};

// A key that is no part of a candidate but of what it is judged under, and that differs.
struct ConditionDifference {
  std::string key;                        // "finger.load"
  std::string first, value, other_value;  // name and value of the first candidate; of another
  std::string other;

  std::string text() const;  // "finger.load: 0.3 N in mine, 0.2 N in flat"
};

struct Ranking {
  std::vector<StateRanking> states;
  std::vector<ConditionDifference> conditions;  // empty unless any_conditions
  int skins = 0;                                // solved in all
  double seconds = 0;
  // Of the finger's parameters: independent directions, and what their steps were run with.
  int directions = 0, step_skins = 0, step_grid = 0;  // 0: not asked for
};

// A candidate: a design, or several regions of one that its skins take in turn.
using Regions = std::vector<Design>;
// What the criteria hang on besides texture, surface and dielectric: finger and air, model and
// accuracy where something is felt; the drive where a criterion needs one; the view where one is
// looked at. The finger's state is that of the options. Only the first difference in each key.
std::vector<ConditionDifference> condition_differences(const std::vector<Regions>& candidates,
                                                       const RankOptions& options);

// Throws InputError when the candidates are under other conditions (unless any_conditions), when a
// criterion is not defined for a design (modulation without a drive), and for parameters of fingers
// that have no `uncertainty` or not the same.
Ranking rank(const std::vector<Regions>& candidates, const RankOptions& options);
Ranking rank(const std::vector<Design>& designs, const RankOptions& options);

std::string ranking_table(const std::vector<std::string>& names, const RankOptions& options,
                          const Ranking& ranking);
std::string ranking_json(const std::vector<std::string>& names, const RankOptions& options,
                         const Ranking& ranking);
// Where `papilla rank --out` leaves a design of a candidate, from 0, in its folder.
std::string ranked_design_file(std::size_t candidate, std::size_t region);
// One polygon a candidate over the criteria, for a finger state; larger is better on every axis.
std::string radar_svg(const std::vector<std::string>& names, const RankOptions& options,
                      const StateRanking& state);

const std::vector<std::string>& finger_state_names();  // "clean", "natural", "wet"

}  // namespace papilla
