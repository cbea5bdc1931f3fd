// A droplet while it settles, and its place in the periodic patch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "base/rooms.h"
#include "fields/wetting.h"
#include "geometry/grid.h"

namespace papilla::capillary {

struct Drop {
  double x = 0, y = 0;                  // centre [m], inside the patch
  double volume = 0;                    // [m^3]
  double radius = 0;                    // footprint [m]; a cap: its widest, which is what overlaps
  double edge_gap = 0, edge_slope = 0;  // a bridge: mean gap on the rim [m], its slope outward [-]
  double energy = 0;                    // [J]
  double film = 0;                      // share of film, once settled
  double footprint = 0, height = 0;     // a cap [m]
  DropletState side = DropletState::OnSubstrate;  // of a cap
  bool bridge = false;
  bool alive = true;
};

// Where a drop looks around: eight directions, half a right angle apart.
struct Directions {
  std::array<double, 8> x, y;
};
constexpr double kHalfRight = 0.7071067811865476;  // cos 45 deg
inline constexpr Directions kDirections = {
    {1, kHalfRight, 0, -kHalfRight, -1, -kHalfRight, 0, kHalfRight},
    {0, kHalfRight, 1, kHalfRight, 0, -kHalfRight, -1, -kHalfRight}};

// A place brought into [0, period).
inline double into_period(double x, double period) {
  x -= period * std::floor(x / period);
  return x < period ? x : 0;
}

// The shortest of the periodic images of a difference between two places inside the period.
inline double nearest_image(double d, double period) {
  if (d > 0.5 * period) return d - period;
  return d < -0.5 * period ? d + period : d;
}

// Its size, without a branch.
inline double image_distance(double d, double period) {
  d = std::abs(d);
  return std::min(d, period - d);
}

struct Disc {
  double x, y, radius;  // [m]
};

// Squared distance of a pixel's centre from a place [m^2], to its nearest image.
inline double square_distance(const Grid& g, std::size_t pixel, double x, double y) {
  const double ex = nearest_image(g.x(static_cast<int>(pixel % g.nx)) - x, g.lx);
  const double ey = nearest_image(g.y(static_cast<int>(pixel / g.nx)) - y, g.ly);
  return square(ex) + square(ey);
}

inline std::size_t pixel_of(const Grid& g, double x, double y) {
  return g.index(std::min(static_cast<int>(x / g.dx()), g.nx - 1),
                 std::min(static_cast<int>(y / g.dy()), g.ny - 1));
}

// Visits the pixels whose centres lie inside a disc, each once.
template <class Visit>
void for_pixels(const Grid& g, const Disc& d, Visit&& visit) {
  const double dx = g.dx(), dy = g.dy();
  const double ry = std::min(d.radius, 0.5 * g.ly);
  const int first = static_cast<int>(std::ceil((d.y - ry) / dy - 0.5));
  const int last = std::min(static_cast<int>(std::floor((d.y + ry) / dy - 0.5)), first + g.ny - 1);
  for (int iy = first; iy <= last; ++iy) {
    const double y = (iy + 0.5) * dy - d.y;
    const double w = std::min(std::sqrt(std::max(0.0, square(d.radius) - square(y))), 0.5 * g.lx);
    const int from = static_cast<int>(std::ceil((d.x - w) / dx - 0.5));
    const int to = std::min(static_cast<int>(std::floor((d.x + w) / dx - 0.5)), from + g.nx - 1);
    const int row = wrap(iy, g.ny);
    for (int ix = from; ix <= to; ++ix) visit(g.index(wrap(ix, g.nx), row));
  }
}

inline Disc disc_of(const Drop& d) { return {d.x, d.y, d.radius}; }

}  // namespace papilla::capillary
