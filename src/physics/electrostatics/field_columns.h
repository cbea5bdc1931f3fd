// The media between electrode and skin as columns of nodes, and the flux that neighbouring columns
// exchange: the geometry of the full field, inside this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::electrostatics {

// A conductor that stands where a column has its media: the electrode or the skin of the
// neighbour, whose surface runs straight from one column to the other, or water, whose wall stands
// half way.
enum class Body { None, Electrode, Skin, Water };

// Flux between two neighbouring columns over an interval of height in which neither changes cell.
struct Exchange {
  double middle = 0;        // height of the interval's middle [m]
  double conductance = 0;   // over eps0 [m]
  int here = 0, there = 0;  // cells of the two columns; of the one that is a body: -1
  Body body = Body::None;
  double share = 1;  // of the way from the column to the body's surface
  double jump = 0;   // of that surface between the columns [m]
  double end = 0;    // upper end of the interval [m]
  // Conductance that a wall of water gains as it rises with the skin, over eps0; 0: it does not.
  double per_rise = 0;
};

// Nodes from the electrode up to the body behind the skin, at heights of each column's own, so that
// every interface lies on a node. The skin's layer stands above the skin as air as thick as d/eps.
class FieldColumns {
 public:
  // The heights must be finite.
  FieldColumns(const PotentialProblem& problem, int dielectric_cells, int air_cells);

  const Grid& grid() const { return grid_; }
  int nodes() const { return nodes_; }  // of a column, the two at the bodies included
  int cells_below_surface() const { return below_; }
  double z(std::size_t column, int k) const { return z_[at(column, k)]; }  // [m]
  double inverse_height(std::size_t column, int cell) const {              // [1/m]
    return inverse_height_[at(column, cell)];
  }
  // How far node k rises when the skin above the column does. 0 to 1
  double rise(std::size_t column, int k) const { return rise_[at(column, k)]; }
  double permittivity(std::size_t column, int cell) const {
    return permittivity_[at(column, cell)];
  }
  // Integral of 1/eps over a cell [m].
  double resistance(std::size_t column, int cell) const { return resistance_[at(column, cell)]; }
  // Water stands on the film's surface; its node is the one there.
  bool bridged(std::size_t column) const { return top_[column] <= below_ + 1; }
  int top(std::size_t column) const { return top_[column]; }  // the node at the upper body
  // Height of the skin over a column that is not bridged, as far up as a wall of water reaches [m].
  double skin(std::size_t column) const { return skin_[column]; }
  // Nodes at a body have its potential: 1 at the electrode, 0 behind the skin.
  bool fixed(std::size_t column, int k) const { return k == 0 || k >= top_[column]; }
  double body_potential(int k) const { return k == 0 ? 1 : 0; }

  // Everything that column i exchanges with its neighbour j across a face as wide as `face` times
  // its distance.
  template <class Visit>
  void exchanges(std::size_t i, std::size_t j, double face, Visit&& visit) const;

 private:
  std::size_t at(std::size_t column, int k) const { return column * nodes_ + k; }
  void place_nodes(std::size_t column, const PotentialProblem& problem);

  Grid grid_;
  int below_, nodes_;
  std::vector<double> z_, inverse_height_, rise_, permittivity_, resistance_, skin_;
  std::vector<int> top_;
};

// Eq. electrostatics.13: at one height the flux follows the two potentials there, through half a
// step of either medium; where the neighbour is a body, over the distance to its surface.
template <class Visit>
void FieldColumns::exchanges(std::size_t i, std::size_t j, double face, Visit&& visit) const {
  // Nearer to the start of a body's slope the potential nearly is the body's: nothing flows.
  constexpr double kLeastShare = 1e-3;
  const double *a = &z_[at(i, 0)], *b = &z_[at(j, 0)];
  // Below water the media end at the film.
  const int top_a = bridged(i) ? below_ : top_[i], top_b = bridged(j) ? below_ : top_[j];
  const bool water = bridged(i) != bridged(j);
  double highest = std::max(a[top_a], b[top_b]), wall_top = highest;
  if (water) {
    // Beside the skin's layer over water no wall stands.
    wall_top = skin(bridged(i) ? j : i);
    highest = std::max(wall_top, bridged(i) ? a[top_a] : b[top_b]);
  }
  int p = -1, q = -1;  // cells that hold z; -1 below the column, top above it
  double z = std::min(a[0], b[0]);
  for (;;) {
    while (p < top_a && a[p + 1] <= z) ++p;
    while (q < top_b && b[q + 1] <= z) ++q;
    if (z >= highest) return;
    double end = highest;
    if (p < top_a) end = std::min(end, a[p + 1]);
    if (q < top_b) end = std::min(end, b[q + 1]);
    const bool in_a = p >= 0 && p < top_a, in_b = q >= 0 && q < top_b;
    if (end > z && (in_a || in_b)) {
      Exchange e;
      e.middle = 0.5 * (z + end);
      double medium = 0;
      if (in_a && in_b) {
        const double ea = permittivity_[at(i, p)], eb = permittivity_[at(j, q)];
        medium = ea == eb ? ea : 2 * ea * eb / (ea + eb);
      } else {
        const bool below = in_a ? q < 0 : p < 0;
        const double from = below ? (in_a ? a[0] : b[0]) : (in_a ? a[top_a] : b[top_b]);
        const double to = below ? (in_a ? b[0] : a[0]) : (in_a ? b[top_b] : a[top_a]);
        e.body = below ? Body::Electrode : water ? Body::Water : Body::Skin;
        e.jump = std::abs(to - from);
        e.share = e.body == Body::Water
                      ? 0.5
                      : std::clamp((e.middle - from) / (to - from), kLeastShare, 1.0);
        medium = (in_a ? permittivity_[at(i, p)] : permittivity_[at(j, q)]) / e.share;
      }
      e.here = in_a ? p : -1;
      e.there = in_b ? q : -1;
      e.conductance = medium * (end - z) * face;
      if (e.body == Body::Water && end == wall_top) e.per_rise = medium * face;
      e.end = end;
      visit(e);
    }
    z = end;
  }
}

}  // namespace papilla::electrostatics
