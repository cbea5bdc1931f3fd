// Which of some designs to build where a model is believed in by weighted members: how probable
// each is the best, what is lost by it on average, how surely it keeps its limits, and what would
// overturn the choice. Eq. search.15-18
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/risk.h"

namespace papilla::search {

// How belief decides among designs: `risk.belief` of a study.
struct BeliefRisk {
  bool regret = true;  // by the least expected regret; else by `risk` of what designs are worth
  Risk risk{};
};
// "regret", or what parse_risk reads. Throws InputError.
BeliefRisk parse_belief_risk(const std::string& text);
std::string belief_risk_forms();  // for people: "regret" and the others

// Designs at the members of a belief. All meet the same members: what these do to all of them alike
// cancels.
struct MemberWorth {
  std::vector<double> weights;  // of the members; only their ratios count
  // [design][member], higher is better; NaN: the design has none there.
  std::vector<std::vector<double>> worth;
  std::vector<std::vector<std::vector<bool>>> kept;  // [design][limit][member]
  // [design][member][skin] Each skin's share of the sampling error of the worth; the squares add up
  // to its variance. Designs share their skins, so much of it is common to them. Empty: the worth
  // has no sampling error.
  std::vector<std::vector<std::vector<double>>> by_skin{};
  // [design][member][error] The same by what else is not known: a standard error of each.
  std::vector<std::vector<std::vector<double>>> by_error{};
  // Where members are draws of others: which each is a draw of. Draws of one share its limits, and
  // it counts once where members tell designs apart. Empty: each is its own.
  std::vector<std::size_t> draw_of{};

  // Some design is worth something there.
  bool known(std::size_t member) const;
  // No limit is broken there, and the design is worth something if any is.
  bool keeps(std::size_t design, std::size_t member) const;
  // What each skin, then each other error, moves a design by on average over the members: the e_ik
  // of Eq. lab.3.
  std::vector<double> mean_moves(std::size_t design) const;
};

// A worth and what each of the skins behind it moves it by.
struct WorthBySkin {
  double worth = 0;
  std::vector<double> by_skin{};
};
// Combines two levels of accuracy by a control variate. `designs` comes with the worths at the
// members on few skins. few: the worths on the same few skins for the finger as it is. confirmed:
// those at the finer level. The difference of the two levels that all designs share is corrected
// in full; what it changes between designs is corrected only as far as it varies from skin to skin
// together with the member's worth. in_proportion: levels and members scale the worth, else they
// shift it. Eq. search.25
void combine_levels(const std::vector<WorthBySkin>& confirmed, const std::vector<WorthBySkin>& few,
                    bool in_proportion, MemberWorth& designs);
// Shrinks the differences between designs that a member states, the more the more they scatter
// from skin to skin. own: the worths for the finger as it is. What a member does to all designs
// alike stays: one factor on `own` if in_proportion, else one shift. The uncertainty of the
// shrinkage is added to by_error. Eq. search.23
void shrink_moves(const std::vector<WorthBySkin>& own, bool in_proportion, MemberWorth& designs);
// Adds to by_error what few skins leave open of each design's correction to the 3-D field. moves: a
// standard error of it, of the confirmed worths; correlation: of these errors, [design][design].
// in_proportion: members scale it as they scale the worth. Eq. search.15
void add_field_moves(const std::vector<WorthBySkin>& confirmed, const std::vector<double>& moves,
                     const std::vector<std::vector<double>>& correlation, bool in_proportion,
                     MemberWorth& designs);

// One design over the belief. p_best, regret and merit are taken over the members at which any
// design has a worth, p_limit and p_limits over all members; p_best and regret over what skins
// leave open too, the merit of another risk than regret over the members alone.
struct Prospect {
  double p_best = 0;              // Eq. search.15
  double regret = 0;              // expected, in the unit of the worth. Eq. search.16
  double merit = 0;               // what the risk makes of it: the highest is chosen. Eq. search.17
  std::vector<double> p_limit{};  // of each limit to be kept
  double p_limits = 1;            // of all of them together
  double less_sure = 0;           // of less_sure()
};
std::vector<Prospect> prospects(const MemberWorth& designs, const BeliefRisk& risk);

// How far the probability of each design to keep every limit is below the highest of them, in
// standard errors of their difference over the members. weights: of the members; only their ratios
// count. keeps: [design][member]. Eq. search.17
std::vector<double> less_sure(const std::vector<double>& weights,
                              const std::vector<std::vector<bool>>& keeps);

// p_best and regret that would be left with infinitely many skins. Each draw of the sampling error
// is taken as the truth, the design that is chosen then is judged, and its numbers are averaged
// over the draws. What `Prospect` has beyond this, more skins can remove. Eq. search.24
struct SettledSkins {
  double p_best = 0, regret = 0;
};
SettledSkins settled_skins(const MemberWorth& designs, const BeliefRisk& risk, double p_limits);

// The worth of the best design at each member and draw of the skins, averaged over the members at
// which any design has a worth.
double best_worth(const MemberWorth& designs);

// The share of belief at which some design is worth something.
double known_share(const MemberWorth& designs);

// The highest merit of those that keep every limit with this probability; where none does, of
// those that the members do not tell from the surest; the first among equals.
std::size_t chosen(const std::vector<Prospect>& prospects, double p_limits);

// Members that share a choice of the model.
struct MemberGroup {
  std::string name;
  std::vector<std::size_t> members;
};
// A number that the members have unlike values of.
struct MemberNumber {
  std::string path;
  std::vector<double> values;  // one per member, SI
};

// What would be chosen if only some members were true.
struct Reversal {
  std::string name;
  double weight = 0;     // of these members, of all 1
  std::size_t best = 0;  // the design that is chosen then
  double loss = 0;       // regret there of the design chosen over all members, minus that of `best`
  double known = 0;      // the part of `weight` at which any design has a worth: `loss` is over it
};
// Each group by itself.
std::vector<Reversal> by_group(const MemberWorth& designs, const BeliefRisk& risk, double p_limits,
                               const std::vector<MemberGroup>& groups);

// The members on both sides of the weighted median of a number.
struct HalvesReversal {
  std::string path;
  double edge = 0;  // between the halves, SI
  Reversal low, high;
};
// Splits the members at the weighted median of each number. Among the numbers of which one half of
// the members by itself would choose another design, returns the one with the largest weighted loss
// of both halves; nothing if there is none. Eq. search.18
std::optional<HalvesReversal> by_half(const MemberWorth& designs, const BeliefRisk& risk,
                                      double p_limits, const std::vector<MemberNumber>& numbers);

}  // namespace papilla::search
