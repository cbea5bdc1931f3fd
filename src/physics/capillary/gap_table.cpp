#include "physics/capillary/gap_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::capillary {
namespace {

constexpr std::array<int, 16> kCounts = {8,   12,  16,  24,  32,  48,  64,   96,
                                         128, 192, 256, 384, 512, 768, 1024, 1536};

// Half the distance of the two circles that give gap and slope of a rim, by its radius: wide
// enough that what a wall adds depends on the wall and not on the pixel (docs/theory/capillary.md).
constexpr double kRimHalfWidth = 0.07;

struct Nodes {
  // Chords: t = cos(j pi / (N + 1)), half width sin(...), weight pi / (N + 1) (Gauss-Chebyshev of
  // the second kind: exact for the disc of a constant gap).
  std::vector<double> t, half_width, weight;
  std::vector<double> cosine, sine;  // rim
};

const std::array<Nodes, kCounts.size()>& nodes() {
  static const std::array<Nodes, kCounts.size()> table = [] {
    std::array<Nodes, kCounts.size()> all;
    for (std::size_t k = 0; k < kCounts.size(); ++k) {
      const int n = kCounts[k];
      for (int j = 1; j <= n; ++j) {
        const double angle = j * kPi / (n + 1);
        all[k].t.push_back(std::cos(angle));
        all[k].half_width.push_back(std::sin(angle));
        all[k].weight.push_back(kPi / (n + 1) * std::sin(angle));
      }
      for (int j = 0; j < n; ++j) {
        const double angle = (j + 0.5) * 2 * kPi / n;
        all[k].cosine.push_back(std::cos(angle));
        all[k].sine.push_back(std::sin(angle));
      }
    }
    return all;
  }();
  return table;
}

template <class Four>
Four load(const double* values) {
  Four out;
  std::memcpy(&out, values, sizeof out);
  return out;
}

int count_index(double wanted) {
  int k = 0;
  while (k + 1 < static_cast<int>(kCounts.size()) && kCounts[k] < wanted) ++k;
  return k;
}

struct Cell {
  int index;        // in [0, n)
  double fraction;  // [0, 1)
  double turns;     // whole periods before it
};

inline Cell locate(double u, int n) {
  double whole = std::floor(u);
  const double fraction = u - whole;
  double turns = 0;
  if (whole < 0 || whole >= n) {
    turns = std::floor(whole / n);
    whole -= turns * n;
  }
  return {static_cast<int>(whole), fraction, turns};
}

}  // namespace

GapTable::GapTable(const Gap& gap, double floor, double around)
    : grid_(gap.grid),
      floor_(floor),
      inverse_dx_(1 / gap.grid.dx()),
      inverse_dy_(1 / gap.grid.dy()),
      stride_(gap.grid.nx + 1),
      node_(static_cast<std::size_t>(stride_) * gap.grid.ny) {
  PAPILLA_CHECK(gap.value.size() == grid_.size() && grid_.size() > 0,
                "gap and grid differ in size");
  for (int iy = 0; iy < grid_.ny; ++iy) {
    Node* n = &node_[static_cast<std::size_t>(iy) * stride_];
    for (int ix = 0; ix < grid_.nx; ++ix) {
      n[ix].value = std::max(gap.value[grid_.index(ix, iy)], floor);
    }
    n[grid_.nx].value = n[0].value;
    n[0].prefix = 0;
    for (int ix = 0; ix < grid_.nx; ++ix) {
      n[ix + 1].prefix = n[ix].prefix + 0.5 * (n[ix].value + n[ix + 1].value);
    }
  }
  if (around > 0) find_lowest(around);
}

void GapTable::find_lowest(double around) {
  // A gap between pixels is made of theirs: one pixel more than the distance.
  block_x_ = std::min(static_cast<int>(std::ceil(around * inverse_dx_)) + 1, grid_.nx);
  block_y_ = std::min(static_cast<int>(std::ceil(around * inverse_dy_)) + 1, grid_.ny);
  blocks_x_ = grid_.nx / block_x_;  // the last one takes what is left
  blocks_y_ = grid_.ny / block_y_;
  std::vector<double> own(static_cast<std::size_t>(blocks_x_) * blocks_y_, kInfinity);
  for (int iy = 0; iy < grid_.ny; ++iy) {
    const Node* n = &node_[static_cast<std::size_t>(iy) * stride_];
    double* row =
        &own[static_cast<std::size_t>(std::min(iy / block_y_, blocks_y_ - 1)) * blocks_x_];
    for (int b = 0; b < blocks_x_; ++b) {
      const int end = b + 1 == blocks_x_ ? grid_.nx : (b + 1) * block_x_;
      for (int ix = b * block_x_; ix < end; ++ix) row[b] = std::min(row[b], n[ix].value);
    }
  }
  lowest_.assign(own.size(), kInfinity);
  for (int by = 0; by < blocks_y_; ++by) {
    for (int bx = 0; bx < blocks_x_; ++bx) {
      double& low = lowest_[static_cast<std::size_t>(by) * blocks_x_ + bx];
      for (int ey = -1; ey <= 1; ++ey) {
        for (int ex = -1; ex <= 1; ++ex) {
          low = std::min(low, own[static_cast<std::size_t>(wrap(by + ey, blocks_y_)) * blocks_x_ +
                                  wrap(bx + ex, blocks_x_)]);
        }
      }
    }
  }
}

double GapTable::lowest_around(double x, double y) const {
  const int bx = std::min(static_cast<int>(x * inverse_dx_) / block_x_, blocks_x_ - 1);
  const int by = std::min(static_cast<int>(y * inverse_dy_) / block_y_, blocks_y_ - 1);
  return lowest_[static_cast<std::size_t>(by) * blocks_x_ + bx];
}

inline double GapTable::row_integral(int iy, double u) const {
  const Cell c = locate(u, grid_.nx);
  const std::size_t row = static_cast<std::size_t>(iy) * stride_;
  const Node* n = &node_[row + c.index];
  const double f = c.fraction;
  return n[0].prefix + f * (n[0].value + 0.5 * f * (n[1].value - n[0].value)) +
         c.turns * node_[row + grid_.nx].prefix;
}

// Four rows, from their beginning to u; without wrapping. row: index of their first node.
[[gnu::always_inline]] inline GapTable::Four GapTable::row_integrals(const Index& row,
                                                                     const Four& u) const {
  const Index ix = __builtin_convertvector(u, Index), at = row + ix;
  Four prefix, here, next;
  for (int k = 0; k < 4; ++k) {
    const Node* n = &node_[static_cast<std::size_t>(at[k])];
    prefix[k] = n[0].prefix;
    here[k] = n[0].value;
    next[k] = n[1].value;
  }
  const Four f = u - __builtin_convertvector(ix, Four);
  return prefix + f * (here + 0.5 * f * (next - here));
}

double GapTable::at(double x, double y) const {
  return bilinear(x * inverse_dx_ - 0.5, y * inverse_dy_ - 0.5);
}

[[gnu::always_inline]] inline double GapTable::bilinear(double u, double v) const {
  const Cell cx = locate(u, grid_.nx), cy = locate(v, grid_.ny);
  const int next = cy.index + 1 == grid_.ny ? 0 : cy.index + 1;
  const Node* a = &node_[static_cast<std::size_t>(cy.index) * stride_ + cx.index];
  const Node* b = &node_[static_cast<std::size_t>(next) * stride_ + cx.index];
  const double low = a[0].value + cx.fraction * (a[1].value - a[0].value);
  const double high = b[0].value + cx.fraction * (b[1].value - b[0].value);
  return low + cy.fraction * (high - low);
}

GapTable::Rule GapTable::rule(double radius) const {
  return {count_index(0.75 * radius * inverse_dy_ + 6),
          count_index(4.5 * radius * inverse_dx_ + 6)};
}

bool GapTable::inside(double u0, double v0, double ru, double rv) const {
  return u0 - ru >= 0 && u0 + ru < grid_.nx - 1 && v0 - rv >= 0 && v0 + rv < grid_.ny - 1;
}

double GapTable::disc_volume(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = nodes()[rule.chords];
  const double u0 = x * inverse_dx_ - 0.5, v0 = y * inverse_dy_ - 0.5;
  const double ru = radius * inverse_dx_, rv = radius * inverse_dy_;
  const int count = static_cast<int>(n.t.size());
  const double *t = n.t.data(), *half = n.half_width.data(), *weight = n.weight.data();
  double sum = 0;
  if (inside(u0, v0, ru, rv)) {  // no wrapping
    Four sums{};
    for (int j = 0; j < count; j += 4) {
      const Four v = v0 + rv * load<Four>(t + j), w = ru * load<Four>(half + j);
      const Index iy = __builtin_convertvector(v, Index);
      const Index row = iy * stride_;
      const Four to_left = row_integrals(row, u0 - w), to_right = row_integrals(row, u0 + w);
      const Four next_left = row_integrals(row + stride_, u0 - w),
                 next_right = row_integrals(row + stride_, u0 + w);
      const Four low = to_right - to_left, high = next_right - next_left;
      sums +=
          load<Four>(weight + j) * (low + (v - __builtin_convertvector(iy, Four)) * (high - low));
    }
    sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    return sum * grid_.dx() * radius;
  }
  for (int j = 0; j < count; ++j) {
    const Cell cy = locate(v0 + rv * t[j], grid_.ny);
    const int next = cy.index + 1 == grid_.ny ? 0 : cy.index + 1;
    const double w = ru * half[j];
    const double low = row_integral(cy.index, u0 + w) - row_integral(cy.index, u0 - w);
    const double high = row_integral(next, u0 + w) - row_integral(next, u0 - w);
    sum += weight[j] * (low + cy.fraction * (high - low));
  }
  return sum * grid_.dx() * radius;
}

double GapTable::ring(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = nodes()[rule.rim_points];
  const double u0 = x * inverse_dx_ - 0.5, v0 = y * inverse_dy_ - 0.5;
  const double ru = radius * inverse_dx_, rv = radius * inverse_dy_;
  const int count = static_cast<int>(n.cosine.size());
  const double *cosine = n.cosine.data(), *sine = n.sine.data();
  const Node* node = node_.data();
  double sum = 0;
  if (inside(u0, v0, ru, rv)) {  // no wrapping
    Four sums{};
    for (int j = 0; j < count; j += 4) {
      const Four u = u0 + ru * load<Four>(cosine + j), v = v0 + rv * load<Four>(sine + j);
      const Index ix = __builtin_convertvector(u, Index), iy = __builtin_convertvector(v, Index);
      const Four fx = u - __builtin_convertvector(ix, Four);
      const Four fy = v - __builtin_convertvector(iy, Four);
      const Index at = iy * stride_ + ix;
      Four a, b, c, d;
      for (int k = 0; k < 4; ++k) {
        const Node *low = node + at[k], *high = low + stride_;
        a[k] = low[0].value;
        b[k] = low[1].value;
        c[k] = high[0].value;
        d[k] = high[1].value;
      }
      const Four low = a + fx * (b - a);
      sums += low + fy * (c + fx * (d - c) - low);
    }
    sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  } else {
    for (int j = 0; j < count; ++j) sum += bilinear(u0 + ru * cosine[j], v0 + rv * sine[j]);
  }
  return sum / count;
}

// From two circles around the rim, exact for a bowl. Where the circle crosses a wall, slopes of
// single pixels would be what the grid makes of a jump; the difference of two means has a limit.
GapTable::Rim GapTable::rim(double x, double y, double radius, const Rule& rule) const {
  const double half = kRimHalfWidth * radius;
  const double in = ring(x, y, radius - half, rule), out = ring(x, y, radius + half, rule);
  const double slope = (out - in) / (2 * half);
  return {0.5 * (in + out) - 0.5 * kRimHalfWidth * half * slope, slope};
}

}  // namespace papilla::capillary
