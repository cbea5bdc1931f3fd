// A finger's belief as a claim or a prediction meets it.
#pragma once

#include <span>

#include "base/rooms.h"
#include "scene/belief.h"

namespace papilla::claims {

// The finger at a member, calibrated for that member's choices of the model.
Finger member_finger(const Belief& belief, const BeliefMember& member, const Finger& finger);

// Standard deviation over members of values, one of each; 0 where they differ by rounding alone.
// weights: of these members, of any sum. Eq. accuracy.16
double deviation_over(std::span<const double> weights, std::span<const double> values);

}  // namespace papilla::claims
