// The answer under the hand: few skins on coarse pixels, carried to the level of the last refined
// design nearby, with a band that says what that may miss.
#pragma once

#include <optional>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/response.h"

namespace papilla::studio {

// The cheapest level whose ratio to a refined one hardly changes from a design to a near one;
// docs/theory/studio.md has what it costs.
Fidelity quick_fidelity(const Design& design);

// A design that was answered by both levels.
struct Anchor {
  Design design;
  Response quick, refined;
};

// How far one design is from another: the sum over keys of |ln(value / value)|, 1 for a number that
// is or was 0. Nothing where they differ by more than numbers: other kinds, choices, humidities.
std::optional<double> distance(const Design& from, const Design& to);

// Whether the anchor's ratio of the two levels says something about this design.
bool carries(const Anchor& anchor, const Design& design);

// Modulation and friction as a refined answer would have them, with what the quick one leaves open
// in their errors: by the ratio of an anchor that carries the design (Eq. studio.1, studio.2), else
// by the ratio that is usual (Eq. studio.3).
Response first_answer(const Response& quick, const Design& design,
                      const std::optional<Anchor>& anchor);

// Of the difference of two first answers that the anchor carries: relative to their values, one
// standard error. Eq. studio.4
double difference_drift(const Anchor& anchor, const Design& from, const Design& to);

}  // namespace papilla::studio
