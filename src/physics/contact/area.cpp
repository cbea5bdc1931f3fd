// The contact area of a solution, by three estimators.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "numerics/arrays.h"
#include "numerics/loops.h"
#include "physics/contact/contact.h"

namespace papilla::contact {
namespace {

// What the estimators sum up over the contact's pixels.
struct AreaSums {
  double pixels = 0;
  double edges = 0, elastic_edges = 0;  // sides towards free pixels; those of pixels below the cap
  double polygon = 0;                   // area within the crossings [pixels]
  double euler = 0;                     // islands less their holes
};

// Where the contact edge crosses between a contact pixel (pressure p) and its free neighbour (gap
// g), as a fraction d in (0, 1) of their distance from the contact pixel: p = c sqrt(d) inside and
// gap = (4c/3E*) s^1.5 outside with s = 1 - d. Eq. contact.7
double edge_position(double p, double g, double modulus, double pixel) {
  // (1-d)^1.5 = r sqrt(d) with x = 1-d: x^3 + r^2 x - r^2 = 0, one real root (Cardano), in (0, 1).
  const double r = 3 * modulus * g / (4 * p * pixel), r2 = r * r;
  const double half = 0.5 * r2, root = std::sqrt(half * half + r2 * r2 * r2 / 27);
  const double u = std::cbrt(half + root);
  const double x = u > 0 ? u - r2 / (3 * u) : 0;
  return std::clamp(1 - x, 0.0, 1.0);
}

// Area of the contact part of the square whose corners are four pixel centres (in order round it);
// cross[k] is the edge position on side k -> k+1 measured from its contact end. Unit square.
double cell_area(const bool in[4], const double cross[4]) {
  static constexpr double kX[4] = {0, 1, 1, 0}, kY[4] = {0, 0, 1, 1};
  const int count = in[0] + in[1] + in[2] + in[3];
  if (count == 4) return 1;
  if (count == 2 && in[0] == in[2]) {  // two opposite corners: separate triangles
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      if (in[k]) sum += 0.5 * cross[k] * cross[(k + 3) % 4];
    }
    return std::min(sum, 1.0);
  }
  double x[8], y[8];
  int n = 0;
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    if (in[k]) {
      x[n] = kX[k];
      y[n++] = kY[k];
    }
    if (in[k] != in[next]) {
      const double t = in[k] ? cross[k] : 1 - cross[k];
      x[n] = kX[k] + t * (kX[next] - kX[k]);
      y[n++] = kY[k] + t * (kY[next] - kY[k]);
    }
  }
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    sum += x[i] * y[j] - x[j] * y[i];
  }
  return 0.5 * std::abs(sum);
}

// Eqs. contact.5-8
ContactArea area_from(const AreaSums& s, const Grid& grid) {
  ContactArea area;
  if (s.pixels == 0) return area;
  const auto n = static_cast<double>(grid.size());
  area.raw = s.pixels / n;
  // Eq. contact.6 with 0.106, the constant measured on rough contact (0.118 is for straight edges).
  area.perimeter = std::max(0.0, (s.pixels - 0.106 * s.edges) / n);
  // Eq. contact.7: the crossings' bias of first order, and chords for arcs, which cut off 1/12 of
  // the angle that an edge turns by.
  const double near_edge = std::max(0.0, s.polygon - 0.0187 * s.elastic_edges + kPi / 6 * s.euler);
  area.near_edge = std::min(1.0, near_edge / n);
  // Eq. contact.8: chord is the mean width of the islands in pixels.
  const double chord = s.edges > 0 ? kPi * s.pixels / s.edges : kInfinity;
  area.se = std::hypot(0.07 * std::sqrt(s.edges) * (1 + 3.5 / chord) / n,
                       (0.001 + 0.075 / square(chord)) * area.near_edge,
                       0.5 * (area.near_edge - area.perimeter));
  return area;
}

// hardness: cap on the pressure [Pa], or 0.
class AreaOfPixels {
 public:
  AreaOfPixels(const ContactKernel& kernel, const ContactSolution& solution, double hardness)
      : grid_(kernel.grid()),
        pressure_(solution.pressure),
        gap_(solution.gap),
        to_right_(grid_.size()),
        upward_(grid_.size()) {
    // The modulus that a pixel's edge feels: of the layer, or of what a layer thinner than a pixel
    // lies on.
    const double q = 0.5 * kPi / std::max(grid_.dx(), grid_.dy());
    modulus_ = 2 / (q * compliance(kernel.solid(), q));
    // At the cap the pressure ends in a step, which may lie anywhere between the pixels.
    cap_ = hardness > 0 ? (1 - 1e-6) * hardness : kInfinity;
  }

  ContactArea measure() {
    std::vector<std::size_t> pressed;
    for_each_where(
        pressure_.size(), [&](auto at) { return at(pressure_) > 0; },
        [&](std::size_t i) { pressed.push_back(i); });
    AreaSums sums;
    for (const std::size_t i : pressed) add_sides(i, sums);
    for (const std::size_t i : pressed) add_squares(i, sums);
    return area_from(sums, grid_);
  }

 private:
  struct Around {
    std::size_t pixel[3][3];  // rows below, at and above a pixel
  };
  Around around(std::size_t pixel) const {
    const int ix = static_cast<int>(pixel) % grid_.nx, iy = static_cast<int>(pixel) / grid_.nx;
    const int column[3] = {ix > 0 ? ix - 1 : grid_.nx - 1, ix, ix + 1 < grid_.nx ? ix + 1 : 0};
    const int row[3] = {iy > 0 ? iy - 1 : grid_.ny - 1, iy, iy + 1 < grid_.ny ? iy + 1 : 0};
    Around out;
    for (int dy = 0; dy < 3; ++dy) {
      for (int dx = 0; dx < 3; ++dx) out.pixel[dy][dx] = grid_.index(column[dx], row[dy]);
    }
    return out;
  }

  void add_sides(std::size_t pixel, AreaSums& sums) {
    ++sums.pixels;
    const Around near = around(pixel);
    const std::size_t left = near.pixel[1][0], right = near.pixel[1][2];
    const std::size_t below = near.pixel[0][1], above = near.pixel[2][1];
    const auto add = [&](std::size_t other, double width, double& crossed) {
      if (pressure_[other] > 0) return;
      const double p = pressure_[pixel];
      ++sums.edges;
      if (p < cap_) ++sums.elastic_edges;
      crossed = p >= cap_ ? 0.5 : edge_position(p, gap_[other], modulus_, width);
    };
    add(left, grid_.dx(), to_right_[left]);
    add(right, grid_.dx(), to_right_[pixel]);
    add(below, grid_.dy(), upward_[below]);
    add(above, grid_.dy(), upward_[pixel]);
  }

  // The four squares of pixel centres round this one, each at the last of its contact pixels.
  void add_squares(std::size_t pixel, AreaSums& sums) const {
    const Around near = around(pixel);
    for (int dy = grid_.ny == 1 ? 1 : 0; dy < 2; ++dy) {
      for (int dx = grid_.nx == 1 ? 1 : 0; dx < 2; ++dx) {
        const std::size_t corner[4] = {near.pixel[dy][dx], near.pixel[dy][dx + 1],
                                       near.pixel[dy + 1][dx + 1], near.pixel[dy + 1][dx]};
        add_square(corner, pixel, sums);
      }
    }
  }

  void add_square(const std::size_t corner[4], std::size_t pixel, AreaSums& sums) const {
    bool in[4];
    std::size_t last = 0;
    for (int k = 0; k < 4; ++k) {
      in[k] = pressure_[corner[k]] > 0;
      if (in[k]) last = std::max(last, corner[k]);
    }
    if (last != pixel) return;
    const double* const side[4] = {&to_right_[corner[0]], &upward_[corner[1]],
                                   &to_right_[corner[3]], &upward_[corner[0]]};
    double cross[4] = {0, 0, 0, 0};
    for (int k = 0; k < 4; ++k) {
      if (in[k] != in[(k + 1) % 4]) cross[k] = *side[k];
    }
    sums.polygon += cell_area(in, cross);
    const int count = in[0] + in[1] + in[2] + in[3];  // Gray 1971, pixels joined at corners
    if (count == 1) sums.euler += 0.25;
    if (count == 3) sums.euler -= 0.25;
    if (count == 2 && in[0] == in[2]) sums.euler -= 0.5;
  }

  const Grid& grid_;
  const std::vector<double>& pressure_;  // [Pa]
  const std::vector<double>& gap_;       // [m]
  double modulus_, cap_;
  // Where the edge crosses the way from a pixel to the next, if it does, from its contact end.
  UnsetArray<double> to_right_, upward_;
};

}  // namespace

ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution,
                         double hardness) {
  return AreaOfPixels(kernel, solution, hardness).measure();
}

}  // namespace papilla::contact
