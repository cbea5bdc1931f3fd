#include "physics/contact/dense_whole.h"

#include <algorithm>

#include "physics/contact/dense_listed.h"

namespace papilla {

void WholePixels::take_over(const ListedPixels& from) {
  f_.field.assign(f_.grid.size(), 0);
  is_free_.assign(f_.grid.size(), 0);
  for (std::size_t k = 0; k < from.free().size(); ++k) {
    is_free_[from.free()[k]] = 1;
    f_.field[from.free()[k]] = from.residual()[k];
  }
  free_count_ = from.free_count();
  for (int i : from.left()) f_.step[i] = 0;
}

void WholePixels::precondition_plainly() {
  const double stiffness = 1 / f_.kernel.self_compliance();
  for (double& r : f_.field) r *= stiffness;
}

bool WholePixels::move(double alpha, bool conjugate) {
  const std::size_t n = f_.grid.size();
  const char* is_free = is_free_.data();
  const double *change = f_.change.data(), cap = f_.cap;
  double *z = f_.field.data(), *p = f_.p.data(), *step = f_.step.data();
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
  const bool approach = f_.problem.approach;
  const auto m = static_cast<double>(free_count_);
  const double mean = approach ? 0 : sum / m;
  const double share = own > 0 ? std::min(0.0, -(cross - mean * changes) / own) : 0;
  const double tilt = approach ? 0 : mean + share * steps / m;
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const double along = p[i] - alpha * (z[i] + share * step[i] - tilt);
    z[i] = is_free[i] ? along : p[i] > 0 ? kBarred : -kBarred;
  }
  const double level = approach ? 0 : load_level(f_.field, {}, cap, f_.load, f_.load);
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

StepSlopes WholePixels::slopes() const {
  double slope = 0, curvature = 0;
  const double *step = f_.step.data(), *change = f_.change.data(), *w = f_.gap.data();
  const double shift = f_.shift;
#pragma omp simd reduction(+ : slope, curvature)
  for (std::size_t i = 0; i < f_.gap.size(); ++i) {
    slope += (w[i] - shift) * step[i];
    curvature += change[i] * step[i];
  }
  return {slope, curvature};
}

double WholePixels::room() const {
  const double *p = f_.p.data(), *step = f_.step.data(), cap = f_.cap;
  double longest = kInfinity;
#pragma omp simd reduction(min : longest)
  for (std::size_t i = 0; i < f_.p.size(); ++i) {
    const double found = room_of(step[i], p[i], cap);
    longest = found < longest ? found : longest;
  }
  return longest;
}

void WholePixels::advance(double t) {
  const std::size_t n = f_.grid.size();
  const double *change = f_.change.data(), *step = f_.step.data(), cap = f_.cap;
  double *p = f_.p.data(), *w = f_.gap.data(), *residual = f_.field.data();
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
  f_.set_shift(sum, count, t);
  const double shift = f_.shift;
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
  f_.low = low;
  f_.work = work;
  free_count_ = static_cast<std::size_t>(free_count);
}

}  // namespace papilla
