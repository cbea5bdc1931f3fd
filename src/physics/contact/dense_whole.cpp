#include "physics/contact/dense_whole.h"

#include <algorithm>

#include "numerics/loops.h"
#include "physics/contact/dense_listed.h"

namespace papilla::contact {

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
  for_each_pixel(f_.field.size(), [&](auto at) { at.store(f_.field, stiffness * at(f_.field)); });
}

bool WholePixels::move(double alpha, bool conjugate) {
  const std::size_t n = f_.grid.size();
  double all = 0, cross = 0, own = 0, changes = 0, steps = 0;
  if (conjugate) {
    std::tie(all, cross, own, changes, steps) = reduce(n, [&](auto at) {
      const auto in = at(is_free_), z = in * at(f_.field), y = in * at(f_.change);
      const auto step = at(f_.step);
      return std::tuple(z, z * y, step * y, y, in * step);
    });
  } else {
    all = sum_over(n, [&](auto at) { return at(is_free_) * at(f_.field); });
  }
  const bool approach = f_.problem.approach;
  const auto m = static_cast<double>(free_count_);
  const double mean = approach ? 0 : all / m;
  const double share = own > 0 ? std::min(0.0, -(cross - mean * changes) / own) : 0;
  const double tilt = approach ? 0 : mean + share * steps / m;
  for_each_pixel(n, [&](auto at) {
    const auto p = at(f_.p), along = p - alpha * (at(f_.field) + share * at(f_.step) - tilt);
    const auto barred = chosen(p > 0.0, decltype(p)(kBarred), -kBarred);
    at.store(f_.field, chosen(at(is_free_) > 0.0, along, barred));
  });
  const double level = approach ? 0 : load_level(f_.field, {}, f_.cap, f_.load, f_.load);
  const double clipped = sum_over(n, [&](auto at) {
    const auto old = at(f_.p), p = within_bounds(at(f_.field) - level, f_.cap);
    at.store(f_.step, p - old);
    at.store(f_.p, p);
    return chosen(meets_bound(old, p, f_.cap), 1.0, 0.0);
  });
  return clipped > 0;
}

StepSlopes WholePixels::slopes() const {
  const auto [slope, curvature] = reduce(f_.grid.size(), [&](auto at) {
    const auto step = at(f_.step);
    return std::tuple((at(f_.gap) - f_.shift) * step, at(f_.change) * step);
  });
  return {slope, curvature};
}

double WholePixels::room() const {
  return reduce(f_.grid.size(),
                [&](auto at) { return Least(room_of(at(f_.step), at(f_.p), f_.cap)); });
}

void WholePixels::advance(double t) {
  const std::size_t n = f_.grid.size();
  if (t != 1) {
    for_each_pixel(n, [&](auto at) {
      at.store(f_.p, within_bounds(at(f_.p) - (1 - t) * at(f_.step), f_.cap));
    });
  }
  const auto [gaps, count] = reduce(n, [&](auto at) {
    const auto inside = at(f_.p) > 0.0 && at(f_.p) < f_.cap;
    return std::tuple(chosen(inside, at(f_.gap) + t * at(f_.change), 0.0),
                      chosen(inside, 1.0, 0.0));
  });
  f_.set_shift(gaps, count, t);
  const auto [low, work, free_count] = reduce(n, [&](auto at) {
    const auto p = at(f_.p), gap = at(f_.gap) + t * at(f_.change);
    const auto free = chosen(p > 0.0, p < f_.cap || gap > f_.shift, gap < f_.shift);
    at.store(f_.gap, gap);
    at.store(is_free_, free);
    at.store(f_.field, chosen(free, gap - f_.shift, 0.0));
    return std::tuple(Least(gap), p * gap, chosen(free, 1.0, 0.0));
  });
  f_.low = low;
  f_.work = work;
  free_count_ = static_cast<std::size_t>(free_count);
}

}  // namespace papilla::contact
