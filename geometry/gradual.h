// What textures share whose heights vary gradually: no two levels, so contours for outlines.
#pragma once

#include <functional>

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

struct GradualProfile {
  Stated<Relief> relief;
  Stated<UnitCell> cell;
  Stated<double> hole, land;  // smallest widths at half the depth [m]
  Stated<double> open_share;
  Stated<double> rim_radius;  // least radius of what is convex [m]
  Stated<double> steepest;    // angle of its steepest slope [rad]
  Stated<bool> directional;
};
TextureFacts gradual_facts(const GradualProfile& profile);

// Heights that do not depend on y; mean(low, high): between two places [m].
Heightmap along_x(const Grid& grid, const std::function<double(double, double)>& mean);

}  // namespace papilla::geometry
