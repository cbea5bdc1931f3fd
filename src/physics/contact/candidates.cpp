#include "physics/contact/candidates.h"

#include <algorithm>
#include <cmath>

#include "numerics/loops.h"
#include "numerics/reductions.h"

namespace papilla::contact {
namespace {

constexpr std::size_t kLeastWatched = 16;
constexpr double kWatchedPerPressed = 3;

using Low = std::pair<double, int>;  // gap and pixel

// Less than wanted where it is demanded; false where so much contact is not worth trying.
bool affordable(double& wanted, const WatchLimits& limits) {
  const double most = 2 * static_cast<double>(limits.limit);
  if (!(wanted <= most)) {
    if (!limits.demand) return false;
    wanted = most;
  }
  return true;
}

std::size_t count_of(double wanted) {
  return std::max(kLeastWatched, static_cast<std::size_t>(wanted));
}

// The lowest values of score, found from a sample: `count` of them and some more.
std::vector<Low> lowest(std::span<const double> score, std::size_t count) {
  const std::size_t n = score.size();
  const std::size_t stride = std::max<std::size_t>(1, n / 8192) | 1;
  std::vector<double> sample;
  for (std::size_t i = 0; i < n; i += stride) sample.push_back(score[i]);
  const std::size_t rank = std::min(sample.size() - 1, 2 * count / stride + 12);
  std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(rank),
                   sample.end());
  const double below = sample[rank];
  std::vector<Low> low;
  for_each_where(
      n, [&](auto at) { return at(score) <= below; },
      [&](std::size_t i) { low.emplace_back(score[i], static_cast<int>(i)); });
  return low;
}

// The lowest `wanted` of them; touching at first: those under pressure, or half.
Watched watch(std::vector<Low> low, double wanted, std::span<const double> pressure) {
  const std::size_t count = count_of(wanted);
  if (low.size() > count) {
    std::nth_element(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(count), low.end());
    low.resize(count);
  }
  std::sort(low.begin(), low.end());
  Watched members;
  for (std::size_t k = 0; k < low.size(); ++k) {
    const int i = low[k].second;
    members.emplace_back(i, pressure.empty() ? 2 * k <= low.size() : pressure[i] > 0);
  }
  return members;
}

// Root mean square slope of a gap function, by differences of neighbours.
double rms_slope(const Grid& grid, std::span<const double> g0) {
  double slopes = 0;
  const auto last = static_cast<std::size_t>(grid.nx - 1);
  for (int iy = 0; iy < grid.ny; ++iy) {
    const double* row = g0.data() + grid.index(0, iy);
    const double* next = g0.data() + grid.index(0, iy + 1 < grid.ny ? iy + 1 : 0);
    const auto [along, across] = reduce(last, [&](auto at) {
      const auto here = at(row), dx = at(row + 1) - here, dy = at(next) - here;
      return std::tuple(dx * dx, dy * dy);
    });
    slopes += along / (grid.dx() * grid.dx()) + across / (grid.dy() * grid.dy());
  }
  return std::sqrt(slopes / static_cast<double>(grid.size()));
}

}  // namespace

std::optional<Watched> watch_lowest(const StandardProblem& problem, std::span<const double> g0,
                                    const WatchLimits& limits) {
  const double slope = rms_slope(problem.kernel.grid(), g0);
  const double expected = 2 * problem.load / (problem.kernel.contact_modulus() * slope);
  double wanted = 4 * expected;
  if (!affordable(wanted, limits)) return std::nullopt;
  return watch(lowest(g0, count_of(wanted)), wanted, {});
}

std::optional<Watched> watch_near(const StandardProblem& problem, const ContactSolution& start,
                                  const WatchLimits& limits) {
  // At least three pixels for each under pressure: spares the search where those are too many.
  double fewest = kWatchedPerPressed * static_cast<double>(count_above(start.pressure, 0));
  if (!affordable(fewest, limits)) return std::nullopt;
  // Pixels under pressure have no gap: they are among the lowest.
  std::vector<Low> low = lowest(start.gap, 2 * limits.limit);
  double load = 0, contact = 0;
  for (const auto& [gap, i] : low) {
    load += start.pressure[i];
    contact += start.pressure[i] > 0 ? 1.0 : 0.0;
  }
  if (!(load > 0)) return std::nullopt;
  double wanted = kWatchedPerPressed * contact * std::max(1.0, problem.load / load);
  if (!affordable(wanted, limits)) return std::nullopt;
  return watch(std::move(low), wanted, start.pressure);
}

}  // namespace papilla::contact
