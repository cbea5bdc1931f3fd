#include "physics/electrostatics/electrode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace papilla::electrostatics {
namespace {

constexpr double kSame = 1e-12;          // [m] heights closer than this are one
constexpr double kThinnestFilm = 1e-10;  // [m] of a planar film that its texture cuts through

int reach_of(double distance, double step, int n) {
  return std::min(static_cast<int>(distance / step), (n - 1) / 2);
}

// A periodic field whose rows have `margin` places more on either side, and what is in each.
class WideRows {
 public:
  WideRows(const Grid& g, const std::vector<double>& z, int margin)
      : ny_(g.ny), margin_(margin), width_(static_cast<std::size_t>(g.nx + 2 * margin)) {
    wide_.reserve(width_ * g.ny);
    for (int iy = 0; iy < g.ny; ++iy) {
      const auto row = z.begin() + static_cast<std::ptrdiff_t>(g.index(0, iy));
      wide_.insert(wide_.end(), row + (g.nx - margin), row + g.nx);
      wide_.insert(wide_.end(), row, row + g.nx);
      wide_.insert(wide_.end(), row, row + margin);
      const auto [low, high] = std::minmax_element(row, row + g.nx);
      low_.push_back(*low);
      high_.push_back(*high);
    }
  }
  // The row `iy`, up to a period away, from place `shift`, at most the margin away, on.
  const double* from(int shift, int iy) const {
    return &wide_[static_cast<std::size_t>(wrap(iy, ny_)) * width_ + margin_ + shift];
  }
  double low(int iy) const { return low_[wrap(iy, ny_)]; }
  double high(int iy) const { return high_[wrap(iy, ny_)]; }

 private:
  int ny_, margin_;
  std::size_t width_;
  std::vector<double> wide_, low_, high_;
};

// Shortest distance from the surface to the electrode [m], where that is nearer beside a pixel than
// below it.
std::vector<double> nearest_electrode(const Heightmap& surface,
                                      const std::vector<double>& electrode,
                                      const std::vector<double>& film) {
  const Grid& g = surface.grid;
  const double thickest = *std::max_element(film.begin(), film.end());
  const int nx = reach_of(thickest, g.dx(), g.nx), ny = reach_of(thickest, g.dy(), g.ny);
  const WideRows below(g, electrode, nx), above(g, surface.z, 0), between(g, film, 0);
  std::vector<double> out(film.size());
  for (int iy = 0; iy < g.ny; ++iy) {
    const double *z = above.from(0, iy), *own = between.from(0, iy);
    double* best = &out[g.index(0, iy)];  // squared
    for (int ix = 0; ix < g.nx; ++ix) best[ix] = own[ix] * own[ix];
    for (int j = -ny; j <= ny; ++j) {
      // No place of that row is nearer than this in height.
      const double drop = std::max(0.0, above.low(iy) - below.high(iy + j));
      for (int k = -nx; k <= nx; ++k) {
        const double beside = square(k * g.dx()) + square(j * g.dy());
        if (!(beside + square(drop) < square(between.high(iy)))) continue;
        const double* there = below.from(k, iy + j);
#pragma omp simd
        for (int ix = 0; ix < g.nx; ++ix) {
          const double distance2 = beside + (z[ix] - there[ix]) * (z[ix] - there[ix]);
          best[ix] = distance2 < best[ix] ? distance2 : best[ix];
        }
      }
    }
    for (int ix = 0; ix < g.nx; ++ix) best[ix] = std::sqrt(best[ix]);
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
  const int nx = reach_of(side_thickness, g.dx(), g.nx),
            ny = reach_of(side_thickness, g.dy(), g.ny);
  if (thickness <= 0) return below;
  // Places beside a pixel, and how high the ellipsoid is there over its lowest point.
  struct Beside {
    int j, k;
    double cap;
  };
  std::vector<Beside> places;
  for (int j = -ny; j <= ny; ++j) {
    for (int k = -nx; k <= nx; ++k) {
      const double r2 = (square(k * g.dx()) + square(j * g.dy())) / square(side_thickness);
      if (r2 < 1) places.push_back({j, k, thickness * (1 - std::sqrt(1 - r2))});
    }
  }
  const WideRows above(g, surface.z, nx);
  for (int iy = 0; iy < g.ny; ++iy) {
    double* least = &below.z[g.index(0, iy)];
    for (const auto& [j, k, cap] : places) {
      // No place of that row is lower by as much.
      if (cap >= above.high(iy) - above.low(iy + j)) continue;
      const double *there = above.from(k, iy + j), up = cap;
#pragma omp simd
      for (int ix = 0; ix < g.nx; ++ix) {
        const double z = there[ix] + up;
        least[ix] = z < least[ix] ? z : least[ix];
      }
    }
  }
  for (double& z : below.z) z -= thickness;
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
