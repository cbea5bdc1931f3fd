// Nested, stencil-preconditioned conjugate gradients on the full grid: one transform pair an
// iteration, everything else on the list of pixels that may carry pressure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/contact.h"

namespace papilla {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class DenseSolver {
 public:
  DenseSolver(const ContactKernel& kernel, std::span<const double> g0, double spread,
              const ContactOptions& options)
      : kernel_(kernel),
        grid_(kernel.grid()),
        g0_(g0),
        spread_(spread),
        cap_(options.hardness > 0 ? options.hardness : kInfinity),
        options_(options),
        p_(grid_.size()),
        w_(grid_.size()),
        next_(grid_.size()),
        step_(grid_.size(), 0.0),
        scratch_(kernel.fft().spectrum_size()),
        width_(grid_.nx + 2 * kReach + ContactKernel::kStencilWidth),
        residual_(static_cast<std::size_t>(width_) * (grid_.ny + 2 * kReach), 0.0F),
        inside_(residual_.size(), 0.0F) {}

  RealArray& pressure() { return p_; }
  const RealArray& gap_function() const { return w_; }
  double pairs() const { return pairs_; }
  int iterations() const { return iterations_; }
  double certificate() const { return certificate_; }
  double shift() const { return shift_; }

  // p_ holds a start with any mean; returns true when certified. w_ is at every moment a transform
  // of the pressure itself (between two of them where a step was shortened), so that the
  // certificate is that of the pressure returned.
  bool solve(double mean) {
    load_ = mean * static_cast<double>(grid_.size());
    start();
    double alpha = 0.4;  // expected step along the preconditioned direction
    double best = kInfinity;
    int since_best = 0;
    bool conjugate = false;
    for (iterations_ = 0;; ++iterations_) {
      certificate_ = certify();
      if (certificate_ <= options_.tolerance) return true;
      if (certificate_ < 0.98 * best) {
        best = certificate_;
        since_best = 0;
      } else if (++since_best > 100) {
        return false;
      }
      if (iterations_ >= options_.max_iterations) return false;

      precondition();
      direct(conjugate);
      const bool clipped = move(alpha);
      kernel_.displace(p_, next_, scratch_);
      ++pairs_;
      // Exact minimum along the step taken, t = 1 being its end. A step that ran into the bounds is
      // kept unless it went too far: its end tells which pixels are free.
      double slope = 0, curvature = 0, longest = kInfinity;
      for (std::size_t k = 0; k < free_.size(); ++k) {
        const int i = free_[k];
        const double s = step_[i];
        slope += r_[k] * s;
        curvature += (next_[i] + g0_[i] - w_[i]) * s;
        if (s < 0) longest = std::min(longest, (p_[i] - s) / -s);
        if (s > 0) longest = std::min(longest, (cap_ - p_[i] + s) / s);
      }
      double t = curvature > 0 ? -slope / curvature : 0;
      if (t > 0) alpha = std::clamp(alpha * t, 0.05, 20.0);
      if (clipped) {
        t = t > 0.85 ? 1 : std::max(t, 0.0);
      } else {
        t = std::clamp(t, 0.0, longest);
      }
      conjugate = t > 0;
      if (t == 0) alpha = std::max(0.05, 0.3 * alpha);
      advance(t);
    }
  }

 private:
  static constexpr int kReach = ContactKernel::kReach;

  void start() {
    scale_to_load();
    kernel_.displace(p_, next_, scratch_);
    ++pairs_;
    old_.clear();
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (p_[i] > 0) old_.push_back(static_cast<int>(i));
    }
    arrive(1);
  }

  // p scaled to the load over the whole grid; below a cap what overflows goes to the others.
  void scale_to_load() {
    const auto n = static_cast<double>(p_.size());
    double sum = 0;
    for (double v : p_) sum += v;
    if (sum <= 0) {
      std::fill(p_.begin(), p_.end(), load_ / n);
      return;
    }
    double factor = load_ / sum;
    if (!std::isfinite(cap_)) {
      for (double& v : p_) v *= factor;
      return;
    }
    for (int k = 0; k < 60; ++k) {
      double total = 0, open = 0;
      for (double& v : p_) {
        v = std::min(v * factor, cap_);
        total += v;
        if (v < cap_) open += v;
      }
      if (std::abs(total - load_) <= 1e-14 * load_) return;
      if (open > 0 && open + load_ - total > 0) {
        factor = 1 + (load_ - total) / open;
      } else {  // everything is at the cap but load is left: open the whole patch
        for (double& v : p_) v = std::min(v + (load_ - total) / n, cap_);
        factor = 1;
      }
    }
  }

  // Gap function and lists of the new p_, at t from the old gap function w_ to that of the
  // transform in next_, where the old one is kept. old_ holds every pixel under pressure; then
  // free_: pixels between the bounds and those at a bound whose gap has the wrong sign; held_:
  // others at the cap.
  void arrive(double t) {
    const auto blend = [&](std::size_t i) {
      return t == 1 ? next_[i] + g0_[i] : w_[i] + t * (next_[i] + g0_[i] - w_[i]);
    };
    double sum = 0;
    std::size_t count = 0;
    for (int i : old_) {
      if (p_[i] > 0 && p_[i] < cap_) {
        sum += blend(i);
        ++count;
      }
    }
    shift_ = count > 0 ? sum / static_cast<double>(count) : kInfinity;
    if (count == 0) {  // all at the cap: the lowest pixel that is not
      for (std::size_t i = 0; i < p_.size(); ++i) {
        if (p_[i] == 0) shift_ = std::min(shift_, blend(i));
      }
    }
    free_.clear();
    held_.clear();
    for (int i : old_) {
      if (p_[i] <= 0) continue;
      if (p_[i] < cap_ || blend(i) > shift_) {
        free_.push_back(i);
      } else {
        held_.push_back(i);
      }
    }
    constexpr std::size_t kBlock = 64;
    low_ = kInfinity;
    for (std::size_t begin = 0; begin < p_.size(); begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, p_.size());
      double low = kInfinity, joining = 0;
#pragma omp simd reduction(min : low) reduction(+ : joining)
      for (std::size_t i = begin; i < end; ++i) {
        const double fresh = next_[i] + g0_[i];
        const double w = t == 1 ? fresh : w_[i] + t * (fresh - w_[i]);
        next_[i] = w;
        low = low < w ? low : w;
        joining += w < shift_ && p_[i] == 0 ? 1.0 : 0.0;
      }
      low_ = std::min(low_, low);
      if (joining == 0) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (p_[i] == 0 && next_[i] < shift_) free_.push_back(static_cast<int>(i));
      }
    }
    w_.swap(next_);
    r_.resize(free_.size());
    for (std::size_t k = 0; k < free_.size(); ++k) r_[k] = w_[free_[k]] - shift_;
  }

  // z = inverse-kernel stencil on the free set (single precision suffices for a direction),
  // projected to zero mean in the metric of the stencil.
  void precondition() {
    constexpr int kWide = ContactKernel::kStencilWidth;
    const std::size_t m = free_.size();
    z_.resize(m);
    ones_.resize(m);
    for (std::size_t k = 0; k < m; ++k) spread(free_[k], static_cast<float>(r_[k]), 1.0F);
    double sum_z = 0, sum_one = 0;
    for (std::size_t k = 0; k < m; ++k) {
      const int ix = free_[k] % grid_.nx, iy = free_[k] / grid_.nx;
      float value[kWide] = {}, one[kWide] = {};
      for (int dy = 0; dy <= 2 * kReach; ++dy) {
        const std::size_t at = static_cast<std::size_t>(iy + dy) * width_ + ix;
        const float* t = kernel_.stencil(dy);
        const float* a = residual_.data() + at;
        const float* b = inside_.data() + at;
#pragma omp simd
        for (int j = 0; j < kWide; ++j) {
          value[j] += t[j] * a[j];
          one[j] += t[j] * b[j];
        }
      }
      float z = 0, o = 0;
      for (int j = 0; j < kWide; ++j) {
        z += value[j];
        o += one[j];
      }
      z_[k] = z;
      ones_[k] = o;
      sum_z += z_[k];
      sum_one += ones_[k];
    }
    for (int i : free_) spread(i, 0, 0);
    if (sum_one > 0) {
      for (std::size_t k = 0; k < m; ++k) z_[k] -= sum_z / sum_one * ones_[k];
    }
  }

  // A pixel and its periodic images within the margin.
  void spread(int i, float value, float one) {
    const int ix = i % grid_.nx, iy = i / grid_.nx;
    for (int y = iy - grid_.ny; y < grid_.ny + kReach; y += grid_.ny) {
      if (y < -kReach) continue;
      for (int x = ix - grid_.nx; x < grid_.nx + kReach; x += grid_.nx) {
        if (x < -kReach) continue;
        const std::size_t at = static_cast<std::size_t>(y + kReach) * width_ + (x + kReach);
        residual_[at] = value;
        inside_[at] = one;
      }
    }
  }

  // d_ = z plus the share of the last step that makes it conjugate to it (Polak-Ribiere+), without
  // load. step_ and next_ hold the last step and the gap function before it.
  void direct(bool conjugate) {
    const std::size_t m = free_.size();
    double share = 0;
    if (conjugate) {
      double cross = 0, own = 0;
      for (std::size_t k = 0; k < m; ++k) {
        const int i = free_[k];
        const double y = w_[i] - next_[i];
        cross += z_[k] * y;
        own += step_[i] * y;
      }
      if (own > 0) share = std::min(0.0, -cross / own);
    }
    d_.resize(m);
    double sum = 0, ones = 0;
    for (std::size_t k = 0; k < m; ++k) {
      d_[k] = z_[k] + share * step_[free_[k]];
      sum += d_[k];
      ones += ones_[k];
    }
    if (ones > 0) {
      for (std::size_t k = 0; k < m; ++k) d_[k] -= sum / ones * ones_[k];
    }
    for (int i : old_) step_[i] = 0;
  }

  // p_ along -alpha d_, cut at the bounds, the load restored; step_ = what it changed by. True if a
  // pixel under pressure met a bound. No step where the free pixels cannot carry the load.
  bool move(double alpha) {
    bool clipped = false;
    double sum = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const int i = free_[k];
      double v = p_[i] - alpha * d_[k];
      if (v <= 0) {
        clipped = clipped || p_[i] > 0;
        v = 0;
      } else if (v >= cap_) {
        clipped = clipped || p_[i] < cap_;
        v = cap_;
      }
      step_[i] = -p_[i];
      p_[i] = v;
      sum += v;
    }
    const double load = held_.empty() ? load_ : load_ - cap_ * static_cast<double>(held_.size());
    for (int k = 0; k < 60 && std::abs(sum - load) > 1e-15 * load; ++k) {
      double open = 0;  // too much scales down what is at the cap too, too little cannot raise it
      for (int i : free_) open += sum > load || p_[i] < cap_ ? p_[i] : 0;
      if (open <= 0) {
        for (int i : free_) {
          p_[i] = -step_[i];
          step_[i] = 0;
        }
        return true;
      }
      const double factor = 1 + (load - sum) / open;
      double total = 0;
      for (int i : free_) {
        if (sum > load || p_[i] < cap_) p_[i] = std::min(p_[i] * factor, cap_);
        total += p_[i];
      }
      sum = total;
      if (!std::isfinite(cap_)) break;
    }
    for (int i : free_) step_[i] += p_[i];
    return clipped;
  }

  // State at t of the step.
  void advance(double t) {
    if (t != 1) {
      for (int i : free_) {
        p_[i] = std::clamp(p_[i] - (1 - t) * step_[i], 0.0, cap_);
        step_[i] *= t;
      }
    }
    old_ = free_;
    old_.insert(old_.end(), held_.begin(), held_.end());
    arrive(t);
  }

  // Frank-Wolfe gap over load and height spread. Eq. contact.4
  double certify() {
    double work = 0;
    for (int i : old_) work += p_[i] * w_[i];
    double least = low_ * load_;
    if (std::isfinite(cap_)) {  // the cheapest pressure fills the lowest pixels to the cap
      next_low_.assign(w_.begin(), w_.end());
      const auto whole = std::min(next_low_.size() - 1, static_cast<std::size_t>(load_ / cap_));
      std::nth_element(next_low_.begin(), next_low_.begin() + static_cast<std::ptrdiff_t>(whole),
                       next_low_.end());
      least = 0;
      for (std::size_t i = 0; i < whole; ++i) least += cap_ * next_low_[i];
      least += (load_ - cap_ * static_cast<double>(whole)) * next_low_[whole];
    }
    return std::max(0.0, work - least) / (load_ * spread_);
  }

  const ContactKernel& kernel_;
  const Grid& grid_;
  std::span<const double> g0_;
  double spread_, cap_, load_ = 0;
  const ContactOptions& options_;
  RealArray p_, w_, next_, step_;
  SpectrumArray scratch_;
  int width_;                             // of the padded images below
  std::vector<float> residual_, inside_;  // of the free pixels; zero between uses
  std::vector<int> free_, held_, old_;    // old_: the free set of the last step, held ones included
  std::vector<double> r_, z_, ones_, d_, next_low_;
  double pairs_ = 0, certificate_ = 0, shift_ = 0, low_ = 0;
  int iterations_ = 0;
};

// Start from the grid of half the pixels, its gaps the 2x2 minimum, solved as far as the start is
// worth. pairs grows in units of the finest grid, of which this grid's pair costs `unit`.
RealArray nested_start(const ContactKernel& kernel, std::span<const double> g0, double spread,
                       double mean, const ContactOptions& options, double unit, double& pairs) {
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
  loose.tolerance = std::max(options.tolerance, 2e-2);
  loose.max_iterations = 200;
  DenseSolver solver(coarse, gap, spread, loose);
  if (coarse.coarse()) {
    solver.pressure() = nested_start(coarse, gap, spread, mean, loose, 0.25 * unit, pairs);
  } else {
    std::fill(solver.pressure().begin(), solver.pressure().end(), mean);
  }
  solver.solve(mean);
  pairs += 0.25 * unit * solver.pairs();
  // The load of a coarse pixel goes to its children as if they were springs of a pixel's own
  // compliance at their heights.
  RealArray fine(fine_grid.size(), 0.0);
  const double yield = kernel.self_compliance();
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double p = solver.pressure()[grid.index(ix, iy)];
      if (p <= 0) continue;
      std::size_t child[4];
      for (int k = 0; k < 4; ++k) child[k] = fine_grid.index(2 * ix + k % 2, 2 * iy + k / 2);
      std::sort(child, child + 4, [&](std::size_t i, std::size_t j) { return g0[i] < g0[j]; });
      double level = 0, below = 0;
      int count = 0;
      while (count < 4) {
        below += g0[child[count++]];
        level = (4 * p * yield + below) / count;
        if (count == 4 || level <= g0[child[count]]) break;
      }
      for (int k = 0; k < count; ++k) fine[child[k]] = (level - g0[child[k]]) / yield;
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
  double mean_height = 0, squares = 0, highest = -kInfinity;
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
    solver.pressure() = nested_start(kernel, g0, spread, mean, options, 1, coarse_pairs);
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
