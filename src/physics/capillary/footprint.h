// The disc of the gap that holds a bridge's volume.
#pragma once

#include "physics/capillary/gap_table.h"

namespace papilla {

struct Footprint {
  double radius;      // [m]
  GapTable::Rim rim;  // mean gap and slope on its circle
};

// The disc about (x, y) [m] whose gap holds `volume` [m^3], Eq. capillary.5, to 1e-13 of it. guess:
// a radius nearby [m], or 0. The result is that of the sampling rule of its own radius, whatever
// the guess was. Cost: 3-6 integrals over discs.
Footprint solve_footprint(const GapTable& table, double x, double y, double volume, double guess);

}  // namespace papilla
