// The file that is written and what the process makes of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "fabricate/export.h"
#include "geometry/io/mask.h"
#include "geometry/texture.h"

namespace papilla::tests::compensation_test {
namespace {

// Share of the patch that lies below half the depth; with the walls moved by `growth` into what is
// deep, as an oxide does it.
double deep_share(const Texture& texture, double growth) {
  const Heightmap h = generate(texture, patch_grid(texture, 384, 12e-6));
  const double middle =
      0.5 * (*std::min_element(h.z.begin(), h.z.end()) + *std::max_element(h.z.begin(), h.z.end()));
  std::vector<std::uint8_t> deep(h.z.size());
  for (std::size_t i = 0; i < deep.size(); ++i) deep[i] = h.z[i] < middle;
  const std::vector<double> to_wall = distance_inside(h.grid, deep);
  double count = 0;
  for (double d : to_wall) count += d > growth + 0.5 * h.grid.dx() * (growth > 0);
  return count / static_cast<double>(to_wall.size());
}

TEST(Compensation, WhatTheProcessMakesOfTheFileIsTheDesign) {
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 100e-9, holes.wall_angle = kPi / 2;
  PillarArray pillars;
  pillars.period = 6e-6, pillars.diameter = 3e-6, pillars.height = 100e-9;
  pillars.wall_angle = kPi / 2;
  Grating grooves;
  grooves.period = 6e-6, grooves.width = 3e-6, grooves.depth = 100e-9;
  grooves.wall_angle = kPi / 2;
  const double growth = 250e-9;
  for (const Texture& wanted : {Texture{holes}, Texture{pillars}, Texture{grooves}}) {
    const Texture written = compensated(wanted, {growth, 0});
    const double design = deep_share(wanted, 0);
    EXPECT_NEAR(deep_share(written, growth), design, 0.02) << texture_name(wanted);
    // Without compensation the holes are too narrow and the pillars too wide.
    EXPECT_LT(deep_share(wanted, growth), design - 0.06) << texture_name(wanted);
  }
}

TEST(Compensation, PillarsAreDrawnNarrowerByBothTheirSides) {
  PillarArray pillars;
  pillars.diameter = 3e-6;
  const Texture written = compensated(Texture{pillars}, {250e-9, 0});
  EXPECT_NEAR(std::get<PillarArray>(written.kind).diameter, 2.5e-6, 1e-15);
}

}  // namespace
}  // namespace papilla::tests::compensation_test
