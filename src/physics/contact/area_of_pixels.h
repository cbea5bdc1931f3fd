// The area estimators over any list of contact pixels, inside this folder.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla {

// What the estimators sum up over the contact's pixels.
struct AreaSums {
  double pixels = 0;
  double edges = 0, elastic_edges = 0;  // sides towards free pixels; those of pixels below the cap
  double polygon = 0;                   // area within the crossings [pixels]
  double euler = 0;                     // islands less their holes
};

// Eqs. contact.5-8
ContactArea area_from(const AreaSums& sums, const Grid& grid);

// Where the contact edge crosses between a contact pixel (pressure p) and its free neighbour (gap
// g), as a fraction d in (0, 1) of their distance from the contact pixel: p = c sqrt(d) inside and
// gap = (4c/3E*) s^1.5 outside with s = 1 - d. Eq. contact.7
double edge_position(double p, double g, double modulus, double pixel);

// Area of the contact part of the square whose corners are four pixel centres (in order round it);
// cross[k] is the edge position on side k -> k+1 measured from its contact end. Unit square.
double cell_area(const bool in[4], const double cross[4]);

// pressure(i) [Pa], gap(i) [m]: of a pixel. hardness: cap on the pressure [Pa], or 0.
template <class Pressure, class GapOf>
class AreaOfPixels {
 public:
  AreaOfPixels(const ContactKernel& kernel, const Pressure& pressure, const GapOf& gap,
               double hardness)
      : grid_(kernel.grid()), pressure_(pressure), gap_(gap) {
    // The modulus that a pixel's edge feels: of the layer, or of what a layer thinner than a pixel
    // lies on.
    const double q = 0.5 * kPi / std::max(grid_.dx(), grid_.dy());
    modulus_ = 2 / (q * compliance(kernel.solid(), q));
    // At the cap the pressure ends in a step, which may lie anywhere between the pixels.
    cap_ = hardness > 0 ? (1 - 1e-6) * hardness : kInfinity;
  }

  // contact: the pixels under pressure.
  ContactArea measure(const std::vector<int>& contact) const {
    AreaSums sums;
    sums.pixels = static_cast<double>(contact.size());
    for (int pixel : contact) add(static_cast<std::size_t>(pixel), sums);
    return area_from(sums, grid_);
  }

 private:
  void add(std::size_t pixel, AreaSums& sums) const {
    const int ix = static_cast<int>(pixel) % grid_.nx, iy = static_cast<int>(pixel) / grid_.nx;
    const bool elastic = pressure_(pixel) < cap_;
    std::size_t near[3][3];
    for (int dy = 0; dy < 3; ++dy) {
      for (int dx = 0; dx < 3; ++dx) {
        near[dy][dx] = grid_.index(wrap(ix + dx - 1, grid_.nx), wrap(iy + dy - 1, grid_.ny));
      }
    }
    for (std::size_t j : {near[0][1], near[1][0], near[1][2], near[2][1]}) {
      if (pressure_(j) > 0) continue;
      ++sums.edges;
      if (elastic) ++sums.elastic_edges;
    }
    // The four squares of pixel centres round this one, each at the last of its contact pixels.
    for (int dy = grid_.ny == 1 ? 1 : 0; dy < 2; ++dy) {
      for (int dx = grid_.nx == 1 ? 1 : 0; dx < 2; ++dx) {
        const std::size_t corner[4] = {near[dy][dx], near[dy][dx + 1], near[dy + 1][dx + 1],
                                       near[dy + 1][dx]};
        add_square(corner, pixel, sums);
      }
    }
  }

  void add_square(const std::size_t corner[4], std::size_t pixel, AreaSums& sums) const {
    bool in[4];
    std::size_t last = 0;
    for (int k = 0; k < 4; ++k) {
      in[k] = pressure_(corner[k]) > 0;
      if (in[k]) last = std::max(last, corner[k]);
    }
    if (last != pixel) return;
    double cross[4] = {0, 0, 0, 0};
    for (int k = 0; k < 4; ++k) {
      const int next = (k + 1) % 4;
      if (in[k] != in[next]) {
        cross[k] = crossing(corner[k], corner[next], k % 2 == 0 ? grid_.dx() : grid_.dy());
      }
    }
    sums.polygon += cell_area(in, cross);
    const int count = in[0] + in[1] + in[2] + in[3];  // Gray 1971, pixels joined at corners
    if (count == 1) sums.euler += 0.25;
    if (count == 3) sums.euler -= 0.25;
    if (count == 2 && in[0] == in[2]) sums.euler -= 0.5;
  }

  double crossing(std::size_t a, std::size_t b, double pixel) const {
    if (!(pressure_(a) > 0)) std::swap(a, b);
    const double p = pressure_(a);
    return p >= cap_ ? 0.5 : edge_position(p, gap_(b), modulus_, pixel);
  }

  const Grid& grid_;
  const Pressure& pressure_;
  const GapOf& gap_;
  double modulus_, cap_;
};

}  // namespace papilla
