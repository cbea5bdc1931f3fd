// Published numbers that a fit can be held against: ratios and trends, because the papers print no
// curves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "numerics/statistics.h"
#include "published/finger_model.h"

namespace papilla::published {

// Its residual is the distance from [low, high] over sd, the width that the paper's words leave.
struct PublishedTarget {
  std::string claim;  // id; kGapTarget and kFrictionTarget are no claims but measurements
  std::string what;   // with its unit
  double low = 0, high = 0, sd = 1;
  std::function<Estimate(FingerModel&)> model;
};
std::vector<PublishedTarget> published_targets();
// These, and those of whole fingers (`whole_finger_targets`): all that a fit can name.
std::vector<PublishedTarget> fittable_targets();

// The gap under a finger that slides on coated glass, by its capacitance [m]: the paper on
// broadband electroadhesion has 250 pF on 30 mm2 (claim B2); and what the ridges of this finger
// give.
inline constexpr const char* kGapTarget = "C_gap";
inline constexpr double kPublishedGap = 1.06e-6;
double capacitance_gap(const Finger& finger);

// The friction coefficient of smooth glass without voltage: 0.2 and 0.4 on two screens at 1 N; by
// mean field with 8 MPa 0.27 to 0.33. In the air of a room, between 35 and 55 % relative humidity.
inline constexpr const char* kFrictionTarget = "friction";

}  // namespace papilla::published
