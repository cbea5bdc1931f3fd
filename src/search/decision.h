// Which finalist to build where the fingers name a belief: the designs of the front at each of its
// members, by the rule that picks the best. docs/theory/search.md
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "metrics/shown.h"
#include "search/pick.h"
#include "search/problem.h"
#include "search/prospects.h"

namespace papilla::search {

struct FinalDesign;

struct Decision {
  std::string absent;  // why there is none, for people; "": there is one
  PickRule rule;       // what a design is worth
  std::size_t members = 0;
  double effective_members = 0;
  // Of the designs of the front, in their order.
  std::vector<Prospect> designs;
  std::vector<std::vector<double>> p_best_by;  // [objective][design]
  std::vector<ObjectiveRange> ranges;          // of the objectives, for the knee
  std::size_t best = 0;                        // of them
  double best_worth = 0;                       // what the best at each member is worth, on average
  std::size_t nominal = 0;                     // the best by the numbers of the fit
  std::size_t by_knee = 0;                     // what the knee would choose over belief
  SettledSkins settled;                        // of what would be chosen then
  MemberWorth worth;                           // what all this was made of
  std::vector<Reversal> hypotheses;            // one each; empty where all members have the same
  std::optional<HalvesReversal> parameter;     // of the finger

  bool made() const { return absent.empty() && !designs.empty(); }
  // Whether a design keeps every limit as surely as the study wants it; whether the best does.
  bool keeps_limits(std::size_t design, double p_limits) const {
    return designs[design].p_limits >= p_limits - 1e-9;
  }
  bool sure(double p_limits) const { return keeps_limits(best, p_limits); }
};

// What a confirmed design has at the members of belief, and what the skins leave open of it: its
// numbers moved as the members move them on few skins. answers: evaluate_steps of each task as
// designed, each with its members. A score is not ok where a task has no answer there.
// Eq. accuracy.15
void add_members(const StudyProblem& problem, const std::vector<TaskAnswer>& answers,
                 FinalDesign& design);

// Whether no other of the finalists is better in every objective and, where designs are judged at
// the study's own amplitude, in the worst modulation by the confirmed numbers and by what it is
// worth at every member of belief at which one of both has an answer. A finalist without members
// stays where its confirmed numbers put it: nothing else is known of it.
std::vector<bool> on_front_of_belief(const StudyProblem& problem,
                                     const std::vector<FinalDesign>& finalists);

// What the designs are compared in: the rule that picks the best of the front; of one objective
// that alone, as its front without belief is one design. rule: of OptimiseOptions::pick; that of a
// number is the usual one. Eq. search.14
PickRule decision_rule(const StudyProblem& problem, const std::string& rule);

// What worths and regrets are shown in: the unit of a single objective, else none.
ShownUnit unit_of_worth(const StudyProblem& problem, const PickRule& rule);

// What designs are worth to a rule at each member. ranges: for the knee.
MemberWorth member_worth(const StudyProblem& problem, const std::vector<FinalDesign>& designs,
                         const PickRule& rule, const std::vector<ObjectiveRange>& ranges);

// As objective_ranges, of what designs differ by at the members: the mean over them. by_objective:
// member_worth of each. Eq. search.14
std::vector<ObjectiveRange> ranges_over_belief(const std::vector<PickCandidate>& front,
                                               const std::vector<MemberWorth>& by_objective);

// Of the designs of the front, which come first of the finalists. rule: of OptimiseOptions::pick.
Decision decide(const StudyProblem& problem, const std::vector<FinalDesign>& finalists,
                const std::string& rule);

// What a design is worth to the pick rule.
PickCandidate pick_candidate(const StudyProblem& problem, const Score& score);

}  // namespace papilla::search
