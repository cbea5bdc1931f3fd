// Where a mask means something.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "fabricate/export.h"

namespace papilla::tests {
namespace {

TEST(MaskShows, TexturesWithEdgesOnPixelsThatAreNoWiderThanHalfOfThem) {
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 5.6e-6;  // walls of 400 nm
  ExportOptions options;
  options.pixels = 64;  // of 187.5 nm over 12 um
  EXPECT_TRUE(mask_shows(Texture{holes}, options));
  options.pixels = 56;  // 214 nm
  EXPECT_FALSE(mask_shows(Texture{holes}, options));
  holes.depth = 0;  // flat: black all over
  EXPECT_TRUE(mask_shows(Texture{holes}, options));
  EXPECT_FALSE(mask_shows(Texture{RandomRough{}}, options));
  EXPECT_FALSE(mask_shows(Texture{ParticleFilm{}}, options));
  EXPECT_TRUE(mask_shows(Texture{}, options));
}

TEST(Rectangle, HasWholePeriodsAndNearlySquarePixels) {
  Design design;
  ExportOptions options;
  options.formats = {"npy"};
  options.size = 110e-6, options.size_y = 62e-6, options.pixels = 220;
  HoleArray holes;
  holes.period = 6e-6, holes.lattice = Lattice::Hexagonal;
  for (const Texture& texture : {Texture{holes}, Texture{RandomRough{}}, Texture{}}) {
    design.texture = texture;
    const Grid grid = prepare_export(design, options).heightmap.grid;
    const auto cell = facts(texture).cell;
    const double ly = cell ? cell->y * std::round(62e-6 / cell->y) : 62e-6;
    const double lx = cell ? cell->x * std::round(110e-6 / cell->x) : 110e-6;
    EXPECT_NEAR(grid.lx, lx, 1e-12) << texture_name(texture);
    EXPECT_NEAR(grid.ly, ly, 1e-12) << texture_name(texture);
    EXPECT_NEAR(grid.dy() / grid.dx(), 1, 0.01) << texture_name(texture);
  }
  // A strip that is narrower than a period has one.
  design.texture = Texture{holes};
  options.size_y = 1e-6;
  EXPECT_NEAR(prepare_export(design, options).heightmap.grid.ly, std::sqrt(3.0) * 6e-6, 1e-12);
}

}  // namespace
}  // namespace papilla::tests
