// What every member of a belief says of a design: friction under conditions, worth under the
// design's own. Answers are kept in a file, so that nothing is evaluated twice.
#pragma once

#include <functional>
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

// A number of a design over belief. NaN where a member has no such state.
struct MemberNumbers {
  std::vector<double> at;  // [member]
  double own = 0;          // by the design's own finger at its own level
  Sampling sampling;       // of that
  // Deviations of `sampling` by the skins of the own level, which come first; as many of each
  // member's move follow, member by member.
  std::size_t own_skins = 0;
};
// Of numbers above 0: their logarithms.
MemberNumbers logarithms(const MemberNumbers& numbers);

// Of one experiment [N]; on of an undriven one: NaN.
struct MemberFriction {
  MemberNumbers off, on;
};

class MemberModel {
 public:
  // folder: where answers are kept; empty: they are not.
  MemberModel(Belief belief, const std::string& folder, int threads,
              std::function<void(const std::string&)> note = {});

  const Belief& belief() const { return belief_; }
  int evaluated() const { return evaluated_; }

  // An evaluation of each member. One humidity at a time, though several would share work: the
  // contact of a humidity starts from that of the one before, so an answer would depend, within
  // the tolerance of the contact, on what else was asked.
  MemberFriction friction(const LabDesign& design, const Conditions& at);
  // Of the design at its own drive and humidities, higher is better.
  MemberNumbers worth(const LabDesign& design, const MetricExpression& expression);

 private:
  std::vector<double> kept(const std::string& question, std::size_t size,
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
