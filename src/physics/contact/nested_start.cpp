#include <algorithm>
#include <cmath>

#include "physics/contact/solvers.h"

namespace papilla {
namespace {

// A start is worth this certificate, and no more steps than these.
constexpr double kStartTolerance = 2e-2;
constexpr int kStartIterations = 200;

// The load of a coarse pixel goes to its children as if they were springs of a pixel's own
// compliance at their heights.
std::vector<double> to_children(const std::vector<double>& coarse, const Grid& grid,
                                const ContactKernel& kernel, const RealArray& g0) {
  const Grid& fine_grid = kernel.grid();
  std::vector<double> fine(fine_grid.size(), 0.0);
  const double yield = kernel.self_compliance();
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const double p = coarse[grid.index(ix, iy)];
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
  const StandardState state =
      solve_dense(problem, std::max(tolerance, kStartTolerance), kStartIterations, {});
  pairs += 0.25 * state.pairs;
  return to_children(state.p, coarse.grid(), kernel, g0);
}

}  // namespace papilla
