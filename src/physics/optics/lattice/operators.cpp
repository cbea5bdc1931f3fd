#include "physics/optics/lattice/operators.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "geometry/grid.h"
#include "physics/optics/apertures.h"
#include "physics/optics/transform.h"

namespace papilla::optics {
namespace {

// Fourier coefficient of the inside of the features.
double inside_share(const LatticeCell& c, const LatticeSlice& s, int m, int n) {
  if (c.centred && (m + n) % 2 != 0) return 0;
  const double copies = c.centred ? 2 : 1, area = c.lx * c.ly;
  if (c.shape == LatticeCell::Shape::Disc) {
    const double q = kPi * s.width_x * std::hypot(m / c.lx, n / c.ly);
    return copies * 0.25 * kPi * square(s.width_x) / area * airy(q);
  }
  const double wx = std::min(s.width_x, c.lx), wy = std::min(s.width_y, c.ly);
  return copies * wx * wy / area * sinc(kPi * m * wx / c.lx) * sinc(kPi * n * wy / c.ly);
}

// Direction across the nearest wall, as its squares and product.
struct Normals {
  double xx, xy, yy;
};
Normals normals_at(const LatticeCell& c, const LatticeSlice& s, double x, double y) {
  const bool along_y = s.width_y >= c.ly, along_x = s.width_x >= c.lx;
  if (c.shape == LatticeCell::Shape::Box && along_y) return {1, 0, 0};
  if (c.shape == LatticeCell::Shape::Box && along_x) return {0, 0, 1};
  const auto from = [](double u, double period) { return u - period * std::rint(u / period); };
  double dx = from(x, c.lx), dy = from(y, c.ly);
  if (c.centred) {
    const double ex = from(x - 0.5 * c.lx, c.lx), ey = from(y - 0.5 * c.ly, c.ly);
    if (std::hypot(ex, ey) < std::hypot(dx, dy)) dx = ex, dy = ey;
  }
  if (c.shape == LatticeCell::Shape::Box)
    return std::abs(dx) / s.width_x > std::abs(dy) / s.width_y ? Normals{1, 0, 0}
                                                               : Normals{0, 0, 1};
  const double r2 = std::max(dx * dx + dy * dy, 1e-40);
  return {dx * dx / r2, dx * dy / r2, dy * dy / r2};
}

// Their Fourier coefficients, from pixels: they vary gradually but at the middles of features and
// between them, where nothing else varies.
struct NormalFields {
  Grid grid;
  SpectrumArray xx, xy, yy;
};
std::shared_ptr<const NormalFields> normal_fields(const LatticeCell& cell,
                                                  const LatticeSlice& slice) {
  constexpr int kPixels = 256;
  constexpr std::size_t kMost = 4;
  constexpr double kMostBytes = 64e6;
  using Key = std::tuple<LatticeCell, double>;
  static Cache<Key, NormalFields> kept(kMost, kMostBytes);
  const bool box = cell.shape == LatticeCell::Shape::Box;
  const double shape_of_box = !box                       ? 0
                              : slice.width_y >= cell.ly ? -1
                              : slice.width_x >= cell.lx ? -2
                                                         : slice.width_x / slice.width_y;
  return kept.get({cell, shape_of_box}, 3.0 * kPixels * kPixels * sizeof(Complex), [&] {
    auto out = std::make_shared<NormalFields>();
    out->grid = {kPixels, kPixels, cell.lx, cell.ly};
    const Grid& g = out->grid;
    SpectrumArray xx(g.size()), xy(g.size()), yy(g.size());
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const Normals n = normals_at(cell, slice, g.x(ix), g.y(iy));
        const std::size_t k = g.index(ix, iy);
        xx[k] = n.xx, xy[k] = n.xy, yy[k] = n.yy;
      }
    }
    out->xx = coefficients(g, xx), out->xy = coefficients(g, xy), out->yy = coefficients(g, yy);
    // Pixel centres sit half a pixel in: the coefficients become those about the middle, real.
    for (SpectrumArray* field : {&out->xx, &out->xy, &out->yy}) {
      for (int iy = 0; iy < g.ny; ++iy) {
        for (int ix = 0; ix < g.nx; ++ix) {
          const int m = 2 * ix > g.nx ? ix - g.nx : ix, n = 2 * iy > g.ny ? iy - g.ny : iy;
          Complex& f = (*field)[g.index(ix, iy)];
          f = (f * std::polar(
                       1.0, -kPi * (static_cast<double>(m) / g.nx + static_cast<double>(n) / g.ny)))
                  .real();
        }
      }
    }
    return std::shared_ptr<const NormalFields>(std::move(out));
  });
}

template <class Coefficient>
ComplexMatrix toeplitz(const std::vector<OrderIndex>& orders, const Coefficient& of) {
  std::map<std::pair<int, int>, Complex> known;
  const auto size = static_cast<Eigen::Index>(orders.size());
  ComplexMatrix out(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const auto &a = orders[static_cast<std::size_t>(i)], &b = orders[static_cast<std::size_t>(j)];
      const std::pair<int, int> difference{a.m - b.m, a.n - b.n};
      auto found = known.find(difference);
      if (found == known.end())
        found = known.emplace(difference, of(difference.first, difference.second)).first;
      out(i, j) = found->second;
    }
  }
  return out;
}

// Hermitian: what is lost in the product of two is shared, and power is kept to rounding.
ComplexMatrix symmetric_product(const ComplexMatrix& a, const ComplexMatrix& b) {
  return 0.5 * (a * b + b * a);
}

double largest_index(const LatticeStack& stack) {
  double out = std::max(stack.from, stack.to);
  for (const LatticeSlice& s : stack.slices)
    out = std::max({out, std::sqrt(std::abs(s.inside)), std::sqrt(std::abs(s.outside))});
  return out;
}

}  // namespace

std::vector<OrderIndex> orders_within(const LatticeStack& stack, double wavelength, int beyond) {
  const LatticeCell& c = stack.cell;
  const bool box = c.shape == LatticeCell::Shape::Box;
  const auto varies = [&](auto&& wide) {
    return !box || std::any_of(stack.slices.begin(), stack.slices.end(),
                               [&](const auto& s) { return !s.flat() && !wide(s); });
  };
  const bool along_x = varies([&](const LatticeSlice& s) { return s.width_x >= c.lx; });
  const bool along_y = varies([&](const LatticeSlice& s) { return s.width_y >= c.ly; });
  // Spatial frequencies in units of the shorter period's.
  const double unit = along_x && along_y ? std::min(c.lx, c.ly) : along_x ? c.lx : c.ly;
  const double radius = largest_index(stack) * unit / wavelength + beyond;
  const int mx = along_x ? static_cast<int>(radius * c.lx / unit) : 0;
  const int my = along_y ? static_cast<int>(radius * c.ly / unit) : 0;
  std::vector<OrderIndex> out;
  for (int m = -mx; m <= mx; ++m) {
    for (int n = -my; n <= my; ++n) {
      if (c.centred && (m + n) % 2 != 0) continue;
      if (std::hypot(m * unit / c.lx, n * unit / c.ly) <= radius * (1 + 1e-12))
        out.push_back({m, n});
    }
  }
  return out;
}

Eigen::MatrixXd combinations(const std::vector<OrderIndex>& orders, Mirror x, Mirror y) {
  std::map<std::pair<int, int>, Eigen::Index> place;
  for (std::size_t i = 0; i < orders.size(); ++i)
    place[{orders[i].m, orders[i].n}] = static_cast<Eigen::Index>(i);
  std::vector<Eigen::VectorXd> columns;
  for (const OrderIndex& o : orders) {
    if ((x != Mirror::None && o.m < 0) || (y != Mirror::None && o.n < 0)) continue;  // its mirrors'
    Eigen::VectorXd column = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(orders.size()));
    for (const int sx : {1, -1}) {
      for (const int sy : {1, -1}) {
        if ((x == Mirror::None && sx < 0) || (y == Mirror::None && sy < 0)) continue;
        const double sign =
            (x == Mirror::Odd && sx < 0 ? -1 : 1) * (y == Mirror::Odd && sy < 0 ? -1 : 1);
        column(place.at({sx * o.m, sy * o.n})) += sign;
      }
    }
    if (const double size = column.norm(); size > 0.5) columns.push_back(column / size);
  }
  Eigen::MatrixXd out(static_cast<Eigen::Index>(orders.size()),
                      static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    out.col(static_cast<Eigen::Index>(k)) = columns[k];
  return out;
}

SliceOperators slice_operators(const LatticeCell& cell, const LatticeSlice& slice,
                               const std::vector<OrderIndex>& orders) {
  const auto permittivity = [&](Complex inside, Complex outside) {
    return toeplitz(orders, [&](int m, int n) {
      return (m == 0 && n == 0 ? outside : Complex(0)) +
             (inside - outside) * inside_share(cell, slice, m, n);
    });
  };
  const ComplexMatrix direct = permittivity(slice.inside, slice.outside);
  const ComplexMatrix across =
      permittivity(1.0 / slice.inside, 1.0 / slice.outside).partialPivLu().inverse();
  const ComplexMatrix difference = direct - across;
  const std::shared_ptr<const NormalFields> normals = normal_fields(cell, slice);
  const auto normal = [&](const SpectrumArray& field) {
    const Grid& g = normals->grid;
    return toeplitz(orders,
                    [&](int m, int n) { return field[g.index(wrap(m, g.nx), wrap(n, g.ny))]; });
  };
  return {direct - symmetric_product(difference, normal(normals->xx)),
          -symmetric_product(difference, normal(normals->xy)),
          direct - symmetric_product(difference, normal(normals->yy)),
          direct.partialPivLu().inverse()};
}

}  // namespace papilla::optics
