#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "physics/contact/active_set.h"
#include "physics/contact/contact.h"
#include "physics/contact/cubic.h"

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

// Eq. contact.5-8. contact: pixels under pressure; pressure, gap: of a pixel.
template <class Pressure, class GapOf>
ContactArea measure(const ContactKernel& kernel, const std::vector<int>& contact,
                    const Pressure& pressure, const GapOf& gap, double hardness) {
  const Grid& grid = kernel.grid();
  // The modulus that a pixel's edge feels: of the layer, or of what a layer thinner than a pixel
  // lies on.
  const double q = 0.5 * kPi / std::max(grid.dx(), grid.dy());
  const double modulus = 2 / (q * compliance(kernel.solid(), q));
  // At the cap the pressure ends in a step, which may lie anywhere between the pixels.
  const double cap = hardness > 0 ? (1 - 1e-6) * hardness : kInfinity;
  const auto crossing = [&](std::size_t a, std::size_t b, double pixel) {
    if (!(pressure(a) > 0)) std::swap(a, b);
    const double p = pressure(a);
    return p >= cap ? 0.5 : edge_position(p, gap(b), modulus, pixel);
  };

  const auto pixels = static_cast<double>(contact.size());
  double edges = 0, elastic_edges = 0;
  double polygon = 0;  // area within the crossings [pixels]
  double euler = 0;    // islands less their holes
  for (int pixel : contact) {
    const int ix = pixel % grid.nx, iy = pixel / grid.nx;
    const bool elastic = pressure(static_cast<std::size_t>(pixel)) < cap;
    std::size_t near[3][3];
    for (int dy = 0; dy < 3; ++dy) {
      for (int dx = 0; dx < 3; ++dx) {
        near[dy][dx] = grid.index(wrap(ix + dx - 1, grid.nx), wrap(iy + dy - 1, grid.ny));
      }
    }
    for (std::size_t j : {near[0][1], near[1][0], near[1][2], near[2][1]}) {
      if (pressure(j) > 0) continue;
      ++edges;
      if (elastic) ++elastic_edges;
    }
    // The four squares of pixel centres round this one, each at the last of its contact pixels.
    for (int dy = grid.ny == 1 ? 1 : 0; dy < 2; ++dy) {
      for (int dx = grid.nx == 1 ? 1 : 0; dx < 2; ++dx) {
        const std::size_t corner[4] = {near[dy][dx], near[dy][dx + 1], near[dy + 1][dx + 1],
                                       near[dy + 1][dx]};
        bool in[4];
        std::size_t last = 0;
        for (int k = 0; k < 4; ++k) {
          in[k] = pressure(corner[k]) > 0;
          if (in[k]) last = std::max(last, corner[k]);
        }
        if (last != static_cast<std::size_t>(pixel)) continue;
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
  area.se = std::hypot(0.07 * std::sqrt(edges) * (1 + 3.5 / chord) / n,
                       (0.001 + 0.075 / square(chord)) * area.near_edge,
                       0.5 * (area.near_edge - area.perimeter));
  return area;
}

}  // namespace

ContactArea measure_area(const ContactKernel& kernel, const ContactSolution& solution,
                         double hardness) {
  const std::vector<double>& p = solution.pressure;
  std::vector<int> contact;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] > 0) contact.push_back(static_cast<int>(i));
  }
  return measure(
      kernel, contact, [&](std::size_t i) { return p[i]; },
      [&](std::size_t i) { return solution.gap[i]; }, hardness);
}

RefinedContact refine_contact(const ContactKernel& kernel, std::span<const double> height,
                              const ContactSolution& solution, std::span<const double> traction,
                              double mean_pressure, const ContactKernel& fine,
                              std::span<const double> fine_height) {
  const Grid &grid = kernel.grid(), &target = fine.grid();
  const int ratio = target.nx / grid.nx;
  PAPILLA_CHECK(ratio * grid.nx == target.nx && ratio * grid.ny == target.ny, "grids do not nest");
  PAPILLA_CHECK(height.size() == grid.size() && fine_height.size() == target.size(), "heights");
  RefinedContact out;
  if (!solution.converged() || solution.pressure.size() != grid.size()) {
    out.reason = "no coarse solution";
    return out;
  }
  double load = mean_pressure * static_cast<double>(target.size()), touching = 0;
  for (double t : traction) load += t * ratio * ratio;
  for (double p : solution.pressure) touching += p > 0;
  const auto limit = static_cast<std::size_t>(2048);
  if (load <= 0 || touching == 0) {
    out.ok = true;
    return out;
  }
  const double expected = touching * ratio * ratio;
  if (expected > static_cast<double>(limit)) {
    out.reason = "too much contact: solve the whole fine grid";
    return out;
  }

  // Displacements by pressure and tractions, smooth on the scale of the coarse pixels, and the
  // tractions' own part.
  std::vector<double> displaced(grid.size()), pulled;
  double slopes = 0;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const std::size_t i = grid.index(ix, iy);
      displaced[i] = solution.gap[i] + solution.shift + height[i];
      slopes += square(height[grid.index(wrap(ix + 1, grid.nx), iy)] - height[i]);
    }
  }
  if (!traction.empty()) {
    const RealArray t(traction.begin(), traction.end());
    RealArray u(grid.size());
    SpectrumArray scratch(kernel.scratch_size());
    kernel.displace(t, u, scratch);
    pulled.assign(u.begin(), u.end());
  }
  std::vector<Cubic> across(static_cast<std::size_t>(target.nx)),
      along(static_cast<std::size_t>(target.ny));
  for (int ix = 0; ix < target.nx; ++ix)
    across[static_cast<std::size_t>(ix)] = cubic(ix, ratio, grid.nx);
  for (int iy = 0; iy < target.ny; ++iy)
    along[static_cast<std::size_t>(iy)] = cubic(iy, ratio, grid.ny);
  const auto initial_gap = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    return pulled.empty() ? -fine_height[at]
                          : -fine_height[at] - interpolate(pulled, grid, across[at % target.nx],
                                                           along[at / target.nx]);
  };

  // Fine points of the pixels that the slope between two pixels may close, by their expected gap.
  const double reach = 3 * std::sqrt(slopes / static_cast<double>(grid.size()));
  std::vector<std::pair<double, int>> low;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (solution.gap[grid.index(ix, iy)] > reach) continue;
      for (int y = ratio * iy; y < ratio * (iy + 1); ++y) {
        for (int x = ratio * ix; x < ratio * (ix + 1); ++x) {
          const std::size_t i = target.index(x, y);
          low.emplace_back(interpolate(displaced, grid, across[static_cast<std::size_t>(x)],
                                       along[static_cast<std::size_t>(y)]) -
                               fine_height[i] - solution.shift,
                           static_cast<int>(i));
        }
      }
    }
  }
  std::sort(low.begin(), low.end());
  const std::size_t watched = std::min(low.size(), static_cast<std::size_t>(3 * expected) + 64);
  std::vector<std::pair<int, bool>> members;
  for (std::size_t k = 0; k < watched; ++k) members.emplace_back(low[k].second, low[k].first <= 0);
  if (!low.empty() && low[0].first > 0) members[0].second = true;

  ActiveSet set(fine);
  for (int round = 0; round < 8; ++round) {
    set.watch(members, initial_gap);
    if (!set.balance(load, 1e-13 * reach, limit)) {
      out.reason = "too much contact: solve the whole fine grid";
      return out;
    }
    members.clear();
    for (std::size_t k = 0; k < set.size(); ++k) members.emplace_back(set.pixel(k), set.touches(k));
    // Penetrating neighbours of the contact, and as many points again above those watched.
    const std::size_t before = members.size();
    const auto inspect = [&](int i) {
      if (set.find(i) == set.size() && set.gap(i, initial_gap(i)) < 0)
        members.emplace_back(i, true);
    };
    for (std::size_t k : set.touching()) {
      const int ix = set.pixel(k) % target.nx, iy = set.pixel(k) / target.nx;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          inspect(
              static_cast<int>(target.index(wrap(ix + dx, target.nx), wrap(iy + dy, target.ny))));
        }
      }
    }
    for (std::size_t k = watched; k < std::min(low.size(), 2 * watched); ++k)
      inspect(low[k].second);
    if (members.size() > before) continue;

    out.ok = true;
    std::vector<int> contact;
    for (std::size_t k : set.touching()) contact.push_back(set.pixel(k));
    out.area = measure(
        fine, contact,
        [&](std::size_t i) {
          const std::size_t k = set.find(static_cast<int>(i));
          return k < set.size() ? set.pressure(k) : 0;
        },
        [&](std::size_t i) {
          return std::max(0.0, set.gap(static_cast<int>(i), initial_gap(static_cast<int>(i))));
        },
        0);
    out.contacts = static_cast<int>(contact.size());
    out.points = static_cast<int>(set.size());
    return out;
  }
  out.reason = "the contact did not settle";
  return out;
}

}  // namespace papilla
