// The answer under the hand: few skins on coarse pixels, carried to the level of the last refined
// design nearby, with a band that says what that may miss.
#pragma once

#include <cstddef>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/kept_patches.h"
#include "forward/load_law.h"
#include "forward/response.h"
#include "metrics/metric.h"

namespace papilla::studio {

// The cheapest level whose ratio to a refined one hardly changes from a design to a near one;
// docs/theory/studio.md has what it costs.
Fidelity quick_fidelity(const Design& design);

// A design that was answered by both levels.
struct Anchor {
  Design design;
  std::vector<LoadLaws> laws;  // one per humidity, of its quick patches; empty: none, or not sound
  Response quick, refined;     // quick: by these laws
};
Anchor anchor_of(const Design& design, Response refined);

// Whether the anchor's ratio of the two levels says something about this design: that differs in
// numbers alone, not in its kind, choices or humidities.
bool carries(const Anchor& anchor, const Design& design);

// At the quick level. anchor: of those that carry the design, or null. Its load laws hold, which
// change slowly from a design to a near one: to measure them is two fifths of the work. kept: of
// the answer before; null: nothing.
Response quick_answer(const Design& design, const Anchor* anchor, KeptPatches* kept = nullptr);

// How a quick number moved from one design to another: ln(q / q), and what its skins leave open of
// that, one standard error; 1 where it changed its sign.
struct QuickMove {
  double logarithm = 0, error = 0;
};
QuickMove quick_move(std::size_t point, const QuantityMetric& number, const Response& from,
                     const Response& to);

// Modulation and friction as a refined answer would have them, with what the quick one leaves open
// in their errors: by the ratio of an anchor, of those that carry the design (Eq. studio.1,
// studio.2), else, with none, by the ratio that is usual (Eq. studio.3).
Response first_answer(const Response& quick, const Design& design, const Anchor* anchor);

// Of the difference of two first answers that one anchor carries, by their quick ones: relative to
// their values, one standard error. Eq. studio.4
double difference_drift(const Response& from, const Response& to);

}  // namespace papilla::studio
