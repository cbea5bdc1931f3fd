#include "physics/contact/dense_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/loops.h"
#include "numerics/reductions.h"

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
  const double carried = sum(p);
  if (carried <= 0) {
    std::fill(p.begin(), p.end(), load / static_cast<double>(p.size()));
    return;
  }
  if (!std::isfinite(cap)) {
    const double factor = load / carried;
    for (double& v : p) v *= factor;
    return;
  }
  // What is at the cap stays there, and what is a rounding below it belongs there: it flows, so its
  // gap function lies below the shift, of which that of an elastic pixel is a sample.
  constexpr double kRounding = 1e-12;
  double factor = 1;
  for (int k = 0; k < 60; ++k) {
    double full = 0, open = 0;  // carried at the cap, and below it
    for (double& v : p) {
      if (v > 0 && v < cap) v *= factor;
      if (v >= (1 - kRounding) * cap) v = cap;
      (v < cap ? open : full) += v;
    }
    const double left = load - full;
    if (std::abs(left - open) <= kRounding * load) return;
    if (left <= 0) {  // more than the load is at the cap: all of it gives way
      for (double& v : p) v *= load / (full + open);
      return;
    }
    if (open == 0) {
      press_highest(left);
      return;
    }
    factor = left / open;
  }
}

void DenseFields::press_highest(double rest) {
  std::vector<std::size_t> bare;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] == 0) bare.push_back(i);
  }
  const double needed = std::ceil(rest / cap);
  const std::size_t count = std::min(bare.size(), static_cast<std::size_t>(needed));
  const auto higher = [&](std::size_t i, std::size_t j) {
    return std::pair(-problem.height[i], i) < std::pair(-problem.height[j], j);
  };
  std::nth_element(bare.begin(), bare.begin() + static_cast<std::ptrdiff_t>(count), bare.end(),
                   higher);
  for (std::size_t k = 0; k < count; ++k) p[bare[k]] = rest / static_cast<double>(count);
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
    load = numerics::sum(p);
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

void DenseFields::settle_shift() {
  if (problem.approach || !std::isfinite(cap)) return;
  const double yield = kernel.self_compliance();
  field.resize(p.size());
  for_each_pixel(p.size(), [&](auto at) { at.store(field, at(p) - at(gap) / yield); });
  shift = -yield * load_level(field, {}, cap, load, load);
}

double DenseFields::certificate() {
  if (load <= 0) return low < shift ? kInfinity : 0;  // given approach, nothing touches yet
  double pressed = work;
  double least = low * load;
  if (problem.approach) {  // Eq. contact.10
    pressed -= load * shift;
    least = 2 * std::min(0.0, least - load * shift);
    if (std::isfinite(cap)) {  // no pixel can gain more than the cap on it does
      least = std::max(least, cap * sum_over(gap.size(), [&](auto at) {
                                return smaller(at(gap) - shift, 0.0);
                              }));
    }
  } else if (std::isfinite(cap)) {  // the cheapest pressure fills the lowest pixels to the cap
    sorted_.assign(gap.begin(), gap.end());
    const auto whole = std::min(sorted_.size() - 1, static_cast<std::size_t>(load / cap));
    std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(whole),
                     sorted_.end());
    least = 0;
    for (std::size_t i = 0; i < whole; ++i) least += cap * sorted_[i];
    least += (load - cap * static_cast<double>(whole)) * sorted_[whole];
  }
  return std::max(0.0, pressed - least) / (load * problem.spread);
}

void DenseFields::close_gaps() {
  const std::span<const double> height = problem.height, traction = problem.traction;
  state.gap.resize(p.size());
  state.work = sum_over(p.size(), [&](auto at) {
    const auto pressure = at(p), w = at(gap);
    at.store(state.gap, chosen(pressure > 0.0 || w < shift, 0.0, w - shift));
    return (pressure - at(traction, 0)) * (at(height) + w);
  });
}

double load_level(std::span<const double> raw, std::span<const double> ones, double cap,
                  double load, double scale) {
  double level = 0, below = -kInfinity, above = kInfinity;
  for (int pass = 0; pass < 100; ++pass) {
    const auto [sum, weight] = reduce(raw.size(), [&](auto at) {
      const auto one = at(ones, 1), v = at(raw) - level * one;
      return std::tuple(within_bounds(v, cap), chosen(v > 0.0 && v < cap, one, 0.0));
    });
    if (std::abs(sum - load) <= 1e-13 * scale) break;
    (sum > load ? below : above) = level;
    double next = weight > 0 ? level + (sum - load) / weight : kInfinity;
    if (!(next > below && next < above)) {
      double size = 0;
      for (std::size_t k = 0; k < raw.size(); ++k) {
        const double one = ones.empty() ? 1 : ones[k], v = std::abs(raw[k] - level * one) / one;
        if (std::abs(raw[k]) != kBarred) size = std::max(size, v);
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
