// The disc of the gap that holds a bridge's volume.
#pragma once

#include "base/rooms.h"
#include "physics/capillary/gap_table.h"

namespace papilla::capillary {

struct Footprint {
  double radius;      // [m]
  GapTable::Rim rim;  // mean gap and slope on its circle
};

// A bridge nearby, from which a search may start.
struct BridgeGuess {
  double radius = 0;    // [m]; 0: none is known
  double edge_gap = 0;  // of it [m]; 0: not known

  BridgeGuess(double r = 0, double gap = 0) : radius(r), edge_gap(gap) {}
};

// The disc about (x, y) [m] whose gap holds `volume` [m^3], Eq. capillary.5, to 1e-12 of it. The
// result is that of the sampling rule of its own radius, whatever the guess was; among pockets of
// a nearly closed gap, where two rules ask for each other, that of a neighbouring radius. Cost: 3-6
// integrals over discs.
Footprint solve_footprint(const GapTable& table, double x, double y, double volume,
                          const BridgeGuess& guess);

}  // namespace papilla::capillary
