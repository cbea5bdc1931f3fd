#include "physics/contact/dense_fields.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace papilla::contact {

DenseFields::DenseFields(const StandardProblem& standard, StandardState& state_of)
    : problem(standard),
      kernel(standard.kernel),
      grid(kernel.grid()),
      state(state_of),
      cap(standard.cap),
      load(standard.load),
      p(state_of.p),
      step(grid.size(), 0.0),
      change(grid.size()),
      scratch_(kernel.scratch_size()) {}

void DenseFields::scale_to_load() {
  const auto n = static_cast<double>(p.size());
  double sum = 0;
  for (double v : p) sum += v;
  if (sum <= 0) {
    std::fill(p.begin(), p.end(), load / n);
    return;
  }
  double factor = load / sum;
  if (!std::isfinite(cap)) {
    for (double& v : p) v *= factor;
    return;
  }
  for (int k = 0; k < 60; ++k) {
    double total = 0, open = 0;
    for (double& v : p) {
      v = std::min(v * factor, cap);
      total += v;
      if (v < cap) open += v;
    }
    if (std::abs(total - load) <= 1e-13 * load) return;
    if (open > 0 && open + load - total > 0) {
      factor = 1 + (load - total) / open;
    } else {  // everything is at the cap but load is left: open the whole patch
      for (double& v : p) v = std::min(v + (load - total) / n, cap);
      factor = 1;
    }
  }
}

void DenseFields::start(RealArray without) {
  ++state.pairs;
  if (without.empty()) {
    gap.assign(problem.height.size(), 0.0);
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = -problem.height[i];
    change.assign(p.begin(), p.end());
    for (std::size_t i = 0; i < problem.traction.size(); ++i) change[i] -= problem.traction[i];
  } else {
    gap = std::move(without);
    change.assign(p.begin(), p.end());
  }
  kernel.displace(change, change, scratch_);
}

void DenseFields::displace_step() {
  kernel.displace(step, change, scratch_);
  ++state.pairs;
}

void DenseFields::press_field() {
  kernel.press(field, scratch_);
  ++state.pairs;
}

void DenseFields::set_shift(double sum, double count, double t) {
  if (problem.approach) {
    shift = problem.level;
    load = std::accumulate(p.begin(), p.end(), 0.0);
  } else if (count > 0) {
    shift = sum / count;
  } else {  // all at the cap: between the highest of them and the lowest of the others
    double lowest = kInfinity, highest = -kInfinity;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double w = gap[i] + t * change[i];
      if (p[i] == 0) {
        lowest = std::min(lowest, w);
      } else {
        highest = std::max(highest, w);
      }
    }
    shift = std::isfinite(lowest) ? 0.5 * (lowest + highest) : highest;
  }
}

double DenseFields::certificate() {
  if (load <= 0) return low < shift ? kInfinity : 0;  // given approach, nothing touches yet
  double pressed = work;
  double least = low * load;
  if (std::isfinite(cap)) {  // the cheapest pressure fills the lowest pixels to the cap
    sorted_.assign(gap.begin(), gap.end());
    const auto whole = std::min(sorted_.size() - 1, static_cast<std::size_t>(load / cap));
    std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(whole),
                     sorted_.end());
    least = 0;
    for (std::size_t i = 0; i < whole; ++i) least += cap * sorted_[i];
    least += (load - cap * static_cast<double>(whole)) * sorted_[whole];
  }
  if (problem.approach) {  // Eq. contact.10
    pressed -= load * shift;
    least = 2 * std::min(0.0, least - load * shift);
  }
  return std::max(0.0, pressed - least) / (load * problem.spread);
}

void DenseFields::close_gaps() {
  constexpr std::size_t kBlock = 512;
  double block[kBlock];
  const double *pressure = p.data(), *w = gap.data(), *h = problem.height.data(),
               *t = problem.traction.data();
  const double level = shift;
  double sum = 0;
  state.gap.reserve(p.size());
  for (std::size_t begin = 0; begin < p.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, p.size() - begin);
#pragma omp simd reduction(+ : sum)
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k;
      block[k] = pressure[i] > 0 || w[i] < level ? 0 : w[i] - level;
      sum += pressure[i] * (h[i] + w[i]);
    }
    if (t) {
#pragma omp simd reduction(+ : sum)
      for (std::size_t i = begin; i < begin + count; ++i) sum -= t[i] * (h[i] + w[i]);
    }
    state.gap.insert(state.gap.end(), block, block + count);
  }
  state.work = sum;
}

double load_level(std::span<const double> raw, std::span<const double> ones, double cap,
                  double load, double scale) {
  const double *value = raw.data(), *one = ones.data();
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
    if (std::abs(sum - load) <= 1e-13 * scale) break;
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

}  // namespace papilla::contact
