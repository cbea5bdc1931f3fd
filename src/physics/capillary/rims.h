// Edges of holes and pillars: where a contact line is held, and the corners at their feet, along
// which water creeps. Options of the droplets, both off by default.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::capillary {

// Gibbs, Eq. capillary.16: at an edge where the surface turns down by `turn` [rad] a line stays put
// for every angle against the level it lies on from theta to theta + turn (at most 180 deg).
struct AngleRange {
  double low, high;
};
AngleRange gibbs_range(double theta, double turn);

// Whether the line of a bridge passes such an edge: the bridge's mean gap on its rim is edge_gap,
// the gap at the edge local_gap. One pressure, so cos(theta*) = C local_gap / edge_gap - cos
// theta_skin there.
bool passes_edge(double theta_skin, double theta, double turn, double edge_gap, double local_gap);

// Concus and Finn, Eq. capillary.17: water creeps along a corner of the opening angle when theta is
// below 90 deg - opening / 2.
bool creeps_along(double theta, double opening);

// The fillet of water in a corner, per meniscus radius R: section area = area R^2, wetted length on
// either wall = leg R, energy per tension and length = -2 area R. Zero where water does not creep.
struct Fillet {
  double area = 0, leg = 0;
};
Fillet corner_fillet(double theta, double opening);  // Eq. capillary.18

// A texture of two levels: which pixels lie low, the edges between, the corners at their feet.
class RimMap {
 public:
  // Not valid (no edges) for a flat texture or one without two clear levels: more than a third of
  // its pixels between 10 and 90 % of its height.
  explicit RimMap(const Heightmap& texture);

  struct Hole {  // a connected low region
    double perimeter = 0, area = 0;
  };
  bool valid() const { return !holes_.empty(); }
  double turn() const { return turn_; }    // of the wall against the level [rad]; 2 pixels: 90 deg
  double depth() const { return depth_; }  // [m]
  const std::vector<Hole>& holes() const { return holes_; }
  bool edge(std::size_t pixel) const { return edge_[pixel] != 0; }    // beside the other level
  int hole_of(std::size_t pixel) const { return label_[pixel] - 1; }  // -1: the high level

  // What the corner of a hole holds at most: a fillet up to the wall's height or the hole's middle
  // [m^3].
  double capacity(const Hole& hole, double theta) const;

 private:
  double turn_ = 0, depth_ = 0;
  std::vector<Hole> holes_;
  std::vector<std::uint8_t> edge_;
  std::vector<int> label_;
};

}  // namespace papilla::capillary
