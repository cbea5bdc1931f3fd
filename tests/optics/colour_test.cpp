// The shift of colour against the tables of CIE 1931 and the definition of CIE 1976 u'v'.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/constants.h"
#include "geometry/texture.h"
#include "physics/optics/optics.h"

namespace papilla::tests::colour_test {
namespace {

// The 2 degree observer, 400 to 720 nm in steps of 20 nm (CIE 15:2004, table T.4).
constexpr std::array<std::array<double, 3>, 17> kObserver{{{0.01431, 0.000396, 0.06785},
                                                           {0.13438, 0.0040, 0.6456},
                                                           {0.34828, 0.0230, 1.74706},
                                                           {0.2908, 0.0600, 1.6692},
                                                           {0.09564, 0.13902, 0.81295},
                                                           {0.0049, 0.3230, 0.2720},
                                                           {0.06327, 0.7100, 0.07825},
                                                           {0.2904, 0.9540, 0.0203},
                                                           {0.5945, 0.9950, 0.0039},
                                                           {0.9163, 0.8700, 0.00165},
                                                           {1.0622, 0.6310, 0.0008},
                                                           {0.85445, 0.3810, 0.00019},
                                                           {0.4479, 0.1750, 0.00002},
                                                           {0.1649, 0.0610, 0},
                                                           {0.04677, 0.0170, 0},
                                                           {0.011359, 0.004102, 0},
                                                           {0.002899, 0.001047, 0}}};

// u' = 4x / (-2x + 12y + 3), v' = 9y / (-2x + 12y + 3) of the chromaticity x, y.
std::array<double, 2> chromaticity(const Optics& o, bool through) {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < kObserver.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      sum[k] += kObserver[i][k] * (through ? o.spectrum[i].transmitted : 1);
  }
  const double all = sum[0] + sum[1] + sum[2], x = sum[0] / all, y = sum[1] / all;
  return {4 * x / (-2 * x + 12 * y + 3), 9 * y / (-2 * x + 12 * y + 3)};
}

TEST(ColourShift, IsTheDistanceInUvOfTheTables) {
  for (double depth : {500e-9, 900e-9, 1200e-9}) {
    HoleArray holes;
    holes.period = 6e-6, holes.diameter = 4.5e-6, holes.depth = depth, holes.wall_angle = kPi / 2;
    const Texture texture{holes};
    const Optics o = array_screen(std::get<FeatureArray>(facts(texture).outline), {1.5, 1});
    ASSERT_EQ(o.spectrum.size(), kObserver.size());
    const auto seen = chromaticity(o, true), source = chromaticity(o, false);
    const double shift = std::hypot(seen[0] - source[0], seen[1] - source[1]);
    EXPECT_GT(shift, 0.01) << depth;
    EXPECT_NEAR(o.colour_shift, shift, 0.05 * shift) << depth;
  }
}

TEST(ColourShift, OfAFlatPlateIsNearlyNone) {
  const Optics o = phase_screen(generate({}, patch_grid({}, 32)), {1.5, 1});
  EXPECT_LT(o.colour_shift, 1e-6);
}

}  // namespace
}  // namespace papilla::tests::colour_test
