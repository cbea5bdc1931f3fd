#include "physics/capillary/gap_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/constants.h"
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
  // the second kind: exact for the disc of a constant gap).
  std::vector<double> t, half_width, weight;
  std::vector<double> cosine, sine;  // rim

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
      }
    }
    return all;
  }();
  return table[static_cast<std::size_t>(rule)];
}

namespace {

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

// Whole part below u.
inline GapTable::Index GapTable::floor_of(const Four& u) {
  const Index cut = __builtin_convertvector(u, Index);  // towards 0
  return cut + __builtin_convertvector(u < __builtin_convertvector(cut, Four), Index);
}

// Brings four indices, at most `periods` away, into [0, n); the whole periods that they were away.
inline GapTable::Index GapTable::wrapped(Index& i, int n, int periods) {
  Index turns{};
  for (int k = 0; k < periods; ++k) {
    const Index low = i < 0, high = i >= n;  // -1 where it is so
    i += (low & n) - (high & n);
    turns += low - high;
  }
  return turns;
}

// The values at four places and the ones after them.
[[gnu::always_inline]] inline GapTable::Neighbours GapTable::neighbours(const double* values,
                                                                        const Index& at) {
  const auto pair = [&](int k) { return load<Two>(values + static_cast<unsigned>(at[k])); };
  const Four even = __builtin_shufflevector(pair(0), pair(2), 0, 1, 2, 3),
             odd = __builtin_shufflevector(pair(1), pair(3), 0, 1, 2, 3);
  return {__builtin_shufflevector(even, odd, 0, 4, 2, 6),
          __builtin_shufflevector(even, odd, 1, 5, 3, 7)};
}

// Integrals of four rows, from their beginning to a share f beyond the node `at`; `later` nodes on.
[[gnu::always_inline]] inline GapTable::Four GapTable::row_integrals(const Index& at, int later,
                                                                     const Four& f) const {
  Four prefix;
  for (int k = 0; k < 4; ++k) prefix[k] = (prefix_.data() + later)[static_cast<unsigned>(at[k])];
  const Neighbours n = neighbours(value_.data() + later, at);
  return prefix + f * (n.here + 0.5 * f * (n.next - n.here));
}

double GapTable::at(double x, double y) const {
  return bilinear(x * inverse_dx_ - 0.5, y * inverse_dy_ - 0.5);
}

[[gnu::always_inline]] inline double GapTable::bilinear(double u, double v) const {
  const Cell cx = locate(u, grid_.nx), cy = locate(v, grid_.ny);
  const double* a = &value_[static_cast<std::size_t>(cy.index) * stride_ + cx.index];
  const double* b = a + stride_;
  const double low = a[0] + cx.fraction * (a[1] - a[0]);
  const double high = b[0] + cx.fraction * (b[1] - b[0]);
  return low + cy.fraction * (high - low);
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

template <bool kWraps>
[[gnu::always_inline]] inline GapTable::Rows GapTable::rows(const Four& v, int periods) const {
  Index low = kWraps ? floor_of(v) : __builtin_convertvector(v, Index);
  const Four share = v - __builtin_convertvector(low, Four);
  if constexpr (kWraps) wrapped(low, grid_.ny, periods);
  return {low * stride_, share};
}

template <bool kWraps>
double GapTable::chords(const Nodes& n, const Disc& d) const {
  const int count = static_cast<int>(n.t.size());
  const double *t = n.t.data(), *half = n.half_width.data(), *weight = n.weight.data();
  Four sums{};
  for (int j = 0; j < count; j += 4) {
    const Rows row = rows<kWraps>(d.v + d.rv * load<Four>(t + j), d.periods);
    // From the beginning of the rows to the places u, between the rows.
    const auto integral = [&](const Four& u) {
      Index ix = kWraps ? floor_of(u) : __builtin_convertvector(u, Index);
      const Four f = u - __builtin_convertvector(ix, Four);
      Four low{}, high{};
      if constexpr (kWraps) {
        const Four turns = __builtin_convertvector(wrapped(ix, grid_.nx, d.periods), Four);
        for (int k = 0; k < 4; ++k) {
          const double* end = prefix_.data() + static_cast<unsigned>(row.low[k] + grid_.nx);
          low[k] = end[0];
          high[k] = end[stride_];
        }
        low *= turns;
        high *= turns;
      }
      low += row_integrals(row.low + ix, 0, f);
      high += row_integrals(row.low + ix, stride_, f);
      return low + row.share * (high - low);
    };
    const Four w = d.ru * load<Four>(half + j);
    sums += load<Four>(weight + j) * (integral(d.u + w) - integral(d.u - w));
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double GapTable::disc_volume(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = Nodes::of(rule.chords);
  const Disc d = disc(x, y, radius);
  return (d.periods > 0 ? chords<true>(n, d) : chords<false>(n, d)) * grid_.dx() * radius;
}

// The gap at four places.
template <bool kWraps>
[[gnu::always_inline]] inline GapTable::Four GapTable::gaps(const Four& u, const Four& v,
                                                            int periods) const {
  const Rows row = rows<kWraps>(v, periods);
  Index ix = kWraps ? floor_of(u) : __builtin_convertvector(u, Index);
  const Four f = u - __builtin_convertvector(ix, Four);
  if constexpr (kWraps) wrapped(ix, grid_.nx, periods);
  const Neighbours below = neighbours(value_.data(), row.low + ix),
                   above = neighbours(value_.data() + stride_, row.low + ix);
  const Four low = below.here + f * (below.next - below.here);
  const Four high = above.here + f * (above.next - above.here);
  return low + row.share * (high - low);
}

std::array<double, 8> GapTable::around(double x, double y, double step) const {
  const Disc d = disc(x, y, step);
  std::array<double, 8> out;
  for (std::size_t k = 0; k < out.size(); k += 4) {
    const Four u = d.u + d.ru * load<Four>(&kDirections.x[k]),
               v = d.v + d.rv * load<Four>(&kDirections.y[k]);
    const Four four = d.periods > 0 ? gaps<true>(u, v, d.periods) : gaps<false>(u, v, 0);
    std::memcpy(&out[k], &four, sizeof four);
  }
  return out;
}

// Means on two circles about one place: one look at each direction.
template <bool kWraps>
GapTable::Pair GapTable::circles(const Nodes& n, const Disc& in, const Disc& out) const {
  const int count = static_cast<int>(n.cosine.size());
  const double *cosine = n.cosine.data(), *sine = n.sine.data();
  Four inner{}, outer{};
  for (int j = 0; j < count; j += 4) {
    const Four c = load<Four>(cosine + j), s = load<Four>(sine + j);
    inner += gaps<kWraps>(in.u + in.ru * c, in.v + in.rv * s, in.periods);
    outer += gaps<kWraps>(out.u + out.ru * c, out.v + out.rv * s, out.periods);
  }
  const auto mean = [&](const Four& f) { return ((f[0] + f[1]) + (f[2] + f[3])) / count; };
  return {mean(inner), mean(outer)};
}

// From two circles around the rim, exact for a bowl. Where the circle crosses a wall, slopes of
// single pixels would be what the grid makes of a jump; the difference of two means has a limit.
GapTable::Rim GapTable::rim(double x, double y, double radius, const Rule& rule) const {
  const Nodes& n = Nodes::of(rule.rim_points);
  const double half = kRimHalfWidth * radius;
  const Disc smaller = disc(x, y, radius - half), larger = disc(x, y, radius + half);
  const auto [in, out] =
      larger.periods > 0 ? circles<true>(n, smaller, larger) : circles<false>(n, smaller, larger);
  const double slope = (out - in) / (2 * half);
  return {0.5 * (in + out) - 0.5 * kRimHalfWidth * half * slope, slope};
}

}  // namespace papilla::capillary
