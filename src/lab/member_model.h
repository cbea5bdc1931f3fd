// Evaluates a design at every member of a belief: its friction under given conditions, its worth at
// the design's own drive and humidities. Answers are kept in a file, so that nothing is evaluated
// twice.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "lab/ensemble.h"
#include "lab/experiment.h"
#include "metrics/metrics.h"
#include "optim/unfinished.h"
#include "scene/belief.h"

namespace papilla::lab {

// One number of a design at every member of a belief. NaN: the number does not exist at that
// member, for example because the gap is pulled in there.
struct MemberNumbers {
  std::vector<double> at;  // [member]
  double own = 0;          // with the design's own finger, at the design's own accuracy level
  Sampling sampling;       // what the skins leave open of `own` and of the moves of the members
  // How many entries of sampling.deviations, the first ones, are of the skins of the design's own
  // accuracy level. The entries of the skins that the members are run on follow, member by member,
  // the same number for each member.
  std::size_t own_skins = 0;
};
// Of numbers above 0: their logarithms.
MemberNumbers logarithms(const MemberNumbers& numbers);

// Friction of one experiment [N]. Without a voltage `on` has no meaning and is not used.
struct MemberFriction {
  MemberNumbers off, on;
};

class MemberModel {
 public:
  // folder: where answers are kept between runs; empty: nothing is kept. note: told of each
  // evaluation before it begins.
  MemberModel(Belief belief, const std::string& folder, int threads,
              std::function<void(const std::string&)> note = {});

  const Belief& belief() const { return belief_; }
  int evaluated() const { return evaluated_; }

  // Evaluates the design at every member, at one humidity. Several humidities in one call would
  // share work, but contact at a humidity starts from that at the one before, so an answer would
  // depend, within the tolerance of the contact, on what else was asked. which: prefix of the
  // progress note, as "3 of 12: ".
  MemberFriction friction(const LabDesign& design, const Conditions& at,
                          const std::string& which = "");
  // The answer of friction() if it is kept already; evaluates nothing.
  std::optional<MemberFriction> kept_friction(const LabDesign& design, const Conditions& at) const;
  // The worth of the design at its own drive and humidities: the value of the expression, negated
  // where lower is better, so that higher is always better.
  MemberNumbers worth(const LabDesign& design, const MetricExpression& expression,
                      const std::string& which = "");

 private:
  std::optional<std::vector<double>> kept(const std::string& question, std::size_t size) const;
  std::vector<double> kept_or_made(const std::string& question, std::size_t size,
                                   const std::function<std::vector<double>()>& make);

  Belief belief_;
  std::string belief_text_;
  Unfinished kept_;
  int threads_, evaluated_ = 0;
  std::function<void(const std::string&)> note_;
};

// The design under other conditions.
Design under_conditions(const Design& design, const Conditions& at);

}  // namespace papilla::lab
