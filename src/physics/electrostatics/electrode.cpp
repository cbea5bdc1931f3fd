#include "physics/electrostatics/electrode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "numerics/loops.h"

namespace papilla::electrostatics {
namespace {

constexpr double kSame = 1e-12;          // [m] heights closer than this are one
constexpr double kThinnestFilm = 1e-10;  // [m] of a planar film that its texture cuts through

constexpr std::size_t kLooks = 16;  // places between two looks at what is still to be lowered
constexpr int kPiece = 64;          // pixels of a row that are looked at together

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
  // The row `iy`, up to a period away, from place `shift` on, at most the margin off its own.
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

// A place beside a pixel, rows and pixels away. far: what it is the farther by, for all pixels
// alike.
struct Beside {
  int j, k;
  double far;
};
bool before(const Beside& a, const Beside& b) { return a.far < b.far; }

// Shortest distance from the surface to the electrode [m], where that is nearer beside a pixel than
// below it.
std::vector<double> nearest_electrode(const Heightmap& surface,
                                      const std::vector<double>& electrode,
                                      const std::vector<double>& film) {
  const Grid& g = surface.grid;
  const double thickest = *std::max_element(film.begin(), film.end());
  const int nx = reach_of(thickest, g.dx(), g.nx), ny = reach_of(thickest, g.dy(), g.ny);
  const WideRows below(g, electrode, nx), above(g, surface.z, 0), between(g, film, 0);
  // Near ones first: they leave little for the others.
  std::vector<Beside> places;
  for (int j = -ny; j <= ny; ++j) {
    for (int k = -nx; k <= nx; ++k)
      places.push_back({j, k, square(k * g.dx()) + square(j * g.dy())});
  }
  std::stable_sort(places.begin(), places.end(), before);
  double highest = below.high(0);  // of the electrode
  for (int iy = 1; iy < g.ny; ++iy) highest = std::max(highest, below.high(iy));
  std::vector<double> out(film.size());
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int from = 0; from < g.nx; from += kPiece) {
      const int n = std::min(kPiece, g.nx - from);
      const double *z = above.from(from, iy), *own = between.from(from, iy);
      const double low = *std::min_element(z, z + n);
      const double least = square(std::max(0.0, low - highest));
      double* best = &out[g.index(from, iy)];  // squared
      for (int ix = 0; ix < n; ++ix) best[ix] = own[ix] * own[ix];
      double worst = *std::max_element(best, best + n);
      for (std::size_t p = 0; p < places.size() && places[p].far + least < worst; ++p) {
        if (p % kLooks == 0) worst = *std::max_element(best, best + n);
        const int j = places[p].j;
        const double beside = places[p].far;
        // No place of that row is nearer than this in height.
        const double drop = std::max(0.0, low - below.high(iy + j));
        if (!(beside + square(drop) < worst)) continue;
        const double* there = below.from(places[p].k + from, iy + j);
        for_each_pixel(static_cast<std::size_t>(n), [&](auto at) {
          const auto above_it = at(z) - at(there);
          at.store(best, smaller(beside + above_it * above_it, at(best)));
        });
      }
      for (int ix = 0; ix < n; ++ix) best[ix] = std::sqrt(best[ix]);
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
  const int nx = reach_of(side_thickness, g.dx(), g.nx),
            ny = reach_of(side_thickness, g.dy(), g.ny);
  if (thickness <= 0) return below;
  // With the height of the ellipsoid over its lowest point. Low ones first: they leave little for
  // the others.
  std::vector<Beside> places;
  for (int j = -ny; j <= ny; ++j) {
    for (int k = -nx; k <= nx; ++k) {
      const double r2 = (square(k * g.dx()) + square(j * g.dy())) / square(side_thickness);
      if (r2 < 1) places.push_back({j, k, thickness * (1 - std::sqrt(1 - r2))});
    }
  }
  std::stable_sort(places.begin(), places.end(), before);
  const WideRows above(g, surface.z, nx);
  const double lowest = *std::min_element(surface.z.begin(), surface.z.end());
  for (int iy = 0; iy < g.ny; ++iy) {
    double* lowest_of_row = &below.z[g.index(0, iy)];
    double worst = above.high(iy);
    for (std::size_t p = 0; p < places.size() && lowest + places[p].far < worst; ++p) {
      if (p % kLooks == 0) worst = *std::max_element(lowest_of_row, lowest_of_row + g.nx);
      const int j = places[p].j, k = places[p].k;
      const double up = places[p].far;
      // No place of that row is lower by as much.
      if (above.low(iy + j) + up >= worst) continue;
      const double* there = above.from(k, iy + j);
      for_each_pixel(static_cast<std::size_t>(g.nx), [&](auto at) {
        at.store(lowest_of_row, smaller(at(there) + up, at(lowest_of_row)));
      });
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
