#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla {
namespace {

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

}  // namespace

ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution,
                         double hardness) {
  const Grid& grid = kernel.grid();
  const std::vector<double>& p = solution.pressure;
  // The modulus that a pixel's edge feels: of the layer, or of what a layer thinner than a pixel
  // lies on.
  const double q = 0.5 * kPi / std::max(grid.dx(), grid.dy());
  const double modulus = 2 / (q * compliance(kernel.solid(), q));
  // At the cap the pressure ends in a step, which may lie anywhere between the pixels.
  const double cap = hardness > 0 ? (1 - 1e-6) * hardness : kInfinity;
  const auto crossing = [&](std::size_t a, std::size_t b, double pixel) {
    if (!(p[a] > 0)) std::swap(a, b);
    return p[a] >= cap ? 0.5 : edge_position(p[a], solution.gap[b], modulus, pixel);
  };

  double pixels = 0, edges = 0, elastic_edges = 0;
  double polygon = 0;  // area within the crossings [pixels]
  double euler = 0;    // islands less their holes
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!(p[i] > 0)) continue;
    ++pixels;
    const int ix = static_cast<int>(i) % grid.nx, iy = static_cast<int>(i) / grid.nx;
    std::size_t near[3][3];
    for (int dy = 0; dy < 3; ++dy) {
      for (int dx = 0; dx < 3; ++dx) {
        near[dy][dx] = grid.index(wrap(ix + dx - 1, grid.nx), wrap(iy + dy - 1, grid.ny));
      }
    }
    for (std::size_t j : {near[0][1], near[1][0], near[1][2], near[2][1]}) {
      if (p[j] > 0) continue;
      ++edges;
      if (p[i] < cap) ++elastic_edges;
    }
    // The four squares of pixel centres round this one, each at the last of its contact pixels.
    for (int dy = grid.ny == 1 ? 1 : 0; dy < 2; ++dy) {
      for (int dx = grid.nx == 1 ? 1 : 0; dx < 2; ++dx) {
        const std::size_t corner[4] = {near[dy][dx], near[dy][dx + 1], near[dy + 1][dx + 1],
                                       near[dy + 1][dx]};
        bool in[4];
        std::size_t last = 0;
        for (int k = 0; k < 4; ++k) {
          in[k] = p[corner[k]] > 0;
          if (in[k]) last = std::max(last, corner[k]);
        }
        if (last != i) continue;
        double cross[4] = {0, 0, 0, 0};
        for (int k = 0; k < 4; ++k) {
          const int next = (k + 1) % 4;
          if (in[k] != in[next]) {
            cross[k] = crossing(corner[k], corner[next], k % 2 == 0 ? grid.dx() : grid.dy());
          }
        }
        polygon += cell_area(in, cross);
        const int count = in[0] + in[1] + in[2] + in[3];  // Gray 1971, pixels joined at corners
        if (count == 1) euler += 0.25;
        if (count == 3) euler -= 0.25;
        if (count == 2 && in[0] == in[2]) euler -= 0.5;
      }
    }
  }
  ContactArea area;
  if (pixels == 0) return area;
  const auto n = static_cast<double>(grid.size());
  area.raw = pixels / n;
  // Eq. contact.6 with 0.106, the constant measured on rough contact (0.118 is for straight edges).
  area.perimeter = std::max(0.0, (pixels - 0.106 * edges) / n);
  // Eq. contact.7: the crossings' bias of first order, and chords for arcs, which cut off 1/12 of
  // the angle that an edge turns by.
  const double near_edge = std::max(0.0, polygon - 0.0187 * elastic_edges + kPi / 6 * euler);
  area.near_edge = std::min(1.0, near_edge / n);
  // Eq. contact.8: chord is the mean width of the islands in pixels.
  const double chord = edges > 0 ? kPi * pixels / edges : kInfinity;
  area.se = std::hypot(0.07 * std::sqrt(edges) * (1 + 3.5 / chord),
                       (0.001 + 0.075 / square(chord)) * near_edge) /
            n;
  return area;
}

}  // namespace papilla
