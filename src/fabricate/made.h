// The surface that a process makes of polygons as they stand in a layout: what a mask is worth
// before it is paid for.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "fabricate/process.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {

// Of one array; lengths as made and as wanted [m], angles [rad].
struct MadeArray {
  // At half the depth that is etched, by the area below it: what a mask is drawn to keep, whatever
  // walls the etch leaves.
  double width = 0, wanted_width = 0;
  double depth = 0, wanted_depth = 0;  // of the lowest place
  bool walls_meet = false;             // above the depth that is etched
  double period = 0, wanted_period = 0;
  double wall_angle = 0, wanted_wall_angle = 0;
  double edge_radius = 0, wanted_edge_radius = 0;  // of the rims

  // Lengths along the surface and rims within 2 nm, depth within 1 %, walls within half a degree.
  bool as_wanted() const;
  // What is otherwise, in words; empty: as wanted.
  std::vector<std::string> left() const;
};

// polygons: of what is deep, of one feature's own cell, its centre at the origin [nm]. Exposure by
// their exact Fourier series, the resist where it is above 1/2, undercut by the distance from
// there, walls below. Eq. fabrication.7. Cost: 0.1 to 0.5 s. Throws InputError where the resist
// does not open.
MadeArray made_of(const MaskedArray& array, const std::vector<Polygon>& polygons,
                  const Process& process);

}  // namespace papilla::fabricate
