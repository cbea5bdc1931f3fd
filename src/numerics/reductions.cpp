#include "numerics/reductions.h"

#include <algorithm>
#include <tuple>

#include "numerics/loops.h"

namespace papilla::numerics {

std::atomic<int> PixelByPixel::alive_{0};

double sum(std::span<const double> a) {
  return sum_over(a.size(), [&](auto at) { return at(a); });
}

double mean(std::span<const double> a) {
  return a.empty() ? 0 : sum(a) / static_cast<double>(a.size());
}

double dot(std::span<const double> a, std::span<const double> b) {
  return sum_over(a.size(), [&](auto at) { return at(a) * at(b); });
}

double least(std::span<const double> a) {
  return reduce(a.size(), [&](auto at) { return Least(at(a)); });
}

double largest(std::span<const double> a) {
  return reduce(a.size(), [&](auto at) { return Largest(at(a)); });
}

std::size_t count_above(std::span<const double> a, double bound) {
  return static_cast<std::size_t>(
      sum_over(a.size(), [&](auto at) { return chosen(at(a) > bound, 1.0, 0.0); }));
}

double variance(std::span<const double> a) {
  const auto n = static_cast<double>(a.size());
  const double origin = a[0];  // near enough to the mean against cancellation
  const auto [sum, squares] = reduce(a.size(), [&](auto at) {
    const auto v = at(a) - origin;
    return std::tuple(v, v * v);
  });
  return std::max(squares / n - (sum / n) * (sum / n), 0 * squares);
}

}  // namespace papilla::numerics
