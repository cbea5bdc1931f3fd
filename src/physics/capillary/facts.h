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
  double (*seconds)(const Grid& grid);  // of one patch on one core of a usual machine
};
const WaterFacts& water_facts(WaterModel model);

}  // namespace papilla::capillary
