// Cross-section of an etched wall: land, convex rim, straight wall, floor.
#pragma once

#include "base/rooms.h"

namespace papilla::geometry {

class WallProfile {
 public:
  // depth [m], wall angle from the land (0, pi/2] [rad], rim radius [m]
  WallProfile(double depth, double wall_angle, double rim_radius);

  // Depth below the land at a distance s [m] inside the edge (negative: on the land), averaged over
  // a pixel: exact integral of the section, so the removed volume is right. Eq. geometry.1
  double mean_drop(double s, double pixel) const;
  double drop(double s) const;  // the same at a point
  // The distance inside the edge where it is so deep [m]; 0 < drop <= depth.
  double inside(double drop) const;
  // From where to where the section falls, as s.
  double start() const { return start_; }
  double end() const { return start_ + floor_; }

 private:
  double integral(double s) const;  // of the drop from far outside to s

  double depth_, slope_;       // slope_: tan of the wall angle
  double rim_, start_;         // rim radius, where the rim begins (negative)
  double rim_end_, rim_drop_;  // end of the rim arc and the drop there, from start_
  double floor_;               // where the floor begins, from start_
};

}  // namespace papilla::geometry
