#include "physics/electrostatics/electrode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::electrostatics {
namespace {

constexpr double kSame = 1e-12;          // [m] heights closer than this are one
constexpr double kThinnestFilm = 1e-10;  // [m] of a planar film that its texture cuts through

// Extremes of a periodic row over `reach` places either side: two passes of blocks as long as the
// window, so that the cost does not depend on it.
class RowExtremes {
 public:
  RowExtremes(int n, int reach)
      : n_(n), reach_(reach), window_(2 * reach + 1), wide_(n + 2 * reach), ahead_(wide_.size()) {}

  template <class Better>
  void operator()(const double* in, Better&& better, double* out) {
    const int padded = n_ + 2 * reach_;
    for (int i = 0, from = wrap(-reach_, n_); i < padded; ++i) {
      wide_[i] = in[from];
      if (++from == n_) from = 0;
    }
    for (int i = 0, in_block = 0; i < padded; ++i) {
      ahead_[i] = in_block == 0 ? wide_[i] : better(ahead_[i - 1], wide_[i]);
      if (++in_block == window_) in_block = 0;
    }
    double behind = 0;  // of the block, from its end
    for (int i = padded - 1, in_block = i % window_; i >= 0; --i) {
      const bool ends = in_block == window_ - 1 || i == padded - 1;
      behind = ends ? wide_[i] : better(behind, wide_[i]);
      if (in_block-- == 0) in_block = window_ - 1;
      if (i < n_) out[i] = better(behind, ahead_[i + window_ - 1]);
    }
  }

 private:
  int n_, reach_, window_;
  std::vector<double> wide_, ahead_;
};

// Extremes over the square of nx by ny places either side of each pixel.
template <class Better>
std::vector<double> extremes(const Grid& g, const std::vector<double>& z, int nx, int ny,
                             Better&& better) {
  std::vector<double> rows(z.size()), column(g.ny), most(g.ny), out(z.size());
  RowExtremes along_x(g.nx, nx), along_y(g.ny, ny);
  for (int iy = 0; iy < g.ny; ++iy) along_x(&z[g.index(0, iy)], better, &rows[g.index(0, iy)]);
  for (int ix = 0; ix < g.nx; ++ix) {
    for (int iy = 0; iy < g.ny; ++iy) column[iy] = rows[g.index(ix, iy)];
    along_y(column.data(), better, most.data());
    for (int iy = 0; iy < g.ny; ++iy) out[g.index(ix, iy)] = most[iy];
  }
  return out;
}

int reach_of(double distance, double step, int n) {
  return std::min(static_cast<int>(distance / step), (n - 1) / 2);
}

// Rows of a periodic field with `margin` places more on either side: a window of a row is one
// piece.
class WideRows {
 public:
  WideRows(const Grid& g, const std::vector<double>& z, int margin)
      : ny_(g.ny), width_(static_cast<std::size_t>(g.nx) + 2 * margin) {
    wide_.reserve(width_ * g.ny);
    for (int iy = 0; iy < g.ny; ++iy) {
      const auto row = z.begin() + static_cast<std::ptrdiff_t>(g.index(0, iy));
      wide_.insert(wide_.end(), row + (g.nx - margin), row + g.nx);
      wide_.insert(wide_.end(), row, row + g.nx);
      wide_.insert(wide_.end(), row, row + margin);
    }
  }
  // From `margin` places before a pixel on; iy up to a period away.
  const double* around(int ix, int iy) const {
    return &wide_[static_cast<std::size_t>(wrap(iy, ny_)) * width_ + ix];
  }

 private:
  int ny_;
  std::size_t width_;
  std::vector<double> wide_;
};

// Calls row(j) for j = 0, 1, -1, 2, -2 ... up to `reach`, until both rows of a distance say that
// nothing beyond can matter.
template <class Row>
void for_each_row(int reach, Row&& row) {
  if (!row(0)) return;
  for (int j = 1; j <= reach; ++j) {
    const bool north = row(j), south = row(-j);
    if (!north && !south) return;
  }
}

// Shortest distance from the surface to the electrode [m], where that is nearer beside a pixel than
// below it.
std::vector<double> nearest_electrode(const Heightmap& surface,
                                      const std::vector<double>& electrode,
                                      const std::vector<double>& film) {
  const Grid& g = surface.grid;
  const double thickest = *std::max_element(film.begin(), film.end());
  const int nx = reach_of(thickest, g.dx(), g.nx), ny = reach_of(thickest, g.dy(), g.ny);
  const std::vector<double> highest =
      extremes(g, electrode, nx, ny, [](double a, double b) { return std::max(a, b); });
  const WideRows wide(g, electrode, nx);
  const int window = 2 * nx + 1;
  std::vector<double> along(window);  // squared distance of its places
  for (int k = 0; k < window; ++k) along[k] = square((k - nx) * g.dx());
  std::vector<double> out = film;
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      if (highest[i] <= electrode[i] + kSame) continue;
      double best = square(film[i]);
      const double z = surface.z[i];
      for_each_row(ny, [&](int j) {
        const double across = square(j * g.dy());
        if (across >= best) return false;
        const double *row = wide.around(ix, iy + j), *beside = along.data();
        double nearest = best;
#pragma omp simd reduction(min : nearest)
        for (int k = 0; k < window; ++k) {
          const double distance2 = across + beside[k] + (z - row[k]) * (z - row[k]);
          nearest = distance2 < nearest ? distance2 : nearest;
        }
        best = nearest;
        return true;
      });
      out[i] = std::sqrt(best);
    }
  }
  return out;
}

// d/eps of columns whose parts lie in layers of these permittivities.
void add_layer(std::vector<double>& dielectric, const std::vector<double>& upper,
               const std::vector<double>& lower, double permittivity) {
  for (std::size_t i = 0; i < dielectric.size(); ++i)
    dielectric[i] += (upper[i] - lower[i]) / permittivity;
}

}  // namespace

std::vector<FilmLayer> film_layers(const Surface& surface) {
  std::vector<FilmLayer> out;
  for (const FilmDielectric& d : surface.dielectric)
    out.push_back({d.made_by(surface.process), surface.step_coverage, d.thickness, d.permittivity});
  return out;
}

Heightmap below_layer(const Heightmap& surface, double thickness, double side_thickness) {
  const Grid& g = surface.grid;
  Heightmap below{g, surface.z};
  for (double& z : below.z) z -= thickness;
  const int nx = reach_of(side_thickness, g.dx(), g.nx),
            ny = reach_of(side_thickness, g.dy(), g.ny);
  if (thickness <= 0 || (nx == 0 && ny == 0)) return below;
  const std::vector<double> lowest =
      extremes(g, surface.z, nx, ny, [](double a, double b) { return std::min(a, b); });
  // Height of the ellipsoid over its lowest point, by row.
  const int window = 2 * nx + 1;
  std::vector<double> cap(static_cast<std::size_t>(window) * (ny + 1));
  for (int j = 0; j <= ny; ++j) {
    for (int k = 0; k < window; ++k) {
      const double r2 = (square((k - nx) * g.dx()) + square(j * g.dy())) / square(side_thickness);
      cap[static_cast<std::size_t>(j) * window + k] =
          r2 < 1 ? thickness * (1 - std::sqrt(1 - r2)) : kInfinity;
    }
  }
  const WideRows wide(g, surface.z, nx);
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      const std::size_t i = g.index(ix, iy);
      if (lowest[i] >= surface.z[i] - kSame) continue;  // nothing beside is lower
      double least = surface.z[i];
      for_each_row(ny, [&](int j) {
        const double* c = &cap[static_cast<std::size_t>(std::abs(j)) * window];
        if (lowest[i] + c[nx] >= least) return false;
        const double* row = wide.around(ix, iy + j);
        double low = least;
#pragma omp simd reduction(min : low)
        for (int k = 0; k < window; ++k) low = row[k] + c[k] < low ? row[k] + c[k] : low;
        least = low;
        return true;
      });
      below.z[i] = least - thickness;
    }
  }
  return below;
}

CoveredSurface::CoveredSurface(Heightmap surface, const std::vector<FilmLayer>& layers)
    : height(std::move(surface)), film(height.z.size(), 0), dielectric(film) {
  double planar = 0;
  for (const FilmLayer& l : layers) {
    if (l.process == FilmProcess::Planar) planar += l.thickness;
  }
  Heightmap lower = height;
  for (std::size_t k = layers.size(); k-- > 0;) {
    const FilmLayer& l = layers[k];
    if (l.process == FilmProcess::Planar) continue;
    const double side = l.process == FilmProcess::Conformal ? 1 : l.step_coverage;
    Heightmap next = below_layer(lower, l.thickness, side * l.thickness);
    add_layer(dielectric, lower.z, next.z, l.permittivity);
    lower = std::move(next);
  }
  if (planar > 0) {
    double total = 0;
    for (const FilmLayer& l : layers) total += l.thickness;
    // The uppermost planar layer carries the texture; those below it are whole.
    double top = -total;
    const FilmLayer* cut = nullptr;
    for (const FilmLayer& l : layers) {
      if (l.process != FilmProcess::Planar) continue;
      if (cut) {
        for (double& d : dielectric) d += cut->thickness / cut->permittivity;
        top += cut->thickness;
      }
      cut = &l;
    }
    std::size_t bare = 0;
    for (std::size_t i = 0; i < lower.z.size(); ++i) {
      const double left = lower.z[i] - top;
      if (left < kThinnestFilm) ++bare;
      dielectric[i] += std::max(left, kThinnestFilm) / cut->permittivity;
    }
    cut_through = static_cast<double>(bare) / static_cast<double>(dielectric.size());
    for (double& z : lower.z) z = std::min(z - kThinnestFilm, -total);
  }
  for (std::size_t i = 0; i < film.size(); ++i) film[i] = height.z[i] - lower.z[i];
  effective = dielectric;
  if (film.empty() || *std::max_element(film.begin(), film.end()) <= 0) return;
  const std::vector<double> near = nearest_electrode(height, lower.z, film);
  for (std::size_t i = 0; i < film.size(); ++i) {
    if (near[i] >= film[i] - kSame) continue;
    walls = true;
    const double beside = dielectric[i] * near[i] / film[i];
    effective[i] = 2 * dielectric[i] * beside / (dielectric[i] + beside);
  }
}

}  // namespace papilla::electrostatics
