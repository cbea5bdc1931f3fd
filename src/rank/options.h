// What a ranking is asked for: candidates, criteria, finger states, cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "metrics/metrics.h"

namespace papilla::rank {

inline constexpr int kMostSkins = 100000;

// One criterion: a metric over humidity and which direction is better.
struct Criterion {
  MetricExpression expression;
  bool high = false;

  const MetricInfo& info() const;
  std::string text() const;  // "mean(friction):low"
};
// "friction:low,adhesion:low"; a metric with a better direction of its own may stand alone.
// Throws InputError.
std::vector<Criterion> parse_criteria(const std::string& text);

// A candidate: a design, or several regions of one that its skins take in turn.
using Regions = std::vector<Design>;

struct RankOptions {
  std::vector<Criterion> criteria;
  // What each criterion counts in the score; empty: no score but of one criterion alone. Several
  // criteria are then a trade-off: who is beaten in all that is known, and who is best in each.
  std::vector<double> weights;
  std::vector<FingerState> states;
  int batch = 6;       // skins per step
  int max_skins = 96;  // per candidate and state; a batch to kMostSkins
  int threads = 0;
  // Also what the finger's fitted numbers leave open, Eq. ranking.5; parameters_unknown() is then
  // "".
  bool parameters = false;
  bool any_conditions = false;     // candidates under other conditions are compared all the same
  std::vector<std::string> names;  // of the candidates in messages; empty: their titles
  std::function<void(const std::string&)> note;  // progress for people; may be empty

  // Whether a finger has to press for some criterion; a look needs none.
  bool felt() const;
  // Whether the finger's fitted numbers are moved: what no finger touches has none of them.
  bool moves_finger() const { return parameters && felt(); }
  bool scored() const { return criteria.size() == 1 || !weights.empty(); }
};

}  // namespace papilla::rank
