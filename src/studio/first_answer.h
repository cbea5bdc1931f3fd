// The answer under the hand: of the level `search`, carried to the level of the last refined design
// nearby, with a band that says what that may miss.
#pragma once

#include <optional>

#include "base/rooms.h"
#include "design/design.h"
#include "forward/response.h"

namespace papilla::studio {

// A design that was answered by both levels.
struct Anchor {
  Design design;
  Response search, refined;
};

// How far one design is from another: the sum over keys of |ln(value / value)|, 1 for a number that
// is or was 0. Nothing where they differ by more than numbers: other kinds, choices, humidities.
std::optional<double> distance(const Design& from, const Design& to);

// Modulation and friction with what the level leaves open added to their errors. With an anchor
// they are carried by its ratio of the two levels; docs/theory/studio.md has the law and its check.
// Eq. studio.1, studio.2
Response first_answer(const Response& search, const Design& design,
                      const std::optional<Anchor>& anchor);

}  // namespace papilla::studio
