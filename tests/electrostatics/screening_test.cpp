// What fades beside water, against the distance to every wet pixel.
#include "physics/electrostatics/screening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"

namespace papilla::tests::screening_test {
namespace {

// To the nearest wet pixel of the periodic patch [m].
double nearest_water(const Grid& g, const std::vector<std::uint8_t>& wet, int ix, int iy) {
  double best = kInfinity;
  for (int y = 0; y < g.ny; ++y) {
    for (int x = 0; x < g.nx; ++x) {
      if (!wet[g.index(x, y)]) continue;
      const int dx = std::min(std::abs(x - ix), g.nx - std::abs(x - ix));
      const int dy = std::min(std::abs(y - iy), g.ny - std::abs(y - iy));
      best = std::min(best, std::hypot(dx * g.dx(), dy * g.dy()));
    }
  }
  return best;
}

// Rows of no whole register, oblong pixels, gaps from a thousandth of a pixel to the patch.
TEST(AirScreening, IsThatOfTheNearestWetPixelHoweverFar) {
  for (const double share : {0.0, 0.002, 0.02, 0.3, 1.0}) {
    const Grid grid{37, 22, 3.7e-6, 4.4e-6};
    RandomStream random(3, "wet", static_cast<std::uint64_t>(1000 * share));
    Gap gap{grid, std::vector<double>(grid.size())};
    Wetting wetting;
    wetting.grid = grid;
    wetting.bridged.resize(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
      gap.value[i] = std::pow(10, -10 + 4.5 * random.uniform());
      wetting.bridged[i] = random.uniform() < share;
    }
    const std::vector<double> factor = air_screening_factor(gap, wetting, true);
    if (factor.empty()) {
      EXPECT_EQ(std::count(wetting.bridged.begin(), wetting.bridged.end(), 1), 0);
      continue;
    }
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const std::size_t i = grid.index(ix, iy);
        const double width = 2 / kPi * std::max(gap.value[i], 1e-9);
        const double x = nearest_water(grid, wetting.bridged, ix, iy) / width;
        EXPECT_NEAR(factor[i], x < 4 ? square(std::tanh(x)) : 1, 4e-6) << ix << ' ' << iy;
      }
    }
  }
}

}  // namespace
}  // namespace papilla::tests::screening_test
