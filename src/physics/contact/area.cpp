#include <algorithm>
#include <cmath>

#include "physics/contact/area_of_pixels.h"

namespace papilla {

double edge_position(double p, double g, double modulus, double pixel) {
  // (1-d)^1.5 = r sqrt(d) with x = 1-d: x^3 + r^2 x - r^2 = 0, one real root (Cardano), in (0, 1).
  const double r = 3 * modulus * g / (4 * p * pixel), r2 = r * r;
  const double half = 0.5 * r2, root = std::sqrt(half * half + r2 * r2 * r2 / 27);
  const double u = std::cbrt(half + root);
  const double x = u > 0 ? u - r2 / (3 * u) : 0;
  return std::clamp(1 - x, 0.0, 1.0);
}

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

ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution,
                         double hardness) {
  const std::vector<double>& p = solution.pressure;
  std::vector<int> contact;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] > 0) contact.push_back(static_cast<int>(i));
  }
  const auto pressure = [&](std::size_t i) { return p[i]; };
  const auto gap = [&](std::size_t i) { return solution.gap[i]; };
  return AreaOfPixels(kernel, pressure, gap, hardness).measure(contact);
}

}  // namespace papilla
