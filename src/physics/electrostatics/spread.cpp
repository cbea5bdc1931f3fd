#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "numerics/convolution.h"
#include "numerics/fft.h"
#include "numerics/loops.h"
#include "numerics/reductions.h"
#include "physics/electrostatics/pull.h"
#include "physics/electrostatics/screening.h"
#include "physics/electrostatics/water_bodies.h"

namespace papilla::electrostatics {
namespace {

constexpr int kMaxIterations = 60;
// Residuals down to this are found in single precision, half the time: what it rounds, a part in
// 10^7 of each number, is a thousandth of them and less.
constexpr double kSinglePrecision = 1e-3;

// Multiplication by a symbol in Fourier space: vector registers where the grid suits them.
template <class Real>
class Filter {
 public:
  explicit Filter(const Grid& grid) {
    if (BasicConvolution<Real>::suits(grid.nx, grid.ny)) {
      fast_ = BasicConvolution<Real>::shared(grid.nx, grid.ny);
      scratch_.resize(fast_->scratch_size());
    } else {
      fft_ = Fft2d::shared(grid.nx, grid.ny);
      values_.resize(fft_->real_size());
      spectrum_.resize(fft_->spectrum_size());
    }
  }

  // From the values on the half spectrum of Fft2d, the transforms' scale included.
  AlignedArray<Real> symbol(const RealArray& half) const {
    return fast_ ? fast_->arrange(half) : AlignedArray<Real>(half.begin(), half.end());
  }

  void apply(const UnsetArray<Real>& in, const AlignedArray<Real>& symbol, UnsetArray<Real>& out) {
    if (fast_) return fast_->apply(in.data(), symbol, scratch_.data(), out.data());
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = in[i];
    fft_->forward(values_.data(), spectrum_.data());
    for (std::size_t o = 0; o < symbol.size(); ++o) spectrum_[o] *= static_cast<double>(symbol[o]);
    fft_->inverse(spectrum_.data(), values_.data());
    for (std::size_t i = 0; i < values_.size(); ++i) out[i] = static_cast<Real>(values_[i]);
  }

 private:
  std::shared_ptr<const BasicConvolution<Real>> fast_;  // or, where it is null:
  std::shared_ptr<const Fft2d> fft_;
  AlignedArray<std::complex<Real>> scratch_;
  RealArray values_;
  SpectrumArray spectrum_;
};

// What the film answers to potentials on it, K: of a flat layer of one thickness.
template <class Real>
struct FilmResponse {
  RealArray half;             // on the half spectrum of Fft2d [1/m]
  double mean;                // what K couples a pixel with [1/m]
  AlignedArray<Real> symbol;  // as Filter takes it, with the transforms' scale
};

template <class Real>
FilmResponse<Real> film_response(const Grid& grid, double thickness, double permittivity) {
  const double scale = 1 / static_cast<double>(grid.size());  // of the unnormalised transforms
  const int half = grid.nx / 2 + 1;
  RealArray k(static_cast<std::size_t>(half) * grid.ny), scaled(k.size());
  for (int iy = 0; iy <= grid.ny / 2; ++iy) {
    const double qy = 2 * kPi * iy / grid.ly;
    for (int ix = 0; ix < half; ++ix) {
      const double q = std::sqrt(square(2 * kPi * ix / grid.lx) + square(qy));
      const double response =
          q > 0 ? permittivity * q / std::tanh(q * thickness) : permittivity / thickness;
      for (int mirrored : {iy, (grid.ny - iy) % grid.ny}) {
        k[static_cast<std::size_t>(mirrored) * half + ix] = response;
      }
    }
  }
  for (std::size_t o = 0; o < k.size(); ++o) scaled[o] = scale * k[o];
  const double mean = sum(k) / static_cast<double>(k.size());
  return {std::move(k), mean, Filter<Real>(grid).symbol(scaled)};
}

// The same for every skin and humidity of a design.
template <class Real>
std::shared_ptr<const FilmResponse<Real>> known_film_response(const Grid& grid, double thickness,
                                                              double permittivity) {
  using Key = std::tuple<Grid, double, double>;
  constexpr double kMostBytes = 64e6;
  static Cache<Key, FilmResponse<Real>> cache(16, kMostBytes);
  return cache.get({grid, thickness, permittivity},
                   2 * sizeof(double) * static_cast<double>(grid.size()), [&] {
                     return std::make_shared<const FilmResponse<Real>>(
                         film_response<Real>(grid, thickness, permittivity));
                   });
}

// What the potential on the film depends on beside K, per pixel.
struct Columns {
  const Gap& gap;
  const AirColumns& above;
  double skin_layer;                      // d/eps [m]
  const std::vector<double>& dielectric;  // d/eps [m]
  const WaterBodies& water;
  double water_skin_layer;  // d/eps [m]

  // From the film to the skin [m].
  template <class At>
  auto distance(const At& at) const {
    const auto air = at(above.air);
    const auto known = !(air < 0);
    return to_skin(chosen(known, air, at(gap.value)), chosen(known, at(above.water, 0), 0.0),
                   skin_layer);
  }
};

// phi for one volt on the electrode: K phi + (1/D - eps/d + c) phi = 1/D; K of a flat layer of the
// mean thickness d, D the d/eps of each column, c one over its distance to the skin, under water
// one over the skin's layer. Each body of water has one potential: of the equations under it the
// sum counts, that is what charges the body. Conjugate gradients among such potentials,
// preconditioned by 1/(K + mean of the rest) between weights that follow it, and each body by
// itself. Eq. electrostatics.16
template <class Real>
class SurfacePotential {
 public:
  SurfacePotential(const Columns& columns, double thickness, double permittivity)
      : filter_(columns.gap.grid),
        film_(known_film_response<Real>(columns.gap.grid, thickness, permittivity)),
        n_(columns.gap.grid.size()),
        water_(columns.water),
        c_(n_),
        drive_(n_),
        start_(n_),
        weight_(n_) {
    const auto flat = static_cast<Real>(permittivity / thickness);
    UnsetArray<Real>& distance = start_;
    for_each_pixel(n_, [&](auto at) {
      at.store(distance, columns.distance(at));
      at.store(drive_, at(columns.dielectric));
    });
    if (!water_.grounded()) {
      for (const std::size_t i : water_.pixels())
        distance[i] = static_cast<Real>(columns.water_skin_layer);
    }
    // Contact spots of a bare skin raise c by orders of magnitude over a few pixels: the weight
    // follows c where it exceeds what K couples a pixel with, k; the rest is left to K + mean c,
    // the mean taken as 1/(k + c).
    const auto k = static_cast<Real>(film_->mean);
    const double all = sum_over<Real>(n_, [&](auto at) {
      const auto drive = Real{1} / at(drive_), conductance = Real{1} / at(distance);
      at.store(drive_, drive);
      // The columns by themselves.
      at.store(start_, drive / (drive + conductance));
      // At least what keeps the sum with K positive.
      const auto c = conductance + (drive - flat), weight = Real{1} / (k + c);
      at.store(c_, c);
      at.store(weight_, weight);
      return weight;
    });
    const double level = static_cast<double>(n_) / all;  // k + mean c
    for_each_pixel<Real>(
        n_, [&](auto at) { at.store(weight_, root(static_cast<Real>(level) * at(weight_))); });
    water_.level(start_, own_place);
    water_.each([&](const std::size_t* begin, const std::size_t* end) {
      const auto pixels = static_cast<double>(end - begin);
      double sum = 0;
      for (const std::size_t* p = begin; p != end; ++p) {
        sum += c_[*p];
        weight_[*p] = 0;
      }
      // K of one pixel and of a body that covers all, between them by its edge.
      const double flat_film = film_->half[0];
      const double coupled = flat_film + (film_->mean - flat_film) / std::sqrt(pixels);
      of_body_.push_back(water_.grounded() ? 0 : pixels / (sum + pixels * coupled));
    });
    RealArray inverse(film_->half.size());
    const double scale = 1 / static_cast<double>(n_);
    for (std::size_t o = 0; o < inverse.size(); ++o) {
      inverse[o] = scale / (film_->half[o] + level - film_->mean);
    }
    inverse_ = filter_.symbol(inverse);
  }

  // Once. Leaves residual (relative, energy norm), iterations and status in `out`.
  std::vector<double> solve(double tolerance, FieldSolution& out) {
    UnsetArray<Real> phi = std::move(start_), r(n_), z(n_), s(n_, 0), q(n_);
    apply(phi, q);
    // The first guess, good to a fraction, gives the scale of the residual.
    const double energy = sum_over<Real>(n_, [&](auto at) {
      const auto drive = at(drive_), left = drive - at(q);
      at.store(r, left);
      at.store(q, at(weight_) * left);
      return at(phi) * drive;
    });
    double old = 0;
    for (out.iterations = 0;; ++out.iterations) {
      water_.level(r, own_place);
      // q: the weighted residual.
      filter_.apply(q, inverse_, z);
      const double rz = weigh(r, z) + charge(r, z);
      out.residual = energy > 0 ? std::sqrt(std::max(rz, 0.0) / energy) : 0;
      if (!std::isfinite(rz) || !std::isfinite(energy) || out.iterations == kMaxIterations) {
        out.ok = false;
        out.reason = fmt::format(
            "the surface potential has not converged: residual {:.1e} after {} iterations, asked "
            "for {:.1e}",
            out.residual, out.iterations, tolerance);
      }
      if (!out.ok || out.residual <= tolerance) return {phi.begin(), phi.end()};
      const auto beta = static_cast<Real>(out.iterations > 0 ? rz / old : 0);
      for_each_pixel<Real>(n_, [&](auto at) { at.store(s, at(z) + beta * at(s)); });
      const auto alpha = static_cast<Real>(rz / apply(s, q));
      for_each_pixel<Real>(n_, [&](auto at) {
        const auto left = at(r) - alpha * at(q);
        at.store(phi, at(phi) + alpha * at(s));
        at.store(r, left);
        at.store(q, at(weight_) * left);
      });
      old = rz;
    }
  }

 private:
  // out = (K + c) in; in . out.
  double apply(const UnsetArray<Real>& in, UnsetArray<Real>& out) {
    filter_.apply(in, film_->symbol, out);
    return sum_over<Real>(n_, [&](auto at) {
      const auto here = at(in), there = at(out) + at(c_) * here;
      at.store(out, there);
      return here * there;
    });
  }
  // z times the weight; r . z.
  double weigh(const UnsetArray<Real>& r, UnsetArray<Real>& z) const {
    return sum_over<Real>(n_, [&](auto at) {
      const auto weighted = at(z) * at(weight_);
      at.store(z, weighted);
      return at(r) * weighted;
    });
  }

  // z of the bodies, each by itself; their part of r . z.
  double charge(const UnsetArray<Real>& r, UnsetArray<Real>& z) const {
    double sum = 0;
    auto of_body = of_body_.begin();
    water_.each([&](const std::size_t* begin, const std::size_t* end) {
      const auto by = static_cast<Real>(*of_body++ * r[*begin]);
      for (const std::size_t* p = begin; p != end; ++p) z[*p] = by;
      sum += static_cast<double>(end - begin) * r[*begin] * by;
    });
    return sum;
  }
  static std::size_t own_place(std::size_t pixel) { return pixel; }

  Filter<Real> filter_;
  std::shared_ptr<const FilmResponse<Real>> film_;
  std::size_t n_;  // pixels
  const WaterBodies& water_;
  UnsetArray<Real> c_;           // beside K [1/m]
  UnsetArray<Real> drive_;       // 1/D [1/m]
  UnsetArray<Real> start_;       // the columns by themselves
  UnsetArray<Real> weight_;      // of the preconditioner, either side of 1/(K + mean c); 0 in water
  std::vector<double> of_body_;  // the preconditioner of each body of water [m]
  AlignedArray<Real> inverse_;   // 1/(K + mean c) as the filter takes it
};

template <class Real>
std::vector<double> surface_potential(const Columns& columns, double permittivity, double tolerance,
                                      FieldSolution& out) {
  const double mean = sum(columns.dielectric) / static_cast<double>(columns.dielectric.size());
  return SurfacePotential<Real>(columns, permittivity * mean, permittivity).solve(tolerance, out);
}

}  // namespace

FieldSolution solve_spread_field(const Gap& gap, const CoveredSurface* surface,
                                 const Wetting& wetting, const FieldProblem& p, double tolerance) {
  if (p.dielectric_thickness <= 0 || holds_all_voltage(p) || (p.v_rms == 0 && p.v_peak == 0))
    return solve_local_field(gap, surface, wetting, p);
  const AirColumns above = columns_above(gap, wetting, p);
  const std::vector<double> flat(surface ? 0 : gap.grid.size(), p.dielectric);
  const WaterBodies water(gap.grid, wetting.bridged, p.water_skin_layer <= 0);
  const Columns columns{gap,
                        above,
                        p.skin_layer.real(),
                        surface ? surface->effective : flat,
                        water,
                        p.water_skin_layer};
  const double permittivity = p.dielectric_thickness / p.dielectric;
  FieldSolution status;
  const std::vector<double> potential =
      tolerance < kSinglePrecision
          ? surface_potential<double>(columns, permittivity, tolerance, status)
          : surface_potential<float>(columns, permittivity, tolerance, status);
  std::vector<double> reach(water.grounded() ? 0 : gap.grid.size());
  if (!water.grounded())
    for_each_pixel(reach.size(), [&](auto at) { at.store(reach, columns.distance(at)); });
  const WallFields wall{potential, columns.dielectric, reach, p.water_skin_layer};
  const std::vector<double> open =
      air_screening_factor(gap, wetting, p.screening, water.grounded() ? nullptr : &wall);
  FieldSolution out = pull(gap, surface, p, above, {.open = open, .potential = potential});
  out.residual = status.residual;
  out.iterations = status.iterations;
  if (out.ok && !status.ok) {
    out.ok = false;
    out.reason = status.reason;
  }
  return out;
}

}  // namespace papilla::electrostatics
