#include "claims/members.h"

#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::claims {

Finger member_finger(const Belief& belief, const BeliefMember& member, const Finger& finger) {
  MemberScene at = with_member(belief, member, finger, finger.calibrated_for);
  at.finger.calibrated_for = at.model;
  return std::move(at.finger);
}

double deviation_over(const Belief& belief, std::span<const double> values) {
  double mean = 0, squares = 0;
  for (std::size_t k = 0; k < values.size(); ++k) mean += belief.members[k].weight * values[k];
  for (std::size_t k = 0; k < values.size(); ++k)
    squares += belief.members[k].weight * square(values[k] - mean);
  return std::sqrt(squares);
}

}  // namespace papilla::claims
