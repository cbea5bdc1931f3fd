// A finger's belief as a claim or a prediction meets it.
#pragma once

#include <span>

#include "base/rooms.h"
#include "scene/belief.h"

namespace papilla::claims {

// The finger at a member, calibrated for that member's choices of the model.
Finger member_finger(const Belief& belief, const BeliefMember& member, const Finger& finger);

// Standard deviation over the members of values, one of each. Eq. accuracy.16
double deviation_over(const Belief& belief, std::span<const double> values);

}  // namespace papilla::claims
