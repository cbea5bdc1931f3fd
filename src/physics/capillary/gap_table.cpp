#include "physics/capillary/gap_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "base/check.h"
#include "base/constants.h"
#include "numerics/loops.h"
#include "physics/capillary/drop.h"

namespace papilla::capillary {
namespace {

constexpr std::array<int, 16> kCounts = {8,   12,  16,  24,  32,  48,  64,   96,
                                         128, 192, 256, 384, 512, 768, 1024, 1536};

// Half the distance of the two circles that give gap and slope of a rim, by its radius: wide
// enough that what a wall adds depends on the wall and not on the pixel (docs/theory/capillary.md).
constexpr double kRimHalfWidth = 0.07;

}  // namespace

struct GapTable::Nodes {
  // Chords: t = cos(j pi / (N + 1)), half width sin(...), weight pi / (N + 1) (Gauss-Chebyshev of
  // the second kind: exact for the disc of a constant gap). Filled up with nodes of no weight.
  std::vector<double> t, half_width, weight;
  std::vector<double> cosine, sine, share;  // rim

  static const Nodes& of(int rule);
};

const GapTable::Nodes& GapTable::Nodes::of(int rule) {
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
        all[k].share.push_back(1.0 / n);
      }
      for (std::vector<double>* nodes : {&all[k].t, &all[k].half_width, &all[k].weight,
                                         &all[k].cosine, &all[k].sine, &all[k].share}) {
        nodes->resize(padded(nodes->size()), 0.0);
      }
    }
    return all;
  }();
  return table[static_cast<std::size_t>(rule)];
}

namespace {

int count_index(double wanted) {
  int k = 0;
  while (k + 1 < static_cast<int>(kCounts.size()) && kCounts[k] < wanted) ++k;
  return k;
}

}  // namespace

GapTable::GapTable(const Gap& gap, double floor, double around)
    : grid_(gap.grid),
      floor_(floor),
      inverse_dx_(1 / gap.grid.dx()),
      inverse_dy_(1 / gap.grid.dy()),
      stride_(gap.grid.nx + 1),
      value_(static_cast<std::size_t>(stride_) * (gap.grid.ny + 1)),
      prefix_(value_.size()) {
  PAPILLA_CHECK(gap.value.size() == grid_.size() && grid_.size() > 0,
                "gap and grid differ in size");
  for (int iy = 0; iy < grid_.ny; ++iy) {
    double* value = &value_[static_cast<std::size_t>(iy) * stride_];
    double* prefix = &prefix_[static_cast<std::size_t>(iy) * stride_];
    const double* given = &gap.value[grid_.index(0, iy)];
    for (int ix = 0; ix < grid_.nx; ++ix) value[ix] = std::max(given[ix], floor);
    value[grid_.nx] = value[0];
    prefix[0] = 0;
    for (int ix = 0; ix < grid_.nx; ++ix) {
      prefix[ix + 1] = prefix[ix] + 0.5 * (value[ix] + value[ix + 1]);
    }
  }
  std::copy_n(value_.begin(), stride_, value_.end() - stride_);
  std::copy_n(prefix_.begin(), stride_, prefix_.end() - stride_);
  if (around > 0) find_lowest(around);
}

void GapTable::find_lowest(double around) {
  // A gap between pixels is made of theirs: one pixel more than the distance.
  block_x_ = std::min(static_cast<int>(std::ceil(around * inverse_dx_)) + 1, grid_.nx);
  block_y_ = std::min(static_cast<int>(std::ceil(around * inverse_dy_)) + 1, grid_.ny);
  blocks_x_ = grid_.nx / block_x_;  // the last one takes what is left
  blocks_y_ = grid_.ny / block_y_;
  std::vector<double> own(static_cast<std::size_t>(blocks_x_) * blocks_y_, kInfinity), band;
  for (int by = 0; by < blocks_y_; ++by) {
    const int end_y = by + 1 == blocks_y_ ? grid_.ny : (by + 1) * block_y_;
    band.assign(grid_.nx, kInfinity);
    for (int iy = by * block_y_; iy < end_y; ++iy) {
      const double* value = &value_[static_cast<std::size_t>(iy) * stride_];
      for (int ix = 0; ix < grid_.nx; ++ix) band[ix] = std::min(band[ix], value[ix]);
    }
    for (int bx = 0; bx < blocks_x_; ++bx) {
      const auto begin = band.begin() + static_cast<std::ptrdiff_t>(bx) * block_x_;
      own[static_cast<std::size_t>(by) * blocks_x_ + bx] =
          *std::min_element(begin, bx + 1 == blocks_x_ ? band.end() : begin + block_x_);
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

// Which nodes places lie beyond; at most `periods` away from the first n they are brought there.
template <bool kWraps, class T>
[[gnu::always_inline]] inline GapTable::Cells<T> GapTable::cells(const T& place, int n,
                                                                 int periods) const {
  Cells<T> out;
  out.node = kWraps ? floored(place) : truncated(place);
  out.share = place - as_number(out.node);
  out.turns = IndexOf<T>{};
  if constexpr (kWraps) {
    for (int k = 0; k < periods; ++k) {
      const auto low = out.node < 0, high = out.node >= n;
      out.node += chosen(low, n, 0) - chosen(high, n, 0);
      out.turns += chosen(high, 1, 0) - chosen(low, 1, 0);
    }
  }
  return out;
}

// Integrals of rows, from their beginning to a share beyond the node `at`; `later` nodes on.
template <class T>
[[gnu::always_inline]] inline T GapTable::row_integrals(const IndexOf<T>& at, int later,
                                                        const T& share) const {
  const auto [here, next] = pairs_at(value_.data() + later, at);
  return values_at(prefix_.data() + later, at) + share * (here + 0.5 * share * (next - here));
}

// Integral along a row at v, between two rows of pixels.
template <bool kWraps, class T>
[[gnu::always_inline]] inline T GapTable::chord(const T& from, const T& to, const T& v,
                                                int periods) const {
  const Cells<T> row = cells<kWraps>(v, grid_.ny, periods);
  const IndexOf<T> first = row.node * stride_;
  const auto integral = [&](const T& u) __attribute__((always_inline)) {
    const Cells<T> column = cells<kWraps>(u, grid_.nx, periods);
    T low{}, high{};
    if constexpr (kWraps) {
      const T turns = as_number(column.turns);
      low = turns * values_at(prefix_.data() + grid_.nx, first);
      high = turns * values_at(prefix_.data() + grid_.nx + stride_, first);
    }
    low += row_integrals<T>(first + column.node, 0, column.share);
    high += row_integrals<T>(first + column.node, stride_, column.share);
    return low + row.share * (high - low);
  };
  return integral(to) - integral(from);
}

template <bool kWraps, class T>
[[gnu::always_inline]] inline T GapTable::gaps(const T& u, const T& v, int periods) const {
  const Cells<T> row = cells<kWraps>(v, grid_.ny, periods),
                 column = cells<kWraps>(u, grid_.nx, periods);
  const IndexOf<T> node = row.node * stride_ + column.node;
  const auto below = pairs_at(value_.data(), node), above = pairs_at(value_.data() + stride_, node);
  const T low = below.first + column.share * (below.second - below.first);
  const T high = above.first + column.share * (above.second - above.first);
  return low + row.share * (high - low);
}

double GapTable::at(double x, double y) const {
  const Disc d = disc(x, y, 0);
  return d.periods > 0 ? gaps<true>(d.u, d.v, d.periods) : gaps<false>(d.u, d.v, 0);
}

GapTable::Rule GapTable::rule(double radius) const {
  return {count_index(0.75 * radius * inverse_dy_ + 6),
          count_index(4.5 * radius * inverse_dx_ + 6)};
}

GapTable::Disc GapTable::disc(double x, double y, double radius) const {
  Disc d{x * inverse_dx_ - 0.5, y * inverse_dy_ - 0.5, radius * inverse_dx_, radius * inverse_dy_};
  const auto beyond = [](double low, double high, int n) {  // periods, from 0 to n
    if (low >= 0 && high < n) return 0;
    return static_cast<int>(std::max(std::ceil(-low / n), std::floor(high / n)));
  };
  // A gap between nodes asks for the one above.
  d.periods = std::max(beyond(d.u - d.ru, d.u + d.ru + 1, grid_.nx),
                       beyond(d.v - d.rv, d.v + d.rv + 1, grid_.ny));
  return d;
}

double GapTable::disc_volume(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = Nodes::of(rule.chords);
  const Disc d = disc(x, y, radius);
  const auto volume = [&](auto wraps) {
    return sum_over(n.t.size(), [&](auto at) {
      const auto half = d.ru * at(n.half_width);
      return at(n.weight) * chord<wraps>(d.u - half, d.u + half, d.v + d.rv * at(n.t), d.periods);
    });
  };
  return (d.periods > 0 ? volume(std::true_type()) : volume(std::false_type())) * grid_.dx() *
         radius;
}

std::array<double, 8> GapTable::around(double x, double y, double step) const {
  const Disc d = disc(x, y, step);
  std::array<double, 8> out;
  const auto look = [&](auto wraps) {
    for_each_pixel(out.size(), [&](auto at) {
      at.store(out, gaps<wraps>(d.u + d.ru * at(kDirections.x), d.v + d.rv * at(kDirections.y),
                                d.periods));
    });
  };
  d.periods > 0 ? look(std::true_type()) : look(std::false_type());
  return out;
}

// From two circles around the rim, exact for a bowl. Where the circle crosses a wall, slopes of
// single pixels would be what the grid makes of a jump; the difference of two means has a limit.
GapTable::Rim GapTable::rim(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = Nodes::of(rule.rim_points);
  const double half = kRimHalfWidth * radius;
  const Disc smaller_circle = disc(x, y, radius - half), larger_circle = disc(x, y, radius + half);
  // Means on two circles about one place: one look at each direction.
  const auto means = [&](auto wraps) {
    return reduce(n.cosine.size(), [&](auto at) {
      const auto c = at(n.cosine), s = at(n.sine), share = at(n.share);
      const auto on = [&](const Disc& circle) __attribute__((always_inline)) {
        return share *
               gaps<wraps>(circle.u + circle.ru * c, circle.v + circle.rv * s, circle.periods);
      };
      return std::tuple(on(smaller_circle), on(larger_circle));
    });
  };
  const auto [in, out] =
      larger_circle.periods > 0 ? means(std::true_type()) : means(std::false_type());
  const double slope = (out - in) / (2 * half);
  return {0.5 * (in + out) - 0.5 * kRimHalfWidth * half * slope, slope};
}

}  // namespace papilla::capillary
