#include "physics/contact/dense_listed.h"

#include <algorithm>

#include "numerics/loops.h"
#include "numerics/reductions.h"
#include "physics/contact/dense_whole.h"

namespace papilla::contact {
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
  const double mean =
      f_.problem.approach ? 0 : stiffness * sum(r_) / static_cast<double>(r_.size());
  ones_.assign(r_.size(), stiffness);
  z_.resize(r_.size());
  for_each_pixel(r_.size(), [&](auto at) { at.store(z_, stiffness * at(r_) - mean); });
}

void ListedPixels::precondition_by_plane() {
  f_.field.assign(f_.grid.size(), 0);
  for (std::size_t k = 0; k < free_.size(); ++k) f_.field[free_[k]] = r_[k];
  f_.press_field();
  z_.resize(free_.size());
  const double all = sum_over(free_.size(), [&](auto at) {
    const auto z = at.listed(f_.field, free_);
    at.store(z_, z);
    return z;
  });
  const double mean = f_.problem.approach ? 0 : all / static_cast<double>(free_.size());
  for_each_pixel(free_.size(), [&](auto at) { at.store(z_, at(z_) - mean); });
  ones_.assign(free_.size(), 1 / f_.kernel.self_compliance());
}

double ListedPixels::conjugate_share() const {
  const auto [cross, own] = reduce(free_.size(), [&](auto at) {
    const auto y = at.listed(f_.change, free_);
    return std::tuple(at(z_) * y, at.listed(f_.step, free_) * y);
  });
  return own > 0 ? std::min(0.0, -cross / own) : 0;
}

bool ListedPixels::move(double alpha, bool conjugate) {
  const std::size_t m = free_.size();
  raw_.resize(m);
  const double share = conjugate ? conjugate_share() : 0;
  const double cap = f_.cap;
  const auto [along, ones] = reduce(m, [&](auto at) {
    return std::tuple(at(z_) + share * at.listed(f_.step, free_), at(ones_));
  });
  const double tilt = ones > 0 && !f_.problem.approach ? along / ones : 0;
  for_each_pixel(m, [&](auto at) {
    const auto direction = at(z_) + share * at.listed(f_.step, free_) - tilt * at(ones_);
    at.store(raw_, at.listed(f_.p, free_) - alpha * direction);
  });
  for (int i : left_) f_.step[i] = 0;
  const double level =
      f_.problem.approach ? 0 : load_level(raw_, ones_, cap, f_.load_beside(held_.size()), f_.load);
  const double clipped = sum_over(m, [&](auto at) {
    const auto old = at.listed(f_.p, free_);
    const auto p = within_bounds(at(raw_) - level * at(ones_), cap);
    at.store_listed(f_.step, free_, p - old);
    at.store_listed(f_.p, free_, p);
    return chosen(meets_bound(old, p, cap), 1.0, 0.0);
  });
  return clipped > 0;
}

StepSlopes ListedPixels::slopes() const {
  const auto [slope, curvature] = reduce(free_.size(), [&](auto at) {
    const auto step = at.listed(f_.step, free_);
    return std::tuple(at(r_) * step, at.listed(f_.change, free_) * step);
  });
  return {slope, curvature};
}

double ListedPixels::room() const {
  return reduce(free_.size(), [&](auto at) {
    return Least(room_of(at.listed(f_.step, free_), at.listed(f_.p, free_), f_.cap));
  });
}

void ListedPixels::advance(double t) {
  if (t != 1) {
    for_each_pixel(free_.size(), [&](auto at) {
      const auto p = at.listed(f_.p, free_) - (1 - t) * at.listed(f_.step, free_);
      at.store_listed(f_.p, free_, within_bounds(p, f_.cap));
    });
  }
  old_.swap(free_);
  old_.insert(old_.end(), held_.begin(), held_.end());
  arrive(t);
}

// Gap function and lists of the new pressure, at t of the step; old_ holds every pixel under it.
void ListedPixels::arrive(double t) {
  const auto [gaps, count, work] = reduce(old_.size(), [&](auto at) {
    const auto p = at.listed(f_.p, old_);
    const auto gap = at.listed(f_.gap, old_) + t * at.listed(f_.change, old_);
    const auto inside = p > 0 && p < f_.cap;
    return std::tuple(chosen(inside, gap, 0.0), chosen(inside, 1.0, 0.0), p * gap);
  });
  f_.work = work;
  f_.set_shift(gaps, count, t);
  sort_pressed(t);
  add_joining(t);
  r_.resize(free_.size());
  for_each_pixel(free_.size(), [&](auto at) { at.store(r_, at.listed(f_.gap, free_) - f_.shift); });
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
  const std::size_t n = f_.p.size();
  double lowest = kInfinity;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, n);
    const double low = reduce(begin, end, [&](auto at) {
      const auto gap = at(f_.gap) + t * at(f_.change);
      at.store(f_.gap, gap);
      return Least(gap);
    });
    if (low >= f_.shift) continue;
    lowest = std::min(lowest, low);
    for_each_where(
        begin, end, [&](auto at) { return at(f_.gap) < f_.shift && at(f_.p) == 0; },
        [&](std::size_t i) { free_.push_back(static_cast<int>(i)); });
  }
  f_.low = lowest < f_.shift ? lowest : least(f_.gap);
}

}  // namespace papilla::contact
