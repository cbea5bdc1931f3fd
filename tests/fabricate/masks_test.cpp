// Where a mask means something.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fabricate/export.h"
#include "tests/cli/program.h"

namespace papilla::tests::masks_test {
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

// Each file is named before it is written; a long one says how far it is.
TEST(Progress, NamesEveryFileAndTheShareOfARepeatedOne) {
  const Workplace place;
  Design design;
  design.texture = Texture{HoleArray{}};
  ExportOptions options;
  options.formats = {"gsf", "exr"};
  options.pixels = 32, options.repeat = 8;
  std::map<std::string, std::vector<double>> told;
  export_design(design, options, place.path().string(), [&](const std::string& file, double share) {
    told[std::filesystem::path(file).filename().string()].push_back(share);
  });
  EXPECT_EQ(told["heightmap.gsf"], std::vector<double>{0});
  const std::vector<double>& shares = told["heightmap.exr"];
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 7.0 / 8);
}

}  // namespace
}  // namespace papilla::tests::masks_test
