// Nested, stencil-preconditioned conjugate gradients on the full grid: one transform pair an
// iteration, everything else on the list of pixels that may carry pressure.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/constants.h"
#include "physics/contact/solvers.h"

namespace papilla {
namespace {

// One row of the stencil in vector registers.
using Row = float __attribute__((vector_size(ContactKernel::kStencilWidth * sizeof(float))));

// By reference: without AVX-512 a returned vector of this width has no fixed calling convention.
void load_row(const float* from, Row& row) { std::memcpy(&row, from, sizeof row); }

float total(const Row& row) {
  float part[8], sum = 0;
  for (int j = 0; j < 8; ++j) part[j] = row[j] + row[j + 8];
  for (int j = 0; j < 4; ++j) sum += part[j] + part[j + 4];
  return sum;
}

class DenseSolver {
 public:
  DenseSolver(const StandardProblem& problem, double tolerance, int max_iterations,
              StandardState& state)
      : problem_(problem),
        kernel_(problem.kernel),
        grid_(kernel_.grid()),
        cap_(problem.cap),
        load_(problem.load),
        tolerance_(tolerance),
        max_iterations_(max_iterations),
        state_(state),
        p_(state.p),
        change_(grid_.size()),
        step_(grid_.size(), 0.0),
        scratch_(kernel_.scratch_size()),
        width_(grid_.nx + 2 * kReach + ContactKernel::kStencilWidth),
        residual_(static_cast<std::size_t>(width_) * (grid_.ny + 2 * kReach), 0.0F),
        inside_(residual_.size(), 0.0F) {}

  // From the pressure of the state, with any mean. without: the gap function without pressure, or
  // empty. Every step's transform is added to the gap function, which so stays that of the pressure
  // to rounding, and the certificate is that of the pressure returned.
  void solve(RealArray without) {
    start(std::move(without));
    state_.certified = iterate();
    state_.exhausted = state_.iterations >= max_iterations_;
    state_.shift = shift_;
    close_gaps();
  }

 private:
  static constexpr int kReach = ContactKernel::kReach;
  static constexpr double kFirstStep = 0.6;
  static constexpr double kBarred = 1e300;  // stands for a pixel held at a bound

  bool iterate() {
    double alpha = kFirstStep;  // expected step along the preconditioned direction
    double best = kInfinity;
    int since_best = 0;
    bool conjugate = false, plain = false;
    for (;; ++state_.iterations) {
      state_.certificate = certify();
      if (state_.certificate <= tolerance_) return true;
      if (state_.certificate < 0.98 * best) {
        best = state_.certificate;
        since_best = 0;
      } else if (++since_best > 100) {
        return false;
      }
      if (state_.iterations >= max_iterations_) return false;

      if (plain) {
        descend();
      } else if (wide_) {
        kernel_.press(field_, scratch_);
        ++state_.pairs;
      } else if (8 * free_.size() > grid_.size()) {
        precondition_all();
      } else {
        precondition();
      }
      const bool clipped = wide_ ? move_wide(alpha, conjugate) : move(alpha, conjugate);
      kernel_.displace(step_, change_, scratch_);
      ++state_.pairs;
      // Exact minimum along the step taken, t = 1 being its end. A step that ran into the bounds is
      // kept unless it went too far: its end tells which pixels are free.
      const auto [slope, curvature] = wide_ ? slopes_wide() : slopes();
      double t = curvature > 0 ? -slope / curvature : 0;
      // A direction far from any length expected lost its meaning: a share of the last step that
      // cancels it, for one, where only two pixels are free.
      const bool sound = t > 1e-3 && t < 1e3;
      if (t > 0) alpha = sound ? std::clamp(alpha * t, 1e-4, 20.0) : kFirstStep;
      if (clipped) {
        t = t > 0.85 ? 1 : std::max(t, 0.0);
      } else {
        t = t > 1 ? std::min(t, room()) : std::max(t, 0.0);
      }
      conjugate = t > 0 && sound;
      // Cut at many bounds a preconditioned direction may climb; the gradient never does.
      if (t == 0) {
        alpha = plain ? std::max(1e-6, 0.3 * alpha) : 0.3;
        plain = true;
      } else if (plain) {
        alpha = 0.3;
        plain = false;
      }
      advance(t);
    }
  }

  void start(RealArray without) {
    if (!problem_.approach) scale_to_load();
    ++state_.pairs;
    if (without.empty()) {
      w_.assign(problem_.height.size(), 0.0);
      for (std::size_t i = 0; i < w_.size(); ++i) w_[i] = -problem_.height[i];
      change_.assign(p_.begin(), p_.end());
      for (std::size_t i = 0; i < problem_.traction.size(); ++i) change_[i] -= problem_.traction[i];
    } else {
      w_ = std::move(without);
      change_.assign(p_.begin(), p_.end());
    }
    kernel_.displace(change_, change_, scratch_);
    old_.clear();
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (p_[i] > 0) old_.push_back(static_cast<int>(i));
    }
    arrive(1);
    if (3 * free_.size() > grid_.size()) widen();
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

  // Gap function and lists of the new p_, at t of the step whose transform is in change_. old_
  // holds every pixel under pressure; then free_: pixels between the bounds and those at a bound
  // whose gap has the wrong sign; held_: others at the cap; left_: others that the step moved.
  void arrive(double t) {
    double sum = 0, count = 0, work = 0;
    const int* old = old_.data();
    double* gap = w_.data();
    const double *change = change_.data(), *p = p_.data();
    const double cap = cap_;
#pragma omp simd reduction(+ : sum, count, work)
    for (std::size_t k = 0; k < old_.size(); ++k) {
      const double pressure = p[old[k]], w = gap[old[k]] + t * change[old[k]];
      const bool inside = pressure > 0 && pressure < cap;
      work += pressure * w;
      sum += inside ? w : 0;
      count += inside ? 1 : 0;
    }
    work_ = work;
    set_shift(sum, count, t);
    held_.clear();
    left_.clear();
    free_.resize(old_.size());
    std::size_t pressed = 0;
    for (int i : old_) {  // every one is written, those that stay are counted
      free_[pressed] = i;
      if (p_[i] == cap_ && w_[i] + t * change_[i] <= shift_) {
        held_.push_back(i);
        left_.push_back(i);
      } else if (p_[i] > 0) {
        ++pressed;
      } else {
        left_.push_back(i);
      }
    }
    free_.resize(pressed);
    constexpr std::size_t kBlock = 64;
    int joining[kBlock];
    const double shift = shift_;
    low_ = kInfinity;
    for (std::size_t begin = 0; begin < p_.size(); begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, p_.size());
      double low = kInfinity;
#pragma omp simd reduction(min : low)
      for (std::size_t i = begin; i < end; ++i) {
        gap[i] += t * change[i];
        low = low < gap[i] ? low : gap[i];
      }
      if (low >= shift) continue;
      low_ = std::min(low_, low);
      double any = 0;
#pragma omp simd reduction(+ : any)
      for (std::size_t i = begin; i < end; ++i) any += gap[i] < shift && p[i] == 0 ? 1.0 : 0.0;
      if (any == 0) continue;
      std::size_t found = 0;
      for (std::size_t i = begin; i < end; ++i) {
        joining[found] = static_cast<int>(i);
        found += gap[i] < shift && p[i] == 0;
      }
      free_.insert(free_.end(), joining, joining + found);
    }
    if (!(low_ < shift_)) low_ = *std::min_element(w_.begin(), w_.end());
    r_.resize(free_.size());
    const int* at = free_.data();
    double* r = r_.data();
#pragma omp simd
    for (std::size_t k = 0; k < free_.size(); ++k) r[k] = gap[at[k]] - shift;
  }

  // Rigid shift at t of the step: the mean gap function of the pixels between the bounds, sum /
  // count. Given approach, the load.
  void set_shift(double sum, double count, double t) {
    if (problem_.approach) {
      shift_ = problem_.level;
      load_ = std::accumulate(p_.begin(), p_.end(), 0.0);
    } else if (count > 0) {
      shift_ = sum / count;
    } else {  // all at the cap: between the highest of them and the lowest of the others
      double lowest = kInfinity, highest = -kInfinity;
      for (std::size_t i = 0; i < p_.size(); ++i) {
        const double w = w_[i] + t * change_[i];
        if (p_[i] == 0) {
          lowest = std::min(lowest, w);
        } else {
          highest = std::max(highest, w);
        }
      }
      shift_ = std::isfinite(lowest) ? 0.5 * (lowest + highest) : highest;
    }
  }

  // z = the residual over a pixel's own compliance.
  void descend() {
    const double stiffness = 1 / kernel_.self_compliance();
    if (wide_) {
      for (double& r : field_) r *= stiffness;
      return;
    }
    double sum = 0;
    for (double r : r_) sum += stiffness * r;
    const double mean = problem_.approach ? 0 : sum / static_cast<double>(r_.size());
    ones_.assign(r_.size(), stiffness);
    z_.resize(r_.size());
    for (std::size_t k = 0; k < r_.size(); ++k) z_[k] = stiffness * r_[k] - mean;
  }

  // z = the inverse kernel of the whole plane on the residual: where much of it is in contact, as
  // cheap as the stencil and without its truncation.
  void precondition_all() {
    field_.assign(grid_.size(), 0);
    for (std::size_t k = 0; k < free_.size(); ++k) field_[free_[k]] = r_[k];
    kernel_.press(field_, scratch_);
    ++state_.pairs;
    z_.resize(free_.size());
    const int* at = free_.data();
    const double* field = field_.data();
    double* z = z_.data();
    double mean = 0;
#pragma omp simd reduction(+ : mean)
    for (std::size_t k = 0; k < free_.size(); ++k) {
      z[k] = field[at[k]];
      mean += z[k];
    }
    mean = problem_.approach ? 0 : mean / static_cast<double>(free_.size());
    for (double& value : z_) value -= mean;
    ones_.assign(free_.size(), 1 / kernel_.self_compliance());
  }

  // z = inverse-kernel stencil on the free set (single precision suffices for a direction), less
  // half of its row sums, projected to zero mean in its metric. The inverse of the kernel between
  // the free pixels alone is softer at their edges than the plane's, whose rows sum to zero: the
  // row sum is what an edge cuts off.
  void precondition() {
    const std::size_t m = free_.size();
    z_.resize(m);
    ones_.resize(m);
    for (std::size_t k = 0; k < m; ++k) spread(free_[k], static_cast<float>(r_[k]), 1.0F);
    const float least_weight = 1e-3F * kernel_.stencil(kReach)[kReach];
    double sum_z = 0, sum_one = 0;
    for (std::size_t k = 0; k < m; ++k) {
      const int ix = free_[k] % grid_.nx, iy = free_[k] / grid_.nx;
      Row value{}, one{};
      for (int dy = 0; dy <= 2 * kReach; ++dy) {
        const std::size_t at = static_cast<std::size_t>(iy + dy) * width_ + ix;
        Row t, residual, inside;
        load_row(kernel_.stencil(dy), t);
        load_row(residual_.data() + at, residual);
        load_row(inside_.data() + at, inside);
        value += t * residual;
        one += t * inside;
      }
      const float half = std::max(0.5F * total(one), least_weight);
      z_[k] = total(value) - half * r_[k];
      ones_[k] = half;
      sum_z += z_[k];
      sum_one += ones_[k];
    }
    for (int i : free_) spread(i, 0, 0);
    if (sum_one > 0 && !problem_.approach) {
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

  // p_ along -alpha d, d = z plus the share of the last step that makes it conjugate to it
  // (Polak-Ribiere+), without load; cut at the bounds. The load is restored by a shift of the rigid
  // level, that is along the preconditioned constant, so that a short step always descends. step_ =
  // what p_ changed by, change_ what that changes the gap function by, both before the step is
  // shortened. True if a pixel under pressure met a bound. No step where the free pixels cannot
  // carry the load.
  bool move(double alpha, bool conjugate) {
    const std::size_t m = free_.size();
    raw_.resize(m);
    const int* at = free_.data();
    const double *change = change_.data(), *z = z_.data(), *one = ones_.data();
    double *raw = raw_.data(), *p = p_.data(), *step = step_.data();
    const double cap = cap_;
    double share = 0;
    if (conjugate) {
      double cross = 0, own = 0;
#pragma omp simd reduction(+ : cross, own)
      for (std::size_t k = 0; k < m; ++k) {
        const double y = change[at[k]];
        cross += z[k] * y;
        own += step[at[k]] * y;
      }
      if (own > 0) share = std::min(0.0, -cross / own);
    }
    double sum = 0, ones = 0;
#pragma omp simd reduction(+ : sum, ones)
    for (std::size_t k = 0; k < m; ++k) {
      sum += z[k] + share * step[at[k]];
      ones += one[k];
    }
    const double tilt = ones > 0 && !problem_.approach ? sum / ones : 0;
#pragma omp simd
    for (std::size_t k = 0; k < m; ++k) {
      raw[k] = p[at[k]] - alpha * (z[k] + share * step[at[k]] - tilt * one[k]);
    }
    for (int i : left_) step_[i] = 0;
    const double level =
        problem_.approach
            ? 0
            : load_level(raw_, ones_,
                         load_ - (held_.empty() ? 0 : cap_ * static_cast<double>(held_.size())));
    double clipped = 0;
#pragma omp simd reduction(+ : clipped)
    for (std::size_t k = 0; k < m; ++k) {
      const double moved = raw[k] - level * one[k], old = p[at[k]];
      const double above = moved > 0 ? moved : 0, v = above < cap ? above : cap;
      clipped += (v == 0 && old > 0) || (v == cap && old < cap) ? 1.0 : 0.0;
      step[at[k]] = v - old;
      p[at[k]] = v;
    }
    return clipped > 0;
  }

  // level at which raw - level ones (empty: 1), cut at the bounds, carries the load: Newton's
  // method on a falling, piecewise linear function, kept between bounds.
  double load_level(std::span<const double> raw, std::span<const double> ones, double load) const {
    const double *value = raw.data(), *one = ones.data(), cap = cap_;
    double level = 0, below = -kInfinity, above = kInfinity;
    for (int pass = 0; pass < 100; ++pass) {
      double sum = 0, weight = 0;
      if (one) {
#pragma omp simd reduction(+ : sum, weight)
        for (std::size_t k = 0; k < raw.size(); ++k) {
          const double v = value[k] - level * one[k], cut = v < cap ? v : cap;
          sum += v > 0 ? cut : 0;
          weight += v > 0 && v < cap ? one[k] : 0;
        }
      } else {
#pragma omp simd reduction(+ : sum, weight)
        for (std::size_t k = 0; k < raw.size(); ++k) {
          const double v = value[k] - level, cut = v < cap ? v : cap;
          sum += v > 0 ? cut : 0;
          weight += v > 0 && v < cap ? 1.0 : 0.0;
        }
      }
      if (std::abs(sum - load) <= 1e-13 * load_) break;
      (sum > load ? below : above) = level;
      double next = weight > 0 ? level + (sum - load) / weight : kInfinity;
      if (!(next > below && next < above)) {
        double size = 0;
        for (std::size_t k = 0; k < raw.size(); ++k) {
          const double unit = one ? one[k] : 1, v = std::abs(value[k] - level * unit) / unit;
          if (std::abs(value[k]) != kBarred) size = std::max(size, v);
        }
        next = std::isinf(below)   ? above - 2 * size
               : std::isinf(above) ? below + 2 * size
                                   : 0.5 * (below + above);
      }
      if (next == level || next == below || next == above) break;
      level = next;
    }
    return level;
  }

  // Slope of the energy along the step from its start, and its curvature.
  std::pair<double, double> slopes() const {
    double slope = 0, curvature = 0;
    const int* at = free_.data();
    const double *step = step_.data(), *change = change_.data(), *r = r_.data();
#pragma omp simd reduction(+ : slope, curvature)
    for (std::size_t k = 0; k < free_.size(); ++k) {
      slope += r[k] * step[at[k]];
      curvature += change[at[k]] * step[at[k]];
    }
    return {slope, curvature};
  }

  // How many times the step taken fits between the bounds.
  double room() const {
    const double *p = p_.data(), *step = step_.data();
    const double cap = cap_;
    const auto times = [=](std::size_t i) {
      const double s = step[i], open = s < 0 ? s - p[i] : cap - p[i] + s;
      const double length = open / (s != 0 ? s : 1e-300);
      return s != 0 ? length : kInfinity;
    };
    double longest = kInfinity;
    if (!wide_) {
      for (int i : free_) longest = std::min(longest, times(i));
      return longest;
    }
#pragma omp simd reduction(min : longest)
    for (std::size_t i = 0; i < p_.size(); ++i) {
      const double found = times(i);
      longest = found < longest ? found : longest;
    }
    return longest;
  }

  // State at t of the step.
  void advance(double t) {
    if (wide_) {
      arrive_wide(t);
      if (4 * free_count_ < grid_.size()) narrow();
      return;
    }
    if (t != 1) {
      for (int i : free_) p_[i] = std::clamp(p_[i] - (1 - t) * step_[i], 0.0, cap_);
    }
    old_.swap(free_);
    old_.insert(old_.end(), held_.begin(), held_.end());
    arrive(t);
    if (3 * free_.size() > grid_.size()) widen();
  }

  // The same steps where much of the surface is in contact: whole fields instead of lists, as few
  // passes over them as their sums allow. is_free_ marks the free pixels, field_ is their residual,
  // then the direction.
  void widen() {
    wide_ = true;
    field_.assign(grid_.size(), 0);
    is_free_.assign(grid_.size(), 0);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      is_free_[free_[k]] = 1;
      field_[free_[k]] = r_[k];
    }
    free_count_ = free_.size();
    for (int i : left_) step_[i] = 0;
  }

  void narrow() {
    wide_ = false;
    free_.clear();
    held_.clear();
    left_.clear();
    r_.clear();
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      const int pixel = static_cast<int>(i);
      if (is_free_[i]) {
        free_.push_back(pixel);
        r_.push_back(field_[i]);
      } else {
        if (p_[i] > 0) held_.push_back(pixel);
        if (step_[i] != 0) left_.push_back(pixel);
      }
    }
  }

  bool move_wide(double alpha, bool conjugate) {
    const std::size_t n = grid_.size();
    const char* is_free = is_free_.data();
    const double *change = change_.data(), cap = cap_;
    double *z = field_.data(), *p = p_.data(), *step = step_.data();
    double sum = 0, cross = 0, own = 0, changes = 0, steps = 0;
    if (conjugate) {
#pragma omp simd reduction(+ : sum, cross, own, changes, steps)
      for (std::size_t i = 0; i < n; ++i) {
        const double in = is_free[i] ? 1.0 : 0.0, value = in * z[i], y = in * change[i];
        sum += value;
        cross += value * y;
        own += step[i] * y;
        changes += y;
        steps += in * step[i];
      }
    } else {
#pragma omp simd reduction(+ : sum)
      for (std::size_t i = 0; i < n; ++i) sum += is_free[i] ? z[i] : 0;
    }
    const auto m = static_cast<double>(free_count_);
    const double mean = problem_.approach ? 0 : sum / m;
    const double share = own > 0 ? std::min(0.0, -(cross - mean * changes) / own) : 0;
    const double tilt = problem_.approach ? 0 : mean + share * steps / m;
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
      const double along = p[i] - alpha * (z[i] + share * step[i] - tilt);
      z[i] = is_free[i] ? along : p[i] > 0 ? kBarred : -kBarred;
    }
    const double level = problem_.approach ? 0 : load_level(field_, {}, load_);
    double clipped = 0;
#pragma omp simd reduction(+ : clipped)
    for (std::size_t i = 0; i < n; ++i) {
      const double moved = z[i] - level, old = p[i];
      const double above = moved > 0 ? moved : 0, v = above < cap ? above : cap;
      clipped += (v == 0 && old > 0) || (v == cap && old < cap) ? 1.0 : 0.0;
      step[i] = v - old;
      p[i] = v;
    }
    return clipped > 0;
  }

  std::pair<double, double> slopes_wide() const {
    double slope = 0, curvature = 0;
    const double *step = step_.data(), *change = change_.data(), *w = w_.data();
    const double shift = shift_;
#pragma omp simd reduction(+ : slope, curvature)
    for (std::size_t i = 0; i < w_.size(); ++i) {
      slope += (w[i] - shift) * step[i];
      curvature += change[i] * step[i];
    }
    return {slope, curvature};
  }

  void arrive_wide(double t) {
    const std::size_t n = grid_.size();
    const double *change = change_.data(), *step = step_.data(), cap = cap_;
    double *p = p_.data(), *w = w_.data(), *residual = field_.data();
    char* is_free = is_free_.data();
    double sum = 0, count = 0;
    if (t != 1) {
#pragma omp simd
      for (std::size_t i = 0; i < n; ++i) {
        const double v = p[i] - (1 - t) * step[i], above = v > 0 ? v : 0;
        p[i] = above < cap ? above : cap;
      }
    }
#pragma omp simd reduction(+ : sum, count)
    for (std::size_t i = 0; i < n; ++i) {
      const bool inside = p[i] > 0 && p[i] < cap;
      sum += inside ? w[i] + t * change[i] : 0;
      count += inside ? 1.0 : 0.0;
    }
    set_shift(sum, count, t);
    const double shift = shift_;
    double low = kInfinity, work = 0, free_count = 0;
#pragma omp simd reduction(min : low) reduction(+ : work, free_count)
    for (std::size_t i = 0; i < n; ++i) {
      const double gap = w[i] + t * change[i];
      const bool free = p[i] > 0 ? p[i] < cap || gap > shift : gap < shift;
      w[i] = gap;
      low = low < gap ? low : gap;
      work += p[i] * gap;
      is_free[i] = free;
      residual[i] = free ? gap - shift : 0;
      free_count += free ? 1.0 : 0.0;
    }
    low_ = low;
    work_ = work;
    free_count_ = static_cast<std::size_t>(free_count);
  }

  // Frank-Wolfe gap over load and height spread. Eq. contact.4
  double certify() {
    if (load_ <= 0) return low_ < shift_ ? kInfinity : 0;  // given approach, nothing touches yet
    double work = work_;
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
    if (problem_.approach) {  // Eq. contact.10
      work -= load_ * shift_;
      least = 2 * std::min(0.0, least - load_ * shift_);
    }
    return std::max(0.0, work - least) / (load_ * problem_.spread);
  }

  // Gaps and work of the state, in one pass over the fields.
  void close_gaps() {
    constexpr std::size_t kBlock = 512;
    double block[kBlock];
    const double *p = p_.data(), *w = w_.data(), *h = problem_.height.data(),
                 *t = problem_.traction.data();
    const double shift = shift_;
    double work = 0;
    state_.gap.reserve(p_.size());
    for (std::size_t begin = 0; begin < p_.size(); begin += kBlock) {
      const std::size_t count = std::min(kBlock, p_.size() - begin);
#pragma omp simd reduction(+ : work)
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = begin + k;
        block[k] = p[i] > 0 || w[i] < shift ? 0 : w[i] - shift;
        work += p[i] * (h[i] + w[i]);
      }
      if (t) {
#pragma omp simd reduction(+ : work)
        for (std::size_t i = begin; i < begin + count; ++i) work -= t[i] * (h[i] + w[i]);
      }
      state_.gap.insert(state_.gap.end(), block, block + count);
    }
    state_.work = work;
  }

  const StandardProblem& problem_;
  const ContactKernel& kernel_;
  const Grid& grid_;
  double cap_, load_, tolerance_;
  int max_iterations_;
  StandardState& state_;
  std::vector<double>& p_;  // of the state
  RealArray w_;             // gap function
  RealArray change_, step_, field_;
  SpectrumArray scratch_;
  int width_;                             // of the padded images below
  std::vector<float> residual_, inside_;  // of the free pixels; zero between uses
  // old_: the free set of the last step, held ones included; left_: of it, no longer free.
  std::vector<int> free_, held_, old_, left_;
  std::vector<double> r_, z_, ones_, raw_, next_low_;
  bool wide_ = false;
  std::vector<char> is_free_;  // where wide
  std::size_t free_count_ = 0;
  double shift_ = 0, low_ = 0, work_ = 0;  // work_: sum of pressure times gap function
};

// Start from the grid of half the pixels, its gaps the 2x2 minimum, solved as far as the start is
// worth. g0: the finer grid's gap function without pressure. pairs: in units of the finer grid.
std::vector<double> nested_start(const StandardProblem& fine_problem, const RealArray& g0,
                                 double tolerance, double& pairs) {
  const ContactKernel& kernel = fine_problem.kernel;
  const ContactKernel& coarse = *kernel.coarse();
  const Grid &fine_grid = kernel.grid(), &grid = coarse.grid();
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const std::size_t i = fine_grid.index(2 * ix, 2 * iy);
      const auto row = static_cast<std::size_t>(fine_grid.nx);
      height[grid.index(ix, iy)] =
          -std::min(std::min(g0[i], g0[i + 1]), std::min(g0[i + row], g0[i + row + 1]));
    }
  }
  StandardProblem problem{coarse,
                          height,
                          {},
                          fine_problem.spread,
                          fine_problem.load / 4,
                          fine_problem.cap,
                          fine_problem.approach,
                          fine_problem.level};
  const StandardState state = solve_dense(problem, std::max(tolerance, 2e-2), 200, {});
  pairs += 0.25 * state.pairs;
  // The load of a coarse pixel goes to its children as if they were springs of a pixel's own
  // compliance at their heights.
  std::vector<double> fine(fine_grid.size(), 0.0);
  const double yield = kernel.self_compliance();
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double p = state.p[grid.index(ix, iy)];
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

StandardState solve_dense(const StandardProblem& problem, double tolerance, int max_iterations,
                          std::span<const double> start) {
  StandardState state;
  RealArray without;
  if (!start.empty()) {
    state.p.assign(start.begin(), start.end());
  } else {
    SpectrumArray scratch;
    state.pairs += problem.rise_unpressed(without, scratch);
    for (std::size_t i = 0; i < without.size(); ++i) without[i] = -problem.height[i] - without[i];
    if (problem.kernel.coarse()) {
      state.p = nested_start(problem, without, tolerance, state.pairs);
    } else {
      const auto n = static_cast<double>(problem.height.size());
      state.p.assign(problem.height.size(), problem.load / n);
    }
  }
  DenseSolver(problem, tolerance, max_iterations, state).solve(std::move(without));
  return state;
}

}  // namespace papilla
