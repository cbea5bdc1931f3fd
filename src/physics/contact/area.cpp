#include <algorithm>
#include <cmath>
#include <numeric>

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

struct Clusters {
  std::vector<int> parent;
  explicit Clusters(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  int find(int i) {
    while (parent[static_cast<std::size_t>(i)] != i) {
      parent[static_cast<std::size_t>(i)] =
          parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
      i = parent[static_cast<std::size_t>(i)];
    }
    return i;
  }
  void join(int a, int b) { parent[static_cast<std::size_t>(find(a))] = find(b); }
};

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

ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution) {
  const Grid& grid = kernel.grid();
  const std::vector<double>& p = solution.pressure;
  ContactArea area;
  std::vector<int> contact;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] > 0) contact.push_back(static_cast<int>(i));
  }
  if (contact.empty()) return area;
  const auto n = static_cast<double>(grid.size());
  area.raw = static_cast<double>(contact.size()) / n;

  const double modulus = kernel.contact_modulus();
  Clusters clusters(p.size());
  long switches = 0;
  double near_edge = 0;
  const auto side = [&](std::size_t a, std::size_t b, double pixel) {
    return p[a] > 0 ? edge_position(p[a], solution.gap[b], modulus, pixel)
                    : edge_position(p[b], solution.gap[a], modulus, pixel);
  };
  const auto add_cell = [&](int ix, int iy) {
    const int jx = wrap(ix + 1, grid.nx), jy = wrap(iy + 1, grid.ny);
    const std::size_t corner[4] = {grid.index(ix, iy), grid.index(jx, iy), grid.index(jx, jy),
                                   grid.index(ix, jy)};
    bool in[4];
    double cross[4] = {0, 0, 0, 0};
    for (int k = 0; k < 4; ++k) in[k] = p[corner[k]] > 0;
    for (int k = 0; k < 4; ++k) {
      const int next = (k + 1) % 4;
      if (in[k] != in[next]) {
        cross[k] = side(corner[k], corner[next], k % 2 == 0 ? grid.dx() : grid.dy());
      }
    }
    near_edge += cell_area(in, cross);
  };
  std::vector<char> done(p.size(), 0);
  for (int i : contact) {
    const int ix = i % grid.nx, iy = i / grid.nx;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const std::size_t j = grid.index(wrap(ix + dx, grid.nx), wrap(iy + dy, grid.ny));
        if (p[j] > 0) {
          clusters.join(i, static_cast<int>(j));
        } else if (dx == 0 || dy == 0) {
          ++switches;
        }
      }
    }
    for (int cy = iy - 1; cy <= iy; ++cy) {
      for (int cx = ix - 1; cx <= ix; ++cx) {
        const int wx = wrap(cx, grid.nx), wy = wrap(cy, grid.ny);
        char& seen = done[grid.index(wx, wy)];
        if (!seen) add_cell(wx, wy);
        seen = 1;
      }
    }
  }
  // Eq. contact.6 with 0.106, the constant measured on rough contact (0.118 is for straight edges).
  area.perimeter = std::max(
      0.0, (static_cast<double>(contact.size()) - 0.106 * static_cast<double>(switches)) / n);
  area.near_edge = near_edge / n;

  std::vector<double> sum(p.size(), 0), squares(p.size(), 0);
  for (int i : contact) {
    const auto root = static_cast<std::size_t>(clusters.find(i));
    const double q = p[static_cast<std::size_t>(i)];
    sum[root] += q;
    squares[root] += q * q;
  }
  double moments = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (squares[i] > 0) moments += 9.0 / 8 * sum[i] * sum[i] / squares[i];
  }
  area.moments = std::min(1.0, moments / n);
  // One pixel of each edge is uncertain by about 5 % after the correction; edges are independent.
  area.se = 0.05 * std::sqrt(static_cast<double>(switches)) / n + 0.003 * area.near_edge;
  return area;
}

}  // namespace papilla
