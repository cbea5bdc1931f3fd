#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "base/convolution.h"
#include "base/fft.h"
#include "base/lanes.h"
#include "physics/electrostatics/pull.h"
#include "physics/electrostatics/screening.h"

namespace papilla::electrostatics {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kLeastDistance = 1e-10;  // [m] of a bare electrode in contact

// Multiplication by a symbol in Fourier space: vector registers where the grid suits them.
class Filter {
 public:
  explicit Filter(const Grid& grid)
      : fft_(Fft2d::shared(grid.nx, grid.ny)),
        fast_(Convolution::suits(grid.nx, grid.ny) ? Convolution::shared(grid.nx, grid.ny)
                                                   : nullptr),
        scratch_(fast_ ? fast_->scratch_size() : fft_->spectrum_size()) {}

  // From the values on the half spectrum of Fft2d, the transforms' scale included.
  RealArray symbol(const RealArray& half) const { return fast_ ? fast_->arrange(half) : half; }

  void apply(const RealArray& in, const RealArray& symbol, RealArray& out) {
    if (fast_) return fast_->apply(in.data(), symbol, scratch_.data(), out.data());
    fft_->forward(in.data(), scratch_.data());
    for (std::size_t o = 0; o < symbol.size(); ++o) scratch_[o] *= symbol[o];
    fft_->inverse(scratch_.data(), out.data());
  }

 private:
  std::shared_ptr<const Fft2d> fft_;
  std::shared_ptr<const Convolution> fast_;
  SpectrumArray scratch_;
};

// What the film answers to potentials on it, K: of a flat layer of one thickness.
struct FilmResponse {
  RealArray half;    // on the half spectrum of Fft2d [1/m]
  double mean;       // what K couples a pixel with [1/m]
  RealArray symbol;  // as Filter takes it, with the transforms' scale
};

FilmResponse film_response(const Grid& grid, double thickness, double permittivity) {
  const Filter filter(grid);
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
  return {std::move(k), mean, filter.symbol(scaled)};
}

// The same for every skin and humidity of a design.
std::shared_ptr<const FilmResponse> known_film_response(const Grid& grid, double thickness,
                                                        double permittivity) {
  using Key = std::tuple<Grid, double, double>;
  constexpr double kMostBytes = 64e6;
  static Cache<Key, FilmResponse> cache(16, kMostBytes);
  return cache.get(
      {grid, thickness, permittivity}, 2 * sizeof(double) * static_cast<double>(grid.size()), [&] {
        return std::make_shared<const FilmResponse>(film_response(grid, thickness, permittivity));
      });
}

// phi for one volt on the electrode: K phi + (1/D - eps/d + c) phi = 1/D, zero on wet pixels; K of
// a flat layer of the mean thickness d, D the d/eps of each column. Conjugate gradients
// preconditioned by 1/(K + mean of the rest) between weights that follow it. Eq. electrostatics.16
class SurfacePotential {
 public:
  // conductance: to the skin [1/m]; dielectric: d/eps of the columns [m].
  SurfacePotential(const Grid& grid, const std::vector<double>& conductance,
                   const std::vector<double>& dielectric, const std::vector<std::uint8_t>& wet,
                   double thickness, double permittivity)
      : filter_(grid),
        film_(known_film_response(grid, thickness, permittivity)),
        c_(conductance),
        dry_(c_.size(), 1),
        drive_(c_.size()),
        start_(c_.size()),
        weight_(c_.size()) {
    const double flat = permittivity / thickness;
    for (std::size_t i = 0; i < wet.size(); ++i) dry_[i] = wet[i] ? 0 : 1;
    for (std::size_t i = 0; i < c_.size(); ++i) {
      drive_[i] = 1 / dielectric[i];
      start_[i] = dry_[i] * drive_[i] / (drive_[i] + c_[i]);
      // At least what keeps the sum with K positive.
      c_[i] += drive_[i] - flat;
    }
    // Contact spots of a bare skin raise c by orders of magnitude over a few pixels: the weight
    // follows c where it exceeds what K couples a pixel with, k; the rest is left to K + mean c,
    // the mean taken as 1/(k + c).
    const double k = film_->mean;
    for (std::size_t i = 0; i < c_.size(); ++i) weight_[i] = 1 / (k + c_[i]);
    const double level = static_cast<double>(c_.size()) / sum(weight_);  // k + mean c
    for (std::size_t i = 0; i < c_.size(); ++i)
      weight_[i] = dry_[i] * std::sqrt(level * weight_[i]);
    RealArray inverse(film_->half.size());
    const double scale = 1 / static_cast<double>(grid.size());
    for (std::size_t o = 0; o < inverse.size(); ++o) {
      inverse[o] = scale / (film_->half[o] + level - k);
    }
    inverse_ = filter_.symbol(inverse);
  }

  // Once. Leaves residual (relative, energy norm), iterations and status in `out`.
  RealArray solve(double tolerance, FieldSolution& out) {
    const std::size_t n = c_.size();
    RealArray phi = std::move(start_), r(n), z(n), s(n, 0.0), q(n);
    apply(phi, q);
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = dry_[i] * drive_[i] - q[i];
      q[i] = weight_[i] * r[i];
    }
    // The first guess, good to a fraction, gives the scale of the residual.
    const double energy = dot(phi, drive_);
    double old = 0;
    for (out.iterations = 0;; ++out.iterations) {
      // q: the weighted residual.
      filter_.apply(q, inverse_, z);
      const double rz = weigh(r, z);
      out.residual = energy > 0 ? std::sqrt(std::max(rz, 0.0) / energy) : 0;
      if (!std::isfinite(rz) || !std::isfinite(energy) || out.iterations == kMaxIterations) {
        out.ok = false;
        out.reason = fmt::format(
            "the surface potential has not converged: residual {:.1e} after {} iterations, asked "
            "for {:.1e}",
            out.residual, out.iterations, tolerance);
      }
      if (!out.ok || out.residual <= tolerance) return phi;
      const double beta = out.iterations > 0 ? rz / old : 0;
      for (std::size_t i = 0; i < n; ++i) s[i] = z[i] + beta * s[i];
      const double alpha = rz / apply(s, q);
      for (std::size_t i = 0; i < n; ++i) {
        phi[i] += alpha * s[i];
        r[i] -= alpha * q[i];
        q[i] = weight_[i] * r[i];
      }
      old = rz;
    }
  }

 private:
  // out = (K + c) in on dry pixels; in . out.
  double apply(const RealArray& in, RealArray& out) {
    filter_.apply(in, film_->symbol, out);
    Lanes sums{};
    for (std::size_t i = 0; i < out.size(); i += kLanes) {
      const Lanes here = lanes_at(in, i);
      const Lanes there = lanes_at(dry_, i) * (lanes_at(out, i) + lanes_at(c_, i) * here);
      store_lanes(there, out, i);
      sums += here * there;
    }
    return total(sums);
  }
  // z times the weight; r . z.
  double weigh(const RealArray& r, RealArray& z) const {
    Lanes sums{};
    for (std::size_t i = 0; i < z.size(); i += kLanes) {
      const Lanes weighted = lanes_at(z, i) * lanes_at(weight_, i);
      store_lanes(weighted, z, i);
      sums += lanes_at(r, i) * weighted;
    }
    return total(sums);
  }

  Filter filter_;
  std::shared_ptr<const FilmResponse> film_;
  std::vector<double> c_;  // beside K [1/m]
  RealArray dry_;          // 0 under bridges, 1 elsewhere
  RealArray drive_;        // 1/D [1/m]
  RealArray start_;        // the columns by themselves, 0 under bridges
  RealArray weight_;       // of the preconditioner, either side of 1/(K + mean c)
  RealArray inverse_;      // 1/(K + mean c) as the filter takes it
};

}  // namespace

FieldSolution solve_spread_field(const Gap& gap, const CoveredSurface* surface,
                                 const Wetting& wetting, const FieldProblem& p, double tolerance) {
  if (p.dielectric_thickness <= 0 || holds_all_voltage(p) || (p.v_rms == 0 && p.v_peak == 0))
    return solve_local_field(gap, surface, wetting, p);
  const AirColumns columns = columns_above(gap, wetting, p);
  const std::size_t n = gap.grid.size();
  std::vector<double> conductance(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double above = columns.air[i] < 0 ? gap.value[i] : columns.air[i];
    conductance[i] = above + p.skin_layer.real();
  }
  if (!columns.water.empty()) {
    for (std::size_t i = 0; i < n; ++i) {
      if (columns.air[i] >= 0) conductance[i] += columns.water[i] / kWaterPermittivity;
    }
  }
  for (double& c : conductance) c = 1 / (c > kLeastDistance ? c : kLeastDistance);
  FieldSolution status;
  const double permittivity = p.dielectric_thickness / p.dielectric;
  const std::vector<double> flat(surface ? 0 : n, p.dielectric);
  const std::vector<double>& dielectric = surface ? surface->effective : flat;
  const double mean = sum(dielectric) / static_cast<double>(n);
  SurfacePotential potential(gap.grid, conductance, dielectric, wetting.bridged,
                             permittivity * mean, permittivity);
  const RealArray phi = potential.solve(tolerance, status);
  std::vector<double> gain(n), voltage(n);
  for (std::size_t i = 0; i < n; ++i) {
    // The flux over that of the column alone.
    gain[i] = square(phi[i] * (1 + dielectric[i] * conductance[i]));
    const double flux = (1 - phi[i]) / dielectric[i];
    voltage[i] = (1 - phi[i]) / std::sqrt(1 + square(flux * p.skin_layer.imag()));
  }
  const std::vector<double> open = air_screening_factor(gap, wetting, p.screening);
  FieldSolution out =
      pull(gap, surface, p, columns, {.open = open, .gain = gain, .voltage = voltage});
  out.residual = status.residual;
  out.iterations = status.iterations;
  if (out.ok && !status.ok) {
    out.ok = false;
    out.reason = status.reason;
  }
  return out;
}

}  // namespace papilla::electrostatics
