#include "claims/members.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::claims {

Finger member_finger(const Belief& belief, const BeliefMember& member, const Finger& finger) {
  MemberScene at = with_member(belief, member, finger, finger.calibrated_for);
  at.finger.calibrated_for = at.model;
  return std::move(at.finger);
}

double deviation_over(std::span<const double> weights, std::span<const double> values) {
  constexpr double kRounding = 1e-9;  // of the largest
  double mean = 0, squares = 0, all = 0, largest = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    all += weights[k];
    mean += weights[k] * values[k];
    largest = std::max(largest, std::abs(values[k]));
  }
  mean /= all;
  for (std::size_t k = 0; k < values.size(); ++k) squares += weights[k] * square(values[k] - mean);
  const double out = std::sqrt(squares / all);
  return out > kRounding * largest ? out : 0;
}

}  // namespace papilla::claims
