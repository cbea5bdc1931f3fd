// Each loop over several places or nodes at once gives what it gives one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/gap_table.h"
#include "tests/numerics/both_ways.h"

namespace papilla::tests::pixel_by_pixel_test {
namespace {

using namespace papilla::capillary;

TEST(PixelByPixel, DiscsRimsAndDirectionsOfAGapAreTheSame) {
  const Grid grid{37, 22, 11e-6, 9e-6};
  Gap gap{grid, std::vector<double>(grid.size())};
  RandomStream random(5, "gap table", 0);
  for (double& h : gap.value) h = 1e-6 * random.uniform();
  const GapTable table(gap, 1e-8);
  // From less than a pixel to more than the patch, inside it and across its borders.
  for (const double radius : {1e-7, 5e-7, 2e-6, 7e-6, 30e-6}) {
    for (const auto& [x, y] : {std::pair{5.5e-6, 4.5e-6}, {0.2e-6, 8.9e-6}, {10.9e-6, 0.1e-6}}) {
      const GapTable::Rule rule = table.rule(radius);
      const auto [together, apart] = both_ways([&, x = x, y = y] {
        const GapTable::Rim rim = table.rim(x, y, radius, rule);
        std::vector<double> out{table.disc_volume(x, y, radius, rule) / (radius * radius), rim.gap,
                                1e-6 * rim.slope};
        for (const double h : table.around(x, y, radius)) out.push_back(h);
        return out;
      });
      expect_alike(together, apart, 1e-13, "gaps");
    }
  }
}

TEST(PixelByPixel, TheProfileOfABridgeIsTheSame) {
  for (const double degrees : {20.0, 60.0, 120.0}) {
    bridge_branch::Unknowns x{0.6, -1.3, 0.4};
    const auto [together, apart] =
        both_ways([&] { return bridge_branch::profile(x, degrees * kPi / 180); });
    const auto numbers = [](const bridge_branch::Profile& p) {
      std::vector<double> out{p.height, p.volume, p.free_area, p.w, p.u, p.r2};
      for (const auto& slopes : {p.height_slope, p.volume_slope, p.w_slope, p.u_slope})
        out.insert(out.end(), slopes.begin(), slopes.end());
      return out;
    };
    expect_alike(numbers(together), numbers(apart), 1e-14, "profile");
  }
}

}  // namespace
}  // namespace papilla::tests::pixel_by_pixel_test
