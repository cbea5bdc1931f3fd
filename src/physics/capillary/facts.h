// The models of the water, and what is known of each before it runs.
#pragma once

#include <span>

#include "base/rooms.h"
#include "geometry/grid.h"
#include "scene/finger.h"

namespace papilla::capillary {

struct WaterFacts {
  const char* method;  // for people: what is computed
  const char* reason;  // for people: why, and what it costs in accuracy
  // Error of the modulation, relative; volumes of water per area [m], one per humidity.
  double (*error)(std::span<const double> water_per_area);
  // Of one patch on one core of a usual machine; droplets: that it starts with.
  double (*seconds)(const Grid& grid, double droplets);
};
const WaterFacts& water_facts(WaterModel model);

// Droplets that a patch starts with, at a volume of water per area [m]; as many at most.
double starting_droplets(const Grid& patch, double water_per_area, double drops_per_um3);
inline constexpr double kMostDroplets = 2e5;

}  // namespace papilla::capillary
