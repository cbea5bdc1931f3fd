// Which of several designs is better, and how sure that is: paired differences on common skins,
// with more skins only where the order is open. Equations ranking.N: docs/theory/ranking.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "rank/conditions.h"
#include "rank/options.h"
#include "rank/scores.h"

namespace papilla::rank {

// How two candidates compare over all criteria.
enum class Relation {
  Better,    // ahead in one criterion at least, behind in none, as far as intervals tell
  Worse,     // the other way round
  TradeOff,  // ahead in one, behind in another
  Equal,     // the same in every criterion on every skin that both have met
  Open,      // no difference is told from none
};

struct RankedCandidate {
  std::size_t index = 0;  // into the designs as given
  // 1 + how many are ahead of it beyond doubt: by the score, or without one by some criterion and
  // behind in none.
  int rank = 1;
  std::vector<Interval> metrics;  // one per criterion, in its unit
  std::vector<double> p_best_by;  // one per criterion: probability of the best value of all
  std::vector<Relation> over;     // of each design as given; Open for itself
  int skins = 0;                  // of what is looked at alone, arrangements seen
  std::string look_warning;       // how far its look can be trusted; "": it can, or there is none
  std::string trouble;            // what the model says against its numbers; "": nothing
  // Where there is one score:
  bool tied_with_next = false;
  Interval score;          // Eq. ranking.1; higher is better
  Interval behind_best;    // score difference to the first, <= 0 up to noise; 0 for itself
  Interval ahead_of_next;  // score difference to the next one; 0 for the last
  double p_best = 0;       // probability of the highest score, Eq. ranking.3
  double p_ahead = 0;      // probability of being ahead of the next one, Eq. ranking.4
};

// Two neighbours in the order by a criterion, or by the score.
struct CandidatePair {
  std::size_t first = 0, second = 0;  // into the designs as given
  std::size_t criterion = 0;          // 0 where there is one score
};

struct StateRanking {
  FingerState state = FingerState::Clean;
  // For people: "finger clean", the pin's name, or that nothing is felt.
  std::string touching;
  std::vector<RankedCandidate> candidates;  // best first
  // Their order is open although they met all skins; empty: the order is known, in every criterion.
  std::vector<CandidatePair> open;
  int skins = 0;        // solved, or arrangements seen
  int equal_skins = 0;  // what everyone as often as the neediest candidate would have taken
  std::vector<CandidatePair> equal{};  // no skin tells them apart, so that none were added for them
};

struct Ranking {
  std::vector<StateRanking> states;
  std::vector<std::string> titles;              // of the designs as given
  std::vector<std::string> scans;               // what was changed of each measured map
  std::vector<ConditionDifference> conditions;  // empty unless any_conditions
  std::vector<std::string> notes;               // what the order leaves out, for people
  int skins = 0;                                // solved in all
  std::optional<double> seconds;                // of the clock
  // Steps of the finger's parameters: independent directions, and what their steps were run with.
  int directions = 0, step_skins = 0, step_grid = 0;  // 0: not asked for
  int members = 0;                                    // of belief, in the place of directions
};

// Why what is not known of the finger (its belief, or without one its fitted numbers) is not
// stated, or not alike, for these candidates; "": it is.
std::string parameters_unknown(const std::vector<Regions>& candidates);

// Throws InputError when the candidates are under other conditions (unless any_conditions), when a
// criterion is not defined for a design (modulation without a drive), and for parameters of fingers
// that have no `uncertainty` or not the same. Cost: a batch of skins per candidate and state, and
// more of those whose order is open, to max_skins.
Ranking ranking_of(const std::vector<Regions>& candidates, const RankOptions& options);
Ranking ranking_of(const std::vector<Design>& designs, const RankOptions& options);

}  // namespace papilla::rank
