#include "physics/contact/dense_listed.h"

#include <algorithm>

#include "physics/contact/dense_whole.h"

namespace papilla {
namespace {

// Where more than one in so many pixels is free the whole plane's inverse is the preconditioner: at
// 20 % contact (512^2, 1e-8) in 20 % less time than the stencil (docs/theory/contact.md, "Method").
constexpr std::size_t kPlaneFrom = 8;

}  // namespace

void ListedPixels::begin() {
  old_.clear();
  for (std::size_t i = 0; i < f_.p.size(); ++i) {
    if (f_.p[i] > 0) old_.push_back(static_cast<int>(i));
  }
  arrive(1);
}

void ListedPixels::take_over(const WholePixels& from) {
  free_.clear();
  held_.clear();
  left_.clear();
  r_.clear();
  for (std::size_t i = 0; i < f_.grid.size(); ++i) {
    const int pixel = static_cast<int>(i);
    if (from.is_free(i)) {
      free_.push_back(pixel);
      r_.push_back(f_.field[i]);
    } else {
      if (f_.p[i] > 0) held_.push_back(pixel);
      if (f_.step[i] != 0) left_.push_back(pixel);
    }
  }
}

void ListedPixels::precondition() {
  if (kPlaneFrom * free_.size() > f_.grid.size()) {
    precondition_by_plane();
  } else {
    stencil_.apply(free_, r_, !f_.problem.approach, z_, ones_);
  }
}

void ListedPixels::precondition_plainly() {
  const double stiffness = 1 / f_.kernel.self_compliance();
  double sum = 0;
  for (double r : r_) sum += stiffness * r;
  const double mean = f_.problem.approach ? 0 : sum / static_cast<double>(r_.size());
  ones_.assign(r_.size(), stiffness);
  z_.resize(r_.size());
  for (std::size_t k = 0; k < r_.size(); ++k) z_[k] = stiffness * r_[k] - mean;
}

void ListedPixels::precondition_by_plane() {
  f_.field.assign(f_.grid.size(), 0);
  for (std::size_t k = 0; k < free_.size(); ++k) f_.field[free_[k]] = r_[k];
  f_.press_field();
  z_.resize(free_.size());
  const int* at = free_.data();
  const double* field = f_.field.data();
  double* z = z_.data();
  double mean = 0;
#pragma omp simd reduction(+ : mean)
  for (std::size_t k = 0; k < free_.size(); ++k) {
    z[k] = field[at[k]];
    mean += z[k];
  }
  mean = f_.problem.approach ? 0 : mean / static_cast<double>(free_.size());
  for (double& value : z_) value -= mean;
  ones_.assign(free_.size(), 1 / f_.kernel.self_compliance());
}

double ListedPixels::conjugate_share() const {
  const int* at = free_.data();
  const double *change = f_.change.data(), *z = z_.data(), *step = f_.step.data();
  double cross = 0, own = 0;
#pragma omp simd reduction(+ : cross, own)
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double y = change[at[k]];
    cross += z[k] * y;
    own += step[at[k]] * y;
  }
  return own > 0 ? std::min(0.0, -cross / own) : 0;
}

bool ListedPixels::move(double alpha, bool conjugate) {
  const std::size_t m = free_.size();
  raw_.resize(m);
  const double share = conjugate ? conjugate_share() : 0;
  const int* at = free_.data();
  const double *z = z_.data(), *one = ones_.data();
  double *raw = raw_.data(), *p = f_.p.data(), *step = f_.step.data();
  const double cap = f_.cap;
  double sum = 0, ones = 0;
#pragma omp simd reduction(+ : sum, ones)
  for (std::size_t k = 0; k < m; ++k) {
    sum += z[k] + share * step[at[k]];
    ones += one[k];
  }
  const double tilt = ones > 0 && !f_.problem.approach ? sum / ones : 0;
#pragma omp simd
  for (std::size_t k = 0; k < m; ++k) {
    raw[k] = p[at[k]] - alpha * (z[k] + share * step[at[k]] - tilt * one[k]);
  }
  for (int i : left_) step[i] = 0;
  const double level =
      f_.problem.approach ? 0 : load_level(raw_, ones_, cap, f_.load_beside(held_.size()), f_.load);
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

StepSlopes ListedPixels::slopes() const {
  double slope = 0, curvature = 0;
  const int* at = free_.data();
  const double *step = f_.step.data(), *change = f_.change.data(), *r = r_.data();
#pragma omp simd reduction(+ : slope, curvature)
  for (std::size_t k = 0; k < free_.size(); ++k) {
    slope += r[k] * step[at[k]];
    curvature += change[at[k]] * step[at[k]];
  }
  return {slope, curvature};
}

double ListedPixels::room() const {
  double longest = kInfinity;
  for (int i : free_) longest = std::min(longest, room_of(f_.step[i], f_.p[i], f_.cap));
  return longest;
}

void ListedPixels::advance(double t) {
  if (t != 1) {
    for (int i : free_) f_.p[i] = std::clamp(f_.p[i] - (1 - t) * f_.step[i], 0.0, f_.cap);
  }
  old_.swap(free_);
  old_.insert(old_.end(), held_.begin(), held_.end());
  arrive(t);
}

// Gap function and lists of the new pressure, at t of the step; old_ holds every pixel under it.
void ListedPixels::arrive(double t) {
  double sum = 0, count = 0, work = 0;
  const int* old = old_.data();
  const double *gap = f_.gap.data(), *change = f_.change.data(), *p = f_.p.data();
  const double cap = f_.cap;
#pragma omp simd reduction(+ : sum, count, work)
  for (std::size_t k = 0; k < old_.size(); ++k) {
    const double pressure = p[old[k]], w = gap[old[k]] + t * change[old[k]];
    const bool inside = pressure > 0 && pressure < cap;
    work += pressure * w;
    sum += inside ? w : 0;
    count += inside ? 1 : 0;
  }
  f_.work = work;
  f_.set_shift(sum, count, t);
  sort_pressed(t);
  add_joining(t);
  r_.resize(free_.size());
  const int* at = free_.data();
  double* r = r_.data();
  const double shift = f_.shift;
#pragma omp simd
  for (std::size_t k = 0; k < free_.size(); ++k) r[k] = gap[at[k]] - shift;
}

// old_ into those still free, held and left.
void ListedPixels::sort_pressed(double t) {
  held_.clear();
  left_.clear();
  free_.resize(old_.size());
  std::size_t pressed = 0;
  for (int i : old_) {  // every one is written, those that stay are counted
    free_[pressed] = i;
    if (f_.p[i] == f_.cap && f_.gap[i] + t * f_.change[i] <= f_.shift) {
      held_.push_back(i);
      left_.push_back(i);
    } else if (f_.p[i] > 0) {
      ++pressed;
    } else {
      left_.push_back(i);
    }
  }
  free_.resize(pressed);
}

// The gap function moves to t of the step; pixels without pressure that penetrate become free.
void ListedPixels::add_joining(double t) {
  constexpr std::size_t kBlock = 64;
  int joining[kBlock];
  double* gap = f_.gap.data();
  const double *change = f_.change.data(), *p = f_.p.data(), shift = f_.shift;
  const std::size_t n = f_.p.size();
  double lowest = kInfinity;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, n);
    double low = kInfinity;
#pragma omp simd reduction(min : low)
    for (std::size_t i = begin; i < end; ++i) {
      gap[i] += t * change[i];
      low = low < gap[i] ? low : gap[i];
    }
    if (low >= shift) continue;
    lowest = std::min(lowest, low);
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
  f_.low = lowest < shift ? lowest : *std::min_element(f_.gap.begin(), f_.gap.end());
}

}  // namespace papilla
