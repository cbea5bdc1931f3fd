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

// Designs at the members of a belief. All meet the same members: what these do to all of them alike
// cancels.
struct MemberWorth {
  std::vector<double> weights;  // of the members; only their ratios count
  // [design][member], higher is better; NaN: the design has none there.
  std::vector<std::vector<double>> worth;
  std::vector<std::vector<std::vector<bool>>> kept;  // [design][limit][member]
  // [design][member][skin] What a standard error by each of the skins moves the worth by: designs
  // share skins, so that much of it is common to them. Empty: worth is known as well as it is said.
  std::vector<std::vector<std::vector<double>>> by_skin{};

  // Some design is worth something there.
  bool known(std::size_t member) const;
  // No limit is broken there, and the design is worth something if any is.
  bool keeps(std::size_t design, std::size_t member) const;
  // [skin] What each moves a design by on average over the members: the e_ik of Eq. lab.3.
  std::vector<double> moves_of_skins(std::size_t design) const;
};

// A worth and what each of the skins behind it moves it by.
struct SkinnedWorth {
  double worth = 0;
  std::vector<double> by_skin{};
};
// Designs at the members on few skins, at the level of `few`, become what they say beside
// `confirmed`, the same designs at the finer level as the finger is: the difference of the levels
// that all designs share is taken off in full, what it tells designs apart by as far as the skins
// move it and the member together. Eq. search.25
void combine_levels(const std::vector<SkinnedWorth>& confirmed,
                    const std::vector<SkinnedWorth>& few, bool in_proportion, MemberWorth& designs);
// A member moves all designs by one difference, or in proportion to `own`, what they are worth as
// the finger is; what it tells them apart by beyond that is shrunk by what it scatters from skin to
// skin. How far is not known, which is a skin more. Eq. search.23
void shrink_moves(const std::vector<SkinnedWorth>& own, bool in_proportion, MemberWorth& designs);

// Over the members at which some design is worth something, but the limits: these over all.
struct Prospect {
  double p_best = 0;              // Eq. search.15
  double regret = 0;              // expected, in the unit of the worth. Eq. search.16
  double merit = 0;               // what the risk makes of it: the highest is chosen. Eq. search.17
  std::vector<double> p_limit{};  // of each limit to be kept
  double p_limits = 1;            // of all of them together
};
std::vector<Prospect> prospects(const MemberWorth& designs, const BeliefRisk& risk);

// Of the design that would be chosen if skins left nothing open, on average over what they may
// turn out to say: what more of them can bring, and what they cannot. Eq. search.24
struct SettledSkins {
  double p_best = 0, regret = 0;
};
SettledSkins settled_skins(const MemberWorth& designs, const BeliefRisk& risk, double p_limits);

// What the best at each member, and draw of its skins, is worth on average over those that
// prospects are of.
double best_worth(const MemberWorth& designs);

// The share of belief at which some design is worth something.
double known_share(const MemberWorth& designs);

// The highest merit of those that keep every limit with this probability; where none does, of
// those that keep them with the highest; the first among equals.
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
  double loss = 0;       // expected there of what is chosen over all, less that of `best`
  double known = 0;      // of `weight`, that of the members that `loss` is the mean over
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
// Of the numbers of which a half of the members changes the choice, the one that loses most by it;
// nothing where none does. Eq. search.18
std::optional<HalvesReversal> by_half(const MemberWorth& designs, const BeliefRisk& risk,
                                      double p_limits, const std::vector<MemberNumber>& numbers);

}  // namespace papilla::search
