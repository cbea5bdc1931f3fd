// Nested, stencil-preconditioned conjugate gradients on the full grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/contact.h"

namespace papilla {
namespace {

class DenseSolver {
 public:
  DenseSolver(const ContactKernel& kernel, std::span<const double> g0, double spread,
              const ContactOptions& options)
      : kernel_(kernel),
        grid_(kernel.grid()),
        g0_(g0),
        spread_(spread),
        cap_(options.hardness > 0 ? options.hardness : std::numeric_limits<double>::infinity()),
        options_(options),
        p_(grid_.size()),
        w_(grid_.size()),
        d_(grid_.size(), 0.0),
        u_(grid_.size()),
        scratch_(kernel.fft().spectrum_size()),
        slot_(grid_.size(), -1) {}

  RealArray& pressure() { return p_; }
  const RealArray& gap_function() const { return w_; }
  double pairs() const { return pairs_; }
  int iterations() const { return iterations_; }
  double certificate() const { return certificate_; }
  double shift() const { return shift_; }

  // p_ holds a start with any mean; returns true when certified.
  bool solve(double mean) {
    load_ = mean * static_cast<double>(grid_.size());
    rescale();
    refresh();
    gather();
    double previous_gz = 0;
    bool fresh = true;  // w_ was computed from p_, not by recurrence
    double best = std::numeric_limits<double>::infinity();
    int since_best = 0;
    std::vector<double> old_r;
    bool restart = true;
    for (iterations_ = 0; iterations_ < options_.max_iterations; ++iterations_) {
      certificate_ = certify();
      if (certificate_ <= options_.tolerance) {
        if (fresh) return true;
        refresh();
        fresh = true;
        gather();
        certificate_ = certify();
        if (certificate_ <= options_.tolerance) return true;
        restart = true;
      }
      if (certificate_ < 0.98 * best) {
        best = certificate_;
        since_best = 0;
      } else if (++since_best > 150) {
        break;
      }
      // Residual on the free set, its preconditioned direction, Polak-Ribiere+.
      const std::size_t m = free_.size();
      r_.resize(m);
      for (std::size_t k = 0; k < m; ++k) r_[k] = w_[free_[k]] - shift_;
      precondition();
      double gz = 0, cross = 0;
      for (std::size_t k = 0; k < m; ++k) {
        gz += r_[k] * z_[k];
        if (!restart) cross += z_[k] * previous_r_[free_[k]];
      }
      const double beta =
          restart || previous_gz <= 0 ? 0 : std::max(0.0, (gz - cross) / previous_gz);
      previous_gz = gz;
      if (previous_r_.size() != grid_.size()) previous_r_.assign(grid_.size(), 0);
      for (std::size_t k = 0; k < m; ++k) previous_r_[free_[k]] = r_[k];
      for (std::size_t k = 0; k < m; ++k) {
        d_[free_[k]] = z_[k] + beta * d_[free_[k]];
      }
      remove_mean(beta > 0);
      kernel_.displace(d_, u_, scratch_);
      ++pairs_;
      double rd = 0, dud = 0;
      for (std::size_t k = 0; k < m; ++k) {
        const std::size_t i = free_[k];
        rd += r_[k] * d_[i];
        dud += d_[i] * u_[i];
      }
      const double alpha = dud > 0 ? rd / dud : 0;
      restart = alpha <= 0;
      // Step; what leaves the box is clipped; free pixels that would penetrate join.
      bool clipped = false;
      for (std::size_t i : free_) {
        p_[i] -= alpha * d_[i];
        if (p_[i] <= 0) {
          clipped = clipped || p_[i] < 0;
          p_[i] = 0;
        } else if (p_[i] >= cap_) {
          clipped = clipped || p_[i] > cap_;
          p_[i] = cap_;
        }
      }
      for (std::size_t i = 0; i < p_.size(); ++i) w_[i] -= alpha * u_[i];
      const bool joined = join();
      if (clipped || joined) {
        rescale();
        refresh();
        fresh = true;
      } else {
        fresh = false;
      }
      gather();
    }
    refresh();
    gather();
    certificate_ = certify();
    return certificate_ <= options_.tolerance;
  }

 private:
  // Pixels outside the free set whose gap has the wrong sign get the pressure that their own
  // compliance asks for, times a safety share: independent of any preconditioner's scale.
  bool join() {
    bool any = false;
    const double step = 0.5 / kernel_.self_compliance();
    const double shift = free_shift();
    for (std::size_t i = 0; i < p_.size(); ++i) {
      const double v = w_[i] - shift;
      if (p_[i] == 0 && v < 0 && slot_[i] < 0) {
        p_[i] = std::min(-v * step, cap_);
        any = true;
      } else if (p_[i] == cap_ && v > 0 && slot_[i] < 0) {
        p_[i] = std::max(0.0, cap_ - v * step);
        any = true;
      }
    }
    return any;
  }

  // p scaled (below a cap: shifted by bisection) to the load.
  void rescale() {
    double sum = 0;
    for (double v : p_) sum += v;
    if (sum <= 0) {
      std::fill(p_.begin(), p_.end(), load_ / static_cast<double>(p_.size()));
      return;
    }
    if (!std::isfinite(cap_)) {
      const double factor = load_ / sum;
      for (double& v : p_) v *= factor;
      return;
    }
    double factor = load_ / sum;
    for (int i = 0; i < 60; ++i) {  // capped pixels stay capped: scale the rest until the load fits
      double total = 0;
      for (double& v : p_) {
        v = std::min(v * factor, cap_);
        total += v;
      }
      if (std::abs(total - load_) <= 1e-14 * load_) break;
      factor = load_ / total;
      if (i == 59 || total <= 0) break;
      double free = 0;
      for (double v : p_) free += v < cap_ ? v : 0;
      if (free <= 0) {  // everything at the cap but load left: open the whole patch
        const double extra = (load_ - total) / static_cast<double>(p_.size());
        for (double& v : p_) v = std::min(v + extra, cap_);
      } else {
        factor = 1 + (load_ - total) / free;
      }
    }
  }

  void refresh() {
    kernel_.displace(p_, w_, scratch_);
    ++pairs_;
    for (std::size_t i = 0; i < w_.size(); ++i) w_[i] += g0_[i];
  }

  void gather() {
    for (std::size_t i : free_) slot_[i] = -1;
    std::vector<std::size_t>& next = next_free_;
    next.clear();
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (p_[i] > 0 && p_[i] < cap_) next.push_back(i);
    }
    for (std::size_t k = 0; k < next.size(); ++k) slot_[next[k]] = static_cast<int>(k);
    // directions of pixels that left the set are forgotten
    for (std::size_t i : free_) {
      if (slot_[i] < 0) d_[i] = 0;
    }
    free_.swap(next);
    shift_ = free_shift();
  }

  double free_shift() const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i : free_) {
      sum += w_[i];
      ++count;
    }
    if (count > 0) return sum / static_cast<double>(count);
    double low = std::numeric_limits<double>::infinity();
    for (double w : w_) low = std::min(low, w);
    return low;
  }

  // z = inverse-kernel stencil on the free set, projected to zero mean in the metric of the
  // stencil.
  void precondition() {
    constexpr int reach = ContactKernel::kReach;
    const std::size_t m = free_.size();
    z_.resize(m);
    ones_.resize(m);
    for (std::size_t k = 0; k < m; ++k) {
      const int ix = static_cast<int>(free_[k]) % grid_.nx,
                iy = static_cast<int>(free_[k]) / grid_.nx;
      const bool inside =
          ix >= reach && ix + reach < grid_.nx && iy >= reach && iy + reach < grid_.ny;
      double sum = 0, one = 0;
      for (int dy = -reach; dy <= reach; ++dy) {
        const std::size_t row = grid_.index(0, inside ? iy + dy : wrap(iy + dy, grid_.ny));
        for (int dx = -reach; dx <= reach; ++dx) {
          const int jx = inside ? ix + dx : wrap(ix + dx, grid_.nx);
          const int slot = slot_[row + static_cast<std::size_t>(jx)];
          if (slot < 0) continue;
          const double t = kernel_.inverse(dx, dy);
          sum += t * r_[static_cast<std::size_t>(slot)];
          one += t;
        }
      }
      z_[k] = sum;
      ones_[k] = one;
    }
    double sum_z = 0, sum_one = 0;
    for (std::size_t k = 0; k < m; ++k) {
      sum_z += z_[k];
      sum_one += ones_[k];
    }
    if (sum_one > 0) {
      for (std::size_t k = 0; k < m; ++k) z_[k] -= sum_z / sum_one * ones_[k];
    }
  }

  // The direction must not change the load (the old direction loses pixels when they leave).
  void remove_mean(bool needed) {
    if (!needed || free_.empty()) return;
    double sum = 0, ones = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      sum += d_[free_[k]];
      ones += ones_[k];
    }
    for (std::size_t k = 0; k < free_.size(); ++k) d_[free_[k]] -= sum / ones * ones_[k];
  }

  // Frank-Wolfe gap over load and height spread. Eq. contact.4
  double certify() {
    double low = std::numeric_limits<double>::infinity(), work = 0;
    for (std::size_t i = 0; i < p_.size(); ++i) {
      low = std::min(low, w_[i]);
      work += p_[i] * w_[i];
    }
    double least = low * load_;
    if (std::isfinite(
            cap_)) {  // the cheapest admissible pressure fills the lowest pixels to the cap
      std::vector<double> sorted(w_.begin(), w_.end());
      const double full = load_ / cap_;
      const auto whole = std::min(sorted.size() - 1, static_cast<std::size_t>(full));
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(whole),
                       sorted.end());
      least = 0;
      for (std::size_t i = 0; i < whole; ++i) least += cap_ * sorted[i];
      least += (load_ - cap_ * static_cast<double>(whole)) * sorted[whole];
    }
    return std::max(0.0, work - least) / (load_ * spread_);
  }

  const ContactKernel& kernel_;
  const Grid& grid_;
  std::span<const double> g0_;
  double spread_, cap_, load_ = 0;
  const ContactOptions& options_;
  RealArray p_, w_, d_, u_;
  SpectrumArray scratch_;
  std::vector<int> slot_;  // position in free_, or -1
  std::vector<std::size_t> free_, next_free_;
  std::vector<double> r_, z_, ones_, previous_r_;
  double pairs_ = 0, certificate_ = 0, shift_ = 0;
  int iterations_ = 0;
};

// Start from the grid of half the pixels: gaps by the 2x2 minimum, pressure handed back a pixel
// each.
RealArray nested_start(const ContactKernel& kernel, std::span<const double> g0, double spread,
                       double mean, const ContactOptions& options, double& pairs) {
  const ContactKernel& coarse = *kernel.coarse();
  const Grid &fine_grid = kernel.grid(), &grid = coarse.grid();
  std::vector<double> gap(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const std::size_t i = fine_grid.index(2 * ix, 2 * iy);
      const auto row = static_cast<std::size_t>(fine_grid.nx);
      gap[grid.index(ix, iy)] =
          std::min(std::min(g0[i], g0[i + 1]), std::min(g0[i + row], g0[i + row + 1]));
    }
  }
  ContactOptions loose = options;
  loose.tolerance = std::max(options.tolerance, 3e-4);
  loose.max_iterations = 200;
  DenseSolver solver(coarse, gap, spread, loose);
  if (coarse.coarse()) {
    solver.pressure() = nested_start(coarse, gap, spread, mean, loose, pairs);
  } else {
    std::fill(solver.pressure().begin(), solver.pressure().end(), mean);
  }
  solver.solve(mean);
  pairs += 0.25 * solver.pairs();
  // Only children below the coarse rigid level can touch; the lowest child always may.
  RealArray fine(fine_grid.size(), 0.0);
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double p = solver.pressure()[grid.index(ix, iy)];
      if (p <= 0) continue;
      for (int k = 0; k < 4; ++k) fine[fine_grid.index(2 * ix + k % 2, 2 * iy + k / 2)] = p;
    }
  }
  return fine;
}

}  // namespace

ContactSolution solve_contact(const ContactKernel& kernel, std::span<const double> height,
                              double mean_pressure, std::span<const double> traction,
                              const ContactOptions& options, const ContactSolution* start) {
  const Grid& grid = kernel.grid();
  const std::size_t n = grid.size();
  ContactSolution out;
  out.pressure.assign(n, 0);
  out.gap.assign(n, 0);
  double mean_height = 0, squares = 0, highest = -std::numeric_limits<double>::infinity();
  bool finite = std::isfinite(mean_pressure);
  for (double h : height) mean_height += h;
  mean_height /= static_cast<double>(n);
  for (double h : height) {
    squares += (h - mean_height) * (h - mean_height);
    highest = std::max(highest, h);
  }
  finite = finite && std::isfinite(squares);
  double mean_traction = 0;
  for (double t : traction) mean_traction += t;
  mean_traction /= static_cast<double>(n);
  finite = finite && std::isfinite(mean_traction);
  if (height.size() != n || (!traction.empty() && traction.size() != n) || !finite) {
    out.status = ContactStatus::Invalid;
    out.reason = "heights, load or tractions are not finite numbers on the kernel's grid";
    return out;
  }

  // Eq. contact.3: tractions deform the surface and add to the load.
  RealArray g0(n);
  SpectrumArray scratch(kernel.fft().spectrum_size());
  if (!traction.empty()) {
    RealArray t(traction.begin(), traction.end());
    kernel.displace(t, g0, scratch);
    out.fft_pairs += 1;
    for (std::size_t i = 0; i < n; ++i) g0[i] = -height[i] - g0[i];
  } else {
    for (std::size_t i = 0; i < n; ++i) g0[i] = -height[i];
  }
  const double mean = mean_pressure + mean_traction;
  if (mean <= 0) {
    const double lowest = *std::min_element(g0.begin(), g0.end());
    for (std::size_t i = 0; i < n; ++i) out.gap[i] = g0[i] - lowest;
    out.shift = lowest;
    out.status = ContactStatus::NoLoad;
    out.reason = mean < 0 ? "the tractions lift the surfaces apart" : "no load: first touch";
    return out;
  }
  if (options.hardness > 0 && mean >= options.hardness) {
    out.status = ContactStatus::Invalid;
    out.reason = fmt::format("mean load {:.3g} Pa is beyond the hardness {:.3g} Pa everywhere",
                             mean, options.hardness);
    std::fill(out.pressure.begin(), out.pressure.end(), options.hardness);
    return out;
  }
  // Height spread that normalises the certificate; a flat surface is measured by what a pixel
  // yields.
  const double spread =
      std::max(std::sqrt(squares / static_cast<double>(n)), 1e-6 * mean * kernel.self_compliance());

  DenseSolver solver(kernel, g0, spread, options);
  double coarse_pairs = 0;
  const bool warm =
      start && start->pressure.size() == n && start->converged() &&
      std::any_of(start->pressure.begin(), start->pressure.end(), [](double p) { return p > 0; });
  if (warm) {
    std::copy(start->pressure.begin(), start->pressure.end(), solver.pressure().begin());
  } else if (kernel.coarse()) {
    solver.pressure() = nested_start(kernel, g0, spread, mean, options, coarse_pairs);
  } else {
    std::fill(solver.pressure().begin(), solver.pressure().end(), mean);
  }
  const bool certified = solver.solve(mean);
  out.pressure.assign(solver.pressure().begin(), solver.pressure().end());
  out.certificate = solver.certificate();
  out.iterations = solver.iterations();
  out.fft_pairs += solver.pairs() + coarse_pairs;
  out.shift = solver.shift();
  double energy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double v = solver.gap_function()[i];
    out.gap[i] = out.pressure[i] > 0 ? 0 : std::max(0.0, v - out.shift);
    energy += 0.5 * out.pressure[i] * (v - g0[i]);
  }
  out.elastic_energy = energy * grid.pixel_area();
  out.status = certified
                   ? ContactStatus::Converged
                   : (solver.iterations() >= options.max_iterations ? ContactStatus::IterationLimit
                                                                    : ContactStatus::Stagnated);
  if (!certified) {
    out.reason = fmt::format("certificate {:.2g} above {:.2g} after {} iterations", out.certificate,
                             options.tolerance, out.iterations);
  }
  return out;
}

}  // namespace papilla
